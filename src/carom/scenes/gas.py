"""A gas that finds its speeds by itself."""

from typing import Annotated

import numpy as np

from carom.checks import count, number
from carom.place import cube_edge, random_positions
from carom.random_numbers import Random
from carom.scene import Scene, Spheres
from carom.scenes.registry import Slider, scene
from carom.walls import Box


@scene
def gas(
    n: Annotated[int, Slider(10, 5000, log=True)] = 500,
    packing_fraction: Annotated[float, Slider(0.001, 0.25, log=True)] = 0.05,
    speed: Annotated[float, Slider(0.1, 5)] = 1.0,
    seed: int = 1,
) -> Scene:
    """A gas in a box: all start at one speed, and collisions spread it into Maxwell's law.

    Parameters
    ----------
    n : int
        Number of spheres, of diameter and mass 1.
    packing_fraction : float
        Share of the box that the spheres fill, up to about 0.3.
    speed : float
        With which every sphere starts, in a random direction.
    seed : int
        Of the random places and directions.
    """
    count("n", n, at_least=1)
    number("packing_fraction", packing_fraction, above=0, at_most=0.74)
    number("speed", speed, at_least=0)
    random = Random(seed)
    side = cube_edge(n, packing_fraction)
    places = random_positions(random, np.full(n, 0.5), (side, side, side))
    return Scene(
        Spheres.of(places, velocity=random.direction(n) * speed),
        walls=(Box(side, side, side),),
        seed=seed,
        pace=2.0,
        color="speed",
        title="Gas in a box",
    )
