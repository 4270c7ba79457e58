"""How often equal hard spheres collide, and how far they fly in between.

All of this is exact for any density, given the equation of state, but for the rate of a sphere
of known speed, which takes partners to know nothing of one another (molecular chaos).
"""

import math

import numpy as np

from carom.theory.equations_of_state import (
    CLOSE_PACKING,
    Equation,
    contact_value,
    kolafa_labik_malijevsky,
)
from carom.theory.formula import NOT_NEGATIVE, POSITIVE, Numbers, Range, formula
from carom.theory.numerics import erf

CHAPMAN_COWLING = (
    "S. Chapman, T. G. Cowling, The Mathematical Theory of Non-Uniform Gases, 3rd ed. (1970)"
)
#: Where spheres can be; `equation` may end earlier.
DENSITY = Range(0, CLOSE_PACKING, open_high=True)
#: The same without nothing, where means of a collision are infinite.
SOME = Range(0, CLOSE_PACKING, open_low=True, open_high=True)


@formula(
    f"{CHAPMAN_COWLING}, ch. 5 and 16",
    packing_fraction=DENSITY,
    temperature=NOT_NEGATIVE,
    mass=POSITIVE,
    radius=POSITIVE,
)
def collision_rate(
    packing_fraction: Numbers,
    temperature: Numbers = 1.0,
    mass: Numbers = 1.0,
    radius: Numbers = 0.5,
    equation: Equation = kolafa_labik_malijevsky,
) -> Numbers:
    """Collisions that each of equal spheres suffers per unit of time.

    omega = 4 n sigma^2 g sqrt(pi kT/m), with the number density n, the diameter sigma and the
    `contact_value` g. Pairs collide half as often: N omega/2 in all. It measures the pressure:
    Z = 1 + (sqrt(pi)/6) sigma omega sqrt(m/kT).

    Parameters
    ----------
    packing_fraction : float or array_like
        phi, in the range of `equation`.
    temperature, mass, radius : float or array_like
        kT, m, sigma/2.
    equation : function
        Z by phi. ``lambda phi: 1 + 4 * phi`` makes g = 1: the rate of a dilute gas.

    Returns
    -------
    float or float64 array
        1/time, in the units of the arguments.

    Raises
    ------
    InputError
        Outside the range of `equation`, or if a mass or radius is not above 0.

    References
    ----------
    S. Chapman, T. G. Cowling, *The Mathematical Theory of Non-Uniform Gases*, 3rd ed. (1970),
    ch. 5 and 16. Its uncertainty is that of g.

    Examples
    --------
    >>> round(collision_rate(0.3), 3)
    10.101
    """
    g = contact_value(packing_fraction, equation)
    # n sigma^2 = 6 phi/(pi sigma)
    return 12 / radius * packing_fraction * g * np.sqrt(temperature / mass / math.pi)


@formula(
    f"{CHAPMAN_COWLING}, ch. 5 and 16",
    packing_fraction=SOME,
    temperature=POSITIVE,
    mass=POSITIVE,
    radius=POSITIVE,
)
def mean_free_time(
    packing_fraction: Numbers,
    temperature: Numbers = 1.0,
    mass: Numbers = 1.0,
    radius: Numbers = 0.5,
    equation: Equation = kolafa_labik_malijevsky,
) -> Numbers:
    """Mean time between two collisions of a sphere, among equal ones: 1/omega.

    Parameters
    ----------
    packing_fraction : float or array_like
        phi, above 0, in the range of `equation`.
    temperature, mass, radius, equation
        See `collision_rate`; the temperature is above 0.

    Returns
    -------
    float or float64 array
        Time, in the units of the arguments.

    Raises
    ------
    InputError
        See `collision_rate`.

    References
    ----------
    See `collision_rate`.

    Examples
    --------
    >>> round(mean_free_time(0.3), 6)
    0.098998
    """
    return 1 / np.asarray(collision_rate(packing_fraction, temperature, mass, radius, equation))


@formula(f"{CHAPMAN_COWLING}, ch. 5 and 16", packing_fraction=SOME, radius=POSITIVE)
def mean_free_path(
    packing_fraction: Numbers,
    radius: Numbers = 0.5,
    equation: Equation = kolafa_labik_malijevsky,
) -> Numbers:
    """Mean way of a sphere between two collisions, among equal ones.

    lambda = <v>/omega = 1/(sqrt(2) pi n sigma^2 g).

    Parameters
    ----------
    packing_fraction : float or array_like
        phi, above 0, in the range of `equation`.
    radius : float or array_like
        sigma/2.
    equation : function
        See `collision_rate`.

    Returns
    -------
    float or float64 array
        Length, in the unit of `radius`.

    Raises
    ------
    InputError
        See `collision_rate`.

    References
    ----------
    See `collision_rate`.

    Examples
    --------
    >>> round(mean_free_path(0.3), 6)
    0.157978
    """
    g = contact_value(packing_fraction, equation)
    return radius / (3 * math.sqrt(2) * packing_fraction * g)


@formula(
    f"{CHAPMAN_COWLING}, section 5.4",
    speed=NOT_NEGATIVE,
    packing_fraction=DENSITY,
    temperature=POSITIVE,
    mass=POSITIVE,
    radius=POSITIVE,
)
def collision_rate_at_speed(
    speed: Numbers,
    packing_fraction: Numbers,
    temperature: Numbers = 1.0,
    mass: Numbers = 1.0,
    radius: Numbers = 0.5,
    equation: Equation = kolafa_labik_malijevsky,
) -> Numbers:
    """Collisions per unit of time of a sphere with a given speed, in a gas of its like.

    With x = v sqrt(m/(2 kT)) and the diameter sigma::

        omega(v) = n pi sigma^2 g sqrt(2 kT/(pi m))
                   [exp(-x^2) + (2 x + 1/x) integral of exp(-y^2) from 0 to x]

    Fast spheres collide more often, so free times are not exponential: see `free_time_pdf`.
    The mean over Maxwell's speeds is `collision_rate`.

    Parameters
    ----------
    speed : float or array_like
        v, at least 0.
    packing_fraction : float or array_like
        phi, in the range of `equation`.
    temperature, mass, radius, equation
        See `collision_rate`; the temperature is above 0.

    Returns
    -------
    float or float64 array
        1/time, in the units of the arguments.

    Raises
    ------
    InputError
        See `collision_rate`.

    References
    ----------
    S. Chapman, T. G. Cowling, *The Mathematical Theory of Non-Uniform Gases*, 3rd ed. (1970),
    section 5.4. Exact in a dilute gas and, within molecular chaos, times g in a dense one.

    Examples
    --------
    >>> round(collision_rate_at_speed(3.0, packing_fraction=0.3), 3)
    14.919
    """
    mean = np.asarray(collision_rate(packing_fraction, temperature, mass, radius, equation))
    return mean * relative_rate(speed * np.sqrt(mass / (2 * temperature)))


def relative_rate(x: Numbers) -> Numbers:
    """omega(v)/omega of a sphere with x = v sqrt(m/(2 kT))."""
    integral = math.sqrt(math.pi) / 2 * erf(x)
    per_x = np.divide(integral, x, out=np.ones_like(integral), where=x > 0)
    return (np.exp(-x * x) + 2 * x * integral + per_x) / math.sqrt(8)
