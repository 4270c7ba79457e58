"""Random small scenes of every kind, as the (State, World) that engines are built from."""

from dataclasses import dataclass
from itertools import product

import numpy as np
from hypothesis import strategies as st

from carom.state import State
from carom.world import CYLINDER, PLANE, SPHERE, WALL, World

SURROUNDINGS = ("open", "box", "planes", "sphere", "cylinder")


@dataclass(frozen=True)
class Recipe:
    """What a scene is to be; the seed draws the rest."""

    seed: int
    spheres: int
    surroundings: str  #: what closes the axes that are not periodic
    periodic: tuple[bool, bool, bool]
    roominess: float  #: side of the world, in sphere diameters per cube root of their number
    restitution: float
    wall_restitution: float
    bounce_back: bool
    contact_time: float
    gravity: float
    straight_down: bool
    fixed: int
    size_ratio: float
    collide: bool

    def build(self) -> tuple[State, World]:
        rng = np.random.default_rng(self.seed)
        world = self.world(rng)
        return self.place(rng, world), world

    @property
    def side(self) -> float:
        return 1.05 + self.roominess * self.spheres ** (1 / 3)

    @property
    def open_axes(self) -> list[int]:
        periodic = self.periodic if self.surroundings not in ("sphere", "cylinder") else (0, 0, 0)
        return [k for k in range(3) if not periodic[k]]

    def world(self, rng: np.random.Generator) -> World:
        axes = self.open_axes
        period = np.array([0.0 if k in axes else self.side * rng.uniform(1, 1.3) for k in range(3)])
        gravity = np.zeros(3)
        if self.gravity > 0.0 and axes:
            pull = rng.normal(size=3) * (period == 0.0)
            if self.straight_down:
                pull = -np.eye(3)[axes[-1]]
            gravity = self.gravity * pull / np.linalg.norm(pull)
        return World(
            period=period,
            walls=self.walls(rng),
            restitution=self.restitution,
            contact_time=self.contact_time,
            gravity=gravity,
            collide=self.collide,
        )

    def walls(self, rng: np.random.Generator) -> np.ndarray:
        half, rows = self.side / 2, []
        if self.surroundings in ("box", "planes"):
            for axis, sign in product(self.open_axes, (1.0, -1.0)):
                normal = sign * np.eye(3)[axis]
                if self.surroundings == "planes":  # tilted, within the axes that are not periodic
                    normal = normal + 0.3 * rng.normal(size=3) * np.isin(range(3), self.open_axes)
                rows.append((PLANE, normal / np.linalg.norm(normal), -half))
        elif self.surroundings == "sphere":
            rows.append((SPHERE, np.zeros(3), half))
        elif self.surroundings == "cylinder":
            rows.append((CYLINDER, np.zeros(3), half))
            rows += [(PLANE, sign * np.eye(3)[2], -half) for sign in (1.0, -1.0)]
        e, back = self.wall_restitution, int(self.bounce_back)
        return np.array([(kind, back, normal, at, e) for kind, normal, at in rows], WALL)

    def place(self, rng: np.random.Generator, world: World) -> State:
        """As many of the spheres as fit, dropped one by one where they touch nothing."""
        state = State.empty(self.spheres)
        state.radius[:] = 0.5 * self.size_ratio ** -rng.random(self.spheres)
        state.mass[:] = rng.uniform(0.2, 3.0, self.spheres)
        state.velocity[:] = rng.normal(size=(self.spheres, 3))
        state.velocity[rng.random(self.spheres) < 0.1] = 0.0
        state.fixed[: min(self.fixed, self.spheres - 1)] = True
        state.mass[state.fixed] = np.inf
        state.velocity[state.fixed] = 0.0
        placed = 0
        for _ in range(200 * self.spheres):
            x = rng.uniform(-self.side / 2, self.side / 2, 3)
            if placed < self.spheres and self.fits(world, state, placed, x):
                state.position[placed] = x
                placed += 1
        return first(state, placed)

    def fits(self, world: World, state: State, i: int, x: np.ndarray) -> bool:
        radius = state.radius[i]
        for wall in world.walls:
            flat = x * (1.0, 1.0, wall["kind"] != CYLINDER)
            inside = wall["offset"] - np.linalg.norm(flat)
            if wall["kind"] == PLANE:
                inside = wall["normal"] @ x - wall["offset"]
            if inside < radius * (1.0 + 1e-9):
                return False
        for m in product((-1, 0, 1), repeat=3):
            r = state.position[:i] - x + m * world.period
            if np.any(np.linalg.norm(r, axis=1) < (state.radius[:i] + radius) * (1.0 + 1e-9)):
                return not self.collide
        return True


def first(state: State, n: int) -> State:
    """The first n spheres of a state."""
    arrays = "position velocity mass radius species color image collision_count fixed resting"
    return State(*(getattr(state, name)[:n] for name in arrays.split()))


def recipes(**fixed_choices: object) -> st.SearchStrategy[Recipe]:
    """Recipes of all kinds; a keyword fixes that field."""
    restitution = st.sampled_from([1.0, 1.0, 0.95, 0.7, 0.3, 0.0]) | st.floats(0.0, 1.0)
    choices = {
        "seed": st.integers(0, 2**32 - 1),
        "spheres": st.integers(1, 10),
        "surroundings": st.sampled_from(SURROUNDINGS),
        "periodic": st.tuples(st.booleans(), st.booleans(), st.booleans()),
        "roominess": st.floats(0.9, 2.0),
        "restitution": restitution,
        "wall_restitution": restitution,
        "bounce_back": st.booleans(),
        "contact_time": st.sampled_from([0.0, 0.0, 0.02, 0.3]),
        "gravity": st.sampled_from([0.0, 0.0, 1.0, 5.0]),
        "straight_down": st.booleans(),
        "fixed": st.sampled_from([0, 0, 0, 1, 2]),
        "size_ratio": st.sampled_from([1.0, 1.0, 3.0]),
        "collide": st.sampled_from([True, True, True, True, False]),
    }
    chosen = {name: st.just(value) for name, value in fixed_choices.items()}
    return st.builds(Recipe, **(choices | chosen))
