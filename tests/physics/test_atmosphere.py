"""A gas under gravity: barometric density, mean height, and the weight on the floor."""

import math

import numpy as np
import pytest

from carom.engine import FastEngine
from carom.place import maxwell, random_positions
from carom.random_numbers import Random
from carom.walls import Periodic, Plane, world

from .tools import Number, drive, spheres

N, WIDTH, G = 1000, 80.0, 0.2
SAMPLES, BLOCKS, EVERY = 500, 20, 4.0
COLUMN = N / WIDTH**2  #: spheres over each unit of floor
TOP = 120.0  #: exp(-24) of the gas would reach it


def compressibility(n: np.ndarray) -> np.ndarray:
    """Z of Carnahan and Starling; n stays below 0.03 here, where it is good to 1e-5."""
    eta = math.pi * n / 6
    return (1 + eta + eta**2 - eta**3) / (1 - eta) ** 3


def profile(kT: float) -> tuple[np.ndarray, np.ndarray]:
    """Heights and densities from dP/dz = -m g n and P = n kT Z(n), from the floor up.

    The floor carries the weight of the column: P(0) = COLUMN m g. In the lowest diameter the
    floor takes away a cap, pi (1 - z)^2 (2 + z)/3, of the volume that others cannot enter.
    """
    n = np.linspace(1e-9, 2 * COLUMN * G / kT, 200_001)
    pressure = n * kT * compressibility(n)
    n, pressure = n[pressure < COLUMN * G], pressure[pressure < COLUMN * G]
    steps = np.diff(pressure) / (G * (n[1:] + n[:-1]) / 2)
    z, n = np.concatenate([[0.0], np.cumsum(steps[::-1])]), n[::-1]
    near = np.maximum(0.0, 1.0 - z)
    n = n * (1 + n * math.pi / 3 * near**2 * (3 - near))
    return z, n * COLUMN / np.trapezoid(n, z)


@pytest.fixture(scope="module")
def column():
    """Heights (samples, N), kinetic energies (samples,), weight on the floor (blocks,)."""
    random = Random(8)
    start = random_positions(random, np.full(N, 0.5), (WIDTH, WIDTH, 20.0), (True, True, False))
    start[:, 2] += 10.0
    sides = [Periodic(WIDTH, WIDTH, None), Plane((0, 0, 1), 0), Plane((0, 0, -1), -TOP)]
    state = spheres(start, maxwell(random, np.ones(N), temperature=0.8))
    engine = FastEngine(state, world(sides, gravity=(0, 0, -G)))
    drive(engine, until=300.0)
    engine.take_events()
    heights, kinetics, pushes = [], [], []
    for k in range(SAMPLES):
        drive(engine, until=300.0 + (k + 1) * EVERY)
        now, events = engine.state(), engine.take_events()
        heights.append(now.position[:, 2] - 0.5)  # from the lowest place of a centre
        kinetics.append(0.5 * (now.velocity**2).sum())
        pushes.append(events["impulse"][events["j"] == -1, 2].sum() / EVERY)
    return np.array(heights), np.array(kinetics), np.array(pushes)


def temperature(kinetics: np.ndarray) -> float:
    return 2 * kinetics.mean() / (3 * N - 2)  # two axes keep their momentum, which is 0


def blocks(values: np.ndarray) -> np.ndarray:
    return values.reshape(BLOCKS, -1).mean(axis=1)


def test_energy_is_shared_between_height_and_motion(column):
    """<m g z>/kT = 1 for an ideal gas, and (1/P0) times the integral of Z dP for a dense one."""
    heights, kinetics, _ = column
    potential, motion = G * heights.mean(axis=1), 2 * kinetics / (3 * N - 2)
    ratio = Number.of_blocks(blocks(potential) / blocks(motion))
    kT = temperature(kinetics)
    z, n = profile(kT)
    expected = G * np.trapezoid(z * n, z) / (kT * np.trapezoid(n, z))
    first_order = 1 + math.pi / 3 * COLUMN * G / kT
    assert expected == pytest.approx(first_order, abs=0.3 * (first_order - 1))
    assert ratio.is_off(expected, 2e-4) < 4
    assert ratio.error < 0.2 * (expected - 1)  # so that the correction itself is seen


def test_density_falls_with_height(column):
    """The barometric formula with the excluded volume; plain exp(-m g z/kT) is far off."""
    heights, kinetics, _ = column
    kT = temperature(kinetics)
    z, n = profile(kT)
    below = np.concatenate([[0.0], np.cumsum(np.diff(z) * (n[1:] + n[:-1]) / 2)]) / COLUMN
    assert below[-1] == pytest.approx(1.0, abs=1e-4)
    # Ten layers of one tenth of the gas each.
    edges = np.interp(np.linspace(0, 1, 11), below, z)
    edges[-1] = TOP
    counts = np.array([np.histogram(sample, edges)[0] for sample in heights]) / N
    shares = [Number.of_blocks(blocks(layer)) for layer in counts.T]
    assert max(share.is_off(0.1) for share in shares) < 4
    assert np.mean([share.is_off(0.1) ** 2 for share in shares]) < 3
    plain = -kT / G * np.log1p(-np.linspace(0, 1, 11)[:-1])
    bare = np.array([np.histogram(s, [*plain, TOP])[0] for s in heights]).mean(axis=0) / N
    errors = np.array([share.error for share in shares])
    assert (((bare - 0.1) / errors) ** 2).mean() > 10


def test_the_floor_carries_the_weight(column):
    pushes = Number.of_blocks(blocks(column[2]))
    assert pushes.is_off(N * G) < 4
    assert pushes.error < 2e-3 * N * G
