"""The world as numbers: what every engine is built from besides a `State`."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.state import Floats

PLANE, SPHERE, CYLINDER = 0, 1, 2

#: One wall. A plane keeps spheres where ``normal . x >= offset`` (unit normal, into the
#: gas). A spherical container about the origin, or the side of a cylinder about the z
#: axis, has `offset` as its radius and no normal.
WALL: np.dtype[Any] = np.dtype(
    [
        ("kind", "i4"),
        ("bounce_back", "i4"),
        ("normal", "f8", (3,)),
        ("offset", "f8"),
        ("restitution", "f8"),
    ]
)


@dataclass(frozen=True, slots=True)
class World:
    """Everything about a scene that is not a sphere.

    Attributes
    ----------
    period : (3,) float64
        Length of each periodic axis (about the origin), 0 where the axis is not periodic.
    walls : (K,) WALL
        In the order in which event records count them.
    restitution : float
        Of collisions between spheres.
    contact_time : float
        TC model: a collision is elastic if either partner collided less than this ago; 0 = off.
    gravity : (3,) float64
    collide : bool
        False makes an ideal gas: spheres pass through one another.
    """

    period: Floats = field(default_factory=lambda: np.zeros(3))
    walls: NDArray[Any] = field(default_factory=lambda: np.zeros(0, WALL))
    restitution: float = 1.0
    contact_time: float = 0.0
    gravity: Floats = field(default_factory=lambda: np.zeros(3))
    collide: bool = True
