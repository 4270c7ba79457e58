"""How fast spheres are: Maxwell and Boltzmann's law, and the exact law of a few spheres."""

import math

import numpy as np

from carom.checks import number
from carom.errors import InputError
from carom.state import Floats
from carom.theory.formula import ANY, NOT_NEGATIVE, POSITIVE, Numbers, formula
from carom.theory.numerics import erf, gauss

MAXWELL = "J. C. Maxwell, Philos. Mag. 19, 19 (1860), doi:10.1080/14786446008642818"
FEW = "R. B. Shirts, S. R. Burt, A. M. Johnson, J. Chem. Phys. 125, 164102 (2006)"
#: Nodes of the quadrature over angles, and exp(-FAR^2/2) of the law that is left out of it.
NODES, FAR = 80, 9.0


@formula(MAXWELL, speed=NOT_NEGATIVE, temperature=POSITIVE, mass=POSITIVE)
def maxwell_speed_pdf(speed: Numbers, temperature: Numbers = 1.0, mass: Numbers = 1.0) -> Numbers:
    """Probability density of speeds in equilibrium, Maxwell and Boltzmann's law.

    f(v) = 4 pi v^2 (m/(2 pi kT))^(3/2) exp(-m v^2/(2 kT)). Exact for infinitely many spheres at
    any density; of a few see `few_speed_pdf`.

    Parameters
    ----------
    speed, temperature, mass : float or array_like
        v, at least 0; kT and m, above 0.

    Returns
    -------
    float or float64 array
        1/speed.

    Raises
    ------
    InputError
        Outside that range.

    References
    ----------
    J. C. Maxwell, Philos. Mag. 19, 19 (1860), doi:10.1080/14786446008642818.

    Examples
    --------
    >>> round(maxwell_speed_pdf(1.0), 4)
    0.4839
    """
    x2 = mass * speed**2 / (2 * temperature)
    scale = np.sqrt(mass / (2 * temperature))
    return 4 / math.sqrt(math.pi) * scale * x2 * np.exp(-x2)


@formula(MAXWELL, speed=NOT_NEGATIVE, temperature=POSITIVE, mass=POSITIVE)
def maxwell_speed_cdf(speed: Numbers, temperature: Numbers = 1.0, mass: Numbers = 1.0) -> Numbers:
    """Probability that a sphere is slower than that, by Maxwell and Boltzmann's law.

    With x = v sqrt(m/(2 kT)): erf(x) - (2/sqrt(pi)) x exp(-x^2).

    Parameters
    ----------
    speed, temperature, mass : float or array_like
        See `maxwell_speed_pdf`.

    Returns
    -------
    float or float64 array
        0 to 1.

    Raises
    ------
    InputError
        See `maxwell_speed_pdf`.

    References
    ----------
    See `maxwell_speed_pdf`.

    Examples
    --------
    >>> round(maxwell_speed_cdf(1.0), 4)
    0.1987
    """
    x = speed * np.sqrt(mass / (2 * temperature))
    return erf(x) - 2 / math.sqrt(math.pi) * x * np.exp(-x * x)


@formula(MAXWELL, velocity=ANY, temperature=POSITIVE, mass=POSITIVE)
def maxwell_component_pdf(
    velocity: Numbers, temperature: Numbers = 1.0, mass: Numbers = 1.0
) -> Numbers:
    """Probability density of one component of the velocity in equilibrium.

    f(v_x) = sqrt(m/(2 pi kT)) exp(-m v_x^2/(2 kT)).

    Parameters
    ----------
    velocity, temperature, mass : float or array_like
        v_x; kT and m, above 0.

    Returns
    -------
    float or float64 array
        1/speed.

    Raises
    ------
    InputError
        If the temperature or mass is not above 0.

    References
    ----------
    See `maxwell_speed_pdf`.

    Examples
    --------
    >>> round(maxwell_component_pdf(-1.0), 4)
    0.242
    """
    x = velocity * np.sqrt(mass / (2 * temperature))
    return np.sqrt(mass / (2 * math.pi * temperature)) * np.exp(-x * x)


@formula(MAXWELL, velocity=ANY, temperature=POSITIVE, mass=POSITIVE)
def maxwell_component_cdf(
    velocity: Numbers, temperature: Numbers = 1.0, mass: Numbers = 1.0
) -> Numbers:
    """Probability that one component of the velocity is less than that.

    [1 + erf(v_x sqrt(m/(2 kT)))]/2.

    Parameters
    ----------
    velocity, temperature, mass : float or array_like
        See `maxwell_component_pdf`.

    Returns
    -------
    float or float64 array
        0 to 1.

    Raises
    ------
    InputError
        See `maxwell_component_pdf`.

    References
    ----------
    See `maxwell_speed_pdf`.

    Examples
    --------
    >>> round(maxwell_component_cdf(1.0), 4)
    0.8413
    """
    return (1 + erf(velocity * np.sqrt(mass / (2 * temperature)))) / 2


@formula(FEW, speed=NOT_NEGATIVE, energy=POSITIVE, mass=POSITIVE)
def few_speed_pdf(speed: Numbers, n: int, energy: Numbers, mass: Numbers = 1.0) -> Numbers:
    """Probability density of speeds of n equal spheres with fixed energy and no momentum.

    f(v) is proportional to v^2 (1 - v^2/w^2)^((3n-8)/2) up to w = sqrt(2 E (n-1)/(n m)), at which
    one sphere has all it can have, and 0 above. Exact for any density: what is left to the n - 1
    others is E - m v^2/2 - m v^2/(2 (n-1)) in 3n - 6 directions, and each set of velocities with
    the same energy is as likely as any other. Becomes Maxwell's law with kT = 2 E/(3n - 3).

    Parameters
    ----------
    speed : float or array_like
        v, at least 0.
    n : int
        Spheres, at least 3. (Two share the energy evenly: both speeds are sqrt(E/m).)
    energy, mass : float or array_like
        E, kinetic energy of all of them together, and m of one; above 0.

    Returns
    -------
    float or float64 array
        1/speed.

    Raises
    ------
    InputError
        Outside that range.

    Notes
    -----
    Of spheres whose momentum is conserved and is 0, as in a periodic box. Hard walls keep no
    momentum.

    References
    ----------
    R. B. Shirts, S. R. Burt, A. M. Johnson, J. Chem. Phys. 125, 164102 (2006).

    Examples
    --------
    >>> round(few_speed_pdf(1.0, n=6, energy=7.5), 4)
    0.5248
    """
    n = _spheres(n)
    fastest = np.sqrt(2 * energy * (n - 1) / (n * mass))
    x2 = np.minimum(speed / fastest, 1.0) ** 2
    whole = _angles(np.asarray(_last_angle(n)), n)
    return x2 * (1 - x2) ** ((3 * n - 8) / 2) / (whole * fastest)


@formula(FEW, speed=NOT_NEGATIVE, energy=POSITIVE, mass=POSITIVE)
def few_speed_cdf(speed: Numbers, n: int, energy: Numbers, mass: Numbers = 1.0) -> Numbers:
    """Probability that one of n equal spheres with fixed energy and no momentum is slower.

    The integral of `few_speed_pdf`, with v = w sin(a) and Gauss's quadrature over the angle a.

    Parameters
    ----------
    speed, n, energy, mass
        See `few_speed_pdf`.

    Returns
    -------
    float or float64 array
        0 to 1, good to 1e-12.

    Raises
    ------
    InputError
        See `few_speed_pdf`.

    References
    ----------
    See `few_speed_pdf`.

    Examples
    --------
    >>> round(few_speed_cdf(1.0, n=6, energy=7.5), 4)
    0.2086
    """
    n = _spheres(n)
    fastest = np.sqrt(2 * energy * (n - 1) / (n * mass))
    last = _last_angle(n)
    angle = np.minimum(np.arcsin(np.minimum(speed / fastest, 1.0)), last)
    return _angles(angle, n) / _angles(np.asarray(last), n)


def _angles(end: Floats, n: int) -> Floats:
    """Integral of v^2 (1 - v^2)^((3n-8)/2) dv with v = sin(a), from 0 to each end of a."""
    total = np.zeros(end.shape)
    for x, weight in zip(*gauss(NODES, 1.0), strict=True):
        angle = end * x
        total += weight * np.sin(angle) ** 2 * np.cos(angle) ** (3 * n - 7)
    return total * end


def _last_angle(n: int) -> float:
    """Beyond it the integrand is nothing: cos(a)^p is below exp(-p a^2/2)."""
    return min(math.pi / 2, FAR / math.sqrt(3 * n - 7))


def _spheres(n: int) -> int:
    if number("n", n, at_least=3) != int(n):
        msg = f"n is {n}; it must be a whole number of spheres, at least 3"
        raise InputError(msg)
    return int(n)
