"""The room that spheres have between walls, and the pressure of a gas on them.

Which area, and which density, make P = n kT Z true of a small box? F = N kT/(L - sigma), the
force on each wall of a box so dilute that spheres never meet, is that of the region which
centres can reach: its area and its volume. So these are used throughout. In a denser gas
spheres crowd at the walls, and fewer are left in between; `carom.theory.wall_pressure` allows
for that. Error of the theory, in percent of the force measured in a cubic box, N = 500,
e = 1, two million collisions or more (L and phi are those of the box)::

    phi   measured  A = L^2,    A = (L - sigma)^2,  the same,         wall_pressure
          +-        V = L^3     V = (L - sigma)^3   Z at phi of L^3
    0.02  0.01       -4.7         0.7               -0.5              0.01
    0.05  0.02       -7.2         2.6               -1.6              0.05
    0.10  0.03      -10.5         8.0               -3.5              0.3
    0.20  0.03      -15.6        29.1               -7.1              1.2
    0.30  0.05      -19.3        74.7               -9.9              2.2
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.observe.fluid import in_range
from carom.observe.kinds import conserves_energy
from carom.state import CAME_TO_REST, WOKE, Floats, State
from carom.theory import wall_pressure
from carom.world import CYLINDER, PLANE, SPHERE, World

FEWEST = 10  #: spheres that make a gas, of which theory speaks


@dataclass(frozen=True)
class Room:
    """The region that the centres of spheres can reach.

    Attributes
    ----------
    areas : (K,) float64
        Of each flattened wall; nan where it has no end.
    volume : float
        Nan where it has none.
    stretch : float
        dS/dV where all walls move outwards alike, S their area together.
    """

    areas: Floats
    volume: float
    stretch: float


def is_still_gas(world: World, state: State, room: Room) -> bool:
    """Whether the spheres are a gas in equilibrium between walls of known area."""
    closed = room.volume > 0 and math.fsum(room.areas) > 0  # not where one is nan
    return closed and conserves_energy(world) and len(state) >= FEWEST and not state.fixed.any()


def reduced_pressure(world: World, state: State, room: Room) -> float | None:
    """P/kT on the walls; None where the spheres are no gas in equilibrium, or freeze."""
    if not is_still_gas(world, state, room):
        return None
    if not world.collide:
        return len(state) / room.volume
    return in_range(wall_pressure, state.radius, room.volume, math.fsum(room.areas), room.stretch)


def room_for(world: World, radius: float) -> Room:
    """The region in which spheres of this radius have their centres."""
    room = _room(world, radius)
    # A round wall that turns all of the velocity round gives an impulse along that, and the
    # record does not tell its part along the normal.
    round_wall = world.walls["kind"] != PLANE
    room.areas[round_wall & (world.walls["bounce_back"] != 0)] = math.nan
    return room


def wall_impulses(
    partner: NDArray[np.int32], impulse: Floats, walls: NDArray[Any]
) -> tuple[NDArray[np.int64], Floats]:
    """Which wall was hit, and how hard.

    Parameters
    ----------
    partner : (n,) int32
        Field j of event records.
    impulse : (3, n) float64
    walls : (K,) WALL

    Returns
    -------
    (n,) int64
        The wall; -1 for other events.
    (n,) float64
        |J_n|.
    """
    wall = -1 - partner.astype(np.int64)
    wall[partner >= 0] = -1
    wall[wall >= -1 - CAME_TO_REST] += CAME_TO_REST + 1
    wall[partner == WOKE] = -1
    along = np.zeros(len(wall))
    hits = np.flatnonzero(wall >= 0)
    if len(hits):
        normal = walls["normal"].reshape(-1, 3)[wall[hits]].T
        pushed = impulse[:, hits]
        length = np.sqrt((pushed * pushed).sum(axis=0))
        flat = walls["kind"][wall[hits]] == PLANE
        along[hits] = np.where(flat, np.abs((pushed * normal).sum(axis=0)), length)
    return wall, along


def _room(world: World, radius: float) -> Room:
    walls = world.walls
    kinds = walls["kind"].tolist()
    if kinds == [SPHERE]:
        r = float(walls["offset"][0]) - radius
        return Room(np.array([4 * math.pi * r * r]), 4 / 3 * math.pi * r**3, 2 / r)
    planes = [k for k, kind in enumerate(kinds) if kind == PLANE]
    sides = [_sides(walls, planes, axis) for axis in range(3)]
    if sum(map(len, sides)) < len(planes) or any(len(pair) == 1 for pair in sides):
        return _boundless(len(walls))
    length = [
        -float(walls["offset"][pair].sum()) - 2 * radius if pair else float(world.period[axis])
        for axis, pair in enumerate(sides)
    ]
    if kinds.count(CYLINDER) == 1 and len(walls) == 3 and len(sides[2]) == 2:
        r, h = float(walls["offset"][kinds.index(CYLINDER)]) - radius, length[2]
        areas = np.where(walls["kind"] == CYLINDER, 2 * math.pi * r * h, math.pi * r * r)
        stretch = (2 * math.pi * h + 8 * math.pi * r) / float(areas.sum())
        return Room(areas, math.pi * r * r * h, stretch)
    if len(planes) < len(walls) or 0.0 in length:
        return _boundless(len(walls))
    volume = math.prod(length)
    areas = np.array([math.nan] * len(walls))
    stretched = 0.0
    for axis, pair in enumerate(sides):
        areas[pair] = volume / length[axis]
        # A wall that moves lengthens those beside it, two on each axis that has walls.
        beside = [other for other in range(3) if other != axis and sides[other]]
        stretched += len(pair) * sum(2 * volume / length[axis] / length[other] for other in beside)
    return Room(areas, volume, stretched / float(areas.sum()) if len(walls) else 0.0)


def _sides(walls: NDArray[Any], planes: list[int], axis: int) -> list[int]:
    """The two planes that close an axis; fewer or none if it is not closed by just two."""
    found = [k for k in planes if abs(walls["normal"][k][axis]) == 1]
    facing = len(found) == 2 and walls["normal"][found][:, axis].sum() == 0
    return found if facing else found[:1]


def _boundless(walls: int) -> Room:
    return Room(np.full(walls, math.nan), math.nan, 0.0)
