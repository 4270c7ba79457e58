"""Phase 1 of the paper."""

import numpy as np

from carom.checks import count
from carom.random_numbers import Random
from carom.scene import Scene
from carom.scenes.paper import BALLS, PACE, WIDTH, Number, Width, balls
from carom.scenes.registry import scene
from carom.walls import Box


@scene
def phase_1(n: Number = BALLS, width: Width = WIDTH, seed: int = 1) -> Scene:
    """The paper's phase 1: balls in a cube that pass through each other.

    They start at the centre, one on another.

    Parameters
    ----------
    n : int
        Number of balls.
    width : float
        Side of the cube, pixels.
    seed : int
        Of the random velocities and colours.
    """
    return Scene(
        balls(Random(seed), np.zeros((count("n", n), 3))),
        walls=(Box(width, width, width),),
        collide=False,
        seed=seed,
        pace=PACE,
        title="Phase 1: balls in a cube",
        wire=True,
    )
