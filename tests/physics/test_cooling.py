"""Homogeneous cooling of a granular gas: Haff's law, per collision and in time."""

import math
from dataclasses import replace
from functools import cache

import pytest

from carom.engine import FastEngine

from .tools import Number, cube, drive, equilibrium, numbers, table

N, ETA, RUNS = 4000, 0.05, 6
FIRST, LAST = 3, 25  #: collisions per sphere; before, the speeds take on their cooling shape
#: Kinetic theory knows no correlations between partners. They make cooling slower, by 0.4 per
#: cent at eta = 0.05 in an independent event-driven program (F. Smallenburg, Eur. Phys. J. E
#: 45, 22, 2022: -0.06287 for e = 0.9); the table itself is good to 0.1 per cent.
THEORY = 0.004


@cache
def cooled(e: float) -> tuple[Number, Number]:
    """d ln T/dC, and d(2/sqrt T)/dt."""
    slopes, rates = [], []
    for seed in range(1, RUNS + 1):
        start, granular = (
            equilibrium(N, ETA, seed, per_sphere=20),
            replace(cube(N, ETA), restitution=e),
        )
        engine = FastEngine(start, granular, log=False)
        points = []
        for c in (FIRST, LAST):
            drive(engine, collisions=c * N // 2 - engine.collisions)
            points.append((engine.time, (engine.state().velocity ** 2).sum() / (3 * N - 3)))
        (t1, hot), (t2, cold) = points
        slopes.append(math.log(cold / hot) / (LAST - FIRST))
        rates.append(2 * (cold**-0.5 - hot**-0.5) / (t2 - t1))
    return Number.of_blocks(slopes), Number.of_blocks(rates)


def theory(e: float) -> tuple[float, float]:
    row = next(row for row in table("haff_smooth") if float(row["e"]) == e)
    slope, a2 = numbers(row, "dlnT_dC_a2", "a2_VNE")
    gas = next(row for row in table("eos_fluid") if float(row["eta"]) == ETA)
    density, contact = numbers(gas, "rho", "chi")
    # dT/dt = -(4 sqrt(pi)/3) (1 - e^2) n sigma^2 chi (1 + 3 a2/16) T^1.5
    rate = 4 * math.sqrt(math.pi) / 3 * (1 - e * e) * density * contact * (1 + 3 * a2 / 16)
    return float(slope), float(rate)


@pytest.mark.parametrize("e", [0.9, 0.8])
def test_temperature_falls_by_the_same_share_in_each_collision(e):
    slope, expected = cooled(e)[0], theory(e)[0]
    assert slope.is_off(expected, THEORY * expected) < 4
    assert slope.error < 0.005 * abs(expected)


@pytest.mark.parametrize("e", [0.9, 0.8])
def test_temperature_falls_as_one_over_time_squared(e):
    """T = T0/(1 + t/tc)^2 means that 1/sqrt T grows evenly."""
    rate, expected = cooled(e)[1], theory(e)[1]
    assert rate.is_off(expected, THEORY * expected) < 4
    assert rate.error < 0.01 * expected
