"""Enskog's transport coefficients, and the speeds of spheres."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import carom
from carom.theory import (
    bmcsl,
    bulk_viscosity,
    carnahan_starling,
    collision_rate,
    finite_size_diffusion,
    mutual_diffusion,
    self_diffusion,
    shear_viscosity,
    thermal_conductivity,
    thermodynamic_factor,
)


@pytest.mark.parametrize(
    ("rho", "diffusion", "shear", "bulk", "heat"),
    # Units m = kT = sigma = 1; made elsewhere, with Sonine's polynomials to order 12, and checked
    # there against numbers of J. J. Erpenbeck (1989).
    [
        (0.01, 21.276907, 0.179862, 0.000080, 0.686255),
        (0.1, 1.883496, 0.193372, 0.009017, 0.788345),
        (0.3, 0.466327, 0.289280, 0.109253, 1.263274),
        (0.5, 0.198956, 0.556924, 0.426793, 2.384676),
        (0.8, 0.066692, 1.831849, 2.037128, 7.354324),
        (0.9, 0.046249, 2.815055, 3.304821, 11.111860),
    ],
)
def test_coefficients(rho, diffusion, shear, bulk, heat):
    phi = math.pi / 6 * rho
    assert self_diffusion(phi) == pytest.approx(diffusion, rel=1e-5, abs=1e-6)
    assert shear_viscosity(phi) == pytest.approx(shear, rel=1e-5)
    assert bulk_viscosity(phi) == pytest.approx(bulk, rel=1e-5, abs=1e-6)
    assert thermal_conductivity(phi) == pytest.approx(heat, rel=1e-5)


def test_the_dilute_gas():
    # 5/(16 sigma^2) sqrt(m kT/pi) and so on, with the corrections of higher orders.
    assert shear_viscosity(0) == pytest.approx(1.016034 * 5 / 16 / math.sqrt(math.pi))
    assert thermal_conductivity(0) == pytest.approx(1.025218 * 75 / 64 / math.sqrt(math.pi))
    assert bulk_viscosity(0) == 0
    phi = 1e-8
    assert self_diffusion(phi) * phi * 6 / math.pi == pytest.approx(
        1.018954 * 3 / 8 / math.sqrt(math.pi)
    )


def test_diffusion_belongs_to_the_collision_rate():
    phi, kT, m, radius = np.array([0.1, 0.4]), 2.0, 3.0, 0.7
    omega = collision_rate(phi, kT, m, radius)
    expected = 1.5 * kT / (m * omega) * 1.018954
    assert self_diffusion(phi, kT, m, radius) == pytest.approx(expected, rel=1e-12)


@settings(max_examples=30)
@given(st.floats(0.01, 0.49), st.floats(0.1, 10), st.floats(0.1, 10), st.floats(0.1, 10))
def test_units(phi, temperature, mass, radius):
    """Each is its number in reduced units times the one product that has its unit."""
    sigma, thermal = 2 * radius, math.sqrt(temperature / mass)
    for call, unit in (
        (self_diffusion, sigma * thermal),
        (shear_viscosity, mass * thermal / sigma**2),
        (bulk_viscosity, mass * thermal / sigma**2),
        (thermal_conductivity, thermal / sigma**2),
    ):
        assert call(phi, temperature, mass, radius) == pytest.approx(unit * call(phi), rel=1e-12)
        other = call(phi, temperature, mass, radius, carnahan_starling)
        assert other == pytest.approx(unit * call(phi), rel=6e-3)


def test_what_a_small_cube_lacks():
    # Measured in DynamO at n sigma^3 = 0.5, N = 1372: D = 0.2490, and eta = 0.538.
    side = (1372 / 0.5) ** (1 / 3)
    lacks = finite_size_diffusion(side, viscosity=0.538)
    assert lacks == pytest.approx(2.837297 / (6 * math.pi * 0.538 * side))
    assert lacks / 0.2490 == pytest.approx(0.08, abs=0.005)
    assert finite_size_diffusion(2 * side, 0.538, [1, 2]) == pytest.approx([lacks / 2, lacks])


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: self_diffusion(0), r"packing_fraction is 0; it must be 0 \(excluded\) to 0\.494"),
        (lambda: self_diffusion(0.5), "freeze"),
        (lambda: shear_viscosity(0.5), "freeze"),
        (lambda: bulk_viscosity(-0.1), r"packing_fraction is -0\.1; it must be 0 to 0\.494"),
        (lambda: thermal_conductivity(0.3, radius=-1), "radius is -1"),
        (lambda: finite_size_diffusion(0, 1), "length is 0"),
        (lambda: finite_size_diffusion(1, 0), "viscosity is 0"),
    ],
)
def test_refusals(call, sentence):
    with pytest.raises(carom.InputError, match=sentence):
        call()


class TestMutualDiffusion:
    def test_equal_spheres_diffuse_as_one_does(self):
        n, kT, m, radius = np.array([300, 100]), 2.0, 3.0, 0.7
        volume = 400 * 4 / 3 * math.pi * radius**3 / 0.3
        alone = self_diffusion(0.3, kT, m, radius, equation=carnahan_starling) / 1.018954
        assert mutual_diffusion([radius] * 2, volume, n, m, kT) == pytest.approx(alone, rel=1e-12)

    def test_a_light_point_among_rare_fixed_spheres(self):
        """Lorentz: D = l <v>/3, which the first order of Sonine falls short of by 9 pi/32."""
        count, mass, kT = [1e-6, 1000], [1e-9, 1], 1.0
        path = 1e6 / (1000 * math.pi * 0.5**2)
        lorentz = path * math.sqrt(8 * kT / (math.pi * mass[0])) / 3
        found = mutual_diffusion([1e-9, 0.5], 1e6, count, mass, kT)
        assert found == pytest.approx(lorentz * 9 * math.pi / 32, rel=2e-3)

    @pytest.mark.parametrize("formula", [mutual_diffusion, thermodynamic_factor])
    @pytest.mark.parametrize("radius", [[0.5], [0.5, 0.4, 0.3]])
    def test_two_kinds(self, formula, radius):
        message = f"radius must hold two numbers, one for each kind, not {len(radius)}"
        with pytest.raises(carom.InputError, match=message):
            formula(radius, 500)
        with pytest.raises(carom.InputError, match="packing_fraction"):
            formula([0.5, 0.5], 1.0)


class TestThermodynamicFactor:
    def test_names_alone_make_an_ideal_mixture(self):
        assert thermodynamic_factor([0.5, 0.5], 500, [300, 100]) == pytest.approx(1, rel=1e-12)

    def test_a_rare_mixture(self):
        """1 - 2 x_1 x_2 n (2 B_12 - B_11 - B_22) to first order."""
        n, share = 400 / 5e5, 0.25 * 0.75
        excess = 2 * math.pi / 3 * (2 * 0.75**3 - 1 - 0.5**3)
        found = thermodynamic_factor([0.5, 0.25], 5e5, [100, 300])
        assert found - 1 == pytest.approx(-2 * share * n * excess, rel=2e-3)

    def test_it_is_that_of_the_equation_of_state(self):
        """The free energy by integrating Z - 1 over density, and its derivatives by differences."""
        radius, at = [0.5, 0.3], np.array([0.35, 0.6])
        place, weight = np.polynomial.legendre.leggauss(12)
        place, weight = (place + 1) / 2, weight / 2

        def free(n):
            excess = [(bmcsl(radius, 1.0, n * part) - 1) / part for part in place]
            return float(n @ np.log(n) + n.sum() * (weight @ excess))

        h, steps = 1e-3, 1e-3 * np.eye(2)
        second = [
            [
                (free(at + a + b) - free(at + a - b) - free(at - a + b) + free(at - a - b))
                / 4
                / h**2
                for b in steps
            ]
            for a in steps
        ]
        expected = at.prod() * at.sum() * np.linalg.det(second) / (at @ second @ at)
        found = thermodynamic_factor(radius, 1.0, at)
        assert found > 1.05
        assert found == pytest.approx(expected, rel=1e-4)
