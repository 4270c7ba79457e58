"""Energy, momentum and angular momentum stay where physics says so, over millions of events."""

import numpy as np
import pytest

from carom import place
from carom.engine import FastEngine
from carom.random_numbers import Random
from carom.walls import Box, Sphere, world

from .tools import angular, cube, drive, kinetic, maxwell_gas, spheres

EVENTS = 1_000_000
DRIFT = 1e-12  #: relative; about sqrt(EVENTS) roundings of one sphere's share would be 1e-15


def mixture(n=500, seed=3):
    """Two sizes and masses at packing fraction 0.3, at rest as a whole, and their cube."""
    state = maxwell_gas(n, 0.3, seed)
    state.radius[::2], state.mass[::2] = 0.3, 0.21
    state.velocity -= (state.mass[:, None] * state.velocity).sum(axis=0) / state.mass.sum()
    return state


def in_a_ball(n=500, radius=6.0, seed=4):
    """Equal spheres, on lattice sites inside a hollow sphere, that turn about it as a whole."""
    sites = place.simple_cubic(13, 13, 13, spacing=1.02)
    sites = sites[np.linalg.norm(sites, axis=1) < radius - 0.5][:n]
    assert len(sites) == n
    velocity = Random(seed).normal(n, 3) + np.cross((0.1, -0.3, 0.4), sites)
    return spheres(sites, velocity)


def sizes(state):
    """What rounding is measured against: sum of m |v|, and of m |x| |v|."""
    speeds = state.mass * np.linalg.norm(state.velocity, axis=1)
    return speeds.sum(), (speeds * np.linalg.norm(state.position, axis=1)).sum()


def test_energy_and_momentum_in_a_periodic_cube():
    state = mixture()
    start, momentum = kinetic(state), state.mass @ state.velocity
    engine = FastEngine(state, cube(500, 0.3), log=False)
    drive(engine, collisions=EVENTS)
    end = engine.state()
    assert abs(kinetic(end) / start - 1) < DRIFT
    assert np.abs(end.mass @ end.velocity - momentum).max() < DRIFT * sizes(state)[0]
    assert engine.dissipated == 0.0
    assert engine.max_overlap() < DRIFT
    assert int(end.collision_count.sum()) == 2 * EVENTS


@pytest.mark.parametrize("bounce", ["specular", "bounce-back"])
def test_energy_in_a_box(bounce):
    state, side = mixture(), float(cube(500, 0.3).period[0])
    state.position *= (side - 1.0) / side  # away from the walls; the smaller ones make room
    state.radius *= 0.9
    start = kinetic(state)
    engine = FastEngine(state, world(Box(side, side, side, reflection=bounce)), log=False)
    drive(engine, events=EVENTS // 2)
    assert abs(kinetic(engine.state()) / start - 1) < DRIFT
    assert engine.wall_collisions > 0.02 * EVENTS


def test_energy_and_angular_momentum_in_a_hollow_sphere():
    state = in_a_ball()
    start, turning = kinetic(state), angular(state)
    engine = FastEngine(state, world(Sphere(6.0)), log=False)
    drive(engine, events=EVENTS)
    end = engine.state()
    assert abs(kinetic(end) / start - 1) < DRIFT
    assert np.linalg.norm(turning) > 0.1 * sizes(state)[1]
    assert np.abs(angular(end) - turning).max() < DRIFT * sizes(state)[1]
    assert engine.wall_collisions > 0.05 * EVENTS


def test_energy_over_ten_million_collisions():
    state = maxwell_gas(500, 0.3, seed=5)
    start = kinetic(state)
    engine = FastEngine(state, cube(500, 0.3), log=False)
    drive(engine, collisions=10_000_000)
    assert abs(kinetic(engine.state()) / start - 1) < DRIFT
