"""Newton's cradle, with walls in place of strings."""

from typing import Annotated

import numpy as np

from carom.checks import count, number
from carom.color import SPECIES
from carom.scene import Scene, Spheres
from carom.scenes.registry import Slider, scene
from carom.walls import Box


@scene
def newton_cradle(
    n: Annotated[int, Slider(2, 20)] = 5, moving: Annotated[int, Slider(1, 4)] = 1
) -> Scene:
    """Newton's cradle: as many balls leave the touching row as come in.

    Walls at both ends send the balls back, as the strings of a real cradle do.

    Parameters
    ----------
    n : int
        Number of balls.
    moving : int
        How many of them come in, side by side.
    """
    count("n", n, at_least=2)
    number("moving", moving, at_least=1, at_most=n - 1)
    x = np.arange(n) - (n - 1) / 2
    x[:moving] -= 3.0
    velocity = np.zeros((n, 3))
    velocity[:moving, 0] = 2.0
    coming = np.arange(n) < moving
    position = np.column_stack([x, np.zeros(n), np.zeros(n)])
    return Scene(
        Spheres.of(position, velocity, color=SPECIES[np.where(coming, 1, 0)]),
        walls=(Box(n + 6, 3, 3),),
        pace=1.0,
        color="own",
        title="Newton's cradle",
    )
