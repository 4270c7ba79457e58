"""Inelastic collapse of three balls on a line: found where it happens, and only there."""

import math

import numpy as np
import pytest

import carom
from carom.engine import FastEngine, Stop
from carom.errors import CollapseError
from carom.reference.exact import ExactEngine
from carom.world import World

from .tools import drive, spheres

#: Three balls collapse for e below this: S. McNamara, W. R. Young, Phys. Fluids A 4, 496 (1992).
THRESHOLD = 7 - 4 * math.sqrt(3)
MOST = 200


def starts(seed, count=100):
    """(places, velocities) of three unit balls whose gaps close, the middle one first."""
    rng = np.random.default_rng(seed)
    for _ in range(count):
        gaps, speeds = rng.uniform(0.1, 2.0, 2), np.sort(rng.normal(size=3))[::-1]
        yield np.array([0.0, 1 + gaps[0], 2 + gaps.sum()]), speeds


def collisions_on_a_line(places, velocities, e):
    """How many there are, from the gaps and their rates alone; `MOST` if there is no end.

    A collision in gap a turns its rate u_a into -e u_a and gives (1 + e) u_a/2 to the other.
    """
    gap = [places[1] - places[0] - 1.0, places[2] - places[1] - 1.0]
    rate = [velocities[1] - velocities[0], velocities[2] - velocities[1]]
    for count in range(MOST):
        when = [g / -u if u < 0 else math.inf for g, u in zip(gap, rate, strict=True)]
        a = int(when[1] < when[0])
        if when[a] == math.inf:
            return count
        gap = [g + u * when[a] for g, u in zip(gap, rate, strict=True)]
        gap[a] = 0.0
        rate[1 - a] += (1 + e) / 2 * rate[a]
        rate[a] *= -e
    return MOST


def on_a_line(places, velocities):
    zero = np.zeros(len(places))
    return spheres(np.column_stack([places, zero, zero]), np.column_stack([velocities, zero, zero]))


@pytest.mark.parametrize("make", [FastEngine, ExactEngine])
@pytest.mark.parametrize("e", [0.06, 0.03, 0.0])
def test_collapse_is_flagged(make, e):
    """All these starts collapse; no run hangs, and the watchdog names the place."""
    for places, velocities in starts(seed=1):
        assert collisions_on_a_line(places, velocities, e) == MOST
        engine = make(on_a_line(places, velocities), World(restitution=e))
        assert drive(engine) is Stop.COLLAPSE
        assert engine.collisions < MOST
        when, i, j = engine.collapse
        assert when == engine.time
        assert (i, j) in ((0, 1), (1, 2))
        assert np.ptp(engine.state().position[:, 0]) == pytest.approx(2.0, abs=1e-12)


@pytest.mark.parametrize("make", [FastEngine, ExactEngine])
def test_a_blow_through_a_row_of_touching_spheres_is_no_collapse(make):
    """Each sphere is hit many times in one moment, and the run goes on."""
    n = 10
    state = on_a_line(np.arange(-1.0, n), np.eye(n + 1)[0])
    state.position[0, 0] = -3.0
    engine = make(state, World(restitution=0.95))
    assert drive(engine) is Stop.IDLE
    assert engine.collisions == n * (n + 1) // 2
    assert engine.collapse is None


@pytest.mark.parametrize("make", [FastEngine, ExactEngine])
def test_above_the_threshold_nothing_is_flagged(make):
    e = 0.09
    assert e > THRESHOLD > 0.06
    for places, velocities in starts(seed=2):
        engine = make(on_a_line(places, velocities), World(restitution=e))
        assert drive(engine) is Stop.IDLE
        assert engine.collisions == collisions_on_a_line(places, velocities, e) <= 10
        assert engine.collapse is None


def test_the_error_names_time_spheres_and_a_cure_that_works():
    sim = carom.Simulation(rule=carom.Smooth(0.06))
    places, velocities = next(
        start for start in starts(seed=1) if collisions_on_a_line(*start, 0.06) == MOST
    )
    state = on_a_line(places, velocities)
    sim.add_many(state.position, velocity=state.velocity)
    with pytest.raises(CollapseError, match=r"spheres \d and \d collapse at time .*contact_time="):
        sim.run(until=1e3)
    before = sim.kinetic_energy + sim.dissipated
    sim.rule = carom.Smooth(0.06, contact_time=1e-3)
    sim.run(until=1e3)
    assert sim.time == 1e3
    assert sim.withheld > 0.0
    assert sim.kinetic_energy + sim.dissipated == pytest.approx(before, rel=1e-12)
