"""What formulas have in common; mixtures and walls against what is published or exact."""

import inspect
import math
import re
from pathlib import Path

import numpy as np
import pytest

import carom
from carom import theory
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


@pytest.mark.parametrize("phi", [0.1, 0.3, 0.49])
def test_tension_of_equal_spheres(phi):
    # -(9/(2 pi)) phi^2 (1 + phi)/(1 - phi)^3 kT/sigma^2 of scaled-particle theory, as in
    # M. Heni, H. Loewen, Phys. Rev. E 60, 7057 (1999).
    radius = 0.4
    tension = wall_tension([radius] * 3, 3 * 4 / 3 * math.pi * radius**3 / phi)
    closed = -9 / (2 * math.pi) * phi**2 * (1 + phi) / (1 - phi) ** 3
    assert tension == pytest.approx(closed / (2 * radius) ** 2, rel=1e-12)


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


TABLES = (Path(__file__).parents[2] / "docs" / "theory.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("name", theory.formulas())
def test_each_formula_is_public_and_in_the_documents_with_its_range_and_source(name):
    function = getattr(theory, name)
    known = theory.about(name)
    assert theory.about(function) is known
    assert name in theory.__all__
    assert re.fullmatch(r"\S.+\.", known.summary)
    row = next(line for line in TABLES.splitlines() if re.match(rf"\|.*`{name}`.*\|.*\|.*\|", line))
    row = re.sub("\u2212", "-", row)
    plain = inspect.getdoc(function)
    for doi in re.findall(r"doi:(\S+[^\s;,.])", known.source):
        assert f"https://doi.org/{doi}" in row
        assert doi in plain or re.search(r"[Ss]ee\s`\w+`", plain)
    for which in ("packing_fraction", "floor_packing_fraction"):
        if which in known.ranges:
            assert f"{known.ranges[which].high:.4g}" in row
            assert not known.ranges[which].far or f"{known.ranges[which].far[1]:g})" in row
    if "restitution" in known.ranges and name != "rough_ratio":  # whose row says "the same"
        assert f"e {known.ranges['restitution'].low:g} to 1" in row
        assert ("stretched: from 0" in row) == bool(known.ranges["restitution"].far)


def test_every_function_is_a_formula():
    functions = {n for n in theory.__all__ if inspect.isfunction(getattr(theory, n))}
    assert functions - {"about", "formulas"} == set(theory.formulas())


def test_ranges_are_what_is_refused():
    known = theory.about(carnahan_starling)
    allowed = known.ranges["packing_fraction"]
    assert (allowed.low, allowed.high, allowed.far) == (0, FREEZING, (0, 0.64))
    assert carnahan_starling(allowed.high) > 12
    with pytest.raises(carom.InputError):
        carnahan_starling(np.nextafter(allowed.high, 1))
    with pytest.raises(carom.InputError, match=r"is 0\.4940000000000000\d+; above"):
        carnahan_starling(np.nextafter(allowed.high, 1))
    with pytest.raises(TypeError):
        known.ranges["packing_fraction"] = allowed


def test_ranges_in_words():
    words = [str(theory.about("few_speed_pdf").ranges[name]) for name in ("speed", "energy")]
    assert words == ["at least 0", "above 0"]
    assert str(theory.about("maxwell_component_pdf").ranges["velocity"]) == "any number"
    assert str(theory.about("self_diffusion").ranges["packing_fraction"]) == "0 (excluded) to 0.494"


def test_a_misspelt_formula():
    with pytest.raises(carom.CaromError, match="did you mean 'carnahan_starling'"):
        theory.about("carnahan_sterling")
    with pytest.raises(carom.CaromError, match="no formula 'sqrt'"):
        theory.about(math.sqrt)
