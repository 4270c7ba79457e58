"""Scenes in which an engine can go wrong in one particular way; each for both engines."""

import itertools
import math

import numpy as np
import pytest

from carom.engine import FastEngine, Stop
from carom.reference.exact import ExactEngine
from carom.state import CAME_TO_REST, WOKE, State
from carom.world import CYLINDER, PLANE, SPHERE, WALL, World

from .comparison import agreement, run

both = pytest.mark.parametrize("make", [ExactEngine, FastEngine])

DOWN = np.array([0.0, 0.0, -1.0])
FLOOR = (PLANE, 0, (0, 0, 1), 0.0, 0.5)


def scene(position, velocity, **more):
    state = State.empty(len(position))
    state.position[:], state.velocity[:] = position, velocity
    for name, values in more.items():
        getattr(state, name)[:] = values
    return state


def walls(*rows):
    return np.array(list(rows), WALL)


def next_meeting(state, length):
    """When two spheres in a cube meet next, by asking 11^3 images with the school formula."""
    images = np.array(list(itertools.product(range(-5, 6), repeat=3)))
    r = state.position[0] - state.position[1] - images * length
    v = state.velocity[0] - state.velocity[1]
    b, c = r @ v, np.sum(r * r, axis=1) - 1.0
    d = b * b - (v @ v) * c
    hits = (b < 0.0) & (d > 0.0) & (c > -1e-9)
    return np.min((-b[hits] - np.sqrt(d[hits])) / (v @ v), initial=math.inf)


@both
def test_two_spheres_in_a_small_box_see_every_image(make):
    """The Sinai billiard: a sphere meets the images of the other one box or more away."""
    length = 2.5
    state = scene([(0, 0, 0), (1.1, 0.2, 0.3)], [(0.9, 0.1, -0.4), (-0.6, 0.7, 0.2)])
    engine = make(state, World(period=np.full(3, length)))
    crossed = 0
    for _ in range(300):
        before = engine.state()
        expected = before.time + next_meeting(before, length)
        run(engine, math.inf, 1)
        # Beyond five boxes the school formula knows nothing.
        if expected < math.inf:
            assert engine.time == pytest.approx(expected, abs=1e-9)
        crossed += np.any(np.abs(engine.state().image - before.image) > 0)
    assert engine.collisions == 300
    assert crossed > 100


@both
def test_the_mean_free_time_of_two_spheres_in_a_cube(make):
    """(L^3 - 4 pi/3) / (pi |v|) with sigma = 1, exactly; free times have a long tail."""
    state = scene([(0, 0, 0), (1.1, 0.2, 0.3)], [(0.9, 0.1, -0.4), (-0.6, 0.7, 0.2)])
    engine = make(state, World(period=np.full(3, 2.5)))
    run(engine, math.inf, 5000)
    speed = np.linalg.norm(state.velocity[0] - state.velocity[1])
    assert engine.time / 5000 == pytest.approx(3.640259 / speed, rel=0.06)


@both
def test_long_flights_are_counted_in_boxes(make):
    state = scene([(0, 0, 0)], [(3.0, -2.0, 0.5)])
    engine = make(state, World(period=np.array([2.0, 3.0, 0.0])))
    run(engine, 1000.0)
    end = engine.state()
    assert np.all(np.abs(end.position[0, :2]) <= [1.0, 1.5])
    unwrapped = end.position + end.image * [2.0, 3.0, 0.0]
    np.testing.assert_allclose(unwrapped, [[3000.0, -2000.0, 500.0]], rtol=1e-12)


@both
def test_spheres_that_stick_do_not_meet_again(make):
    """After e = 0 the approach speed is rounding, and so is the sign of it."""
    rng = np.random.default_rng(5)
    for _ in range(200):
        n, across = rng.normal(size=3), rng.normal(size=3)
        n /= np.linalg.norm(n)
        across -= (across @ n) * n
        place = rng.normal(size=3)
        together = rng.normal(size=3)
        for approach in (0.7, 1e-15):
            state = scene(
                [place + n, place], [together + across - approach * n, together], mass=[1.0, 1.7]
            )
            engine = make(state, World(restitution=0.0))
            run(engine, 20.0)
            assert engine.collisions <= 1


@both
def test_a_sphere_that_gravity_pulls_off_another_leaves_it(make):
    """A plastic hit from below on a fixed sphere: gravity parts them, rounding must not repeat."""
    rng = np.random.default_rng(6)
    for _ in range(100):
        n = rng.normal(size=3)
        n[2] = -abs(n[2])
        n /= np.linalg.norm(n)
        across = rng.normal(size=3)
        velocity = across - (across @ n) * n - 0.3 * n
        state = scene([(0, 0, 0), n], [(0, 0, 0), velocity], fixed=[1, 0], mass=[math.inf, 1.3])
        engine = make(state, World(restitution=0.0, gravity=DOWN))
        run(engine, 5.0, 10)
        assert engine.collisions <= 1
        assert engine.collapse is None


@both
def test_coming_to_rest_and_sliding(make):
    """A ball drops, rests, slides to an elastic wall and back, and rests all the while."""
    far = (PLANE, 0, (-1, 0, 0), -3.0, 1.0)
    state = scene([(0, 0, 1.5)], [(0.25, 0, 0)])
    engine = make(state, World(walls=walls(FLOOR, far), gravity=DOWN))
    run(engine, 8.0)
    drop = engine.take_events()
    stop = math.sqrt(2.0) * (1 + 0.5) / (1 - 0.5)  # h = 1, g = 1, e = 0.5
    assert drop["j"][-1] == CAME_TO_REST
    assert drop["time"][-1] == pytest.approx(stop, rel=3e-5)
    assert engine.dissipated == pytest.approx(1.0, rel=1e-12)
    resting = engine.state()
    assert resting.resting.tolist() == [True]
    assert resting.velocity.tolist() == [[0.25, 0.0, 0.0]]
    assert resting.position[0] == pytest.approx([2.0, 0.0, 0.5])
    run(engine, 12.0)
    (bump,) = engine.take_events()
    assert (bump["i"], bump["j"]) == (0, -2)
    assert bump["time"] == pytest.approx(10.0)
    end = engine.state()
    assert end.resting.tolist() == [True]
    assert end.velocity.tolist() == [[-0.25, 0.0, 0.0]]
    assert engine.wall_collisions == len(drop) + 1


@both
def test_a_blow_from_above_wakes_a_resting_sphere(make):
    state = scene([(0, 0, 0.5), (0.3, 0, 3.0)], [(0, 0, 0), (0, 0, 0)], resting=[1, 0])
    engine = make(state, World(walls=walls(FLOOR), gravity=DOWN, restitution=0.5))
    run(engine, 10.0, 2)
    cause, woken, floor = engine.take_events()[:3]
    assert (cause["i"], cause["j"]) == (0, 1)
    assert (woken["i"], woken["j"]) == (0, WOKE)
    assert not np.any(woken["impulse"])
    assert woken["time"] == cause["time"]
    assert (floor["i"], floor["j"]) == (0, -1)
    assert floor["time"] == pytest.approx(cause["time"], abs=1e-12)


@both
def test_a_push_along_the_floor_wakes_nobody(make):
    state = scene([(0, 0, 0.5), (3, 0, 0.5)], [(1, 0, 0), (0, 0, 0)], resting=[1, 1])
    engine = make(state, World(walls=walls(FLOOR), gravity=DOWN))
    run(engine, 10.0)
    events = engine.take_events()
    assert events["j"].tolist() == [1]
    assert engine.state().resting.all()
    assert engine.state().velocity.tolist() == [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]


@both
def test_simultaneous_events_happen_in_the_order_of_their_numbers(make):
    """Three pairs and a sphere in a corner, all at t = 1 exactly."""
    x = [(0, 0, 0), (0, 0, 3), (9, 0, 0), (9, 0, 3), (-20, -20, 0), (5, 0, 0), (5, 0, 3)]
    v = [(0, 0, 1), (0, 0, -1)] * 2 + [(-1, -1, 0), (0, 0, 1), (0, 0, -1)]
    corner = walls((PLANE, 0, (1, 0, 0), -21.5, 1.0), (PLANE, 0, (0, 1, 0), -21.5, 1.0))
    order = [6, 2, 0, 4, 5, 3, 1]  # scattered over the numbers
    state = scene([x[k] for k in order], [v[k] for k in order])
    engine = make(state, World(walls=corner))
    run(engine, 1.5)
    events = engine.take_events()
    assert events["time"].tolist() == [1.0] * 5
    met = list(zip(events["i"].tolist(), events["j"].tolist(), strict=True))
    assert met == [(0, 4), (1, 5), (2, 6), (3, -2), (3, -1)]


@both
def test_the_events_at_until_itself_belong_to_the_call(make):
    state = scene([(0, 0, 0), (3, 0, 0)], [(1, 0, 0), (-1, 0, 0)])
    engine = make(state, World())
    assert engine.advance(1.0) is Stop.TIME
    assert engine.collisions == 1
    assert engine.state().velocity[:, 0].tolist() == [-1.0, 1.0]


@pytest.mark.parametrize("kind", [SPHERE, CYLINDER])
@pytest.mark.parametrize("bounce_back", [0, 1])
@pytest.mark.parametrize("gravity", [0.0, 1.0])
def test_sliding_along_an_inelastic_curved_wall(kind, bounce_back, gravity):
    """Bounces die out in finite time and become micro-hops; motion along an axis is no slide."""
    container = walls((kind, bounce_back, (0, 0, 0), 2.0, 0.5))
    state = scene([(1.4, 0, 0)], [(0.3, 1.0, 0.7)])
    world = World(walls=container, gravity=np.array([0.0, -gravity, 0.0]))
    compared, total = agreement(state, world, until=4.0, events=500)
    assert compared > 0.9 * total


def test_a_giant_among_small_ones():
    rng = np.random.default_rng(8)
    directions = rng.normal(size=(15, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    around = np.concatenate([np.zeros((1, 3)), 20.0 * directions])
    state = scene(around, rng.normal(size=(16, 3)))
    state.radius[0], state.mass[0] = 15.0, 300.0
    world = World(walls=walls((SPHERE, 0, (0, 0, 0), 30.0, 1.0)), restitution=0.9)
    compared, _ = agreement(state, world, until=1000.0)
    assert compared > 50
