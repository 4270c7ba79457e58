"""Turn all velocities round, and the gas goes back the way it came - for as long as it can."""

import numpy as np
import pytest

from carom.engine import FastEngine
from carom.walls import Box, Sphere, world

from .test_conservation import in_a_ball
from .tools import cube, drive, maxwell_gas

N = 500


def returned(state, surroundings, per_sphere):
    """Largest distance from the start, back where we should be."""
    there = FastEngine(state, surroundings, log=False)
    drive(there, collisions=per_sphere * N // 2)
    drive(there, until=there.time + 1e-3)
    turned = there.state()
    turned.velocity *= -1
    back = FastEngine(turned, surroundings, log=False)
    drive(back, until=2 * there.time)
    end = back.state()
    moved = end.position + (end.image - state.image) * surroundings.period - state.position
    return np.abs(moved).max(), np.abs(end.velocity + state.velocity).max()


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_fluid_goes_back(seed):
    """Errors grow as exp(0.75 C) in C collisions per sphere, from 1e-16 there and back."""
    state, surroundings = maxwell_gas(N, 0.3, seed), cube(N, 0.3)
    far, fast = returned(state, surroundings, 10)
    assert far < 1e-6
    assert fast < 1e-5
    farther = returned(state, surroundings, 20)[0]
    assert 0.4 < np.log(farther / far) / 10 < 1.1
    # Memory is lost after 33 to 38: what returns above was truly reversed, not replayed.
    assert returned(state, surroundings, 50)[0] > 0.1


def test_a_gas_in_a_hollow_sphere_goes_back():
    assert returned(in_a_ball(N), world(Sphere(6.0)), 10)[0] < 1e-6


@pytest.mark.parametrize("bounce", ["specular", "bounce-back"])
def test_a_falling_gas_goes_back(bounce):
    """Gravity and reversible walls keep the symmetry."""
    state, side = maxwell_gas(N, 0.3, 4), float(cube(N, 0.3).period[0])
    state.position *= (side - 1.0) / side
    state.radius *= 0.9
    box = world(Box(side, side, side, reflection=bounce), gravity=(0.1, 0.0, -0.3))
    assert returned(state, box, 10)[0] < 1e-6
