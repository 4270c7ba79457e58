"""Diffusion, viscosity and conduction of heat in a fluid of equal hard spheres, by Enskog.

Enskog's theory takes the velocities of two spheres that meet to know nothing of one another. That
is exact in a dilute gas; in a dense one it errs, in a known way. Molecular dynamics over Enskog::

    n sigma^3   diffusion   shear viscosity   bulk viscosity   conductivity
    0.5         1.25        0.99              1.00             1.00
    0.8         1.00        1.17              1.08             1.02

(within 0.01, 0.01, 0.02, 0.01; N = 1372, and diffusion is that of a periodic cube of this N, in
which it is some percent too low: see `finite_size_diffusion`). The factors 1.01..., to all orders
of Sonine's polynomials, are exact to the digits given.
"""

import math

import numpy as np

from carom.theory.collisions import CHAPMAN_COWLING
from carom.theory.equations_of_state import Equation, contact_value, kolafa_labik_malijevsky
from carom.theory.formula import (
    FLUID,
    FREEZES,
    FREEZING,
    NOT_NEGATIVE,
    POSITIVE,
    Numbers,
    Range,
    formula,
)

ENSKOG = (
    f"{CHAPMAN_COWLING}, ch. 16; all orders: M. J. Lindenfeld, B. Shizgal, Chem. Phys. 41, 81 "
    "(1979)"
)
#: Over the first order of Sonine's polynomials.
DIFFUSION, SHEAR, HEAT = 1.018954, 1.016034, 1.025218


@formula(
    ENSKOG,
    packing_fraction=Range(0, FREEZING, open_low=True, above=FREEZES),
    temperature=NOT_NEGATIVE,
    mass=POSITIVE,
    radius=POSITIVE,
)
def self_diffusion(
    packing_fraction: Numbers,
    temperature: Numbers = 1.0,
    mass: Numbers = 1.0,
    radius: Numbers = 0.5,
    equation: Equation = kolafa_labik_malijevsky,
) -> Numbers:
    """Coefficient D of self-diffusion in a fluid of equal hard spheres, by Enskog.

    D = 1.018954 3/(8 n sigma^2 g) sqrt(kT/(pi m)), which is 1.018954 3 kT/(2 m omega), with the
    `contact_value` g and the `collision_rate` omega. A sphere's mean square displacement is 6 D t
    in the end.

    Parameters
    ----------
    packing_fraction : float or array_like
        phi, above 0, to 0.494.
    temperature, mass, radius : float or array_like
        kT, m, sigma/2.
    equation : function
        Z by phi, from which g is taken.

    Returns
    -------
    float or float64 array
        Length^2/time. Too low by a quarter near n sigma^3 = 0.5, and good near 0.8.

    Raises
    ------
    InputError
        Outside that range.

    References
    ----------
    S. Chapman, T. G. Cowling, *The Mathematical Theory of Non-Uniform Gases*, 3rd ed. (1970),
    ch. 16; all orders: M. J. Lindenfeld, B. Shizgal, Chem. Phys. 41, 81 (1979).

    Examples
    --------
    >>> round(self_diffusion(0.3), 4)
    0.1513
    """
    g = contact_value(packing_fraction, equation)
    # 1/(n sigma^2) = pi sigma/(6 phi)
    mean_square = np.sqrt(temperature / (math.pi * mass))
    return DIFFUSION * math.pi * radius / (8 * packing_fraction * g) * mean_square


@formula(ENSKOG, packing_fraction=FLUID, temperature=NOT_NEGATIVE, mass=POSITIVE, radius=POSITIVE)
def shear_viscosity(
    packing_fraction: Numbers,
    temperature: Numbers = 1.0,
    mass: Numbers = 1.0,
    radius: Numbers = 0.5,
    equation: Equation = kolafa_labik_malijevsky,
) -> Numbers:
    """Shear viscosity eta of a fluid of equal hard spheres, by Enskog.

    With y = Z - 1 and the `contact_value` g::

        eta = 5/(16 sigma^2 g) sqrt(m kT/pi) [1.016034 (1 + 2 y/5)^2 + 48 y^2/(25 pi)]

    Parameters
    ----------
    packing_fraction : float or array_like
        phi, 0 to 0.494.
    temperature, mass, radius, equation
        See `self_diffusion`.

    Returns
    -------
    float or float64 array
        Mass/(length time). Good to 2 percent to n sigma^3 = 0.5; 15 percent too low at 0.8.

    Raises
    ------
    InputError
        Outside that range.

    References
    ----------
    See `self_diffusion`.

    Examples
    --------
    >>> round(shear_viscosity(0.3), 4)
    0.7325
    """
    g = contact_value(packing_fraction, equation)
    y = 4 * packing_fraction * g
    bracket = SHEAR * (1 + 0.4 * y) ** 2 + 48 / (25 * math.pi) * y * y
    return _dilute_viscosity(temperature, mass, radius) / g * bracket


@formula(ENSKOG, packing_fraction=FLUID, temperature=NOT_NEGATIVE, mass=POSITIVE, radius=POSITIVE)
def bulk_viscosity(
    packing_fraction: Numbers,
    temperature: Numbers = 1.0,
    mass: Numbers = 1.0,
    radius: Numbers = 0.5,
    equation: Equation = kolafa_labik_malijevsky,
) -> Numbers:
    """Bulk viscosity kappa of a fluid of equal hard spheres, by Enskog.

    kappa = 5/(16 sigma^2 g) sqrt(m kT/pi) 16 y^2/(5 pi) with y = Z - 1 and the `contact_value`
    g. A dilute gas has none.

    Parameters
    ----------
    packing_fraction : float or array_like
        phi, 0 to 0.494.
    temperature, mass, radius, equation
        See `self_diffusion`.

    Returns
    -------
    float or float64 array
        Mass/(length time). Good to 3 percent to n sigma^3 = 0.5; 8 percent too low at 0.8.

    Raises
    ------
    InputError
        Outside that range.

    References
    ----------
    See `self_diffusion`.

    Examples
    --------
    >>> round(bulk_viscosity(0.3), 4)
    0.6431
    """
    g = contact_value(packing_fraction, equation)
    y = 4 * packing_fraction * g
    return _dilute_viscosity(temperature, mass, radius) / g * 16 / (5 * math.pi) * y * y


@formula(ENSKOG, packing_fraction=FLUID, temperature=NOT_NEGATIVE, mass=POSITIVE, radius=POSITIVE)
def thermal_conductivity(
    packing_fraction: Numbers,
    temperature: Numbers = 1.0,
    mass: Numbers = 1.0,
    radius: Numbers = 0.5,
    equation: Equation = kolafa_labik_malijevsky,
) -> Numbers:
    """Thermal conductivity lambda of a fluid of equal hard spheres, by Enskog.

    With y = Z - 1, the `contact_value` g and Boltzmann's constant 1::

        lambda = 75/(64 sigma^2 g) sqrt(kT/(pi m)) [1.025218 (1 + 3 y/5)^2 + 32 y^2/(25 pi)]

    Parameters
    ----------
    packing_fraction : float or array_like
        phi, 0 to 0.494.
    temperature, mass, radius, equation
        See `self_diffusion`.

    Returns
    -------
    float or float64 array
        1/(length time), as temperatures are energies. Good to 2 percent to n sigma^3 = 0.8.

    Raises
    ------
    InputError
        Outside that range.

    References
    ----------
    See `self_diffusion`.

    Examples
    --------
    >>> round(thermal_conductivity(0.3), 3)
    3.087
    """
    g = contact_value(packing_fraction, equation)
    y = 4 * packing_fraction * g
    bracket = HEAT * (1 + 0.6 * y) ** 2 + 32 / (25 * math.pi) * y * y
    # 75/64 over 5/16 is 15/4
    return 3.75 / mass * _dilute_viscosity(temperature, mass, radius) / g * bracket


@formula(
    "I.-C. Yeh, G. Hummer, J. Phys. Chem. B 108, 15873 (2004), doi:10.1021/jp0477147",
    length=POSITIVE,
    viscosity=POSITIVE,
    temperature=NOT_NEGATIVE,
)
def finite_size_diffusion(
    length: Numbers, viscosity: Numbers, temperature: Numbers = 1.0
) -> Numbers:
    """What the diffusion coefficient in a periodic cube lacks: add it to the measured one.

    D - D_L = 2.837297 kT/(6 pi eta L), because a sphere drags its own images along. The next term
    is of order 1/L^3.

    Parameters
    ----------
    length : float or array_like
        L, edge of the cube.
    viscosity : float or array_like
        eta, the shear viscosity, measured or from `shear_viscosity`.
    temperature : float or array_like
        kT.

    Returns
    -------
    float or float64 array
        Length^2/time.

    Raises
    ------
    InputError
        If the length or viscosity is not above 0.

    References
    ----------
    I.-C. Yeh, G. Hummer, J. Phys. Chem. B 108, 15873 (2004), doi:10.1021/jp0477147.

    Examples
    --------
    >>> round(finite_size_diffusion(14.0, viscosity=0.538), 4)
    0.02
    """
    return 2.837297 * temperature / (6 * math.pi * viscosity * length)


def _dilute_viscosity(temperature: Numbers, mass: Numbers, radius: Numbers) -> Numbers:
    """Viscosity of a dilute gas, to first order."""
    return 5 / (64 * radius**2) * np.sqrt(mass * temperature / math.pi)
