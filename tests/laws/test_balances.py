"""Energy, momentum, angular momentum, and the log that accounts for every change."""

import numpy as np
from hypothesis import given, settings
from tests.oracle.comparison import run

from carom import mechanics, rules, walls
from carom.engine import FastEngine
from carom.state import CAME_TO_REST, WOKE, State
from carom.walls import Cylinder, Open, Plane, Sphere
from carom.world import World

from . import gallery

LAW = settings(max_examples=200, derandomize=True, deadline=None)
LONG, UNTIL = 20, 60.0  #: events for each sphere, and time, after which runs end


def ran(state: State, world: World) -> FastEngine:
    engine = FastEngine(state, world)
    run(engine, UNTIL, LONG * len(state))
    return engine


def unwrapped(state: State, world: World) -> np.ndarray:
    return state.position + state.image * world.period


@LAW
@given(gallery.anything())
def test_no_energy_appears_or_vanishes(setting):
    """Kinetic, potential, and what the rules have taken."""
    state, world = setting.build()
    engine = ran(state, world)
    end = engine.state()
    (given, before), (now, after) = (mechanics.energy_and_size(s, world) for s in (state, end))
    size = max(before, after)
    assert abs(now + engine.dissipated - given) <= 1e-12 * size
    if not damped(world):
        assert abs(engine.dissipated) <= 1e-14 * size  # hops along walls, if any
    assert engine.withheld >= 0.0
    assert engine.withheld == 0.0 or world.contact_time > 0.0


def damped(world: World) -> bool:
    return world.restitution < 1.0 or bool((world.walls["restitution"] < 1.0).any())


@LAW
@given(gallery.anything())
def test_momentum_stays_where_nothing_pushes(setting):
    state, world = setting.build()
    axes = mechanics.conserved_axes(state, world)
    end = ran(state, world).state()
    free = ~state.fixed
    size = (state.mass[free, None] * np.abs(state.velocity[free])).sum() + 1e-300
    before, after = ((s.mass[free, None] * s.velocity[free]).sum(axis=0) for s in (state, end))
    assert np.abs(after - before)[axes].max(initial=0.0) <= 1e-12 * size


def turning(state: State, world: World) -> np.ndarray:
    arm = np.cross(unwrapped(state, world), state.velocity)
    return (state.mass[:, None] * arm).sum(axis=0)


ROUND = [(Sphere(6),), (Sphere(6, 0.7),), (Open(),)]
AROUND_Z = [
    *ROUND,
    (Cylinder(5, 12, 0.8),),
    (Sphere(6), Plane((0, 0, 1), -5, 0.5)),
    (Plane((0, 0, 1), -5),),
]


def arms(state: State, world: World) -> float:
    places, speeds = (np.linalg.norm(a, axis=1) for a in (unwrapped(state, world), state.velocity))
    return float((state.mass * (places + 1.0) * (speeds + 1.0)).sum())


@LAW
@given(gallery.settings(ROUND, gravities=[(0.0, 0.0, 0.0)], fixed=[0]))
def test_angular_momentum_stays_where_space_is_round(setting):
    state, world = setting.build()
    end = ran(state, world).state()
    size = max(arms(state, world), arms(end, world))
    assert np.abs(turning(end, world) - turning(state, world)).max() <= 1e-12 * size


@LAW
@given(gallery.settings(AROUND_Z, gravities=[(0.0, 0.0, -1.0)], fixed=[0]))
def test_angular_momentum_about_the_axis_of_gravity(setting):
    state, world = setting.build()
    end = ran(state, world).state()
    size = max(arms(state, world), arms(end, world))
    assert abs(turning(end, world)[2] - turning(state, world)[2]) <= 1e-12 * size


def replayed(state: State, world: World, events: np.ndarray, time: float):
    """Places and velocities at `time`, from the start and the log alone."""
    x, v, at = unwrapped(state, world), state.velocity.copy(), np.zeros(len(state))
    falls = np.where((state.fixed | state.resting)[:, None], 0.0, world.gravity)

    def advance(k, now):
        dt = now - at[k]
        x[k] += v[k] * dt + 0.5 * falls[k] * dt * dt
        v[k] += falls[k] * dt
        at[k] = now

    for event in events:
        i, j = int(event["i"]), int(event["j"])
        advance(i, event["time"])
        v[i] += event["impulse"] / state.mass[i]
        if j >= 0:
            advance(j, event["time"])
            v[j] -= event["impulse"] / state.mass[j]
        elif j == WOKE:
            falls[i] = world.gravity
        elif j <= CAME_TO_REST:
            falls[i] = 0.0
    for k in range(len(state)):
        advance(k, time)
    return x, v


@LAW
@given(gallery.anything())
def test_start_and_log_tell_the_whole_story(setting):
    state, world = setting.build()
    engine = ran(state, world)
    end, events = engine.state(), engine.take_events()
    assert (np.diff(events["time"]) >= 0.0).all()
    x, v = replayed(state, world, events, engine.time)
    reach = 1.0 + np.abs(x).max()
    assert np.abs(x - unwrapped(end, world)).max() < 1e-9 * reach
    assert np.abs(v - end.velocity).max() < 1e-10 * (1.0 + np.abs(v).max())


@LAW
@given(gallery.anything())
def test_nothing_enters_anything(setting):
    """Spheres stay out of one another and inside their walls."""
    state, world = setting.build()
    engine = ran(state, world)
    assert engine.max_overlap() <= 1e-9 if world.collide else True
    x, free = engine.state().position, ~state.fixed
    for wall in world.walls:
        room = wall["normal"] @ x.T - wall["offset"]
        if wall["kind"] == gallery.CYLINDER:
            room = wall["offset"] - np.hypot(x[:, 0], x[:, 1])
        elif wall["kind"] != gallery.PLANE:
            room = wall["offset"] - np.linalg.norm(x, axis=1)
        assert (room - state.radius)[free].min(initial=0.0) > -1e-9


def test_the_gallery_is_complete():
    """Every kind of wall and every rule there is."""
    assert {type(w) for both in gallery.WALLS for w in both} == set(walls.KINDS)
    kinds = {kind for kind in vars(rules).values() if hasattr(kind, "examples")}
    assert {type(rule) for rule in gallery.RULES} == kinds
