"""The speed laws: of infinitely many spheres, and of a few."""

import math

import numpy as np
import pytest

import carom
from carom.theory import (
    few_speed_cdf,
    few_speed_pdf,
    maxwell_component_cdf,
    maxwell_component_pdf,
    maxwell_speed_cdf,
    maxwell_speed_pdf,
)

NODES, WEIGHTS = np.polynomial.legendre.leggauss(400)


def integral(function, low, high):
    half = (high - low) / 2
    return float(half * (WEIGHTS @ function(low + half * (NODES + 1))))


@pytest.mark.parametrize(("temperature", "mass"), [(1.0, 1.0), (2.0, 0.3)])
def test_maxwell(temperature, mass):
    width = math.sqrt(temperature / mass)
    moments = [
        integral(lambda v, k=k: v**k * maxwell_speed_pdf(v, temperature, mass), 0, 12 * width)
        for k in range(5)
    ]
    mean = math.sqrt(8 / math.pi)
    assert moments == pytest.approx(
        [1, mean * width, 3 * width**2, 2 * mean * 2 * width**3, 15 * width**4], rel=1e-12
    )
    for k, moment in ((0, 1), (1, 0), (2, width**2)):
        value = integral(
            lambda u, k=k: u**k * maxwell_component_pdf(u, temperature, mass),
            -12 * width,
            12 * width,
        )
        assert value == pytest.approx(moment, abs=1e-12)


def test_shares_of_maxwell():
    # Of the normal law and of chi-squared with three degrees of freedom, from printed tables.
    assert maxwell_component_cdf([-1.959964, 0, 1.0]) == pytest.approx(
        [0.025, 0.5, 0.841345], abs=1e-6
    )
    at = np.sqrt([2.365974, 7.814728])
    assert maxwell_speed_cdf(at) == pytest.approx([0.5, 0.95], abs=1e-6)
    assert maxwell_speed_cdf(2 * at, temperature=8, mass=2) == pytest.approx([0.5, 0.95], abs=1e-6)
    assert maxwell_component_cdf(2.0, temperature=8, mass=2) == pytest.approx(0.841345, abs=1e-6)
    assert maxwell_component_pdf(0.0) == pytest.approx(1 / math.sqrt(2 * math.pi))
    assert maxwell_speed_cdf(0) == 0
    assert maxwell_speed_cdf(1e3) == 1


@pytest.mark.parametrize("n", [3, 4, 6, 50, 100_000])
def test_a_few_have_their_energy(n):
    """m <v^2>/2 is E/n, with no sphere faster than momentum allows."""
    energy, mass = 1.7 * n, 0.6
    fastest = math.sqrt(2 * energy * (n - 1) / (n * mass))
    high = min(fastest, 12 * math.sqrt(2 * energy / (3 * n * mass)))
    # v = w sin(a) takes the square root at the end of three spheres' law away.
    end = math.asin(high / fastest)

    def law(a, k):
        v = fastest * np.sin(a)
        return v**k * few_speed_pdf(v, n, energy, mass) * fastest * np.cos(a)

    assert integral(lambda a: law(a, 0), 0, end) == pytest.approx(1, rel=1e-9)
    assert integral(lambda a: law(a, 2), 0, end) == pytest.approx(2 * 1.7 / 0.6, rel=1e-9)
    for share in (0.2, 0.5, 0.9):
        below = integral(lambda a: law(a, 0), 0, share * end)
        v = fastest * math.sin(share * end)
        assert few_speed_cdf(v, n, energy, mass) == pytest.approx(below, abs=1e-10)
    assert few_speed_pdf(1.001 * fastest, n, energy, mass) == 0
    assert few_speed_cdf([0, fastest, 2 * fastest], n, energy, mass) == pytest.approx([0, 1, 1])


def test_a_few_drawn_by_chance():
    """Velocities on the sphere of one energy, without momentum: uniform there."""
    n, energy, mass = 4, 3.0, 2.0
    v = np.random.default_rng(3).normal(size=(200_000, n, 3))
    v -= v.mean(axis=1, keepdims=True)
    v *= np.sqrt(2 * energy / mass / (v**2).sum(axis=(1, 2)))[:, None, None]
    speed = np.sort(np.linalg.norm(v[:, 0], axis=1))
    steps = np.arange(1, speed.size + 1) / speed.size
    assert np.abs(few_speed_cdf(speed, n, energy, mass) - steps).max() < 1.95 / math.sqrt(
        speed.size
    )
    # Maxwell's law of the same temperature is far from it.
    other = maxwell_speed_cdf(speed, 2 * energy / (3 * n - 3), mass)
    assert np.abs(other - steps).max() > 20 / math.sqrt(speed.size)


def test_many_are_maxwell():
    n, v = 10**7, np.array([0.3, 1.0, 2.0, 4.0])
    energy = (3 * n - 3) / 2
    assert few_speed_pdf(v, n, energy) == pytest.approx(maxwell_speed_pdf(v), rel=3e-6)
    assert few_speed_cdf(v, n, energy) == pytest.approx(maxwell_speed_cdf(v), rel=3e-6)


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: maxwell_speed_pdf(-1), "speed is -1"),
        (lambda: maxwell_speed_cdf(1, temperature=0), "temperature is 0"),
        (lambda: maxwell_component_pdf(1, mass=0), "mass is 0"),
        (lambda: maxwell_component_cdf(math.nan), "velocity is nan"),
        (lambda: few_speed_pdf(1, n=2, energy=1), "n is 2; it must be at least 3"),
        (lambda: few_speed_cdf(1, n=3.5, energy=1), "n is 3.5; it must be a whole number"),
        (lambda: few_speed_cdf(1, n=5, energy=0), "energy is 0"),
    ],
)
def test_refusals(call, sentence):
    with pytest.raises(carom.InputError, match=sentence):
        call()
