"""Equal elastic spheres on a line between two walls: the gas of rods of L. Tonks.

Two that meet exchange velocities. Take their lengths out, and let them exchange names instead:
points that pass freely through one another on a line of L - N sigma. So all of it is exact for
every N, and follows from the velocities at the start.
"""

import numpy as np

from carom.checks import number
from carom.errors import InputError
from carom.state import Floats
from carom.theory.formula import ANY, NOT_NEGATIVE, POSITIVE, Numbers, formula

TONKS = "L. Tonks, Phys. Rev. 50, 955 (1936), doi:10.1103/PhysRev.50.955"


@formula(TONKS, n=NOT_NEGATIVE, length=POSITIVE, temperature=NOT_NEGATIVE, radius=NOT_NEGATIVE)
def rod_force(
    n: Numbers, length: Numbers, temperature: Numbers = 1.0, radius: Numbers = 0.5
) -> Numbers:
    """Mean force of equal spheres on a line on the wall at either end.

    F = N kT/(L - N sigma), where N kT is twice their kinetic energy along the line.

    Parameters
    ----------
    n : float or array_like
        N, how many there are.
    length : float or array_like
        L, from wall to wall; more than N sigma.
    temperature : float or array_like
        kT = 2 K/N.
    radius : float or array_like
        sigma/2.

    Returns
    -------
    float or float64 array
        Energy/length. Exact.

    Raises
    ------
    InputError
        If they do not fit.

    References
    ----------
    L. Tonks, Phys. Rev. 50, 955 (1936), doi:10.1103/PhysRev.50.955.

    Examples
    --------
    >>> rod_force(10, length=15.0)
    2.0
    """
    return n * temperature / _room(n, length, radius)


@formula(TONKS, velocity=ANY, length=POSITIVE, radius=NOT_NEGATIVE)
def rod_collision_rate(velocity: Numbers, length: float, radius: float = 0.5) -> float:
    """Collisions per unit of time between equal spheres on a line between walls, all together.

    The sum over pairs of max(|v_i|, |v_j|), over L - N sigma. In equilibrium it is on average
    N (N - 1) sqrt(kT/(pi m))/(L - N sigma).

    Parameters
    ----------
    velocity : (N,) array_like
        Of each, along the line, at any moment: collisions only exchange them, walls turn them.
    length : float
        L, from wall to wall; more than N sigma.
    radius : float
        sigma/2.

    Returns
    -------
    float
        1/time, over a long time. Exact.

    Raises
    ------
    InputError
        If they do not fit.

    References
    ----------
    See `rod_force`.

    Examples
    --------
    >>> rod_collision_rate([1.0, 0.0], length=3.0)
    1.0
    """
    speeds = np.sort(np.abs(_line(velocity)))
    # In order of speed, the k-th is the faster one of k pairs.
    return float(speeds @ np.arange(speeds.size) / _one_room(speeds.size, length, radius))


@formula(TONKS, velocity=ANY, length=POSITIVE, radius=NOT_NEGATIVE)
def rod_wall_rate(velocity: Numbers, length: float, radius: float = 0.5) -> float:
    """Hits per unit of time of equal spheres on a line on both walls together.

    The sum of |v_i|, over L - N sigma.

    Parameters
    ----------
    velocity, length, radius
        See `rod_collision_rate`.

    Returns
    -------
    float
        1/time, over a long time. Exact.

    Raises
    ------
    InputError
        If they do not fit.

    References
    ----------
    See `rod_force`.

    Examples
    --------
    >>> rod_wall_rate([1.0, 0.0], length=3.0)
    1.0
    """
    speeds = np.abs(_line(velocity))
    return float(speeds.sum() / _one_room(speeds.size, length, radius))


def _line(velocity: Floats) -> Floats:
    if velocity.ndim != 1:
        msg = f"velocity has the shape {velocity.shape}; give one number for each sphere"
        raise InputError(msg)
    return velocity


def _one_room(n: int, length: float, radius: float) -> Floats:
    return _room(n, number("length", length), number("radius", radius))


def _room(n: Numbers, length: Numbers, radius: Numbers) -> Floats:
    room = np.asarray(length - 2 * radius * n)
    if not (room > 0).all():
        msg = (
            f"spheres of radius {np.max(radius):g}, {np.max(n):g} of them, do not fit on a line of "
            f"{np.min(length):g}; make it longer than {np.max(2 * radius * n):g}"
        )
        raise InputError(msg)
    return room
