"""The structure factor of Percus and Yevick, against its own integrals and its known limits."""

import numpy as np
import pytest

import carom
from carom.theory import carnahan_starling, kolafa_labik_malijevsky, percus_yevick

PHIS = [0.0, 0.05, 0.2, 0.35, 0.494]


@pytest.mark.parametrize("phi", PHIS)
def test_it_is_the_transform_of_the_direct_correlation_function(phi):
    """By quadrature, and across the border between the series and the closed form."""
    k = np.array([0, 0.01, 0.5, 0.999, 1.001, 3, 6.8, 20, 60])
    a, b = (1 + 2 * phi) ** 2 / (1 - phi) ** 4, -((1 + phi / 2) ** 2) / (1 - phi) ** 4
    nodes, weight = np.polynomial.legendre.leggauss(200)
    s, weight = (nodes + 1) / 2, weight / 2
    c = -a - 6 * phi * b * s - phi / 2 * a * s**3
    transform = 24 * phi * (np.sinc(np.outer(k, s) / np.pi) * (s**2 * c)) @ weight
    assert percus_yevick(k, phi) == pytest.approx(1 / (1 - transform), rel=1e-12)


def test_limits():
    assert percus_yevick(3.0, 0.0) == 1
    assert percus_yevick(1e6, 0.3) == pytest.approx(1, abs=1e-9)
    for phi in PHIS:
        assert percus_yevick(0.0, phi) == pytest.approx((1 - phi) ** 4 / (1 + 2 * phi) ** 2, 1e-14)
    assert percus_yevick(2.0, 0.3, radius=1.0) == percus_yevick(4.0, 0.3, radius=0.5)


@pytest.mark.parametrize(("phi", "low"), [(0.1, 0.002), (0.3, 0.035), (0.49, 0.105)])
def test_its_compressibility_and_that_of_the_equation_of_state(phi, low):
    """S(0) = 1/(d(phi Z)/d phi), by Ornstein and Zernike; the docstring says how far it is off."""
    for equation, digits in ((kolafa_labik_malijevsky, 2e-3), (carnahan_starling, 6e-3)):
        step = 1e-5
        rise = (phi + step) * equation(phi + step) - (phi - step) * equation(phi - step)
        s0 = 2 * step / rise
        assert percus_yevick(0.0, phi) / s0 == pytest.approx(1 - low, abs=digits)


def test_the_first_peak_of_the_dense_fluid():
    """At freezing it is 2.85 high (Hansen and Verlet 1969); Percus and Yevick's is higher."""
    k = np.linspace(6, 8, 2001)
    s = percus_yevick(k, 0.49)
    assert 2.85 < s.max() < 1.25 * 2.85
    assert k[s.argmax()] == pytest.approx(7.0, abs=0.15)


@pytest.mark.parametrize(("k", "phi", "words"), [
    (-1.0, 0.3, "wave_number is -1"),
    (1.0, 0.5, "above 0.494 hard spheres freeze"),
])  # fmt: skip
def test_where_it_does_not_hold(k, phi, words):
    with pytest.raises(carom.InputError, match=words):
        percus_yevick(k, phi)
