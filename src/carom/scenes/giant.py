"""Brownian motion: a giant among many small spheres."""

from typing import Annotated

import numpy as np

from carom.checks import count, number
from carom.place import cube_root, maxwell, random_positions
from carom.random_numbers import Random
from carom.scene import Scene, Spheres
from carom.scenes.registry import Slider, scene
from carom.walls import Box


@scene
def giant(
    n: Annotated[int, Slider(10, 5000, log=True)] = 1000,
    radius_ratio: Annotated[float, Slider(1, 20)] = 8.0,
    mass_ratio: Annotated[float, Slider(1, 1000, log=True)] = 50.0,
    packing_fraction: Annotated[float, Slider(0.01, 0.2)] = 0.1,
    seed: int = 1,
) -> Scene:
    """Brownian motion: one giant is pushed about by many small spheres in a box.

    The small spheres have diameter and mass 1 and Maxwell velocities of temperature 1; the
    giant starts at rest in the centre, with a box wide enough to let it pass.

    Parameters
    ----------
    n : int
        Number of small spheres.
    radius_ratio : float
        Radius of the giant over that of a small sphere.
    mass_ratio : float
        Mass of the giant over that of a small sphere.
    packing_fraction : float
        Share of the space around the giant that the small spheres fill (less in a box that
        must be larger for the giant).
    seed : int
        Of the random places and velocities.
    """
    count("n", n, at_least=2)
    number("radius_ratio", radius_ratio, at_least=1)
    number("mass_ratio", mass_ratio, above=0)
    number("packing_fraction", packing_fraction, above=0, at_most=0.74)
    random = Random(seed)
    big = 0.5 * radius_ratio
    space = np.pi / 6 * (n / packing_fraction + radius_ratio * radius_ratio * radius_ratio)
    side = max(cube_root(float(space)), 2 * big + 4)
    centre = np.zeros((1, 3))
    places = random_positions(random, np.full(n, 0.5), (side, side, side), avoid=(centre, big))
    one = Spheres.of(centre, radius=big, mass=mass_ratio, color="orange", species=1)
    return Scene(
        one + Spheres.of(places, velocity=maxwell(random, np.ones(n))),
        walls=(Box(side, side, side),),
        seed=seed,
        pace=2.0,
        color="own",
        title="Brownian motion of a giant",
    )
