"""The same gas seen from elsewhere, on the move, in other axes or other units."""

import numpy as np
import pytest

from carom.engine import FastEngine
from carom.world import World

from .tools import cube, drive, maxwell_gas, spheres

N, ETA, EVENTS = 500, 0.3, 200
#: Times move by the rounding of places, 1e-16 to 1e-14 (boosted), times exp(0.75 C), C < 1.
CLOSE = 1e-12


def story(state, world=None):
    """The first events, and the state right after."""
    engine = FastEngine(state, world or cube(N, ETA))
    drive(engine, events=EVENTS)
    return engine.take_events(), engine.state()


@pytest.fixture(scope="module")
def gas():
    state = maxwell_gas(N, ETA, seed=6)
    state.radius[::3], state.mass[::3] = 0.4, 0.6
    return state


def rewritten(gas, **changes):
    """Another state, with the gas's arrays where nothing is changed."""
    arrays = {name: getattr(gas, name) for name in ("position", "velocity", "radius", "mass")}
    return spheres(**(arrays | changes))


def same(a, b):
    """Whether two stories tell the same collisions at the same times."""
    assert a["i"].tolist() == b["i"].tolist()
    assert a["j"].tolist() == b["j"].tolist()
    assert np.abs(a["time"] - b["time"]).max() < CLOSE
    return True


@pytest.mark.parametrize("axes", [[1, 2, 0], [2, 1, 0]])
def test_permuted_axes(gas, axes):
    told = story(gas)[0]
    permuted = rewritten(gas, position=gas.position[:, axes], velocity=gas.velocity[:, axes])
    other = story(permuted)[0]
    assert same(told, other)
    assert np.abs(told["impulse"][:, axes] - other["impulse"]).max() < 10 * CLOSE


def test_mirrored_axes(gas):
    signs = np.array([1, -1, 1])
    told = story(gas)[0]
    other = story(rewritten(gas, position=gas.position * signs, velocity=gas.velocity * signs))[0]
    assert same(told, other)
    assert np.abs(told["impulse"] * signs - other["impulse"]).max() < 10 * CLOSE


def test_another_origin(gas):
    side = cube(N, ETA).period
    moved = gas.position + np.array([0.37, -1.9, 4.2])
    moved -= np.rint(moved / side) * side
    assert same(story(gas)[0], story(rewritten(gas, position=moved))[0])


def test_a_moving_observer(gas):
    told, end = story(gas)
    boost = np.array([3.0, -7.0, 1.5])
    other, boosted = story(rewritten(gas, velocity=gas.velocity + boost))
    assert same(told, other)
    assert np.abs(end.velocity + boost - boosted.velocity).max() < 100 * CLOSE


def test_a_turned_frame_in_open_space():
    """No axis is special where nothing repeats: a cloud that falls in on itself, turned."""
    rng = np.random.default_rng(9)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    places = maxwell_gas(N, ETA, seed=7).position
    velocity = rng.normal(size=(N, 3)) - places
    told = story(spheres(places, velocity), World())[0]
    other = story(spheres(places @ turn, velocity @ turn), World())[0]
    assert same(told, other)


@pytest.mark.parametrize(("length", "time", "mass"), [(1, 0.125, 1), (4, 1, 1), (0.5, 16, 8)])
def test_other_units(gas, length, time, mass):
    """Powers of two only move exponents: not one bit may differ."""
    told, end = story(gas)
    speed = length / time
    scaled = rewritten(
        gas,
        position=gas.position * length,
        velocity=gas.velocity * speed,
        radius=gas.radius * length,
        mass=gas.mass * mass,
    )
    other, last = story(scaled, World(period=cube(N, ETA).period * length))
    assert other["i"].tolist() == told["i"].tolist()
    assert other["j"].tolist() == told["j"].tolist()
    assert (other["time"] == told["time"] * time).all()
    assert (other["impulse"] == told["impulse"] * (mass * speed)).all()
    assert (last.position == end.position * length).all()
    assert (last.velocity == end.velocity * speed).all()
