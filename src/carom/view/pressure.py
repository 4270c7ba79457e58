"""Pressure on each wall of a scene shown live; `carom.observe.room` says by which area."""

import math
from collections import deque
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.observe.room import reduced_pressure, room_for, wall_impulses
from carom.state import Floats, State
from carom.world import World


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
        room = room_for(world, float(radius.mean()) if len(radius) else 0.0)
        self._areas, self._window, self._walls = room.areas, window, world.walls
        self._batches: deque[tuple[float, Floats]] = deque()
        self._impulse = np.zeros(len(world.walls))
        self.duration = 0.0
        self._theory = reduced_pressure(world, state, room)

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
        wall, along = wall_impulses(events["j"], events["impulse"].T, self._walls)
        hit = wall >= 0
        batch = np.bincount(wall[hit], along[hit], len(self._areas)).astype(np.float64)
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
