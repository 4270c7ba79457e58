"""Rough spheres, which turn one another: energy of motion becomes energy of spin, and is lost."""

import numpy as np

from carom.theory.formula import NOT_NEGATIVE, Numbers, Range, formula

#: Inertia I/(m R^2): 0.4 of a solid sphere, 2/3 of a shell.
INERTIA = Range(0, 2 / 3, open_low=True)
TANGENTIAL = Range(-1, 1)
ROUGH = "M. Huthmann, A. Zippelius, Phys. Rev. E 56, R6275 (1997), doi:10.1103/PhysRevE.56.R6275"


@formula(
    ROUGH,
    collisions=NOT_NEGATIVE,
    restitution=Range(0, 1),
    tangential=TANGENTIAL,
    translation=NOT_NEGATIVE,
    rotation=NOT_NEGATIVE,
    inertia=INERTIA,
)
def rough_temperatures(
    collisions: Numbers,
    restitution: Numbers,
    tangential: Numbers,
    translation: Numbers = 1.0,
    rotation: Numbers = 0.0,
    inertia: Numbers = 0.4,
) -> tuple[Numbers, Numbers]:
    """Temperatures of motion and of spin of rough spheres, after so many collisions of each.

    With T = m <v^2>/3, R = I <w^2>/3, q = I/(m R0^2) of spheres with radius R0, and the share
    h = q (1 + beta)/(2 q + 2)::

        dT/dC = -(4/3) (A T - B R),    A = (1 - e^2)/4 + h (1 - h)
        dR/dC =  (4/3) (B T - D R),    B = h^2/q,    D = (h/q)(1 - h/q)

    Parameters
    ----------
    collisions : float or array_like
        C, collisions that a sphere has suffered: twice those of pairs, over their number.
    restitution : float or array_like
        e along the line of centres, 0 to 1.
    tangential : float or array_like
        beta across it: -1 smooth, 1 perfectly rough.
    translation, rotation : float or array_like
        T and R at the start.
    inertia : float or array_like
        q, above 0, to 2/3; 0.4 of a solid sphere.

    Returns
    -------
    (T, R) of float or float64 array
        In the unit of `translation`. Within 0.5 and 2 percent of simulations of the Boltzmann
        equation to C = 10, less if e is far from 1: speeds and spins are taken to be Gaussian.

    Raises
    ------
    InputError
        Outside that range.

    References
    ----------
    M. Huthmann, A. Zippelius, Phys. Rev. E 56, R6275 (1997), doi:10.1103/PhysRevE.56.R6275.

    Examples
    --------
    >>> t, r = rough_temperatures(5.0, restitution=0.9, tangential=0.5)
    >>> round(t, 4), round(r, 4)
    (0.3049, 0.1793)
    """
    a, b, d = _rough(restitution, tangential, inertia)
    # The matrix [[-a, b], [b, -d]] 4/3 is symmetric: two exponentials along its own axes.
    middle, half = (a + d) / 2, np.hypot((a - d) / 2, b)
    slow, fast = (np.exp(-4 / 3 * collisions * (middle + s * half)) for s in (-1, 1))
    even, odd = (slow + fast) / 2, (slow - fast) / 2 / np.where(half > 0, half, 1)
    lean = (a - d) / 2
    return (
        (even - lean * odd) * translation + b * odd * rotation,
        (even + lean * odd) * rotation + b * odd * translation,
    )


@formula(
    ROUGH,
    restitution=Range(0, 1),
    tangential=Range(-1, 1, open_low=True, below="smooth spheres never turn one another"),
    inertia=INERTIA,
)
def rough_ratio(restitution: Numbers, tangential: Numbers, inertia: Numbers = 0.4) -> Numbers:
    """Temperature of spin over that of motion of rough spheres, in the end: R/T.

    The root of B x^2 + (D - A) x - B = 0, with the letters of `rough_temperatures`. 1 where no
    energy is lost (e = 1, beta = 1).

    Parameters
    ----------
    restitution, tangential, inertia : float or array_like
        See `rough_temperatures`; beta above -1.

    Returns
    -------
    float or float64 array
        No unit. For e below 1 it is 2 to 7 percent off simulations.

    Raises
    ------
    InputError
        Outside that range.

    References
    ----------
    See `rough_temperatures`.

    Examples
    --------
    >>> round(rough_ratio(0.9, 0.5), 4)
    0.8671
    """
    a, b, d = _rough(restitution, tangential, inertia)
    lean = (a - d) / 2
    # Of the two forms of the root, the one in which nothing cancels.
    far = np.abs(lean) + np.hypot(lean, b)
    return np.where(lean > 0, far / b, b / far)


def _rough(e: Numbers, beta: Numbers, q: Numbers) -> tuple[Numbers, Numbers, Numbers]:
    """A, B and D."""
    h = q * (1 + beta) / (2 * q + 2)
    return (1 - e * e) / 4 + h * (1 - h), h * h / q, h / q * (1 - h / q)
