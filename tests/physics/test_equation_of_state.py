"""Pressure and collision rate of the hard-sphere fluid against its equation of state.

From the log of collisions, with m = sigma = kT = 1: Z = 1 + sum |J|/(3 N kT t), as each
impulse acts along a line of centres of length sigma, and omega = 2 collisions/(N t).
"""

import math
from functools import cache
from typing import NamedTuple

import numpy as np
import pytest

from carom.engine import FastEngine

from .tools import Number, cube, drive, equilibrium, numbers, table

N, BLOCKS = 4000, 25
ETAS = ("0.1", "0.2", "0.3", "0.4", "0.45", "0.49")
FULL = 20_000_000


class Reference(NamedTuple):
    """A row of the table, for N spheres."""

    excess: float  #: Z - 1
    rate: float
    error: float  #: relative


def reference(eta: str) -> Reference:
    row = next(row for row in table("eos_fluid") if float(row["eta"]) == float(eta))
    z, rate, finite_size, density = numbers(row, "Z_ref", "omega", "fsc", "rho")
    # Fewer spheres are less free: Z_N = Z + fsc/N. The rate follows the contact value, as Z - 1.
    excess = z - 1 + finite_size / N
    assert rate == pytest.approx(6 / math.sqrt(math.pi) * (z - 1), rel=1e-5)
    assert density == pytest.approx(6 * float(eta) / math.pi, rel=1e-6)
    return Reference(excess, rate * excess / (z - 1), 2e-5)


class Measured(NamedTuple):
    excess: Number
    rate: Number
    impulse: Number


@cache
def measured(eta: str, collisions: int) -> Measured:
    state = equilibrium(N, float(eta), seed=round(1000 * float(eta)))
    assert 2 * 0.5 * (state.velocity**2).sum() / (3 * N - 3) == pytest.approx(1.0, rel=1e-12)
    engine = FastEngine(state, cube(N, float(eta)))
    each, blocks, clock = collisions // BLOCKS, [], 0.0
    for _ in range(BLOCKS):
        total = 0.0
        for part in range(0, each, 100_000):  # so that the log stays small
            drive(engine, collisions=min(100_000, each - part))
            total += np.linalg.norm(engine.take_events()["impulse"], axis=1).sum()
        lasted, clock = engine.time - clock, engine.time
        blocks.append((total / (3 * N * lasted), 2 * each / (N * lasted), total / each))
    assert int(engine.state().collision_count.sum()) == 2 * each * BLOCKS
    return Measured(*(Number.of_blocks(column) for column in np.transpose(blocks)))


runs = pytest.mark.parametrize(
    ("eta", "collisions"),
    [(eta, 1_000_000) for eta in ("0.1", "0.3", "0.45")]
    + [pytest.param(eta, FULL, marks=pytest.mark.validate) for eta in ETAS],
)


@runs
def test_pressure(eta, collisions):
    excess, expected = measured(eta, collisions).excess, reference(eta)
    # Density fluctuates slowly: 1.35/sqrt(collisions), twice that near freezing.
    assert 0.5 < excess.error / expected.excess * math.sqrt(collisions) / 1.35 < 3.0
    assert excess.is_off(expected.excess, expected.error * expected.excess) < 4


@runs
def test_collision_rate(eta, collisions):
    """Each collision counts for both partners: a factor 2 is easily lost here."""
    rate, expected = measured(eta, collisions).rate, reference(eta)
    assert rate.is_off(expected.rate, expected.error * expected.rate) < 4
    assert rate.error < 0.005 * rate.value


@runs
def test_mean_impulse(eta, collisions):
    """<|J|> = m <v_n> = sqrt(pi), for the flux v_n exp(-v_n^2/4) of a Maxwell gas.

    That N spheres share one fixed energy changes it by a fraction 1/N at most.
    """
    impulse = measured(eta, collisions).impulse
    assert impulse.is_off(math.sqrt(math.pi), 1.0 / N) < 4
    # Hardly correlated: the spread of v_n, sqrt(4 - pi), over sqrt(collisions).
    assert impulse.error == pytest.approx(math.sqrt((4 - math.pi) / collisions), rel=0.6)
