"""The structure factor of the fluid of equal hard spheres."""

import math

import numpy as np

from carom.state import Floats
from carom.theory.formula import FLUID, NOT_NEGATIVE, POSITIVE, Numbers, formula

#: Below this k sigma the closed form loses digits to cancellation, and a series is used.
_SMALL, _TERMS = 1.0, 9


@formula(
    "J. K. Percus, G. J. Yevick, Phys. Rev. 110, 1 (1958), doi:10.1103/PhysRev.110.1; solved by "
    "M. S. Wertheim, Phys. Rev. Lett. 10, 321 (1963), doi:10.1103/PhysRevLett.10.321; as a "
    "structure factor: N. W. Ashcroft, J. Lekner, Phys. Rev. 145, 83 (1966), "
    "doi:10.1103/PhysRev.145.83",
    wave_number=NOT_NEGATIVE,
    packing_fraction=FLUID,
    radius=POSITIVE,
)
def percus_yevick(
    wave_number: Numbers, packing_fraction: Numbers, radius: Numbers = 0.5
) -> Numbers:
    """Structure factor S(k) of the fluid of equal hard spheres, by Percus and Yevick.

    S = 1/(1 - n c(k)), where c(k) is the transform of the direct correlation function, inside
    the diameter sigma ::

        c(r) = -a - 6 phi b (r/sigma) - (phi/2) a (r/sigma)^3
        a = (1 + 2 phi)^2/(1 - phi)^4,  b = -(1 + phi/2)^2/(1 - phi)^4

    and 0 outside. S(0) = (1 - phi)^4/(1 + 2 phi)^2 is too low by 0.2 percent (phi = 0.1), 4 (0.3)
    and 10 (0.49), compared with the equation of state. The first peak is some
    8 percent too high at freezing.

    Parameters
    ----------
    wave_number : float or array_like
        k, 0 or more; unit 1/length.
    packing_fraction : float or array_like
        phi, 0 to 0.494.
    radius : float or array_like
        Of the spheres.

    Returns
    -------
    float or float64 array
        No unit.

    Raises
    ------
    InputError
        Outside that range.

    References
    ----------
    J. K. Percus, G. J. Yevick, Phys. Rev. 110, 1 (1958), doi:10.1103/PhysRev.110.1;
    M. S. Wertheim, Phys. Rev. Lett. 10, 321 (1963), doi:10.1103/PhysRevLett.10.321;
    N. W. Ashcroft, J. Lekner, Phys. Rev. 145, 83 (1966), doi:10.1103/PhysRev.145.83.

    Examples
    --------
    >>> percus_yevick([0, 6.5], packing_fraction=0.4).round(4)
    array([0.04 , 2.006])
    """
    x, phi = 2 * radius * wave_number, packing_fraction
    a = (1 + 2 * phi) ** 2 / (1 - phi) ** 4
    b = -((1 + phi / 2) ** 2) / (1 - phi) ** 4
    first, second, fourth = _transforms(x)
    return 1 / (1 + 24 * phi * (a * first + 6 * phi * b * second + phi / 2 * a * fourth))


def _transforms(x: Floats) -> tuple[Floats, Floats, Floats]:
    """Integrals from 0 to 1 of s^2, s^3 and s^5 times sin(x s)/(x s)."""
    y = np.where(x < _SMALL, 1.0, x)
    sin, cos = np.sin(y), np.cos(y)
    closed = (
        (sin - y * cos) / y**3,
        (2 * y * sin + (2 - y**2) * cos - 2) / y**4,
        ((4 * y**3 - 24 * y) * sin - (y**4 - 12 * y**2 + 24) * cos + 24) / y**6,
    )
    z = np.where(x < _SMALL, x, 0.0) ** 2
    found = []
    for power, large in zip((3, 4, 6), closed, strict=True):
        series = [(-1) ** m / (math.factorial(2 * m + 1) * (power + 2 * m)) for m in range(_TERMS)]
        small = np.polynomial.polynomial.polyval(z, series)
        found.append(np.where(x < _SMALL, small, large))
    return found[0], found[1], found[2]
