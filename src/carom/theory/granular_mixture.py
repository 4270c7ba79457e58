"""Granular gases of several kinds of spheres: each kind has a temperature of its own."""

import math

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import number
from carom.errors import InputError
from carom.state import Floats
from carom.theory.formula import FLUID, FREEZING, POSITIVE, Numbers, Range, formula
from carom.theory.mixtures import moments, pair_rates, per_kind
from carom.theory.numerics import root

GARZO = "V. Garzo, J. W. Dufty, Phys. Rev. E 60, 5706 (1999), doi:10.1103/PhysRevE.60.5706"
#: As far as simulations of the Boltzmann equation and molecular dynamics have been compared.
TRIED = Range(0, 0.1, above="above 0.1 it was not compared with simulations", far=(0, FREEZING))


@formula(
    GARZO, packing_fraction=FLUID, restitution=Range(0, 1), temperature=POSITIVE, mass=POSITIVE
)
def temperature_rates(
    radius: ArrayLike,
    volume: float,
    count: ArrayLike = 1.0,
    mass: Numbers = 1.0,
    temperature: Numbers = 1.0,
    restitution: float = 1.0,
) -> Floats:
    """How fast the temperature of each kind of sphere changes, dT_i/dt.

    With S = T/m and nu_ij of `pair_rates`, each kind with its own temperature::

        dT_i/dt = (2/3) sum over j of nu_ij [-2 mu (1 + e) S_i + (mu^2/m_i)(1 + e)^2 (S_i + S_j)]

    Kinds of different temperature exchange energy, and it is lost if e is below 1. Velocities are
    taken to be Gaussian and to know nothing of one another.

    Parameters
    ----------
    radius : (K,) array_like
        Of every kind of sphere. Packing fraction 0 to 0.494.
    volume : float
        In which they are.
    count : float or (K,) array_like
        How many spheres there are of each kind.
    mass, temperature : float or (K,) array_like
        Of every kind.
    restitution : float
        e of all pairs.

    Returns
    -------
    (K,) float64
        Temperature/time.

    Raises
    ------
    InputError
        Outside that range.

    References
    ----------
    V. Garzo, J. W. Dufty, Phys. Rev. E 60, 5706 (1999), doi:10.1103/PhysRevE.60.5706.

    Examples
    --------
    >>> temperature_rates([0.5, 0.5], 1000, count=[50, 50], temperature=[1, 2]).round(4)
    array([ 0.3312, -0.3312])
    """
    rates = pair_rates(radius, volume, count, mass, temperature)
    m, t = per_kind("mass", mass, radius), per_kind("temperature", temperature, radius)
    s = (t / m)[:, None]
    mu = m[:, None] * m / (m[:, None] + m)
    keep = 1 + number("restitution", restitution)
    gain = -2 * mu * keep * s + mu**2 / m[:, None] * keep**2 * (s + s.T)
    result: Floats = 2 / 3 * (rates * gain).sum(axis=1)
    return result


@formula(
    GARZO,
    packing_fraction=TRIED,
    restitution=Range(0.8, 1, below="below 0.8 speeds are not Gaussian enough", far=(0, 1)),
    mass=POSITIVE,
)
def granular_temperature_ratio(
    radius: ArrayLike,
    volume: float,
    count: ArrayLike,
    mass: Numbers,
    restitution: float,
    *,
    extrapolate: bool = False,
) -> float:
    """T_1/T_2 of two kinds of spheres that cool evenly: inelastic kinds do not share energy alike.

    The ratio at which `temperature_rates` makes both lose the same share of their temperature.

    Parameters
    ----------
    radius : (2,) array_like
        Of both kinds. Packing fraction 0 to 0.1.
    volume : float
        In which they are.
    count, mass : float or (2,) array_like
        Of both kinds.
    restitution : float
        e of all pairs, 0.8 to 1.
    extrapolate : bool
        Go on to a packing fraction of 0.494, and with e down to 0.

    Returns
    -------
    float
        No unit. Half to one percent too high in two cases that were simulated (Boltzmann equation,
        e = 0.8 and 0.95, equal diameters, the first kind four and ten times as heavy).

    Raises
    ------
    InputError
        Outside that range, or if there are not two kinds.

    References
    ----------
    V. Garzo, J. W. Dufty, Phys. Rev. E 60, 5706 (1999), doi:10.1103/PhysRevE.60.5706.

    Examples
    --------
    >>> round(
    ...     granular_temperature_ratio([0.5, 0.5], 1000, [50, 50], mass=[1, 0.25], restitution=0.9),
    ...     4,
    ... )
    1.1566
    """
    if np.shape(radius) != (2,):
        msg = f"radius must hold two numbers, one for each kind, not {radius!r}"
        raise InputError(msg)
    TRIED.check("packing_fraction", moments(radius, volume, count)[3], extrapolate)

    def excess(log_ratio: float) -> float:
        """By how much faster kind 1 cools than kind 2, if T_1/T_2 is exp(log_ratio)."""
        t = np.array([math.exp(log_ratio), 1.0])
        one, two = temperature_rates(radius, volume, count, mass, t, restitution) / t
        return float(two - one)

    one, two = per_kind("mass", mass, radius)
    most = 20.0 + abs(math.log(one / two))  # far beyond: T_1/T_2 goes to m_1/m_2 at most
    return math.exp(root(excess, high=most, low=-most))
