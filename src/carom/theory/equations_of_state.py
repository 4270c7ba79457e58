"""Equations of state of equal hard spheres: Z = P/(n kT) by the packing fraction."""

import math
from collections.abc import Callable

import numpy as np

from carom.checks import number
from carom.errors import InputError
from carom.theory.formula import FLUID, FREEZES, FREEZING, Numbers, Range, formula

#: Packing fraction of the densest lattice, pi/(3 sqrt 2), at which the pressure is infinite.
CLOSE_PACKING = math.pi / math.sqrt(18)

#: B_1 ... B_10 in volumes of a sphere: Z = sum B_k phi^(k-1). The first four are exact; the
#: standard errors of the others are 3e-4, 9e-4, 0.004, 0.018, 0.09, 0.4. N. Clisby, B. M. McCoy,
#: J. Stat. Phys. 122, 15 (2006), doi:10.1007/s10955-005-8080-0.
VIRIAL = (
    1.0,
    4.0,
    10.0,
    (2707 * math.pi + 438 * math.sqrt(2) - 4131 * math.acos(1 / 3)) / (70 * math.pi),
    *(b * 4.0**k for k, b in enumerate((0.110252, 0.03888198, 0.01302354), 4)),
    *(b * 4.0**k for k, b in enumerate((0.0041832, 0.0013094, 0.0004035), 7)),
)

#: Packing fraction up to which the series that ends with B_2 ... B_10 is within one percent.
_ONE_PERCENT = (0.032, 0.087, 0.152, 0.215, 0.274, 0.326, 0.373, 0.414, 0.452)

Equation = Callable[[Numbers], Numbers]


@formula(
    "N. F. Carnahan, K. E. Starling, J. Chem. Phys. 51, 635 (1969), doi:10.1063/1.1672048",
    packing_fraction=Range(0, FREEZING, above=FREEZES, far=(0, 0.64)),
)
def carnahan_starling(packing_fraction: Numbers, *, extrapolate: bool = False) -> Numbers:
    """Compressibility factor Z = P/(n kT) of the fluid of equal hard spheres.

    Z = (1 + phi + phi^2 - phi^3)/(1 - phi)^3. Too low by 3e-4 (phi = 0.1) to 3e-3 (0.4) of
    itself; `kolafa_labik_malijevsky` is a hundred times better, and no simpler to call.

    Parameters
    ----------
    packing_fraction : float or array_like
        phi, 0 to 0.494.
    extrapolate : bool
        Go on to 0.64, for the fluid that is kept from freezing; near 0.64, where random packings
        jam, it is far too low.

    Returns
    -------
    float or float64 array
        Of the shape of `packing_fraction`; no unit.

    Raises
    ------
    InputError
        Outside that range.

    References
    ----------
    N. F. Carnahan, K. E. Starling, J. Chem. Phys. 51, 635 (1969), doi:10.1063/1.1672048.

    Examples
    --------
    >>> round(carnahan_starling(0.45), 4)
    9.3847
    """
    x = packing_fraction
    return (1 + x + x * x - x**3) / (1 - x) ** 3


@formula(
    "form: J. Kolafa, S. Labik, A. Malijevsky, Phys. Chem. Chem. Phys. 6, 2335 (2004), "
    "doi:10.1039/b402792b; coefficients: S. Pieprzyk et al., Phys. Chem. Chem. Phys. 21, 6886 "
    "(2019), doi:10.1039/C9CP00903E",
    packing_fraction=Range(0, FREEZING, above=FREEZES, far=(0, 0.539)),
)
def kolafa_labik_malijevsky(packing_fraction: Numbers, *, extrapolate: bool = False) -> Numbers:
    """Compressibility factor Z = P/(n kT) of the fluid of equal hard spheres, the best one.

    With x = phi/(1 - phi), a polynomial fitted to molecular dynamics of large systems::

        Z = 1 + 4 x + 6 x^2 + 2.3647684 x^3 - 0.8698551 x^4 + 1.1062803 x^5
            - 1.1014221 x^6 + 0.66605866 x^7 - 0.03633431 x^8 - 0.20965164 x^10
            + 0.10555569 x^14 - 0.00872380 x^22

    An independent fit agrees to 2e-5 of Z up to freezing.

    Parameters
    ----------
    packing_fraction : float or array_like
        phi, 0 to 0.494.
    extrapolate : bool
        Go on to 0.539, for the fluid that is kept from freezing: about as far as spheres can be
        simulated before they do freeze.

    Returns
    -------
    float or float64 array
        Of the shape of `packing_fraction`; no unit.

    Raises
    ------
    InputError
        Outside that range.

    Notes
    -----
    J. Kolafa, S. Labik and A. Malijevsky found this kind of polynomial; the coefficients are
    those of the later fit. Others that are quoted for their name differ by up to 5e-4.

    References
    ----------
    J. Kolafa, S. Labik, A. Malijevsky, Phys. Chem. Chem. Phys. 6, 2335 (2004),
    doi:10.1039/b402792b; S. Pieprzyk, M. N. Bannerman, A. C. Branka, M. Chudak, D. M. Heyes,
    Phys. Chem. Chem. Phys. 21, 6886 (2019), doi:10.1039/C9CP00903E.

    Examples
    --------
    >>> round(kolafa_labik_malijevsky(0.45), 4)
    9.4041
    """
    x = packing_fraction / (1 - packing_fraction)
    to_8 = (1, 4, 6, 2.3647684, -0.8698551, 1.1062803, -1.1014221, 0.66605866, -0.03633431)
    low = np.polynomial.polynomial.polyval(x, to_8)
    return low - 0.20965164 * x**10 + 0.10555569 * x**14 - 0.00872380 * x**22


@formula(
    "R. J. Speedy, J. Phys.: Condens. Matter 10, 4387 (1998), doi:10.1088/0953-8984/10/20/006",
    packing_fraction=Range(
        0.523,
        CLOSE_PACKING,
        open_high=True,
        below="below 0.523 the crystal melts and this formula ends",
        above="spheres cannot be packed as densely as that",
    ),
)
def speedy_fcc(packing_fraction: Numbers) -> Numbers:
    """Compressibility factor Z = P/(n kT) of the face-centred crystal of equal hard spheres.

    With y = phi/0.74048, the share of close packing::

        Z = 3/(1 - y) - 0.5921 (y - 0.7072)/(y - 0.601)

    Within 6e-4 of two other fits to molecular dynamics. The crystal is stable above 0.545 and
    keeps for long above 0.523.

    Parameters
    ----------
    packing_fraction : float or array_like
        phi, 0.523 to 0.7405 (excluded).

    Returns
    -------
    float or float64 array
        Of the shape of `packing_fraction`; no unit.

    Raises
    ------
    InputError
        Outside that range.

    References
    ----------
    R. J. Speedy, J. Phys.: Condens. Matter 10, 4387 (1998), doi:10.1088/0953-8984/10/20/006.

    Examples
    --------
    >>> round(speedy_fcc(0.6), 3)
    15.522
    """
    y = packing_fraction / CLOSE_PACKING
    return 3 / (1 - y) - 0.5921 * (y - 0.7072) / (y - 0.601)


@formula(
    "N. Clisby, B. M. McCoy, J. Stat. Phys. 122, 15 (2006), doi:10.1007/s10955-005-8080-0",
    packing_fraction=FLUID,
)
def virial_series(
    packing_fraction: Numbers, order: int = 10, *, extrapolate: bool = False
) -> Numbers:
    """Compressibility factor Z = P/(n kT) of the fluid, as a series in the density.

    Z = sum of B_k phi^(k-1), k = 1 ... order, with the coefficients `VIRIAL`. All are positive:
    where the series is cut, it is too low.

    Parameters
    ----------
    packing_fraction : float or array_like
        phi, from 0 to where the series is one percent too low: 0.032, 0.087, 0.152, 0.215,
        0.274, 0.326, 0.373, 0.414, 0.452 for order 2 ... 10.
    order : int
        2 to 10: the last coefficient taken along.
    extrapolate : bool
        Go on to 0.494, to see how wrong it becomes.

    Returns
    -------
    float or float64 array
        Of the shape of `packing_fraction`; no unit.

    Raises
    ------
    InputError
        Outside that range.

    References
    ----------
    N. Clisby, B. M. McCoy, J. Stat. Phys. 122, 15 (2006), doi:10.1007/s10955-005-8080-0.

    Examples
    --------
    >>> round(virial_series(0.02, order=2), 6)
    1.08
    """
    n = number("order", order, at_least=2, at_most=len(VIRIAL))
    if n != int(n):
        msg = f"order is {order}; it must be a whole number, 2 to {len(VIRIAL)}"
        raise InputError(msg)
    limit = _ONE_PERCENT[int(n) - 2]
    reason = f"above {limit} a series that ends with B_{int(n)} is off by more than one percent"
    allowed = Range(0, limit, above=reason, far=(0, FREEZING))
    x = allowed.check("packing_fraction", packing_fraction, extrapolate)
    return np.polynomial.polynomial.polyval(x, VIRIAL[: int(n)])


@formula(
    "pressure equation, for instance J.-P. Hansen, I. R. McDonald, Theory of Simple Liquids",
    packing_fraction=Range(0, CLOSE_PACKING, open_high=True),
)
def contact_value(
    packing_fraction: Numbers, equation: Equation = kolafa_labik_malijevsky
) -> Numbers:
    """How much denser than average equal hard spheres are at the surface of one: g(sigma).

    g = (Z - 1)/(4 phi): exact, given the equation of state. 1 in a dilute gas. With
    `carnahan_starling` it is (1 - phi/2)/(1 - phi)^3.

    Parameters
    ----------
    packing_fraction : float or array_like
        phi, in the range of `equation`.
    equation : function
        Z by phi; default `kolafa_labik_malijevsky`.

    Returns
    -------
    float or float64 array
        Of the shape of `packing_fraction`; no unit.

    Raises
    ------
    InputError
        Outside that range.

    References
    ----------
    Any textbook of liquids, for instance J.-P. Hansen, I. R. McDonald, *Theory of Simple
    Liquids*: the pressure equation of hard spheres.

    Examples
    --------
    >>> round(contact_value(0.3), 4)
    2.4867
    >>> round(contact_value(0.6, speedy_fcc), 3)
    6.051
    """
    x = packing_fraction
    z = np.asarray(equation(x), np.float64)
    # Of almost nothing Z - 1 keeps no digits; there B_2 to B_4 are all there is of g.
    thin = x < 1e-5
    few = np.polynomial.polynomial.polyval(x, VIRIAL[1:4]) / 4
    return np.where(thin, few, (z - 1) / np.where(thin, 1.0, 4 * x))
