"""Where scales end: of colours by energy and by speed, and of sliders of gravity."""

import math
from dataclasses import dataclass

import numpy as np

from carom.pictures.room import lowest
from carom.state import Floats, State
from carom.world import World

#: Kinetic energy at which the paper's saturation KE/5 reaches 100 percent.
PAPER_FULL = 500.0
#: A scale stays while the end that would suit is within these parts of its own. Beyond, most
#: spheres would have the colour of one of its ends.
LEAST, MOST = 1 / 3, 2.0
HEIGHT = 2 / 3  #: of potential energy, as balls that are thrown up have it on average


@dataclass
class Scales:
    """The ends of the scales of energy and speed, as motion goes on.

    A free sphere's kinetic energy is a third of the end on average, its usual speed half of it;
    of what height becomes in falling, `HEIGHT` counts already. Ends are 1, 2 or 5 times a power of
    ten, and stay until the motion has left them: so a gas that cools fades, and before all its
    spheres look alike the scale moves after it. Scenes in the paper's look keep the paper's number
    for ever: saturation is KE/5 percent, so full at 500.

    Attributes
    ----------
    paper : bool
        Whether the scene has the look of the paper.
    energy, speed : float
        The ends; 0 before anything could move.
    """

    paper: bool
    energy: float = 0.0
    speed: float = 0.0

    def follow(self, state: State, world: World) -> tuple[float, float]:
        """Move the ends if these spheres need others; returns both."""
        energy, square = _usual(state, world)
        self.energy = PAPER_FULL if self.paper else _moved(self.energy, 3 * energy)
        self.speed = _moved(self.speed, 2 * math.sqrt(square))
        return self.ends

    @property
    def ends(self) -> tuple[float, float]:
        """Of energy and speed; 1 where nothing could move so far."""
        return self.energy or 1.0, self.speed or 1.0


def full_gravity(state: State, world: World) -> float:
    """Where a slider of gravity may end: a usual sphere then rises a fifth of the way across."""
    free = ~state.fixed
    if not free.any():
        return 1.0
    across = float(np.ptp(state.position, axis=0).max()) or float(state.radius.max())
    square = float(_squares(state)[free].mean())
    return _round(max(2.5 * square / across, 2 * float(np.abs(world.gravity).max())))


def _usual(state: State, world: World) -> tuple[float, float]:
    """Means over free spheres of the kinetic energy and of v², with what falling may bring."""
    squares = _squares(state)
    strength = float(np.linalg.norm(world.gravity))
    if strength > 0:
        above = -world.gravity / strength
        height = state.position @ above - lowest(state, world, above)
        squares = squares + 2 * HEIGHT * strength * np.maximum(height, 0.0)
    free = ~state.fixed
    if not free.any():
        return 0.0, 0.0
    squares = squares[free]
    return float((state.mass[free] * squares).mean()) / 2, float(squares.mean())


def _squares(state: State) -> Floats:
    x, y, z = state.velocity.T
    squares: Floats = x * x + y * y + z * z
    return squares


def _moved(end: float, suits: float) -> float:
    if suits <= 0 or not math.isfinite(suits):
        return end
    return end if end * LEAST <= suits <= end * MOST else _round(suits)


def _round(value: float) -> float:
    """Round to the nearest of 1, 2, 5 times a power of ten; 1 for 0."""
    if value <= 0 or not math.isfinite(value):
        return 1.0
    power = 10.0 ** math.floor(math.log10(value))
    return float(
        min((1.0, 2.0, 5.0, 10.0), key=lambda step: abs(math.log(value / power / step))) * power
    )
