"""The two kinds of data that cross a border: `State` (arrays) and event records."""

from dataclasses import dataclass, fields, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

#: One collision, 40 bytes. Pairs have i < j and `impulse` acts on i, −impulse on j. `j = -1 - k`
#: is wall k, `j = CAME_TO_REST - k` came to rest on wall k, `j = WOKE` left its rest (no impulse).
EVENT: np.dtype[Any] = np.dtype([("time", "f8"), ("i", "i4"), ("j", "i4"), ("impulse", "f8", (3,))])
CAME_TO_REST = -(2**20) - 1
WOKE = -(2**21)


@dataclass(slots=True)
class State:
    """N spheres at one instant.

    Attributes
    ----------
    position, velocity : (N, 3) float64
        Positions are wrapped into the box on periodic axes.
    mass, radius : (N,) float64
        Mass is inf where `fixed`.
    species, color : (N,) uint32
        Color is packed 0xRRGGBB.
    image : (N, 3) int32
        Whole boxes travelled: the unwrapped position is ``position + image * period``.
    collision_count : (N,) uint32
        Impulses each sphere has received, walls included.
    fixed, resting : (N,) bool
    time : float
    collisions, wall_collisions : int
        Sphere-sphere collisions, and the others, since the scene began.
    """

    position: Floats
    velocity: Floats
    mass: Floats
    radius: Floats
    species: NDArray[np.uint32]
    color: NDArray[np.uint32]
    image: NDArray[np.int32]
    collision_count: NDArray[np.uint32]
    fixed: NDArray[np.bool_]
    resting: NDArray[np.bool_]
    time: float = 0.0
    collisions: int = 0
    wall_collisions: int = 0

    @classmethod
    def empty(cls, n: int = 0) -> Self:
        """N spheres of mass 1 and radius 0.5 at rest at the origin."""
        return cls(
            position=np.zeros((n, 3)),
            velocity=np.zeros((n, 3)),
            mass=np.ones(n),
            radius=np.full(n, 0.5),
            species=np.zeros(n, np.uint32),
            color=np.full(n, 0x4C9BE8, np.uint32),
            image=np.zeros((n, 3), np.int32),
            collision_count=np.zeros(n, np.uint32),
            fixed=np.zeros(n, np.bool_),
            resting=np.zeros(n, np.bool_),
        )

    def __len__(self) -> int:
        return len(self.mass)

    def copy(self) -> Self:
        """A state that shares no array with this one."""
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        arrays: dict[str, Any] = {
            k: v.copy() for k, v in values.items() if isinstance(v, np.ndarray)
        }
        return replace(self, **arrays)


def readonly(state: State) -> State:
    """The same with arrays that refuse changes in place."""
    values = {field.name: getattr(state, field.name) for field in fields(state)}
    views: dict[str, Any] = {
        name: array.view() for name, array in values.items() if isinstance(array, np.ndarray)
    }
    for view in views.values():
        view.flags.writeable = False
    return replace(state, **views)
