"""Collision rates, free times and free paths, of equal spheres and of mixtures."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import carom
from carom.theory import (
    bmcsl,
    bmcsl_contact,
    carnahan_starling,
    collision_rate,
    collision_rate_at_speed,
    contact_value,
    free_path_cdf,
    free_path_pdf,
    free_time_cdf,
    free_time_pdf,
    kolafa_labik_malijevsky,
    maxwell_speed_pdf,
    mean_free_path,
    mean_free_time,
    pair_rates,
    speedy_fcc,
)

NODES, WEIGHTS = np.polynomial.legendre.leggauss(120)


def integral(function, low, high):
    """By Gauss's quadrature, in ten pieces."""
    edges = np.linspace(low, high, 11)
    half = np.diff(edges)[:, None] / 2
    return float((half * WEIGHTS * function(edges[:-1, None] + half * (NODES + 1))).sum())


@pytest.mark.parametrize(
    ("eta", "omega", "mft", "mfp"),
    # Units m = sigma = kT = 1; the equation of state of S. Pieprzyk et al. (2019).
    [
        (0.05, 0.770069, 1.298585, 2.072241),
        (0.30, 10.101194, 0.098998, 0.157978),
        (0.49, 37.813199, 0.026446, 0.042201),
        (0.418879, 22.917686, 0.043634, 0.069630),
    ],
)
def test_rates_in_the_fluid(eta, omega, mft, mfp):
    assert collision_rate(eta) == pytest.approx(omega, rel=1e-5)
    assert mean_free_time(eta) == pytest.approx(mft, rel=3e-5)
    assert mean_free_path(eta) == pytest.approx(mfp, rel=3e-5)


def test_measured_free_times():
    # M. Bannerman's DynamO, N = 1372: at n sigma^3 = 0.5 and 0.8.
    assert mean_free_time(math.pi / 12) == pytest.approx(0.130267, abs=3 * 0.000064)
    assert mean_free_time(math.pi / 7.5) == pytest.approx(0.0436102, abs=3 * 0.000023)


positive = st.floats(0.1, 10)


@settings(max_examples=50)
@given(st.floats(0.001, 0.49), positive, positive, positive)
def test_rate_and_pressure_are_one(phi, temperature, mass, radius):
    """Z = 1 + (sqrt(pi)/6) sigma omega sqrt(m/kT); and the path is <v>/omega, in any units."""
    for equation in (kolafa_labik_malijevsky, carnahan_starling):
        omega = collision_rate(phi, temperature, mass, radius, equation)
        z = 1 + math.sqrt(math.pi) / 6 * 2 * radius * omega * math.sqrt(mass / temperature)
        assert z == pytest.approx(equation(phi), rel=1e-10)
        assert mean_free_time(phi, temperature, mass, radius, equation) * omega == pytest.approx(1)
        mean_speed = math.sqrt(8 * temperature / (math.pi * mass))
        path = mean_free_path(phi, radius, equation)
        assert path == pytest.approx(mean_speed / omega, rel=1e-10)


def test_a_dilute_gas():
    # omega = 4 sqrt(pi) n sigma^2 sqrt(kT/m), lambda = 0.2250790790/(n sigma^2)
    n = 1e-9
    phi = math.pi / 6 * n
    assert collision_rate(phi) / n == pytest.approx(7.0898154036, rel=1e-8)
    assert mean_free_path(phi) * n == pytest.approx(0.2250790790, rel=1e-8)
    assert collision_rate(0) == 0
    ideal = collision_rate(0.3, equation=lambda x: 1 + 4 * x)
    assert ideal == pytest.approx(7.0898154036 * 0.3 * 6 / math.pi)
    assert collision_rate(0.3, temperature=0) == 0


def test_a_crystal():
    assert collision_rate(0.6, equation=speedy_fcc) == pytest.approx(
        (speedy_fcc(0.6) - 1) * 6 / math.sqrt(math.pi)
    )


def test_the_rate_of_a_speed_has_the_right_mean_and_limits():
    phi, kT, m, radius = 0.3, 2.0, 3.0, 0.25
    width = math.sqrt(kT / m)

    def share(v):
        return maxwell_speed_pdf(v, kT, m) * collision_rate_at_speed(v, phi, kT, m, radius)

    assert integral(share, 0, 12 * width) == pytest.approx(
        collision_rate(phi, kT, m, radius), rel=1e-12
    )
    n, g = phi / (4 / 3 * math.pi * radius**3), contact_value(phi)
    # At rest all depends on the others' mean speed; far faster than they, on its own.
    area = math.pi * (2 * radius) ** 2
    slow = collision_rate_at_speed(0.0, phi, kT, m, radius)
    assert slow == pytest.approx(n * area * g * math.sqrt(8 * kT / (math.pi * m)), rel=1e-12)
    fast = collision_rate_at_speed(1e4, phi, kT, m, radius)
    assert fast == pytest.approx(n * area * g * 1e4, rel=1e-6)
    near = collision_rate_at_speed([0.0, 1e-12, 1e-5], phi, kT, m, radius)
    assert near == pytest.approx([slow] * 3, rel=1e-9)


def test_free_times_of_a_dilute_gas():
    # Quadratures done elsewhere; an exponential law has 2 and 0.3679, 0.1353, 0.0498, 0.0067.
    beyond = 1 - free_time_cdf([1, 2, 3, 5])
    assert beyond == pytest.approx(
        [0.3609538586, 0.1356627221, 0.0526906411, 0.0085752295], abs=1e-10
    )
    assert integral(free_time_pdf, 0, 60) == pytest.approx(1, abs=1e-12)
    assert integral(lambda t: t * free_time_pdf(t), 0, 60) == pytest.approx(1, abs=1e-12)
    square = integral(lambda t: t * t * free_time_pdf(t), 0, 60)
    assert square == pytest.approx(2.0761308045, abs=1e-9)


def test_free_paths_of_a_dilute_gas():
    assert integral(free_path_pdf, 0, 60) == pytest.approx(1, abs=1e-7)
    assert integral(lambda s: s * free_path_pdf(s), 0, 60) == pytest.approx(1, abs=1e-7)

    # Tait's path <v/omega(v)>, the mean until the next collision from any moment on, has to be
    # <s/omega(v)> over <1/...>: here by the law of paths of one speed, in mean free paths.
    def tait(v):
        return maxwell_speed_pdf(v) * v / collision_rate_at_speed(v, 0.1)

    n_sigma2 = 0.6 / math.pi * contact_value(0.1)
    assert n_sigma2 * integral(tait, 0, 12) == pytest.approx(0.2156429269, abs=1e-9)


def test_free_paths_drawn_by_chance():
    """Speeds after a collision, and exponential times for each: as the law is made."""
    random = np.random.default_rng(5)
    v = np.linalg.norm(random.normal(size=(400_000, 3)), axis=1)
    rate = collision_rate_at_speed(v, 0.2) / collision_rate(0.2)
    keep = random.random(v.size) < rate / rate.max()
    time = random.exponential(1 / rate[keep])
    path = v[keep] * time / math.sqrt(8 / math.pi)
    for sample, law in ((time, free_time_cdf), (path, free_path_cdf)):
        ordered = np.sort(sample)
        steps = np.arange(1, ordered.size + 1) / ordered.size
        distance = np.abs(law(ordered) - steps).max() * math.sqrt(ordered.size)
        assert distance < 1.95  # one in a thousand is farther


@pytest.mark.parametrize(
    ("pdf", "cdf"), [(free_time_pdf, free_time_cdf), (free_path_pdf, free_path_cdf)]
)
def test_densities_are_slopes(pdf, cdf):
    x, h = np.array([0.01, 0.5, 2.0, 7.0]), 1e-5
    assert (cdf(x + h) - cdf(x - h)) / (2 * h) == pytest.approx(pdf(x), rel=1e-5)
    assert cdf(0) == 0
    # Both in other units.
    scale = 3.0
    if pdf is free_time_pdf:
        assert pdf(x, scale) == pytest.approx(scale * pdf(scale * x), rel=1e-12)
        assert cdf(x, scale) == pytest.approx(cdf(scale * x), rel=1e-12)
    else:
        assert pdf(x, scale) == pytest.approx(pdf(x / scale) / scale, rel=1e-12)
        assert cdf(x, scale) == pytest.approx(cdf(x / scale), rel=1e-12)


MIXTURES = [
    # phi, sigma2, m2, x1, n, Z, chi 11 12 22, pairs per volume and time 11 12 22, mean free time
    (0.1, 0.5, 0.125, 0.5, 0.33953055, 1.450448, (1.325340, 1.252049, 1.216109),
     (0.135404, 0.305269, 0.087854), 0.32120505),
    (0.3, 0.5, 0.125, 0.5, 1.01859164, 3.505831, (2.610949, 2.180830, 1.979268),
     (2.400731, 4.785483, 1.286870), 0.06010749),
    (0.49, 0.8, 0.512, 0.5, 1.23787178, 11.860710, (6.090566, 5.526543, 5.094254),
     (8.270921, 14.773751, 6.187595), 0.02117304),
    (0.3, 0.5, 1.0, 0.5, 1.01859164, 3.505831, (2.610949, 2.180830, 1.979268),
     (2.400731, 2.255898, 0.454977), 0.09963517),
    (0.2, 0.2, 0.008, 0.1, 3.56317037, 1.630905, (1.907554, 1.455213, 1.371451),
     (0.858529, 33.686045, 22.359318), 0.03130867),
]  # fmt: skip


@pytest.mark.parametrize("row", MIXTURES)
def test_mixtures(row):
    """A table of BMCSL and Enskog made elsewhere; kT = sigma1 = m1 = 1."""
    phi, sigma2, m2, x1, n, z, chi, pairs, mft = row
    radius, volume, count = [0.5, sigma2 / 2], 2.0, 2 * n * np.array([x1, 1 - x1])
    assert math.pi / 6 * n * (x1 + (1 - x1) * sigma2**3) == pytest.approx(phi, rel=1e-6)
    assert bmcsl(radius, volume, count) == pytest.approx(z, rel=1e-6)
    contact = bmcsl_contact(radius, volume, count)
    assert contact[[0, 0, 1], [0, 1, 1]] == pytest.approx(chi, rel=1e-6)
    assert contact[0, 1] == contact[1, 0]
    rates = pair_rates(radius, volume, count, mass=[1, m2])
    density = count / volume
    per_volume = density[:, None] * rates
    assert per_volume[0, 1] == pytest.approx(per_volume[1, 0], rel=1e-12)
    assert per_volume[0, 0] / 2 == pytest.approx(pairs[0], rel=2e-5, abs=1e-6)
    assert per_volume[0, 1] == pytest.approx(pairs[1], rel=2e-5)
    assert per_volume[1, 1] / 2 == pytest.approx(pairs[2], rel=2e-5)
    assert n / per_volume.sum() == pytest.approx(mft, rel=1e-5)


def test_a_mixture_measured():
    # F. Smallenburg's event-driven code, N = 4000, phi = 0.3, sigma2 = 0.5, m2 = 0.125.
    radius, count, volume = [0.5, 0.25], [2000, 2000], 4000 / 1.0185916
    assert bmcsl(radius, volume, count) == pytest.approx(3.51616, rel=4e-3)
    rates = pair_rates(radius, volume, count, mass=[1, 0.125]) * 1.0185916 / 2
    assert rates[0, 0] / 2 == pytest.approx(2.42598, rel=0.012)
    assert rates[0, 1] == pytest.approx(4.76863, rel=0.006)
    assert rates[1, 1] / 2 == pytest.approx(1.28296, rel=0.006)


def test_contact_values_give_the_pressure():
    """Z = 1 + (2 pi/3) n sum of x_i x_j sigma_ij^3 chi_ij."""
    radius, count, volume = np.array([0.5, 0.3, 0.1]), np.array([3, 10, 40]), 8.0
    n, x = count.sum() / volume, count / count.sum()
    sigma = radius[:, None] + radius
    chi = bmcsl_contact(radius, volume, count)
    z = 1 + 2 * math.pi / 3 * n * (np.outer(x, x) * sigma**3 * chi).sum()
    assert bmcsl(radius, volume, count) == pytest.approx(z, rel=1e-12)


def test_spheres_one_by_one():
    """Without a count each radius is that of one sphere, of mass 1 at temperature 1."""
    given = ([0.5, 0.3], 10)
    assert (bmcsl_contact(*given) == bmcsl_contact(*given, [1, 1])).all()
    assert (pair_rates(*given) == pair_rates(*given, [1, 1], mass=[1, 1], temperature=1)).all()


def test_mixtures_of_equal_spheres_are_one_kind():
    phi, volume = 0.35, 100.0
    count = np.array([1, 2, 5]) * phi * volume / (8 * math.pi / 6)
    chi = bmcsl_contact([0.5] * 3, volume, count)
    assert chi == pytest.approx(np.full((3, 3), contact_value(phi, carnahan_starling)), rel=1e-12)
    rates = pair_rates([0.5] * 3, volume, count, mass=2, temperature=3)
    total = collision_rate(phi, 3, 2, equation=carnahan_starling)
    assert rates.sum(axis=1) == pytest.approx([total] * 3, rel=1e-12)


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: mean_free_time(0), r"packing_fraction is 0; it must be 0 \(excluded\) to"),
        (lambda: mean_free_path([0.1, 0.0]), r"packing_fraction\[1\] is 0"),
        (lambda: collision_rate(0.5), "freeze"),
        (lambda: collision_rate(0.3, mass=0), "mass is 0; it must be above 0"),
        (lambda: collision_rate(0.3, temperature=-1), "temperature is -1; it must be at least 0"),
        (lambda: collision_rate([0.1, 0.2], mass=[1] * 3), r"packing_fraction \(2,\), mass \(3,\)"),
        (lambda: collision_rate(0.3, mass=math.inf), "mass is inf; give a finite number"),
        (lambda: collision_rate(0.3, mass=1e61), "overflows: choose other units"),
        (lambda: collision_rate_at_speed(-1, 0.3), "speed is -1"),
        (lambda: free_time_pdf(-1), "time is -1"),
        (lambda: free_path_cdf(1, mean=0), "mean is 0"),
        (lambda: pair_rates([0.5, 0.3], 10, mass=[1] * 3), r"mass has the shape \(3,\); give one"),
        (lambda: pair_rates([0.5, 0.3], 10, mass=[1, -2]), r"mass\[1\] is -2"),
        (lambda: bmcsl_contact([[0.5]], 10), "above 0 for each sphere"),
    ],
)  # fmt: skip
def test_refusals(call, sentence):
    with pytest.raises(carom.InputError, match=sentence):
        call()
