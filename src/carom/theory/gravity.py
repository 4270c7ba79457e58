"""A gas of equal hard spheres in a gravity field: the barometric formula and what density adds.

Heights count from the lowest that a centre can reach. To first order in the density the
pressure is P = n kT (1 + B n), B = (2 pi/3) sigma^3, and dP/dz = -m g n. Within a diameter of the
floor spheres are crowded besides; that layer is left out.
"""

import math

import numpy as np

from carom.state import Floats
from carom.theory.formula import NOT_NEGATIVE, POSITIVE, Numbers, Range, formula

SOURCE = "hydrostatics with the second virial coefficient, derived in docs/theory.md"


def _floor_range(limit: float) -> Range:
    """Packing fractions that n0 may make."""
    reason = f"above {limit} the next order of the density is more than one percent"
    return Range(0, limit, above=reason)


PROFILE, MEAN = _floor_range(0.02), _floor_range(0.07)


@formula(
    SOURCE,
    height=NOT_NEGATIVE,
    column=NOT_NEGATIVE,
    gravity=POSITIVE,
    temperature=POSITIVE,
    mass=POSITIVE,
    radius=NOT_NEGATIVE,
    floor_packing_fraction=PROFILE,
)
def barometric_density(
    height: Numbers,
    column: Numbers,
    gravity: Numbers,
    temperature: Numbers = 1.0,
    mass: Numbers = 1.0,
    radius: Numbers = 0.5,
) -> Numbers:
    """Number density of a gas at a height, under gravity.

    With n0 = column m g/kT and s = m g z/kT, to first order in the density::

        n(z) = n0 exp(-s) [1 + (2 pi/3) sigma^3 n0 (1 - 2 exp(-s))]

    Parameters
    ----------
    height : float or array_like
        z, above the lowest place of a centre.
    column : float or array_like
        Spheres over each unit of floor.
    gravity, temperature, mass : float or array_like
        g, kT, m.
    radius : float or array_like
        sigma/2. 0 leaves the barometric formula of an ideal gas. The packing fraction that n0
        makes must not be above 0.02: there the next term is one percent at the floor.

    Returns
    -------
    float or float64 array
        1/length^3.

    Raises
    ------
    InputError
        Outside that range.

    References
    ----------
    Hydrostatics with the second virial coefficient: exact to its order, away from the floor.

    Examples
    --------
    >>> round(barometric_density(0.0, column=0.1, gravity=0.2, radius=0), 4)
    0.02
    >>> round(barometric_density(0.0, column=0.1, gravity=0.2), 5)
    0.01916
    """
    floor, excess = _floor(column, gravity, temperature, mass, radius, PROFILE)
    thin = np.exp(-mass * gravity * height / temperature)
    return floor * thin * (1 + excess * (1 - 2 * thin))


@formula(
    SOURCE,
    column=NOT_NEGATIVE,
    gravity=POSITIVE,
    temperature=POSITIVE,
    mass=POSITIVE,
    radius=NOT_NEGATIVE,
    floor_packing_fraction=MEAN,
)
def mean_height(
    column: Numbers,
    gravity: Numbers,
    temperature: Numbers = 1.0,
    mass: Numbers = 1.0,
    radius: Numbers = 0.5,
) -> Numbers:
    """Mean height of the spheres of a gas under gravity.

    <z> = kT/(m g) [1 + (pi/3) sigma^3 n0] with n0 = column m g/kT, to first order in the density.

    Parameters
    ----------
    column, gravity, temperature, mass : float or array_like
        See `barometric_density`.
    radius : float or array_like
        sigma/2; 0 of an ideal gas. The packing fraction that n0 makes must not be above 0.07:
        there the next term is one percent.

    Returns
    -------
    float or float64 array
        Length.

    Raises
    ------
    InputError
        Outside that range.

    References
    ----------
    See `barometric_density`.

    Examples
    --------
    >>> round(mean_height(column=0.1, gravity=0.2), 4)
    5.1047
    """
    _, excess = _floor(column, gravity, temperature, mass, radius, MEAN)
    return temperature / (mass * gravity) * (1 + excess / 2)


def _floor(
    column: Numbers,
    gravity: Numbers,
    temperature: Numbers,
    mass: Numbers,
    radius: Numbers,
    allowed: Range,
) -> tuple[Floats, Floats]:
    """n0 and B n0, which is four times the packing fraction."""
    density = column * mass * gravity / temperature
    packing = 4 / 3 * math.pi * radius**3 * density
    allowed.check("floor_packing_fraction", packing)
    return density, 4 * packing
