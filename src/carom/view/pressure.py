"""Pressure on each wall: the impulses of collisions with it, and what theory says of a gas.

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
from collections import deque
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.errors import InputError
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


class WallPressure:
    """The force on each wall over its area, averaged over the newest stretch of time.

    Parameters
    ----------
    world : World
    state : State
        The spheres; make another `WallPressure` when there are others.
    window : float
        Simulated time averaged over; all there was if left out.

    Notes
    -----
    A sphere at rest on a wall gives it no impulse, so its weight is not in the pressure.
    """

    def __init__(self, world: World, state: State, window: float = math.inf) -> None:
        free = ~state.fixed
        radius = state.radius[free]
        room = _room(world, float(radius.mean()) if len(radius) else 0.0)
        self._areas, self._window = room.areas, window
        # A round wall that turns all of the velocity round gives an impulse along that, and
        # the record does not tell its part along the normal.
        round_wall = world.walls["kind"] != PLANE
        self._areas[round_wall & (world.walls["bounce_back"] != 0)] = math.nan
        self._normals = world.walls["normal"].reshape(-1, 3)
        self._round = round_wall
        self._batches: deque[tuple[float, Floats]] = deque()
        self._impulse = np.zeros(len(world.walls))
        self.duration = 0.0
        self._theory = _reduced_pressure(world, state, radius, room)

    @property
    def pressure(self) -> Floats:
        """Sum |J_n|/(A t) on each flattened wall, (K,) float64; nan where A is none, or t 0."""
        per = self._areas * self.duration if self.duration > 0 else math.nan * self._areas
        result: Floats = self._impulse / per
        return result

    def add(self, events: NDArray[Any], duration: float) -> None:
        """Count the collisions with walls within another stretch of time.

        Parameters
        ----------
        events : (n,) EVENT
        duration : float
            Simulated time in which they happened.
        """
        batch = self._sums(events)
        self._batches.append((duration, batch))
        self.duration += duration
        self._impulse = self._impulse + batch
        while self.duration - self._batches[0][0] >= self._window:
            old, sums = self._batches.popleft()
            self.duration -= old
            self._impulse = self._impulse - sums

    def theory(self, temperature: float) -> float | None:
        """Return the pressure on the walls of a gas of this temperature; None if there is no gas.

        There is one in a closed room with hard walls, where all is elastic, nothing falls and
        no sphere is fixed, up to the density of freezing.
        """
        if self._theory is None or not math.isfinite(temperature):
            return None
        return temperature * self._theory

    def _sums(self, events: NDArray[Any]) -> Floats:
        """Sum |J_n| on each wall."""
        partner = events["j"]
        hits = np.flatnonzero((partner < 0) & (partner != WOKE))
        wall = -1 - partner[hits]
        wall[wall >= -1 - CAME_TO_REST] += CAME_TO_REST + 1
        impulse = events["impulse"][hits]
        along = np.abs(np.einsum("ij,ij->i", impulse, self._normals[wall]))
        if self._round.any():
            lengths = np.sqrt(np.einsum("ij,ij->i", impulse, impulse))
            along = np.where(self._round[wall], lengths, along)
        return np.bincount(wall, along, len(self._areas)).astype(np.float64)


def _reduced_pressure(world: World, state: State, radius: Floats, room: Room) -> float | None:
    """P/kT, or None where the spheres are no gas in equilibrium."""
    elastic = world.restitution == 1 and (world.walls["restitution"] == 1).all()
    closed = len(room.areas) > 0 and math.isfinite(room.volume) and room.volume > 0
    gas = len(radius) >= FEWEST and len(radius) == len(state)
    if not (elastic and closed and gas) or world.gravity.any():
        return None
    if not world.collide:
        return len(radius) / room.volume
    area = math.fsum(room.areas)
    try:
        return wall_pressure(radius, room.volume, area, room.stretch)
    except InputError:  # it freezes
        return None


def _room(world: World, radius: float) -> Room:
    """The region in which spheres of this radius have their centres."""
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
