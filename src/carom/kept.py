"""What is kept of a motion: where it began, what was counted, its newest events."""

from collections import deque
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from carom.rules import Smooth
from carom.scene import Scene
from carom.state import EVENT, State
from carom.walls import Wall, world
from carom.world import World

Serials = NDArray[np.int64]


@dataclass(frozen=True)
class Surroundings:
    """Everything about a world that is not a sphere, as people write it."""

    walls: tuple[Wall, ...]
    rule: Smooth
    gravity: tuple[float, float, float]
    collide: bool

    @classmethod
    def of(cls, scene: Scene) -> Self:
        """Those of a scene."""
        return cls(scene.walls, scene.rule, scene.gravity, scene.collide)

    def world(self) -> World:
        """The same as numbers; contradictions are refused with `InputError`."""
        return world(self.walls, self.rule, self.gravity, self.collide)


@dataclass(frozen=True, eq=False)
class Start:
    """Where the first run began."""

    state: State
    surroundings: Surroundings
    serial: Serials
    edited: bool


@dataclass(frozen=True)
class Account:
    """What engines that are gone have counted, and the energy the present one began with."""

    energy: float
    dissipated: float = 0.0
    withheld: float = 0.0
    overlap: float = 0.0
    drift: float = 0.0
    missed: int = 0


class EventKeeper:
    """The newest `limit` event records of one run, kept in the batches they came in."""

    def __init__(self, limit: int) -> None:
        self.limit = limit
        self._batches: deque[NDArray[Any]] = deque()
        self._count = 0

    def clear(self) -> None:
        """Forget all records."""
        self._batches.clear()
        self._count = 0

    def append(self, batch: NDArray[Any]) -> None:
        """Take a batch, and let go of old ones beyond the limit."""
        self._batches.append(batch)
        self._count += len(batch)
        while self._batches and self._count - len(self._batches[0]) >= self.limit:
            self._count -= len(self._batches.popleft())

    def records(self) -> NDArray[Any]:
        """(n,) EVENT, oldest first."""
        joined = np.concatenate([np.zeros(0, EVENT), *self._batches])
        return joined[max(0, len(joined) - self.limit) :]
