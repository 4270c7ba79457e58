"""What hard walls do to a fluid of hard spheres, of one size or several.

Numbers are reduced by kT: a pressure here is P/kT, a surface tension gamma/kT.
"""

import math

import numpy as np
from numpy.typing import ArrayLike

from carom.errors import InputError
from carom.theory.formula import FLUID, FREEZING, formula
from carom.theory.mixtures import Moments, moments, pressure
from carom.theory.numerics import root

SOURCE = (
    "J. L. Lebowitz, E. Helfand, E. Praestgaard, J. Chem. Phys. 43, 774 (1965), "
    "doi:10.1063/1.1696842"
)


@formula(SOURCE, packing_fraction=FLUID)
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
    the radius. Exact to the second order of the density.

    Examples
    --------
    >>> round(wall_tension([0.5] * 100, 500), 5)
    -0.02418
    """
    zeta = moments(radius, volume)
    FLUID.check("packing_fraction", zeta[3])
    return _tension(zeta)


@formula(SOURCE, packing_fraction=FLUID)
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
    all. In a cubic box of 500 spheres the force is 0.3 percent off at a packing fraction of 0.1
    and 2 percent at 0.3.

    References
    ----------
    The tension: see `wall_tension`; the pressure between the walls: see `bmcsl`.

    Examples
    --------
    >>> round(wall_pressure([0.5] * 100, 1000, area=600, stretch=0.4), 4)
    0.1198
    """
    given = moments(radius, volume)

    def excess(share: float) -> float:
        """Spheres too many, over N, if the density between the walls is `share` N/V."""
        h = 1e-4 * share
        low, high = _scaled(given, share - h), _scaled(given, share + h)
        slope = (_tension(high) - _tension(low)) / (pressure(high) - pressure(low))
        return share * (1 - slope * area / volume) - 1

    most = min(1.0, FREEZING / given[3])  # spheres at the walls only make it fewer
    if excess(most) < 0:
        msg = (
            f"{np.size(radius)} spheres are too many for this room: between the walls the packing "
            f"fraction would be above {FREEZING}, where hard spheres freeze; take fewer"
        )
        raise InputError(msg)
    zeta = _scaled(given, root(excess, most))
    return pressure(zeta) - _tension(zeta) * stretch


def _scaled(zeta: Moments, share: float) -> Moments:
    """The same spheres at another density."""
    zero, one, two, three = (share * z for z in zeta)
    return zero, one, two, three


def _tension(zeta: Moments) -> float:
    zero, one, two, three = zeta
    u = 1 - three
    # About the wall's own surface; the second term moves it to where the centres are.
    bare = (3 * one / u + 4.5 * two**2 / u**2) / math.pi
    return bare - one / zero / 2 * pressure(zeta, correction=0.0)
