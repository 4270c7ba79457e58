"""What theory says of hard spheres in equilibrium, to hold measured numbers against.

Numbers are reduced by kT: a pressure here is P/kT, a surface tension gamma/kT.
"""

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import number
from carom.errors import InputError

#: Packing fraction at which a fluid of equal hard spheres begins to freeze: W. G. Hoover,
#: F. H. Ree, J. Chem. Phys. 49, 3609 (1968), doi:10.1063/1.1670641. The formulas end here.
FREEZING = 0.494

#: (pi/6) sum sigma^k / V for k = 0 ... 3, with the diameters sigma; the last is the packing
#: fraction.
Moments = tuple[float, float, float, float]


def carnahan_starling(packing_fraction: float) -> float:
    """Compressibility factor Z = P/(n kT) of the fluid of equal hard spheres.

    Z = (1 + phi + phi^2 - phi^3)/(1 - phi)^3, within 0.3 percent of simulations.

    Parameters
    ----------
    packing_fraction : float
        phi, 0 to 0.494.

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
    x = _fluid(number("packing_fraction", packing_fraction, at_least=0))
    return (1 + x + x * x - x**3) / (1 - x) ** 3


def bmcsl(radius: ArrayLike, volume: float) -> float:
    """Compressibility factor Z = P/(n kT) of the fluid of hard spheres of several sizes.

    With zeta_k = (pi/6) sum sigma_i^k / V and u = 1 - zeta_3::

        Z = [zeta_0/u + 3 zeta_1 zeta_2/u^2 + (3 - zeta_3) zeta_2^3/u^3]/zeta_0

    For equal sizes this is `carnahan_starling`.

    Parameters
    ----------
    radius : (N,) array_like
        Of every sphere.
    volume : float
        In which they are.

    Raises
    ------
    InputError
        If a radius or the volume is not above 0, or the packing fraction above 0.494.

    References
    ----------
    T. Boublik, J. Chem. Phys. 53, 471 (1970), doi:10.1063/1.1673824; G. A. Mansoori,
    N. F. Carnahan, K. E. Starling, T. W. Leland, J. Chem. Phys. 54, 1523 (1971),
    doi:10.1063/1.1675048.

    Examples
    --------
    >>> round(bmcsl([0.5] * 200 + [0.25] * 200, volume=500), 4)
    2.5816
    """
    zeta = _moments(radius, volume)
    _fluid(zeta[3])
    return _pressure(zeta) / (6 / math.pi * zeta[0])


def wall_tension(radius: ArrayLike, volume: float) -> float:
    """Surface tension gamma/kT of the fluid at a flat hard wall, by scaled-particle theory.

    About the surface that the centres of spheres reach, so that volume and area are those the
    centres have, and gamma vanishes with the square of the density. Spheres crowd at a wall,
    so it is negative. With the mean diameter s and this theory's own pressure P (`bmcsl` with
    3 in place of 3 - zeta_3)::

        gamma/kT = [3 zeta_1/u + (9/2) zeta_2^2/u^2]/pi - (s/2) P/kT

    Parameters
    ----------
    radius : (N,) array_like
        Of every sphere.
    volume : float
        In which they are.

    Raises
    ------
    InputError
        As `bmcsl`.

    References
    ----------
    J. L. Lebowitz, E. Helfand, E. Praestgaard, J. Chem. Phys. 43, 774 (1965),
    doi:10.1063/1.1696842, the term of their work of insertion that grows with the square of
    the radius.
    """
    zeta = _moments(radius, volume)
    _fluid(zeta[3])
    return _tension(zeta)


def wall_pressure(radius: ArrayLike, volume: float, area: float, stretch: float) -> float:
    """Pressure P/kT that a fluid of hard spheres puts on the hard walls around it.

    Spheres crowd at walls, so in between them are fewer than N/V. The density n there follows
    from N = n V - S n dgamma/dP, and moving a wall stretches the surface too::

        P_wall = P(n) - gamma(n) dS/dV

    Parameters
    ----------
    radius : (N,) array_like
        Of every sphere.
    volume, area : float
        V and S, of the region that the centres can reach.
    stretch : float
        dS/dV where all walls move outwards alike.

    Raises
    ------
    InputError
        If the fluid is so dense that it freezes.

    Notes
    -----
    Of spheres of different size the mixture between the walls is taken to be the mixture of
    all.
    """
    given = _moments(radius, volume)

    def excess(share: float) -> float:
        """Spheres too many, over N, if the density between the walls is `share` N/V."""
        h = 1e-4 * share
        low, high = _scaled(given, share - h), _scaled(given, share + h)
        slope = (_tension(high) - _tension(low)) / (_pressure(high) - _pressure(low))
        return share * (1 - slope * area / volume) - 1

    most = min(1.0, FREEZING / given[3])  # spheres at the walls only make it fewer
    if excess(most) < 0:
        msg = (
            f"{np.size(radius)} spheres are too many for this room: between the walls the packing "
            f"fraction would be above {FREEZING}, where hard spheres freeze; take fewer"
        )
        raise InputError(msg)
    zeta = _scaled(given, _root(excess, most))
    return _pressure(zeta) - _tension(zeta) * stretch


def _root(rising: Callable[[float], float], high: float) -> float:
    """Where a function that rises from below 0 at 0 to above it at `high` is 0; by halving."""
    low = 0.0
    for _ in range(50):
        middle = (low + high) / 2
        low, high = (middle, high) if rising(middle) < 0 else (low, middle)
    return high


def _moments(radius: ArrayLike, volume: float) -> Moments:
    sigma = 2 * np.asarray(radius, np.float64)
    if sigma.size == 0 or not (sigma > 0).all():
        msg = "radius must hold a number above 0 for each sphere, and one sphere at least"
        raise InputError(msg)
    per = math.pi / 6 / number("volume", volume, above=0)
    zero, one, two, three = (per * float(np.sum(sigma**k)) for k in range(4))
    return zero, one, two, three


def _scaled(zeta: Moments, share: float) -> Moments:
    """The same spheres at another density."""
    zero, one, two, three = (share * z for z in zeta)
    return zero, one, two, three


def _pressure(zeta: Moments, correction: float = 1.0) -> float:
    """P/kT; `correction` 0 is scaled-particle theory, 1 what Carnahan and Starling made of it."""
    zero, one, two, three = zeta
    u = 1 - three
    last = (3 - correction * three) * two**3 / u**3
    return 6 / math.pi * (zero / u + 3 * one * two / u**2 + last)


def _tension(zeta: Moments) -> float:
    zero, one, two, three = zeta
    u = 1 - three
    # About the wall's own surface; the second term moves it to where the centres are.
    bare = (3 * one / u + 4.5 * two**2 / u**2) / math.pi
    return bare - one / zero / 2 * _pressure(zeta, correction=0.0)


def _fluid(packing_fraction: float) -> float:
    if packing_fraction > FREEZING:
        msg = (
            f"the packing fraction is {packing_fraction:.4g}; above {FREEZING} hard spheres "
            "freeze and this formula of the fluid ends"
        )
        raise InputError(msg)
    return packing_fraction
