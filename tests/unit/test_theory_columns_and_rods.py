"""Gas under gravity, and spheres on a line, against hydrostatics and against runs of spheres."""

import math

import numpy as np
import pytest

import carom
from carom.theory import (
    barometric_density,
    kolafa_labik_malijevsky,
    mean_height,
    rod_collision_rate,
    rod_force,
    rod_wall_rate,
)


def hydrostatics(floor_packing):
    """<m g z>/kT and the floor's density over n0, of the full equation of state.

    With dP = -m g n dz the former is the mean of Z over the pressures from 0 to the floor's.
    """
    phi = np.linspace(0, 1.2 * floor_packing, 200_001)
    pressure = phi * kolafa_labik_malijevsky(phi)
    even = np.linspace(0, floor_packing, 20_001)
    at = np.interp(even, pressure, phi)
    return float(kolafa_labik_malijevsky(at).mean()), at[-1] / floor_packing


@pytest.mark.parametrize("floor_packing", [0.001, 0.01, 0.02, 0.07])
def test_density_lifts_a_column(floor_packing):
    m, g, kT, radius = 2.0, 0.3, 1.5, 0.25
    volume = 4 / 3 * math.pi * radius**3
    column = floor_packing / volume * kT / (m * g)
    mean, floor = hydrostatics(floor_packing)
    ideal = kT / (m * g)
    assert mean_height(column, g, kT, m, radius=0) == pytest.approx(ideal)
    height = mean_height(0.9999999 * column, g, kT, m, radius)
    assert height / ideal == pytest.approx(mean, abs=2.2 * floor_packing**2)
    assert height / ideal - 1 == pytest.approx(2 * floor_packing, rel=1e-6)
    if floor_packing <= 0.02:
        n = barometric_density(0.0, 0.9999999 * column, g, kT, m, radius)
        assert n * volume / floor_packing == pytest.approx(floor, abs=23 * floor_packing**2)


def test_the_column_holds_all_spheres_and_has_its_mean_height():
    m, g, kT, radius, column = 2.0, 0.3, 1.5, 0.25, 0.3
    z = np.linspace(0, 100, 1_000_001)
    for r in (0.0, radius):
        n = barometric_density(z, column, g, kT, m, r)
        assert np.trapezoid(n, z) == pytest.approx(column, rel=1e-8)
        mean = np.trapezoid(z * n, z) / column
        assert mean == pytest.approx(mean_height(column, g, kT, m, r), rel=1e-8)
    ideal = barometric_density([0, kT / (m * g)], column, g, kT, m, radius=0)
    assert ideal == pytest.approx(column * m * g / kT * np.array([1, math.exp(-1)]))


def test_a_column_measured():
    # tests/physics/test_atmosphere.py: <m g z>/kT = 1.0221(36) with 1000/80^2 spheres a unit.
    ratio = 0.2 / 0.8 * mean_height(1000 / 6400, gravity=0.2, temperature=0.8)
    assert ratio == pytest.approx(1.0221, abs=3 * 0.0036 + 0.02)
    assert ratio == pytest.approx(1 + math.pi / 3 * 1000 / 6400 * 0.2 / 0.8)


#: Ten rods of length 0.5 on a line of 10, of which an exact solution with 60 digits (by relabelling
#: free points) has 10 709 collisions and 1672 hits of both walls until t = 1000.
VELOCITIES = [
    0.27276877584472176, -1.2333286640307717, -0.9582652054360887, 1.6000190889991115,
    0.2028824405086084, -1.7321348424395848, -0.08369619281702581, -1.1632259734447485,
    -0.6292880940615545, -0.48800582327685743,
]  # fmt: skip


def test_rods():
    # Each pair and each wall is at most one collision off its mean in the run.
    assert 1000 * rod_collision_rate(VELOCITIES, 10, 0.25) == pytest.approx(10709, abs=25)
    assert 1000 * rod_wall_rate(VELOCITIES, 10, 0.25) == pytest.approx(1672, abs=5)
    twice_energy = float(np.square(VELOCITIES).sum())
    force = rod_force(10, 10, temperature=twice_energy / 10, radius=0.25)
    assert force == pytest.approx(2.0219081983270002784, rel=1e-12)
    # Half the impulse on both walls together, over the time.
    assert force == pytest.approx(4044.8778712164454034 / 2000, rel=5e-3)


def test_rods_in_equilibrium():
    """The mean of max(|v_i|, |v_j|) of a normal law is 2/sqrt(pi); of |v_i|, sqrt(2/pi)."""
    v = np.random.default_rng(1).normal(size=4000)
    n = v.size
    length = 3 * n
    expected = n * (n - 1) / math.sqrt(math.pi) / (2 * n)
    assert rod_collision_rate(v, length) == pytest.approx(expected, rel=0.05)
    assert rod_wall_rate(v, length) == pytest.approx(n * math.sqrt(2 / math.pi) / (2 * n), rel=0.05)
    # The sum over pairs, written out.
    few = v[:20]
    pairs = sum(max(abs(few[i]), abs(few[j])) for i in range(20) for j in range(i))
    assert rod_collision_rate(few, 30, radius=0.25) == pytest.approx(pairs / 20)
    assert rod_force(4, 4.5) == 4 / 0.5
    assert rod_force([1, 2], 5.0, temperature=[1, 3], radius=[0, 0.5]) == pytest.approx([0.2, 2])


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: barometric_density(0, 1, 1), r"floor_packing_fraction is 0\.523599; above 0\.02"),
        (lambda: barometric_density(-1, 0.01, 1), "height is -1"),
        (lambda: mean_height(0.2, 1), r"above 0\.07 the next order"),
        (lambda: mean_height(0.01, 0), "gravity is 0"),
        (
            lambda: rod_force(10, 10),
            "10 of them, do not fit on a line of 10; make it longer than 10",
        ),
        (lambda: rod_collision_rate([1, 2], 1.9), "do not fit on a line"),
        (lambda: rod_wall_rate([[1, 2]], 5), r"velocity has the shape \(1, 2\)"),
        (lambda: rod_wall_rate([1, 2], [5, 6]), "length must be a number"),
    ],
)
def test_refusals(call, sentence):
    with pytest.raises(carom.InputError, match=sentence):
        call()
