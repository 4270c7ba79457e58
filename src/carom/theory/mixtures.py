"""Fluids of hard spheres of several sizes: equation of state, contact, rates of pairs."""

import math

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import number
from carom.errors import InputError
from carom.state import Floats
from carom.theory.collisions import CHAPMAN_COWLING
from carom.theory.formula import ANY, FLUID, POSITIVE, Numbers, formula

#: (pi/6) sum sigma^k / V for k = 0 ... 3, with the diameters sigma; the last is the packing
#: fraction.
Moments = tuple[float, float, float, float]

BMCSL = (
    "T. Boublik, J. Chem. Phys. 53, 471 (1970), doi:10.1063/1.1673824; G. A. Mansoori, "
    "N. F. Carnahan, K. E. Starling, T. W. Leland, J. Chem. Phys. 54, 1523 (1971), "
    "doi:10.1063/1.1675048"
)


@formula(BMCSL, packing_fraction=FLUID)
def bmcsl(radius: ArrayLike, volume: float, count: ArrayLike = 1.0) -> float:
    """Compressibility factor Z = P/(n kT) of the fluid of hard spheres of several sizes.

    With zeta_k = (pi/6) sum sigma_i^k / V and u = 1 - zeta_3::

        Z = [zeta_0/u + 3 zeta_1 zeta_2/u^2 + (3 - zeta_3) zeta_2^3/u^3]/zeta_0

    For equal sizes this is `carnahan_starling`. Within 0.5 percent of simulations, a little more
    where sizes differ by far or the fluid is about to freeze.

    Parameters
    ----------
    radius : (K,) array_like
        Of every sphere, or of every kind of sphere. Packing fraction 0 to 0.494.
    volume : float
        In which they are.
    count : float or (K,) array_like
        How many spheres have that radius.

    Returns
    -------
    float
        No unit.

    Raises
    ------
    InputError
        If a radius, a count or the volume is not above 0, or the packing fraction above 0.494.

    References
    ----------
    T. Boublik, J. Chem. Phys. 53, 471 (1970), doi:10.1063/1.1673824; G. A. Mansoori,
    N. F. Carnahan, K. E. Starling, T. W. Leland, J. Chem. Phys. 54, 1523 (1971),
    doi:10.1063/1.1675048.

    Examples
    --------
    >>> round(bmcsl([0.5] * 200 + [0.25] * 200, volume=500), 4)
    2.5816
    >>> round(bmcsl([0.5, 0.25], volume=500, count=200), 4)
    2.5816
    """
    zeta = moments(radius, volume, count)
    FLUID.check("packing_fraction", zeta[3])
    return pressure(zeta) / (6 / math.pi * zeta[0])


@formula(BMCSL, packing_fraction=FLUID)
def bmcsl_contact(radius: ArrayLike, volume: float, count: ArrayLike = 1.0) -> Floats:
    """How much denser than average spheres of one kind are at the surface of another: chi_ij.

    With zeta_k of `bmcsl`, u = 1 - zeta_3 and d = sigma_i sigma_j/(sigma_i + sigma_j)::

        chi_ij = 1/u + 3 d zeta_2/u^2 + 2 d^2 zeta_2^2/u^3

    which gives the pressure of `bmcsl`. Of one kind it is (1 - phi/2)/(1 - phi)^3. At a packing
    fraction of 0.3 and diameters of 1 and 1/2 it is one percent too low between large ones and
    half a percent off otherwise.

    Parameters
    ----------
    radius : (K,) array_like
        Of every kind of sphere. Packing fraction 0 to 0.494.
    volume : float
        In which they are.
    count : float or (K,) array_like
        How many spheres there are of each kind.

    Returns
    -------
    (K, K) float64
        No unit.

    Raises
    ------
    InputError
        See `bmcsl`.

    References
    ----------
    See `bmcsl`.

    Examples
    --------
    >>> bmcsl_contact([0.5, 0.25], volume=500, count=200).round(3)
    array([[2.057, 1.79 ],
           [1.79 , 1.663]])
    """
    zeta = moments(radius, volume, count)
    FLUID.check("packing_fraction", zeta[3])
    r = np.asarray(radius, np.float64)
    d = 2 * r[:, None] * r / (r[:, None] + r)  # with diameters instead of radii
    u = 1 - zeta[3]
    result: Floats = 1 / u + 3 * d * zeta[2] / u**2 + 2 * (d * zeta[2]) ** 2 / u**3
    return result


@formula(
    f"{CHAPMAN_COWLING}, ch. 5 and 16; contact values: {BMCSL}",
    packing_fraction=FLUID,
    mass=POSITIVE,
    temperature=POSITIVE,
)
def pair_rates(
    radius: ArrayLike,
    volume: float,
    count: ArrayLike = 1.0,
    mass: Numbers = 1.0,
    temperature: Numbers = 1.0,
) -> Floats:
    """Collisions of one sphere of kind i with spheres of kind j, per unit of time: nu_ij.

    With s = (sigma_i + sigma_j)/2, the reduced mass mu and `bmcsl_contact`::

        nu_ij = n_j s^2 chi_ij sqrt(8 pi kT/mu)

    A row's sum is the collision rate of a sphere of that kind. Per volume and time, n_i nu_ij
    pairs of unlike spheres collide, and n_i nu_ii/2 of like ones. If every kind has its own
    temperature, kT/mu is T_i/m_i + T_j/m_j.

    Parameters
    ----------
    radius, volume, count
        See `bmcsl_contact`.
    mass, temperature : float or (K,) array_like
        Of every kind: m, kT.

    Returns
    -------
    (K, K) float64
        1/time.

    Raises
    ------
    InputError
        See `bmcsl`; or if a mass or temperature is not above 0.

    References
    ----------
    S. Chapman, T. G. Cowling, *The Mathematical Theory of Non-Uniform Gases*, 3rd ed. (1970),
    ch. 5 and 16. Its uncertainty is that of `bmcsl_contact`.

    Examples
    --------
    >>> pair_rates([0.5, 0.25], 500, count=200, mass=[1, 0.125]).round(3)
    array([[5.834, 6.059],
           [6.059, 3.336]])
    """
    contact = bmcsl_contact(radius, volume, count)
    r = np.asarray(radius, np.float64)
    density = per_kind("count", count, r) / volume
    spread = per_kind("temperature", temperature, r) / per_kind("mass", mass, r)
    speed = np.sqrt(8 * math.pi * (spread[:, None] + spread))
    result: Floats = density * (r[:, None] + r) ** 2 * contact * speed
    return result


@formula(
    f"{CHAPMAN_COWLING}, ch. 14 and 16; contact values: {BMCSL}",
    packing_fraction=FLUID,
    mass=POSITIVE,
    temperature=POSITIVE,
)
def mutual_diffusion(
    radius: ArrayLike,
    volume: float,
    count: ArrayLike = 1.0,
    mass: Numbers = 1.0,
    temperature: float = 1.0,
) -> float:
    """Coefficient D_12 of the mutual diffusion of two kinds of hard spheres, by Enskog.

    To first order of Sonine's polynomials, with n = n_1 + n_2, s = (sigma_1 + sigma_2)/2, the
    reduced mass mu and `bmcsl_contact`::

        D_12 = 3/(8 n s^2 chi_12) sqrt(kT/(2 pi mu))

    It is the coefficient of Maxwell and Stefan; Fick's is that times the thermodynamic factor,
    which is 1 in a dilute gas and between spheres of one size.

    Parameters
    ----------
    radius, volume, count
        See `bmcsl_contact`, of two kinds.
    mass : float or (2,) array_like
        m of either kind.
    temperature : float
        kT.

    Returns
    -------
    float
        Length^2/time. In a dilute gas too low by 1.9 percent for equal spheres, and by up to 12
        for a few light spheres among heavy ones, where the exact one is 32/(9 pi) times as large.

    Raises
    ------
    InputError
        See `pair_rates`; or if there are not two kinds.

    References
    ----------
    S. Chapman, T. G. Cowling, *The Mathematical Theory of Non-Uniform Gases*, 3rd ed. (1970),
    ch. 14 and 16.

    Examples
    --------
    >>> round(mutual_diffusion([0.5, 0.25], 500, count=200, mass=[1, 0.125]), 4)
    0.557
    """
    contact = bmcsl_contact(radius, volume, count)
    if len(contact) != 2:
        msg = f"radius must hold two radii, one for each kind, not {len(contact)}"
        raise InputError(msg)
    r = np.asarray(radius, np.float64)
    density = float(np.sum(per_kind("count", count, r))) / volume
    between = density * float(r.sum() ** 2 * contact[0, 1])
    spread = float(np.sum(temperature / per_kind("mass", mass, r)))  # kT/mu
    return 3 / (8 * between) * math.sqrt(spread / (2 * math.pi))


def per_kind(name: str, value: Numbers, radius: ArrayLike) -> Floats:
    """A number for each kind of sphere, from one for all or one for each."""
    kinds = np.size(radius)
    if np.shape(value) not in ((), (kinds,)):
        msg = f"{name} has the shape {np.shape(value)}; give one number, or one for each of {kinds}"
        raise InputError(msg)
    return np.broadcast_to(np.asarray(value, np.float64), (kinds,))


def moments(radius: ArrayLike, volume: float, count: ArrayLike = 1.0) -> Moments:
    """The sums that all of it depends on."""
    sigma = 2 * ANY.check("radius", radius)
    if sigma.ndim != 1 or sigma.size == 0 or not (sigma > 0).all():
        msg = "radius must hold a number above 0 for each sphere, and one sphere at least"
        raise InputError(msg)
    numbers = per_kind("count", POSITIVE.check("count", count), sigma)
    per = math.pi / 6 / number("volume", volume, above=0)
    zero, one, two, three = (per * float(np.sum(numbers * sigma**k)) for k in range(4))
    return zero, one, two, three


def pressure(zeta: Moments, correction: float = 1.0) -> float:
    """P/kT; `correction` 0 is scaled-particle theory, 1 what Carnahan and Starling made of it."""
    zero, one, two, three = zeta
    u = 1 - three
    last = (3 - correction * three) * two**3 / u**3
    return 6 / math.pi * (zero / u + 3 * one * two / u**2 + last)
