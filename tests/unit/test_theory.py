"""Equations of state against published values, and the wall's tension against what is exact."""

import math

import numpy as np
import pytest

import carom
from carom.theory import FREEZING, bmcsl, carnahan_starling, wall_pressure, wall_tension


@pytest.mark.parametrize(
    ("packing_fraction", "factor"),
    # Molecular dynamics; see tests/physics/test_equation_of_state.py for ours.
    [(0.05, 1.227485), (0.2, 2.409403), (0.3, 3.983983), (0.4, 6.945460), (0.49, 12.170358)],
)
def test_equal_spheres(packing_fraction, factor):
    assert carnahan_starling(packing_fraction) == pytest.approx(factor, rel=4e-3)
    radius, volume = np.full(7, 0.3), 7 * 4 / 3 * math.pi * 0.3**3 / packing_fraction
    assert bmcsl(radius, volume) == pytest.approx(carnahan_starling(packing_fraction), rel=1e-14)


def test_the_ideal_gas_is_its_limit():
    assert carnahan_starling(0) == 1
    # Z = 1 + 4 phi + 10 phi^2 + ...: the exact second virial coefficient.
    assert (carnahan_starling(1e-4) - 1) / 1e-4 == pytest.approx(4, rel=1e-3)
    assert bmcsl([1e-6, 2e-6], 1) == pytest.approx(1, abs=1e-15)


def test_a_mixture():
    # Diameters 1 and 0.5, as many of each, packing fraction 0.3.
    radius = np.repeat([0.5, 0.25], 100)
    volume = 4 / 3 * math.pi * (radius**3).sum() / 0.3
    assert bmcsl(radius, volume) == pytest.approx(3.5058, abs=5e-5)
    assert bmcsl(10 * radius, 1000 * volume) == pytest.approx(bmcsl(radius, volume), rel=1e-14)


def test_second_virial_coefficient_of_a_mixture():
    # Z = 1 + B n with B = (2 pi/3) <(mean of two diameters)^3>, exactly.
    radius = np.array([0.5, 0.2, 0.2, 0.9])
    sigma = radius[:, None] + radius
    exact = 2 * math.pi / 3 * (sigma**3).mean() * len(radius)
    volume = 1e6
    assert (bmcsl(radius, volume) - 1) * volume == pytest.approx(exact, rel=1e-5)


def test_tension_in_a_thin_gas_is_exact():
    # gamma/kT = -(pi/8) n^2 sigma^4: from the caps of spheres that a wall cuts off.
    n = 1e-4
    assert wall_tension([0.5], 1 / n) == pytest.approx(-math.pi / 8 * n * n, rel=1e-3)


def test_pressure_on_walls():
    side, n = 20.0, 500
    # Spheres that are hardly there are an ideal gas.
    ideal = wall_pressure(np.full(n, 1e-6), side**3, 6 * side**2, 4 / side)
    assert ideal == pytest.approx(n / side**3, rel=1e-12)
    # In a room so large that walls do not matter, P = n kT Z.
    radius, volume = np.full(n, 0.5), n * math.pi / 6 / 0.3
    bulk = n / volume * carnahan_starling(0.3)
    assert wall_pressure(radius, volume, 0, 0) == pytest.approx(bulk, rel=1e-12)
    # Measured in a cubic box at packing fraction 0.1, see carom.view.pressure.
    side = 13.782337338022655
    reach = side - 1
    force = wall_pressure(radius, reach**3, 6 * reach**2, 4 / reach) * reach**2 / 3
    assert force == pytest.approx(20.556, rel=0.005)


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: carnahan_starling(-0.1), "packing_fraction is -0.1"),
        (lambda: carnahan_starling(0.5), r"is 0\.5; above 0\.494 hard spheres freeze"),
        (lambda: carnahan_starling(math.nan), "packing_fraction is nan"),
        (lambda: bmcsl([0.5] * 10, 10), r"is 0\.523599; above 0\.494"),
        (lambda: bmcsl([0.5, 0.0], 10), "above 0 for each sphere"),
        (lambda: bmcsl([], 10), "one sphere at least"),
        (lambda: bmcsl([0.5], 0), "volume is 0"),
        (lambda: wall_tension([0.5], 1), "freeze"),
        (lambda: wall_pressure([0.5] * 100, 100, 1, 1), "100 spheres are too many"),
    ],
)
def test_outside_their_range_they_refuse(call, sentence):
    with pytest.raises(carom.InputError, match=sentence):
        call()
    assert carnahan_starling(FREEZING) > 12
