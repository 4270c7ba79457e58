"""Granular gases: cooling, rough spheres, kinds that do not share energy alike."""

import math

import numpy as np
import pytest

import carom
from carom.theory import (
    collision_rate,
    granular_temperature_ratio,
    haff_temperature,
    haff_temperature_by_collisions,
    rough_ratio,
    rough_temperatures,
    sonine_a2,
    temperature_rates,
)


@pytest.mark.parametrize(
    ("e", "a2", "slope", "time", "simulated"),
    # Made elsewhere: a2, d ln T/dC, tc omega0 without a2, and d ln T/dC of a direct simulation
    # Monte Carlo with 1e5 particles.
    [
        (0.99, -0.002383, -0.00662938, 301.507538, None),
        (0.9, -0.014560, -0.06310300, 31.578947, -0.06314),
        (0.8, -0.012577, -0.11962298, 16.666667, None),
        (0.7, 0.001306, -0.17005551, 11.764706, -0.16981),
        (0.5, 0.052459, -0.25328947, 8.000000, -0.25356),
    ],
)
def test_cooling(e, a2, slope, time, simulated):
    assert sonine_a2(e) == pytest.approx(a2, abs=1e-6)
    c = np.array([1.0, 10.0])
    t = haff_temperature_by_collisions(c, e, temperature=2.0)
    assert np.log(t / 2.0) == pytest.approx(slope * c, rel=2e-6)
    if simulated is not None:
        assert slope == pytest.approx(simulated, rel=2e-3)
    # At t = tc a quarter of the temperature is left.
    rate = 3.0
    tc = time / rate / (1 + 3 / 16 * a2)
    assert haff_temperature([0.0, tc], e, rate, temperature=2.0) == pytest.approx(
        [2, 0.5], rel=1e-5
    )


def test_cooling_in_time_and_by_collisions_are_one():
    """The rate falls with sqrt(T); a2 makes collisions rarer by 1 - a2/16."""
    e, rate = 0.8, collision_rate(0.05)
    t = np.linspace(0, 30, 300_001)
    temperature = haff_temperature(t, e, rate)
    actual = rate * np.sqrt(temperature) * (1 - sonine_a2(e) / 16)
    c = float(((actual[1:] + actual[:-1]) / 2 * np.diff(t)).sum())
    assert haff_temperature_by_collisions(c, e) == pytest.approx(temperature[-1], rel=1e-6)


def test_elastic_spheres_do_not_cool():
    assert sonine_a2(1) == 0
    assert haff_temperature([0, 100], 1, rate=5) == pytest.approx([1, 1])
    assert haff_temperature_by_collisions(1000, 1) == 1
    assert sonine_a2(math.sqrt(0.5)) == pytest.approx(0, abs=1e-16)
    assert haff_temperature_by_collisions(
        1, 0.3, extrapolate=True
    ) < haff_temperature_by_collisions(1, 0.5)
    assert haff_temperature(1, 0.3, 1, extrapolate=True) < haff_temperature(1, 0.5, 1)


ROUGH = [
    # e, beta, R/T in the end, R at the start (T = 1), T and R at C = 1, at C = 5
    (1.0, 1.0, 1.000000, 0.0, (0.790148, 0.209852), (0.532902, 0.467098)),
    (0.9, 0.5, 0.867077, 0.0, (0.758568, 0.112741), (0.304947, 0.179350)),
    (0.95, 0.0, 0.476479, 1.0, (0.877038, 0.791063), (0.494278, 0.331854)),
    (0.9, -0.5, 0.342627, 1.0, (0.873607, 0.836777), (0.505582, 0.413367)),
]


@pytest.mark.parametrize(("e", "beta", "ratio", "start", "at_1", "at_5"), ROUGH)
def test_rough_spheres(e, beta, ratio, start, at_1, at_5):
    """A numerical solution made elsewhere, which a simulation agrees with to a percent."""
    t, r = rough_temperatures([1, 5, 400], e, beta, rotation=start)
    both = np.array(rough_temperatures([1, 5, 400], e, beta, 3.0, 3 * start))
    assert both == pytest.approx(3 * np.array([t, r]), rel=1e-12)
    assert (t[0], r[0]) == pytest.approx(at_1, abs=1e-6)
    assert (t[1], r[1]) == pytest.approx(at_5, abs=1e-6)
    assert rough_ratio(e, beta) == pytest.approx(ratio, abs=1e-6)
    assert r[2] / t[2] == pytest.approx(ratio, rel=1e-5)


def test_rough_and_elastic_spheres_keep_their_energy():
    c = np.array([0.0, 1.0, 3.0])
    t, r = rough_temperatures(c, 1, 1, 1.0, 0.2)
    assert t + r == pytest.approx([1.2] * 3)
    assert t - r == pytest.approx(0.8 * np.exp(-0.5442 * c), rel=2e-4)
    # Of a shell, the same but faster: h (1 - h) with q = 2/3.
    assert rough_ratio(1, 1, inertia=2 / 3) == pytest.approx(1)


def test_spin_may_outlast_motion():
    """Without restitution spin is lost more slowly; what remains is the slowest of two modes."""
    late = np.array(rough_temperatures([60, 61], 0, 1))
    ratio = late[1] / late[0]
    assert rough_ratio(0, 1) == pytest.approx(ratio[0], rel=1e-9)
    assert ratio[0] > 1.5
    assert rough_temperatures(0, 0.9, 0.5) == (1, 0)


def test_smooth_spheres_never_turn():
    t, r = rough_temperatures([0, 10], 0.9, -1, 1.0, 0.3)
    assert r == pytest.approx([0.3, 0.3])
    assert t == pytest.approx([1, math.exp(-(1 - 0.81) / 3 * 10)])
    t, r = rough_temperatures(5, 1, -1, 1.0, 0.3)
    assert (t, r) == (1.0, pytest.approx(0.3))
    assert type(t) is float


GRANULAR = [
    # phi, sigma2, m2, e, n, T1/T2, rate of cooling where x1 T1 + x2 T2 = 1; x1 = 1/2
    (0.05, 0.5, 0.125, 0.9, 0.16976527, 1.173987, 0.083649),
    (0.1, 1.0, 0.25, 0.8, 0.19098593, 1.341169, 0.294446),
    (0.1, 1.0, 0.1, 0.95, 0.19098593, 1.213158, 0.114861),
    (0.1, 0.5, 1.0, 0.95, 0.33953055, 0.964032, 0.058873),
]


@pytest.mark.parametrize(("phi", "sigma2", "m2", "e", "n", "ratio", "cooling"), GRANULAR)
def test_kinds_have_their_own_temperature(phi, sigma2, m2, e, n, ratio, cooling):
    radius, volume, count, mass = [0.5, sigma2 / 2], 100 / n, [50, 50], [1, m2]
    volume *= 1 + 1e-7  # rounding must not put 0.1 above 0.1
    found = granular_temperature_ratio(radius, volume, count, mass, e)
    assert found == pytest.approx(ratio, abs=2e-6)
    t2 = 2 / (1 + found)
    t = np.array([found * t2, t2])
    rates = temperature_rates(radius, volume, count, mass, t, e)
    assert -rates / t == pytest.approx([cooling] * 2, rel=1e-5)


def test_a_ratio_simulated():
    # Direct simulation Monte Carlo: 1.328(3) and 1.208(3).
    volume = 100 / 0.19
    for mass, e, measured in (([1, 0.25], 0.8, 1.328), ([1, 0.1], 0.95, 1.208)):
        ratio = granular_temperature_ratio([0.5, 0.5], volume, [50, 50], mass, e)
        assert ratio == pytest.approx(measured, rel=0.015)


def test_temperatures_of_one_kind_and_of_elastic_ones():
    volume, phi = 1000.0, 0.05
    count = phi * volume * 6 / math.pi
    rate = temperature_rates([0.5], volume, count, mass=2, temperature=3, restitution=0.9)
    omega = collision_rate(phi, 3, 2, equation=lambda x: 1 + 4 * x * (1 - x / 2) / (1 - x) ** 3)
    assert rate == pytest.approx([-3 * omega * (1 - 0.81) / 3], rel=1e-10)
    assert temperature_rates([0.5], 99, restitution=0.9) == pytest.approx(
        temperature_rates([0.5], 99, 1, 1, 1, 0.9), rel=1e-15
    )
    # Elastic kinds keep the energy they share, and hold still at one temperature.
    kinds = ([0.5, 0.2], 80.0, [10, 40], [1, 0.3])
    gain = temperature_rates(*kinds, temperature=[1, 2])
    assert gain[0] > 0
    assert gain @ [10, 40] == pytest.approx(0, abs=1e-12)
    assert temperature_rates(*kinds, temperature=2) == pytest.approx([0, 0], abs=1e-12)
    assert granular_temperature_ratio(*kinds, 1.0) == pytest.approx(1, rel=1e-12)


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: sonine_a2(0.4), r"is 0\.4; below 0\.5 the first Sonine coefficient does not"),
        (lambda: sonine_a2(1.1), r"restitution is 1\.1; it must be 0\.5 to 1"),
        (lambda: sonine_a2(-0.1, extrapolate=True), "must be 0 to 1"),
        (lambda: haff_temperature(-1, 0.9, 1), "time is -1"),
        (lambda: haff_temperature(1, 0.9, -1), "rate is -1"),
        (lambda: haff_temperature_by_collisions(-1, 0.9), "collisions is -1"),
        (lambda: rough_temperatures(1, 0.9, 1.5), r"tangential is 1\.5; it must be -1 to 1"),
        (lambda: rough_temperatures(1, 0.9, 0, inertia=0.7), r"inertia is 0\.7"),
        (lambda: rough_temperatures([1, 2], [0.9, 0.8, 0.7], 0), "do not fit together"),
        (lambda: rough_ratio(0.9, -1), "tangential is -1; smooth spheres never turn"),
        (lambda: granular_temperature_ratio([0.5] * 3, 100, 1, 1, 0.9), "radius must hold two"),
        (
            lambda: granular_temperature_ratio([0.5] * 2, 100, 11, 1, 0.9),
            r"above 0\.1 it was not compared",
        ),
        (lambda: granular_temperature_ratio([0.5] * 2, 100, 1, 1, 0.7), "not Gaussian enough"),
        (lambda: rough_temperatures(1, 1.1, 0), r"restitution is 1\.1"),
        (lambda: rough_ratio(1.1, 0), r"restitution is 1\.1"),
        (lambda: rough_ratio(1, 1.1), r"tangential is 1\.1"),
        (lambda: temperature_rates([0.5], 99, restitution=1.1), r"restitution is 1\.1"),
        (lambda: granular_temperature_ratio([0.5] * 2, 100, 1, 1, 1.1), r"restitution is 1\.1"),
        (lambda: temperature_rates([0.5] * 2, 99, restitution=[1, 1]), "restitution must be"),
    ],
)
def test_refusals(call, sentence):
    with pytest.raises(carom.InputError, match=sentence):
        call()


def test_how_far_the_ratio_can_be_stretched():
    dense = granular_temperature_ratio([0.5] * 2, 100, 20, [1, 0.25], 0.7, extrapolate=True)
    assert 1.3 < dense < 1.8
    # Without any restitution a heavy kind ends with the speeds of the light one.
    for mass in (1e3, 1e20):
        hot = granular_temperature_ratio([0.5] * 2, 1000, 1, [mass, 1], 0, extrapolate=True)
        assert hot == pytest.approx(mass, rel=1e-6)
    hot = granular_temperature_ratio([0.5] * 2, 1000, 1, [1e15, 1e-15], 0, extrapolate=True)
    assert hot == pytest.approx(1e30, rel=1e-6)
