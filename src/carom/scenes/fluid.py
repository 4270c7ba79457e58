"""The hard-sphere fluid of the textbooks."""

from typing import Annotated

import numpy as np

from carom.checks import count
from carom.place import cube_edge, fcc, fluid_cells, maxwell
from carom.random_numbers import Random
from carom.scene import Scene, Spheres
from carom.scenes.registry import Slider, scene
from carom.walls import Periodic


@scene
def fluid(
    n: Annotated[int, Slider(32, 50_000, log=True)] = 4000,
    packing_fraction: Annotated[float, Slider(0.01, 0.5)] = 0.3,
    temperature: Annotated[float, Slider(0.1, 10, log=True)] = 1.0,
    seed: int = 1,
) -> Scene:
    """A hard-sphere fluid in a periodic cube, at any packing fraction.

    Diameter and mass are 1. The spheres start on sites of a face-centred grid, of which
    the seed leaves some empty, with Maxwell velocities of total momentum 0.

    Parameters
    ----------
    n : int
        Number of spheres, 2 or more.
    packing_fraction : float
        Share of the cube that the spheres fill, pi n / (6 L^3).
    temperature : float
        2 K/(3 n - 3).
    seed : int
        Of the empty sites and the velocities.
    """
    count("n", n, at_least=2)
    cells = fluid_cells(n, packing_fraction)
    side = cube_edge(n, packing_fraction)
    random = Random(seed)
    sites = fcc(*cells, size=side)
    places = sites[random.choice(len(sites), n)]
    return Scene(
        Spheres.of(places, velocity=maxwell(random, np.ones(n), temperature)),
        walls=(Periodic(side, side, side),),
        seed=seed,
        pace=1.0,
        color="speed",
        title="Hard-sphere fluid",
    )
