"""Equations of state, against molecular dynamics, independent fits and one another."""

import csv
import math
from pathlib import Path

import numpy as np
import pytest

import carom
from carom.theory import (
    CLOSE_PACKING,
    FREEZING,
    VIRIAL,
    bmcsl,
    carnahan_starling,
    contact_value,
    kolafa_labik_malijevsky,
    speedy_fcc,
    virial_series,
)

DATA = Path(__file__).parents[1] / "physics" / "data" / "eos_fluid.csv"


@pytest.fixture(scope="module")
def fluid():
    """Columns of the reference table, see tests/physics/data."""
    with DATA.open(newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def test_the_polynomial_is_the_reference(fluid):
    z = kolafa_labik_malijevsky(fluid["eta"])
    assert z == pytest.approx(fluid["Z_ref"], abs=1e-6)
    # A fit to other simulations (A. Schultz, etomica) by another formula.
    assert z == pytest.approx(fluid["Z_etomica"], rel=2e-5)


def test_carnahan_starling_and_its_known_error(fluid):
    z = carnahan_starling(fluid["eta"])
    assert z == pytest.approx(fluid["Z_CS"], abs=1e-6)
    error = z / kolafa_labik_malijevsky(fluid["eta"]) - 1
    assert (error < 0).all()
    assert np.abs(error).max() == pytest.approx(2.8e-3, abs=3e-4)
    at = carnahan_starling([0.1, 0.4]) / kolafa_labik_malijevsky([0.1, 0.4]) - 1
    assert at == pytest.approx([-3e-4, -3e-3], rel=0.2)


@pytest.mark.parametrize(
    ("density", "etomica", "hall", "speedy"),
    # Z of the perfect crystal by n sigma^3: two fits to molecular dynamics as coded in etomica,
    # and Speedy's formula as SklogWiki has it.
    [
        (1.02, 10.69634, 10.68876, 10.69311),
        (1.0409, 11.24029, 11.22987, 11.23841),
        (1.1, 13.26706, 13.26076, 13.26594),
        (1.2, 19.46844, 19.46629, 19.46759),
        (1.3, 36.75241, 36.74930, 36.75205),
        (1.4, 298.06256, 298.05538, 298.06199),
    ],
)
def test_the_crystal(density, etomica, hall, speedy):
    z = speedy_fcc(math.pi / 6 * density)
    assert z == pytest.approx(speedy, abs=6e-6)
    assert z == pytest.approx(etomica, rel=4e-4)
    assert z == pytest.approx(hall, rel=1e-3)


def test_crystal_and_fluid_coexist_where_they_do():
    # P sigma^3/kT = 11.57 on both sides: L. A. Fernandez et al., arXiv:1103.2599.
    for z, packing_fraction in ((kolafa_labik_malijevsky, 0.4918), (speedy_fcc, 0.5433)):
        pressure = 6 / math.pi * packing_fraction * z(packing_fraction)
        assert pressure == pytest.approx(11.57, rel=2e-3)


def test_virial_coefficients():
    # In volumes of a sphere, with the errors of N. Clisby, B. M. McCoy (2006).
    known = (1, 4, 10, 18.364768, 28.22451, 39.81515, 53.3444, 68.538, 85.813, 105.78)
    errors = (0, 0, 0, 1e-6, 26e-5, 93e-5, 37e-4, 0.018, 0.085, 0.39)
    assert len(VIRIAL) == 10
    assert (np.abs(np.subtract(VIRIAL, known)) <= np.array(errors) + 6e-5).all()


def test_the_series_is_the_fluid_where_it_is_thin():
    x = np.array([0.0, 1e-4, 1e-3, 0.01, 0.05])
    assert virial_series(x) == pytest.approx(kolafa_labik_malijevsky(x), rel=1e-7)
    assert virial_series(x, 4) == pytest.approx(kolafa_labik_malijevsky(x), rel=2e-4)
    assert virial_series(0.02, order=3) == 1 + 4 * 0.02 + 10 * 0.02**2
    # And so are the formulas, order by order; Carnahan and Starling have B_4 = 18.
    for k, known in ((1, 4), (2, 10), (3, VIRIAL[3])):
        low = np.polynomial.polynomial.polyval(x[2:4], VIRIAL[:k])
        for z in (carnahan_starling, kolafa_labik_malijevsky):
            slope = (z(x[2:4]) - low) / x[2:4] ** k
            assert slope[0] == pytest.approx(known, rel=0.03)


@pytest.mark.parametrize("order", range(2, 11))
def test_a_series_ends_where_it_is_one_percent_low(order):
    with pytest.raises(carom.InputError, match=f"ends with B_{order} is off by more than one"):
        virial_series(FREEZING, order)
    limit = float(str(_refusal(virial_series, FREEZING, order)).split("above ")[1].split(" ")[0])
    error = 1 - virial_series(limit, order) / kolafa_labik_malijevsky(limit)
    assert 0.009 < error <= 0.01
    assert virial_series(FREEZING, order, extrapolate=True) < 0.99 * 12.4


def test_contact_value(fluid):
    x = fluid["eta"]
    assert contact_value(x) == pytest.approx(fluid["chi"], abs=1e-6)
    closed = (1 - x / 2) / (1 - x) ** 3
    assert contact_value(x, carnahan_starling) == pytest.approx(closed, rel=1e-12)
    # No digits are lost in a thin gas, and the change of formula there does not show.
    thin = np.array([0.0, 1e-300, 1e-12, 9.999e-6, 1.0001e-5])
    assert contact_value(thin) == pytest.approx(1 + 2.5 * thin, rel=1e-9)
    assert contact_value(0.6, speedy_fcc) == pytest.approx((speedy_fcc(0.6) - 1) / 2.4)


def test_scalars_arrays_and_lists():
    assert type(carnahan_starling(0.3)) is float
    assert type(contact_value(np.float64(0.3))) is float
    assert carnahan_starling([[0.1], [0.2]]).shape == (2, 1)
    assert carnahan_starling(0) == kolafa_labik_malijevsky(0) == virial_series(0) == 1
    given = np.array([0.1, 0.2])
    kolafa_labik_malijevsky(given)
    assert given.tolist() == [0.1, 0.2]


def test_how_far_each_can_be_stretched():
    assert carnahan_starling(0.6, extrapolate=True) == pytest.approx(27.0, abs=5)
    # Metastable: both formulas still agree to half a percent.
    x = 0.53
    z = kolafa_labik_malijevsky(x, extrapolate=True)
    assert z == pytest.approx(carnahan_starling(x, extrapolate=True), rel=6e-3)
    for call, limit in ((carnahan_starling, 0.64), (kolafa_labik_malijevsky, 0.539)):
        with pytest.raises(carom.InputError, match=f"or with extrapolate=True 0 to {limit}"):
            call(0.5)
        with pytest.raises(carom.InputError, match=f"must be 0 to {limit}"):
            call(0.65, extrapolate=True)
    assert speedy_fcc(CLOSE_PACKING - 1e-6) > 1e6


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (
            lambda: kolafa_labik_malijevsky([0.1, 0.6]),
            r"packing_fraction\[1\] is 0\.6; above 0\.494",
        ),
        (lambda: speedy_fcc(0.5), r"is 0\.5; below 0\.523 the crystal melts"),
        (lambda: speedy_fcc(CLOSE_PACKING), "cannot be packed as densely"),
        (
            lambda: virial_series(0.01, order=11),
            "order is 11; it must be at least 2 and at most 10",
        ),
        (lambda: virial_series(0.01, order=2.5), "order is 2.5; it must be a whole number"),
        (lambda: contact_value(0.8), r"is 0\.8; it must be 0 to 0\.74048 \(excluded\)"),
        (lambda: contact_value(0.6), "freeze"),
        (lambda: contact_value("0.3"), "must be a number or an array of numbers, not '0.3'"),
        (lambda: contact_value([0.1, None]), "must be a number or an array of numbers"),
        (lambda: contact_value(None), "must be a number or an array of numbers, not None"),
        (lambda: contact_value(True), "must be a number or an array of numbers, not True"),
        (lambda: bmcsl([0.5], 10, count=[1, 2]), r"count has the shape \(2,\)"),
        (lambda: bmcsl([0.5, 0.3], 10, count=[1, 0]), r"count\[1\] is 0; it must be above 0"),
    ],
)
def test_refusals(call, sentence):
    with pytest.raises(carom.InputError, match=sentence):
        call()


def _refusal(call, *arguments):
    with pytest.raises(carom.InputError) as refused:
        call(*arguments)
    return refused.value
