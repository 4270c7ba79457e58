"""One sphere and one wall as the reference engine sees them."""

import math
from dataclasses import dataclass

from carom.reference.periodic import Image
from carom.reference.times import (
    NEVER,
    ZERO,
    Vec,
    dot,
    landing,
    leaving,
    plus,
    sub,
)
from carom.state import Floats, State
from carom.world import CYLINDER, PLANE, World

#: Who met whom: (i, j, whole boxes between them) or (i, -1 - wall, (0, 0, 0)).
Contact = tuple[int, int, Image]


@dataclass(slots=True)
class Body:
    """A sphere, anchored at its own last event: nothing else changes what is stored here.

    Attributes
    ----------
    position, velocity : Vec
        At `time`; the position is wrapped into the box and `image` counts the boxes.
    acceleration : Vec
        Gravity; zero if fixed or resting.
    resting_on : int or None
        Number of the wall it rests on.
    contact : Contact or None
        Its last event.
    window_start, window_count, window_speed
        The watchdog for inelastic collapse.
    """

    position: Vec
    velocity: Vec
    acceleration: Vec
    image: Image
    time: float
    radius: float
    mass: float
    inverse_mass: float
    collision_count: int
    resting_on: int | None = None
    contact: Contact | None = None
    window_start: float = -math.inf
    window_count: int = 0
    window_speed: float = 0.0

    @property
    def fixed(self) -> bool:
        """Nothing moves it."""
        return self.inverse_mass == 0.0

    def at(self, time: float) -> tuple[Vec, Vec]:
        """Position (not wrapped anew) and velocity at a later time."""
        t = time - self.time
        position = plus(plus(self.position, t, self.velocity), 0.5 * t * t, self.acceleration)
        return position, plus(self.velocity, t, self.acceleration)

    def fly_to(self, time: float) -> None:
        """Move the anchor."""
        self.position, self.velocity = self.at(time)
        self.time = time

    def kick(self, impulse: Vec) -> None:
        """Receive an impulse."""
        self.velocity = plus(self.velocity, self.inverse_mass, impulse)
        self.collision_count += 1

    def collapses(self, time: float, speed: float, spheres: int) -> bool:
        """Count an inelastic event; True once 14 follow one another while the sphere goes nowhere.

        "Nowhere": at its fastest relative speed it moves less than 1e-12 radii from the first
        of them to the last. Less than 1e-15 is one moment, in which a blow may run through a
        row of touching `spheres`: then four for each sphere are allowed, up to 1000.
        """
        if self.fixed:
            return False
        self.window_speed = max(self.window_speed, speed)
        moved = (time - self.window_start) * self.window_speed
        if self.window_count == 0 or moved >= 1e-12 * self.radius:
            self.window_start, self.window_count, self.window_speed = time, 1, speed
            return False
        self.window_count += 1
        row = min(max(4 * spheres, 14), 1000)
        return self.window_count >= (row if moved < 1e-15 * self.radius else 14)


@dataclass(frozen=True, slots=True)
class Wall:
    """A plane, a spherical container or the side of a cylinder.

    `pressing` is gravity's component into a plane, if gravity is exactly perpendicular to it
    and holds spheres on it: only there can a sphere rest. Otherwise 0.
    """

    kind: int
    bounce_back: bool
    normal: Vec
    offset: float
    restitution: float
    pressing: float

    def across(self, a: Vec) -> Vec:
        """The part of a vector that a curved wall is curved in."""
        return (a[0], a[1], 0.0) if self.kind == CYLINDER else a

    def normal_at(self, position: Vec) -> Vec:
        """Unit normal into the gas where a sphere at `position` touches the wall."""
        if self.kind == PLANE:
            return self.normal
        r = self.across(position)
        length = math.sqrt(dot(r, r))
        return (-r[0] / length, -r[1] / length, -r[2] / length)

    def gap(self, body: Body) -> float:
        """Distance between a plane and a sphere's surface."""
        return dot(self.normal, body.position) - self.offset - body.radius

    def time(self, body: Body, *, just_hit: bool) -> float:
        """Time at which a sphere hits the wall, from the sphere's anchor on."""
        if self.kind == PLANE:
            bend = dot(self.normal, body.acceleration)
            if just_hit and bend >= 0.0:  # it leaves, whatever rounding says
                return NEVER
            return landing(self.gap(body), dot(self.normal, body.velocity), bend)
        parts = (body.position, body.velocity, body.acceleration)
        r, v, a = (self.across(part) for part in parts)
        return leaving(r, v, a, self.offset - body.radius)

    def curvature_acceleration(self, velocity: Vec, normal: Vec, radius: float) -> float:
        """v_t^2 / A of a sphere that follows a curved wall; 0 for a plane."""
        if self.kind == PLANE:
            return 0.0
        v = self.across(velocity)
        v = plus(v, -dot(v, normal), normal)
        return dot(v, v) / (self.offset - radius)


def vector(row: Floats) -> Vec:
    """Three numbers of an array as a tuple of floats."""
    x, y, z = row.tolist()
    return (x, y, z)


def walls_of(world: World) -> list[Wall]:
    """The walls of a world, in their order."""
    g = vector(world.gravity)
    walls = []
    for row in world.walls:
        kind, normal = int(row["kind"]), vector(row["normal"])
        falling = dot(g, normal)
        sideways = sub(g, (falling * normal[0], falling * normal[1], falling * normal[2]))
        level = dot(sideways, sideways) <= 1e-24 * dot(g, g)
        walls.append(
            Wall(
                kind=kind,
                bounce_back=bool(row["bounce_back"]),
                normal=normal,
                offset=float(row["offset"]),
                restitution=float(row["restitution"]),
                pressing=max(0.0, -falling) if kind == PLANE and level else 0.0,
            )
        )
    return walls


def bodies_of(state: State, world: World, walls: list[Wall]) -> list[Body]:
    """The spheres of a state. A resting one lies on the nearest wall it can rest on."""
    bodies = []
    floors = [k for k, wall in enumerate(walls) if wall.pressing > 0.0]
    for i in range(len(state)):
        fixed = bool(state.fixed[i])
        x, y, z = state.image[i].tolist()
        mass = float(state.mass[i])
        body = Body(
            position=vector(state.position[i]),
            velocity=vector(state.velocity[i]),
            acceleration=ZERO if fixed else vector(world.gravity),
            image=(x, y, z),
            time=float(state.time),
            radius=float(state.radius[i]),
            mass=mass,
            inverse_mass=0.0 if fixed else 1.0 / mass,
            collision_count=int(state.collision_count[i]),
        )
        if state.resting[i] and floors:
            _, body.resting_on = min((abs(walls[k].gap(body)), k) for k in floors)
            body.acceleration = ZERO
        bodies.append(body)
    return bodies
