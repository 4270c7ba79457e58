"""Phase 3 of the paper."""

import numpy as np

from carom.checks import count
from carom.place import random_positions
from carom.random_numbers import Random
from carom.scene import Scene
from carom.scenes.paper import BALLS, PACE, RADIUS, WIDTH, Number, Width, balls
from carom.scenes.registry import scene
from carom.walls import Box


@scene
def phase_3(n: Number = BALLS, width: Width = WIDTH, seed: int = 1) -> Scene:
    """The paper's phase 3: many equal balls that collide in a cube.

    Parameters
    ----------
    n : int
        Number of balls.
    width : float
        Side of the cube, pixels.
    seed : int
        Of the random places, velocities and colours.
    """
    random = Random(seed)
    places = random_positions(random, np.full(count("n", n), RADIUS), (width, width, width))
    return Scene(
        balls(random, places),
        walls=(Box(width, width, width),),
        seed=seed,
        pace=PACE,
        title="Phase 3: many balls",
        wire=True,
    )
