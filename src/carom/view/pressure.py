"""Pressure on each wall, from the impulses of collisions with it."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.state import State
from carom.world import World


class WallPressure:
    """Placeholder replaced on merge."""

    def __init__(self, world: World, state: State) -> None:
        self._walls = len(world.walls)
        self.duration = 0.0

    @property
    def pressure(self) -> NDArray[np.float64]:
        return np.zeros(self._walls)

    def add(self, events: NDArray[Any], duration: float) -> None:
        self.duration += duration

    def theory(self, temperature: float) -> float | None:
        return None
