"""How long, and how far, a sphere of a gas flies between two collisions.

A sphere of speed v has an exponential free time with the rate omega(v). After a collision, speeds
occur as Maxwell's law times omega(v): fast spheres collide more often. Both together::

    P(free time > t) = integral of f(v) omega(v)/omega exp(-omega(v) t) dv

and with l/v for t, P(free path > l). The integral is done with Gauss's quadrature. Exact for a
dilute gas in equilibrium. In a dense one the rates of all speeds grow alike and the law keeps its
shape, as far as partners know nothing of one another.
"""

import math
from functools import cache

import numpy as np

from carom.state import Floats
from carom.theory.collisions import CHAPMAN_COWLING, relative_rate
from carom.theory.formula import NOT_NEGATIVE, POSITIVE, Numbers, formula
from carom.theory.numerics import gauss

SOURCE = f"{CHAPMAN_COWLING}, section 5.4, for the rate of a given speed; averaged here"
#: Nodes of the quadrature, good to 1e-13 for times and 1e-10 for paths; and where the speeds end,
#: in units of sqrt(2 kT/m): exp(-64) is nothing.
NODES, FASTEST = 160, 8.0


@formula(SOURCE, time=NOT_NEGATIVE, rate=POSITIVE)
def free_time_pdf(time: Numbers, rate: Numbers = 1.0) -> Numbers:
    """Probability density of the time between two collisions of a sphere.

    See the formula above. <t^2>/<t>^2 is 2.0761308; it would be 2 for an exponential law.

    Parameters
    ----------
    time : float or array_like
        t, at least 0.
    rate : float or array_like
        omega, collisions of a sphere per unit of time, from `collision_rate` or from a run. The
        default makes the mean free time the unit.

    Returns
    -------
    float or float64 array
        1/time.

    Raises
    ------
    InputError
        If a time is negative or a rate not above 0.

    References
    ----------
    S. Chapman, T. G. Cowling, *The Mathematical Theory of Non-Uniform Gases*, 3rd ed. (1970),
    section 5.4, for omega(v).

    Examples
    --------
    >>> round(free_time_pdf(0.0), 4)  # 1 for an exponential law
    1.0422
    """
    _, weight, rates = _after_a_collision()
    t = time * rate
    return rate * sum(w * r * np.exp(-r * t) for w, r in zip(weight, rates, strict=True))


@formula(SOURCE, time=NOT_NEGATIVE, rate=POSITIVE)
def free_time_cdf(time: Numbers, rate: Numbers = 1.0) -> Numbers:
    """Probability that a sphere collides again within a time.

    See the formula above.

    Parameters
    ----------
    time, rate : float or array_like
        See `free_time_pdf`.

    Returns
    -------
    float or float64 array
        0 to 1.

    Raises
    ------
    InputError
        See `free_time_pdf`.

    References
    ----------
    See `free_time_pdf`.

    Examples
    --------
    >>> round(1 - free_time_cdf(1.0), 6)  # 0.367879 for an exponential law
    0.360954
    """
    _, weight, rates = _after_a_collision()
    t = time * rate
    return -sum(w * np.expm1(-r * t) for w, r in zip(weight, rates, strict=True))


@formula(SOURCE, path=NOT_NEGATIVE, mean=POSITIVE)
def free_path_pdf(path: Numbers, mean: Numbers = 1.0) -> Numbers:
    """Probability density of the way of a sphere between two collisions.

    See the formula above. The mean is <v>/omega.

    Parameters
    ----------
    path : float or array_like
        l, at least 0.
    mean : float or array_like
        lambda, from `mean_free_path` or from a run. The default makes it the unit.

    Returns
    -------
    float or float64 array
        1/length.

    Raises
    ------
    InputError
        If a path is negative or a mean not above 0.

    References
    ----------
    See `free_time_pdf`.

    Examples
    --------
    >>> round(free_path_pdf(1.0), 4)
    0.353
    """
    _, weight, per_length = _along_the_path()
    s = path / mean
    total = sum(w * r * np.exp(-r * s) for w, r in zip(weight, per_length, strict=True))
    return total / mean


@formula(SOURCE, path=NOT_NEGATIVE, mean=POSITIVE)
def free_path_cdf(path: Numbers, mean: Numbers = 1.0) -> Numbers:
    """Probability that a sphere collides again within a distance.

    See the formula above.

    Parameters
    ----------
    path, mean : float or array_like
        See `free_path_pdf`.

    Returns
    -------
    float or float64 array
        0 to 1.

    Raises
    ------
    InputError
        See `free_path_pdf`.

    References
    ----------
    See `free_time_pdf`.

    Examples
    --------
    >>> round(free_path_cdf(1.0), 6)
    0.641052
    """
    _, weight, per_length = _along_the_path()
    s = path / mean
    return -sum(w * np.expm1(-r * s) for w, r in zip(weight, per_length, strict=True))


@cache
def _after_a_collision() -> tuple[Floats, Floats, Floats]:
    """Speeds in sqrt(2 kT/m), how often each follows a collision, and omega(v)/omega."""
    x, weight = gauss(NODES, FASTEST)
    rate = relative_rate(x)
    return x, weight * 4 / math.sqrt(math.pi) * x * x * np.exp(-x * x) * rate, rate


@cache
def _along_the_path() -> tuple[Floats, Floats, Floats]:
    """The same with collisions per mean free path, (omega(v)/v) (<v>/omega)."""
    x, weight, rate = _after_a_collision()
    return x, weight, rate / x * 2 / math.sqrt(math.pi)
