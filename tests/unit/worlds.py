"""Small worlds of every kind, as the (State, World) that engines are built from."""

import hashlib
import math
from itertools import product

import numpy as np

from carom.engine import Engine, Stop
from carom.state import CAME_TO_REST, WOKE, State
from carom.world import CYLINDER, PLANE, SPHERE, WALL, World

DOWN = np.array([0.0, 0.0, -1.0])
UP = -DOWN
ORIGIN = (0.0, 0.0, 0.0)


def spheres(position, velocity=0.0, *, radius=0.5, mass=1.0, fixed=False, time=0.0):
    """A state; everything but the positions broadcasts."""
    position = np.asarray(position, float).reshape(-1, 3)
    state = State.empty(len(position))
    state.position[:] = position
    state.velocity[:] = velocity
    state.radius[:] = radius
    state.mass[:] = mass
    state.fixed[:] = fixed
    state.mass[state.fixed] = np.inf
    state.time = time
    return state


def grid(n, spacing):
    """n x n x n places about the origin."""
    return spacing * (np.stack(np.meshgrid(*[np.arange(n)] * 3), -1).reshape(-1, 3) - (n - 1) / 2)


def gas(n=3, spacing=1.5, seed=0, **options):
    """n x n x n spheres on a grid with random velocities."""
    places = grid(n, spacing)
    return spheres(places, np.random.default_rng(seed).normal(size=places.shape), **options)


def plane(normal, offset=0.0, restitution=1.0, bounce_back=False):
    normal = np.asarray(normal, float)
    return (PLANE, int(bounce_back), normal / np.linalg.norm(normal), offset, restitution)


def ball(radius, restitution=1.0):
    return (SPHERE, 0, ORIGIN, radius, restitution)


def walls(*rows):
    return np.array(list(rows), WALL)


def box(side, restitution=1.0):
    side = np.broadcast_to(side, 3)
    faces = product(range(3), (1.0, -1.0))
    return walls(*[plane(s * np.eye(3)[k], -side[k] / 2, restitution) for k, s in faces])


def can(radius, height, **options):
    ends = [plane(s * UP, -height / 2, **options) for s in (1.0, -1.0)]
    bounce_back, restitution = ends[0][1], ends[0][4]
    return walls((CYLINDER, bounce_back, ORIGIN, radius, restitution), *ends)


def mixture(seed=3, fixed=0):
    """27 spheres of different sizes and masses, the first few fixed."""
    draw = np.random.default_rng(seed)
    state = gas(3, 1.6, seed, radius=draw.uniform(0.2, 0.7, 27), mass=draw.uniform(0.2, 3, 27))
    state.fixed[:fixed] = True
    state.mass[:fixed] = np.inf
    state.velocity[:fixed] = 0.0
    return state


def with_giant():
    """124 small spheres round one eight times as large, which nothing drives at first."""
    state = gas(5, 3.0, 8, radius=np.where(np.arange(125) == 62, 4.0, 0.5))
    near = np.linalg.norm(state.position, axis=1) < 4.6
    near[62] = False
    keep = ~near
    state.mass[62] = 30.0
    state.velocity[62] = 0.0
    return spheres(
        *(a[keep] for a in (state.position, state.velocity)),
        radius=state.radius[keep],
        mass=state.mass[keep],
    )


def every_kind():
    """Each as {name: (state, world, time to run)}: some ten to fifty collisions per sphere."""
    cube = World(period=np.full(3, 5.0))
    return {
        "box": (gas(), World(walls=box(5.0)), 30.0),
        "periodic": (gas(), cube, 30.0),
        "unequal periods": (gas(2), World(period=np.array([3.1, 4.0, 7.0])), 40.0),
        "two in a small cube": (two(), World(period=np.full(3, 2.5)), 60.0),
        "slab with gravity": (
            gas(),
            World(
                period=np.array([5.0, 5.0, 0.0]),
                walls=walls(plane(UP, -3.0), plane(DOWN, -3.0)),
                gravity=DOWN,
            ),
            20.0,
        ),
        "contact time": (
            gas(),
            World(period=np.full(3, 5.0), restitution=0.8, contact_time=1e-3),
            60.0,
        ),
        "sphere with gravity": (gas(2), World(walls=walls(ball(3.0)), gravity=DOWN), 20.0),
        "bounce-back can": (gas(), World(walls=can(4.0, 6.0, bounce_back=True)), 30.0),
        "fixed ones under gravity": (
            mixture(fixed=4),
            World(walls=box(6.5), gravity=0.5 * DOWN),
            15.0,
        ),
        "mixture": (mixture(), World(period=np.full(3, 5.0), restitution=0.95), 20.0),
        "giant": (with_giant(), World(period=np.full(3, 15.0)), 60.0),
        "coming to rest": (
            gas(3, 2.0),
            World(walls=box(7.0, 0.5), restitution=0.6, gravity=DOWN),
            40.0,
        ),
        "open space": (gas(4, 1.1), World(), 1000.0),
    }


def two():
    """Two spheres that see several images of each other in a cube of side 2.5."""
    return spheres([(-0.6, 0.1, 0.2), (0.6, -0.2, -0.1)], [(1.0, 0.3, -0.7), (-0.4, 0.9, 0.2)])


def run(engine: Engine, until=math.inf, **counts):
    """Advance through all slices; the `Stop` it ends with."""
    stop = Stop.SLICE
    goals = {name: goal + done(engine, name) for name, goal in counts.items()}
    while stop is Stop.SLICE:
        left = {name: goal - done(engine, name) for name, goal in goals.items()}
        stop = engine.advance(until, **left)
    return stop


def done(engine, name):
    walls_too = engine.wall_collisions if name == "max_events" else 0
    return engine.collisions + walls_too


def bits(state):
    """Digest of all that an engine changes."""
    return digest(state.position, state.velocity, state.image, state.collision_count, state.resting)


def digest(*arrays):
    """SHA-256 of the arrays' bytes."""
    return hashlib.sha256(b"".join(a.tobytes() for a in arrays)).hexdigest()


def energy(state, world):
    """Kinetic and potential, of the spheres that are free."""
    free = ~state.fixed
    m, v, x = state.mass[free], state.velocity[free], state.position[free]
    return 0.5 * m @ (v**2).sum(1) - m @ (x @ world.gravity)


def unwrapped(state, world):
    return state.position + state.image * world.period


def replayed(state, world, events, until):
    """Free flight from event to event, by the records alone; unwrapped positions, velocities."""
    x, v, t = unwrapped(state, world), state.velocity.copy(), np.full(len(state), state.time)
    falls = (~state.fixed & ~state.resting)[:, None] * world.gravity

    def fly(i, time):
        dt = time - t[i]
        x[i] += (v[i] + falls[i] * (0.5 * dt)) * dt
        v[i] += falls[i] * dt
        t[i] = time

    for time, i, j, impulse in events.tolist():
        fly(i, time)
        v[i] += np.array(impulse) / state.mass[i]
        if j >= 0:
            fly(j, time)
            v[j] -= np.array(impulse) / state.mass[j]
        elif j == WOKE:
            falls[i] = world.gravity
        elif j <= CAME_TO_REST:
            falls[i] = 0.0
    for i in range(len(state)):
        fly(i, until)
    return x, v
