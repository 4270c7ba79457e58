"""The part of a frame that OVITO, freud and MDAnalysis read: GSD's schema "hoomd"."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.frame import Frame
from carom.state import State
from carom.world import CYLINDER, PLANE, SPHERE, World

Chunks = dict[str, NDArray[Any]]


def standing(state: State) -> Chunks:
    """What the schema says of the spheres that no motion changes."""
    kinds, kind = np.unique(state.species, return_inverse=True)
    with np.errstate(over="ignore"):  # beyond 3e38 it is inf here, and exact in carom's chunks
        return {
            "configuration/dimensions": np.array([3], np.uint8),
            "particles/N": np.array([len(state)], np.uint32),
            "particles/types": _names([str(label) for label in kinds.tolist()]),
            "particles/typeid": kind.reshape(-1).astype(np.uint32),
            "particles/mass": state.mass.astype(np.float32),
            "particles/diameter": (2 * state.radius).astype(np.float32),
        }


def moving(frame: Frame, world: World) -> Chunks:
    """What it says of an instant in a world, in single precision; `image` is exact."""
    state = frame.state
    events = frame.collisions + frame.wall_collisions
    with np.errstate(over="ignore"):
        return {
            "configuration/step": np.array([events], np.uint64),
            "configuration/box": np.array([*lengths(state, world), 0, 0, 0], np.float32),
            "particles/position": state.position.astype(np.float32),
            "particles/velocity": state.velocity.astype(np.float32),
            "particles/image": np.ascontiguousarray(state.image, np.int32),
            "log/time": np.array([frame.time]),
        }


def lengths(state: State, world: World) -> list[float]:
    """Sides of a box about the origin that holds the world; where it is open, the spheres.

    Around open space it grows by doubling, so that it does not change with every frame.
    """
    return [_length(axis, state, world) for axis in range(3)]


def _length(axis: int, state: State, world: World) -> float:
    if world.period[axis] > 0:
        return float(world.period[axis])
    walls = world.walls
    round_ones = walls[(walls["kind"] == SPHERE) | ((walls["kind"] == CYLINDER) & (axis < 2))]
    if len(round_ones):
        return 2 * float(round_ones["offset"].min())
    along = walls[(walls["kind"] == PLANE) & (np.abs(walls["normal"][:, axis]) == 1)]
    if {1.0, -1.0} <= set(along["normal"][:, axis].tolist()):
        return 2 * float(np.abs(along["offset"]).max())
    reach = np.abs(state.position[:, axis]) + state.radius
    half = float(reach.max()) if len(reach) else 1.0
    return 2 * 2.0 ** math.ceil(math.log2(half))


def _names(names: list[str]) -> NDArray[np.int8]:
    """Names as the schema has them: rows of characters, filled up with zeros."""
    width = max(map(len, names), default=0) + 1
    rows = [name.encode().ljust(width, b"\0") for name in names]
    return np.frombuffer(b"".join(rows), np.int8).reshape(len(names), width)
