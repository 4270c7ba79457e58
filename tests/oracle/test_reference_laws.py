"""The oracle itself keeps the laws of mechanics and the contract of an engine."""

import math

import numpy as np
import pytest
from hypothesis import given, settings

from carom.engine import Stop
from carom.errors import InputError
from carom.reference.exact import ExactEngine
from carom.state import EVENT, WOKE, State
from carom.world import PLANE, SPHERE, WALL, World

from .comparison import run
from .strategies import recipes

EXAMPLES = settings(max_examples=60, derandomize=True, deadline=None)


def energy(state, world):
    """Kinetic and potential energy of what moves."""
    free = ~state.fixed
    x = state.position + state.image * world.period
    kinetic = 0.5 * np.sum(state.velocity**2, axis=1)
    return np.sum(state.mass[free] * (kinetic - x @ world.gravity)[free])


@EXAMPLES
@given(recipes())
def test_every_joule_is_accounted_for(recipe):
    state, world = recipe.build()
    engine = ExactEngine(state, world)
    run(engine, 20.0, 100)
    start, end = energy(state, world), energy(engine.state(), world)
    scale = 1.0 + np.sum(np.linalg.norm(engine.take_events()["impulse"], axis=1))
    assert end + engine.dissipated == pytest.approx(start, abs=1e-11 * scale**2)


@EXAMPLES
@given(recipes())
def test_the_records_tell_every_impulse(recipe):
    state, world = recipe.build()
    engine = ExactEngine(state, world)
    run(engine, 20.0, 100)
    end, events = engine.state(), engine.take_events()
    assert events.dtype == EVENT
    assert np.all(np.diff(events["time"]) >= 0.0)
    free = ~state.fixed
    change = np.zeros((len(state), 3))
    count = np.zeros(len(state), int)
    for event in events:
        partners = [(event["i"], 1.0)]
        if event["j"] >= 0:
            partners.append((event["j"], -1.0))
        for k, sign in partners:
            change[k] += sign * event["impulse"]
            count[k] += event["j"] != WOKE
    np.testing.assert_array_equal(end.collision_count, count)
    if not np.any(world.gravity):
        expected = state.velocity[free] + change[free] / state.mass[free, None]
        np.testing.assert_allclose(end.velocity[free], expected, atol=1e-9)
    assert engine.collisions == np.sum(events["j"] >= 0)
    hits = (events["j"] < 0) & (events["j"] != WOKE)
    assert engine.wall_collisions == np.sum(hits)


@EXAMPLES
@given(recipes(restitution=1.0, wall_restitution=1.0, contact_time=0.0, fixed=0, collide=True))
def test_elastic_motion_runs_backwards(recipe):
    state, world = recipe.build()
    out = ExactEngine(state, world)
    run(out, 3.0, 2 * len(state))
    turned = out.state()
    turned.velocity *= -1.0
    back = ExactEngine(turned, world)
    run(back, turned.time + turned.time)
    end = back.state()
    x, y = (s.position + s.image * world.period for s in (state, end))
    np.testing.assert_allclose(y, x, atol=1e-6)
    np.testing.assert_allclose(end.velocity, -state.velocity, atol=1e-6)


def test_momenta_are_conserved():
    rng = np.random.default_rng(2)
    state = State.empty(8)
    state.position[:] = (np.stack(np.meshgrid(*[(0, 1)] * 3), -1).reshape(-1, 3) - 0.5) * 1.4
    state.velocity[:], state.mass[:] = rng.normal(size=(8, 3)), rng.uniform(0.5, 2.0, 8)
    box = ExactEngine(state, World(period=np.full(3, 3.0), restitution=0.8))
    run(box, math.inf, 300)
    momentum = [s.mass @ s.velocity for s in (state, box.state())]
    np.testing.assert_allclose(*momentum, atol=1e-12)
    container = np.array([(SPHERE, 0, (0, 0, 0), 2.2, 0.9)], WALL)
    inside = ExactEngine(state, World(walls=container, restitution=0.8))
    run(inside, math.inf, 300)
    spin = [s.mass @ np.cross(s.position, s.velocity) for s in (state, inside.state())]
    np.testing.assert_allclose(*spin, atol=1e-12)


def test_where_it_stops_does_not_change_where_it_goes():
    rng = np.random.default_rng(3)
    state = State.empty(8)
    state.position[:] = (np.stack(np.meshgrid(*[(0, 1)] * 3), -1).reshape(-1, 3) - 0.5) * 1.4
    state.velocity[:] = rng.normal(size=(8, 3))
    world = World(period=np.array([3.0, 3.0, 3.0]))
    whole, parts = ExactEngine(state, world), ExactEngine(state, world)
    run(whole, 5.0)
    for until in np.sort(rng.uniform(0, 5, 40)):
        run(parts, until)
        assert parts.time == parts.state().time == until
        parts.max_overlap()
    run(parts, 5.0)
    a, b = whole.state(), parts.state()
    np.testing.assert_array_equal(a.position, b.position)
    np.testing.assert_array_equal(a.velocity, b.velocity)


def test_the_contact_time_keeps_energy_from_being_lost():
    """Three balls on a line: the second collision comes 0.01 after the first."""
    state = State.empty(3)
    state.position[:, 0] = [0.0, 3.0, 4.01]
    state.velocity[0, 0] = 1.0
    engine = ExactEngine(state, World(restitution=0.5, contact_time=0.1))
    run(engine, 2.03)
    # First: 1 -> 0.25 and 0.75. Second, elastic: the last ball takes the whole 0.75.
    np.testing.assert_allclose(engine.state().velocity[:, 0], [0.25, 0.0, 0.75])
    assert engine.dissipated == pytest.approx(0.25 * 0.75)
    assert engine.withheld == pytest.approx(0.25 * 0.75 * 0.75**2)


def test_inelastic_collapse_is_seen_and_leaves_the_state_whole():
    state = State.empty(3)
    state.position[:, 0], state.velocity[:, 0] = [-2.0, 0.0, 2.0], [1.0, 0.0, -1.0]
    engine = ExactEngine(state, World(restitution=0.05))
    assert run(engine, math.inf) is Stop.COLLAPSE
    time, i, j = engine.collapse
    assert time == engine.time == pytest.approx(1.0, abs=0.2)
    assert {i, j} in ({0, 1}, {1, 2})
    assert np.all(np.isfinite(engine.state().position))
    assert engine.advance(math.inf) is Stop.COLLAPSE


def test_nothing_to_wait_for_and_no_way_back():
    engine = ExactEngine(State.empty(1), World())
    assert engine.advance(math.inf) is Stop.IDLE
    assert engine.advance(2.0) is Stop.TIME
    with pytest.raises(InputError, match="already"):
        engine.advance(1.0)


def test_overlapping_spheres_collide_at_once_if_they_approach():
    floor = np.array([(PLANE, 0, (0, 0, 1), 0.0, 1.0)], WALL)
    state = State.empty(2)
    state.position[:] = [(0, 0, 5.0), (0, 0, 5.8)]
    state.velocity[:, 2] = [1.0, -1.0]
    engine = ExactEngine(state, World(walls=floor))
    assert engine.max_overlap() == pytest.approx(0.2)
    engine.advance(0.0, max_collisions=1)
    assert engine.take_events()["time"].tolist() == [0.0]
    assert engine.state().velocity[:, 2].tolist() == [-1.0, 1.0]
