"""Phase 0 of the paper."""

import numpy as np

from carom.checks import count
from carom.random_numbers import Random
from carom.scene import Scene
from carom.scenes.paper import BALLS, PACE, WIDTH, Number, Width, balls
from carom.scenes.registry import scene
from carom.walls import Sphere


@scene
def phase_0(n: Number = BALLS, width: Width = WIDTH, seed: int = 1) -> Scene:
    """The paper's phase 0: balls in a sphere that turns every velocity round.

    They start at the centre, one on another, and pass through each other.

    Parameters
    ----------
    n : int
        Number of balls.
    width : float
        Radius of the sphere, pixels.
    seed : int
        Of the random velocities and colours.
    """
    return Scene(
        balls(Random(seed), np.zeros((count("n", n), 3))),
        walls=(Sphere(width, reflection="bounce-back"),),
        collide=False,
        seed=seed,
        pace=PACE,
        title="Phase 0: balls in a sphere",
        wire=True,
    )
