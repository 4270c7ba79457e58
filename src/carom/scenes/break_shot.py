"""The break of pool, in three dimensions."""

import math
from typing import Annotated

import numpy as np

from carom.checks import number
from carom.color import SPECIES
from carom.scene import Scene, Spheres
from carom.scenes.registry import Slider, scene
from carom.walls import Box

#: Neighbours in the rack are this much more than a diameter apart, as on a table: which
#: pair meets first is then settled by the geometry, not by rounding.
GAP = 1e-3


@scene
def break_shot(
    layers: Annotated[int, Slider(1, 12)] = 5, speed: Annotated[float, Slider(1, 40)] = 12.0
) -> Scene:
    """A cue ball breaks a pyramid of resting balls.

    Parameters
    ----------
    layers : int
        Layers of the pyramid: 1, 3, 6, 10, 15 ... balls.
    speed : float
        Of the cue ball, diameters per unit of time.
    """
    number("layers", layers, at_least=1, at_most=100)
    number("speed", speed, above=0)
    rack, colors = [], []
    down = math.sqrt(2 / 3)  # height of a tetrahedron of edge 1
    across = math.sqrt(3) / 2  # height of a triangle of edge 1
    for layer in range(layers):
        for row in range(layer + 1):
            for k in range(row + 1):
                y, z = k - row / 2, (row - 2 * layer / 3) * across
                rack.append((layer * down, y, z))
                colors.append(SPECIES[layer % len(SPECIES)])
    balls = np.array(rack) * (1 + GAP)
    # A little off centre: a dead-centre hit would keep the picture symmetric for ever.
    cue = Spheres.of((-layers - 2.0, 0.11, 0.07), velocity=(speed, 0, 0), color=0xFFFFFF)
    side = 2.0 * layers + 6
    return Scene(
        cue + Spheres.of(balls, color=np.array(colors)),
        walls=(Box(2 * side, side, side),),
        pace=0.5,
        color="own",
        title="Break shot",
    )
