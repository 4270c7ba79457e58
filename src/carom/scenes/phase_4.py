"""Phase 4 of the paper."""

from carom.checks import count
from carom.place import random_positions
from carom.random_numbers import Random, total
from carom.scene import Scene
from carom.scenes.paper import BALLS, PACE, WIDTH, Number, Width, balls
from carom.scenes.registry import scene
from carom.walls import Box

SMALLEST, LARGEST = 20.0, 60.0


@scene
def phase_4(n: Number = BALLS, width: Width = WIDTH, seed: int = 1) -> Scene:
    """The paper's phase 4: balls of different size and mass that collide in a cube.

    Radii are even between 20 and 60 pixels; masses go with the radius cubed and have mean 1.

    Parameters
    ----------
    n : int
        Number of balls.
    width : float
        Side of the cube, pixels.
    seed : int
        Of the random sizes, places, velocities and colours.
    """
    random = Random(seed)
    radius = random.uniform(count("n", n), low=SMALLEST, high=LARGEST)
    cubed = radius * radius * radius
    places = random_positions(random, radius, (width, width, width))
    return Scene(
        balls(random, places, radius, mass=cubed * (n / total(cubed))),
        walls=(Box(width, width, width),),
        seed=seed,
        pace=PACE,
        title="Phase 4: different masses",
        wire=True,
    )
