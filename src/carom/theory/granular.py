"""A granular gas that cools evenly: smooth spheres that lose energy at each collision.

Haff's law and the slight deviation of the speeds from Maxwell's law, a2. Simulations of the
Boltzmann equation agree to 1e-3 of the rate of cooling for restitution 0.5 to 0.99, molecular
dynamics (packing fraction 0.05, restitution 0.8 and 0.9) to 4e-3. It begins after about three
collisions per sphere, and ends when the gas clusters, which large systems do earlier.
"""

import numpy as np

from carom.theory.formula import NOT_NEGATIVE, Numbers, Range, formula

HAFF = "P. K. Haff, J. Fluid Mech. 134, 401 (1983), doi:10.1017/S0022112083003419"
SONINE = "T. P. C. van Noije, M. H. Ernst, Granular Matter 1, 57 (1998), doi:10.1007/s100350050009"
RESTITUTION = Range(
    0.5, 1, below="below 0.5 the first Sonine coefficient does not suffice", far=(0, 1)
)


@formula(SONINE, restitution=RESTITUTION)
def sonine_a2(restitution: Numbers, *, extrapolate: bool = False) -> Numbers:
    """Second Sonine coefficient a2 of the speeds in a gas that cools evenly.

    a2 = 16 (1 - e)(1 - 2 e^2)/(81 - 17 e + 30 e^2 (1 - e)), by which <v^4> = (15/4) (1 + a2) u^4
    with <v^2> = (3/2) u^2. Maxwell's law has 0.

    Parameters
    ----------
    restitution : float or array_like
        e, 0.5 to 1.
    extrapolate : bool
        Go down to 0.

    Returns
    -------
    float or float64 array
        No unit. Within 0.006 of simulations.

    Raises
    ------
    InputError
        Outside that range.

    References
    ----------
    T. P. C. van Noije, M. H. Ernst, Granular Matter 1, 57 (1998), doi:10.1007/s100350050009.

    Examples
    --------
    >>> round(sonine_a2(0.9), 5)
    -0.01456
    """
    e = restitution
    return 16 * (1 - e) * (1 - 2 * e * e) / (81 - 17 * e + 30 * e * e * (1 - e))


@formula(
    f"{HAFF}; a2: {SONINE}",
    time=NOT_NEGATIVE,
    restitution=RESTITUTION,
    rate=NOT_NEGATIVE,
    temperature=NOT_NEGATIVE,
)
def haff_temperature(
    time: Numbers,
    restitution: Numbers,
    rate: Numbers,
    temperature: Numbers = 1.0,
    *,
    extrapolate: bool = False,
) -> Numbers:
    """Temperature of a gas that cools evenly, at a time: Haff's law.

    T = T0/(1 + t/tc)^2 with tc = 6/[(1 - e^2) omega0 (1 + 3 a2/16)].

    Parameters
    ----------
    time : float or array_like
        t since the gas had the temperature T0, at least 0.
    restitution : float or array_like
        e, 0.5 to 1.
    rate : float or array_like
        omega0, the `collision_rate` at T0.
    temperature : float or array_like
        T0.
    extrapolate : bool
        Go on with e down to 0.

    Returns
    -------
    float or float64 array
        In the unit of `temperature`.

    Raises
    ------
    InputError
        Outside that range.

    References
    ----------
    P. K. Haff, J. Fluid Mech. 134, 401 (1983), doi:10.1017/S0022112083003419; a2: see
    `sonine_a2`.

    Examples
    --------
    >>> round(haff_temperature(10.0, restitution=0.9, rate=0.77), 4)
    0.6471
    """
    per_time = (1 - restitution**2) * rate * _energy_factor(restitution, extrapolate) / 6
    return temperature / (1 + time * per_time) ** 2


@formula(
    f"{HAFF}; a2: {SONINE}",
    collisions=NOT_NEGATIVE,
    restitution=RESTITUTION,
    temperature=NOT_NEGATIVE,
)
def haff_temperature_by_collisions(
    collisions: Numbers,
    restitution: Numbers,
    temperature: Numbers = 1.0,
    *,
    extrapolate: bool = False,
) -> Numbers:
    """Temperature of a gas that cools evenly, after so many collisions of each sphere.

    T = T0 exp(-C (1 - e^2)/3 (1 + 3 a2/16)/(1 - a2/16)), whatever the density.

    Parameters
    ----------
    collisions : float or array_like
        C, collisions that a sphere has suffered: twice those of pairs, over their number.
    restitution : float or array_like
        e, 0.5 to 1.
    temperature : float or array_like
        T0.
    extrapolate : bool
        Go on with e down to 0.

    Returns
    -------
    float or float64 array
        In the unit of `temperature`.

    Raises
    ------
    InputError
        Outside that range.

    References
    ----------
    See `haff_temperature`.

    Examples
    --------
    >>> round(haff_temperature_by_collisions(10.0, restitution=0.9), 4)
    0.532
    """
    a2 = np.asarray(sonine_a2(restitution, extrapolate=extrapolate))
    share = (1 - restitution**2) / 3 * _energy_factor(restitution, extrapolate) / (1 - a2 / 16)
    return temperature * np.exp(-share * collisions)


def _energy_factor(restitution: Numbers, extrapolate: bool) -> Numbers:
    """By which a2 changes the energy lost per time."""
    return 1 + 3 / 16 * np.asarray(sonine_a2(restitution, extrapolate=extrapolate))
