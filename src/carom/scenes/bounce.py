"""Balls that fall, bounce and come to rest on the floor."""

import math
from typing import Annotated

import numpy as np

from carom.checks import count, number
from carom.color import SPECIES
from carom.place import random_positions
from carom.random_numbers import Random
from carom.rules import Smooth
from carom.scene import Scene, Spheres
from carom.scenes.registry import Slider, scene
from carom.walls import Box

HEIGHT = 10.0
#: Balls caught between others bounce ever faster; below this time between collisions they
#: keep their energy (the TC model). A ball comes to rest on the floor after bounces of about
#: 2e-5 s, so this must stay well below that, or it would never rest.
CONTACT_TIME = 1e-6


@scene
def bounce(
    n: Annotated[int, Slider(1, 200)] = 25,
    restitution: Annotated[float, Slider(0, 1)] = 0.8,
    gravity: Annotated[float, Slider(0, 20)] = 9.81,
    seed: int = 1,
) -> Scene:
    """Balls drop into a box, bounce lower and lower, and end up sliding on its floor.

    Parameters
    ----------
    n : int
        Number of balls.
    restitution : float
        Of balls and walls, 0 to 1.
    gravity : float
        Downward acceleration, metres per second squared.
    seed : int
        Of the random sizes, places and velocities.
    """
    count("n", n, at_least=1)
    number("gravity", gravity, at_least=0)
    random = Random(seed)
    radius = random.uniform(n, low=0.3, high=0.7)
    # The floor has room for all of them side by side: they end on it, not on a heap.
    side = max(4.0, 2 * math.sqrt(n))
    places = random_positions(random, radius, (side, side, HEIGHT / 2))
    places[:, 2] += HEIGHT / 4  # the upper half
    velocity = random.uniform(n, 3, low=-2.0, high=2.0)
    species = np.floor((radius - 0.3) / 0.08).astype(np.int64)
    spheres = Spheres.of(
        places, velocity, radius, mass=8 * radius * radius * radius, color=SPECIES[species]
    )
    return Scene(
        spheres,
        walls=(Box(side, side, HEIGHT, restitution=restitution),),
        rule=Smooth(restitution, contact_time=CONTACT_TIME),
        gravity=(0.0, 0.0, -gravity),
        seed=seed,
        pace=1.0,
        color="own",
        title="Bouncing balls",
    )
