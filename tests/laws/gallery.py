"""Every wall, every rule and every scene carom has, as states and worlds to try laws on."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from hypothesis import strategies as st

from carom import scenes, walls
from carom.rules import Smooth
from carom.scene import Scene, Spheres
from carom.state import State
from carom.walls import Open, Periodic, Plane, Sphere, Wall
from carom.world import CYLINDER, PLANE, World

#: A wall or rule that gets `examples` is tried here from then on.
WALLS = [(wall,) for kind in walls.KINDS for wall in kind.examples()] + [
    (Periodic(8, 9, None), Plane((0, 0, 1), -5, 0.9), Plane((0, 0, -1), -5)),
    (Sphere(6), Plane((0, 0, 1), -4)),
    (Plane((0, 0, 1), -5), Plane((1, 0, 0), -5), Plane((-1, -1, -2), -5, 0.9)),
]
RULES = Smooth.examples()
ELASTIC = [both for both in WALLS if all(getattr(w, "restitution", 1.0) == 1.0 for w in both)]
FREE = [(Open(),), *((wall,) for wall in Periodic.examples())]
GRAVITIES = [(0.0, 0.0, 0.0), (0.0, 0.0, -1.0), (0.3, -0.2, -0.5)]
HALF = 5.0  #: half the side of the cube in which spheres start; it fits the examples of walls


@dataclass(frozen=True)
class Setting:
    """Some spheres between some walls; the seed draws places, sizes, masses and velocities."""

    walls: tuple[Wall, ...]
    rule: Smooth
    gravity: tuple[float, float, float]
    seed: int
    spheres: int
    fixed: int = 0
    collide: bool = True

    def build(self) -> tuple[State, World]:
        rng = np.random.default_rng(self.seed)
        closed = [self.axis_is_closed(axis) for axis in range(3)]
        pull = tuple(g * c for g, c in zip(self.gravity, closed, strict=True))
        there = walls.world(self.walls, self.rule, pull, self.collide)
        radius = rng.uniform(0.4, 1.0, self.spheres)
        places = self.places(rng, there, radius)
        n = len(places)
        # Inwards, so that they meet even where nothing holds them.
        velocity = rng.normal(size=(n, 3)) - 0.5 * places
        fixed = np.arange(n) < min(self.fixed, n - 1)
        velocity[fixed] = 0.0
        one = Spheres.of(places, velocity, radius[:n], rng.uniform(0.3, 3.0, n), fixed=fixed)
        scene = Scene(one, self.walls, self.rule, pull, self.collide)
        return scene.build()

    def axis_is_closed(self, axis: int) -> bool:
        """Gravity along a periodic axis is refused."""
        repeats = [w for w in self.walls if isinstance(w, Periodic)]
        return all((w.lx, w.ly, w.lz)[axis] is None for w in repeats)

    def places(self, rng: np.random.Generator, there: World, radius: np.ndarray) -> np.ndarray:
        """As many places as are found; the first is always there."""
        found: list[np.ndarray] = []
        for _ in range(100 * self.spheres):
            x = rng.uniform(-HALF, HALF, 3) * (0.99 if found else 0.1)
            if len(found) < self.spheres and fits(there, found, radius, x):
                found.append(x)
        return np.array(found)


def fits(there: World, found: list[np.ndarray], radius: np.ndarray, x: np.ndarray) -> bool:
    """Whether the next sphere has room at x."""
    own = radius[len(found)] * (1 + 1e-9)
    for wall in there.walls:
        flat = x * (1.0, 1.0, wall["kind"] != CYLINDER)
        room = wall["offset"] - np.linalg.norm(flat)
        if wall["kind"] == PLANE:
            room = wall["normal"] @ x - wall["offset"]
        if room < own:
            return False
    for other, size in zip(found, radius, strict=False):
        d = other - x
        long = np.where(there.period > 0, there.period, np.inf)
        d = d - np.where(there.period > 0, np.rint(d / long) * there.period, 0.0)
        if d @ d < (own + size) ** 2:
            return False
    return True


def settings(
    among: Iterable[tuple[Wall, ...]] = WALLS,
    rules: Iterable[Smooth] = RULES,
    gravities: Iterable[tuple[float, float, float]] = GRAVITIES,
    fixed: Iterable[int] = (0, 0, 1),
    collide: Iterable[bool] = (True, True, True, False),
) -> st.SearchStrategy[Setting]:
    """Settings of all kinds, or of some."""
    return st.builds(
        Setting,
        walls=st.sampled_from(list(among)),
        rule=st.sampled_from(list(rules)),
        gravity=st.sampled_from(list(gravities)),
        seed=st.integers(0, 2**32 - 1),
        spheres=st.integers(1, 14),
        fixed=st.sampled_from(list(fixed)),
        collide=st.sampled_from(list(collide)),
    )


@dataclass(frozen=True)
class Known:
    """A scene by name, small, from a seed."""

    name: str
    seed: int

    def build(self) -> tuple[State, World]:
        options = {option.name: option.default for option in scenes.options(self.name)}
        few = {"n": min(int(options.get("n", 0)), 24), "seed": self.seed, "digits": 3}
        return scenes.build(self.name, {k: v for k, v in few.items() if k in options}).build()


def known() -> st.SearchStrategy[Known]:
    """Scenes of every name."""
    return st.builds(Known, st.sampled_from(scenes.names()), st.integers(1, 2**31))


def anything() -> st.SearchStrategy[Setting | Known]:
    """Settings and scenes."""
    return settings() | known()


def elastic(world: World) -> World:
    """The same world without losses."""
    hard = world.walls.copy()
    hard["restitution"] = 1.0
    return replace(world, walls=hard, restitution=1.0, contact_time=0.0)
