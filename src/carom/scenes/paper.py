"""What the five phases of the paper share: its balls, speeds and colours.

T. J. Liggett, *Three-Dimensional Collisions in Java* (2017). One tick is one unit of time,
lengths are pixels.
"""

from typing import Annotated, Any

import numpy as np

from carom.color import hsb
from carom.random_numbers import Random
from carom.scene import Spheres
from carom.scenes.registry import Slider

RADIUS = 50.0
WIDTH = 500.0
BALLS = 12
#: What the phases' sliders span.
Number = Annotated[int, Slider(1, 60)]
Width = Annotated[float, Slider(300, 1500)]
#: Ticks per second at speed 1x.
PACE = 60.0
#: Velocities are even between minus and plus these, pixels per tick.
FASTEST = np.array([10.0, 10.0, 20.0])


def balls(random: Random, position: Any, radius: Any = RADIUS, mass: Any = 1.0) -> Spheres:
    """Balls with the paper's random velocities, and hues and brightnesses of their own.

    Parameters
    ----------
    random : Random
    position : (N, 3) array_like
    radius, mass : (N,) or scalar array_like
    """
    n = len(position)
    velocity = random.uniform(n, 3, low=-FASTEST, high=FASTEST)
    hue = random.uniform(n, high=360.0)
    brightness = random.uniform(n, low=70.0, high=100.0)
    return Spheres.of(position, velocity, radius, mass, color=hsb(hue, 100, brightness))
