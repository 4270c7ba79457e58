"""Phase 2 of the paper, and what it prints."""

from collections.abc import Sequence

import numpy as np

from carom.place import random_positions
from carom.random_numbers import Random
from carom.scene import Scene
from carom.scenes.paper import PACE, RADIUS, WIDTH, Width, balls
from carom.scenes.registry import scene
from carom.walls import Box


@scene
def phase_2(width: Width = WIDTH, seed: int = 1) -> Scene:
    """The paper's phase 2: two balls of equal mass that collide in a cube.

    Parameters
    ----------
    width : float
        Side of the cube, pixels.
    seed : int
        Of the random places, velocities and colours.
    """
    random = Random(seed)
    places = random_positions(random, np.full(2, RADIUS), (width, width, width))
    return Scene(
        balls(random, places),
        walls=(Box(width, width, width),),
        seed=seed,
        pace=PACE,
        title="Phase 2: two balls",
        wire=True,
    )


def phase_2_lines(
    number: int, normal: Sequence[float], psi: float, energies: Sequence[float]
) -> str:
    """What the paper prints at a collision of its two balls.

    Parameters
    ----------
    number : int
        Of the collision, counted from 1.
    normal : (3,) floats
        n, from ball 2 to ball 1. It is a unit vector if all is well: |n| is printed.
    psi : float
        (v_1 - v_2) . n before the collision, in pixels per tick.
    energies : (2,) floats
        Kinetic energy of each ball after the collision.

    Returns
    -------
    str
        Five lines, without a line feed at the end.

    Examples
    --------
    >>> print(phase_2_lines(1, (0.6, 0.8, 0), -12.5, (40.0, 2.5)))
    collision 1
    |n| = 1.000000
    psi = -12.500000
    KE = 40.000000, 2.500000
    total KE = 42.500000
    """
    x, y, z = normal
    length = float(np.sqrt(x * x + y * y + z * z))
    return "\n".join(
        (
            f"collision {number}",
            f"|n| = {length:.6f}",
            f"psi = {psi:.6f}",
            f"KE = {', '.join(f'{energy:.6f}' for energy in energies)}",
            f"total KE = {sum(energies):.6f}",
        )
    )
