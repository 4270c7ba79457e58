"""Noticing that nothing will ever happen again."""

import math
from collections.abc import Callable

from carom.engine import NO_LIMIT, Engine, Stop

PATIENCE = 64  #: samples without an event between them, before it asks for the first time


class Watch:
    """Notices that nothing will ever happen again in a run that samples keep going.

    An engine says so by itself only where it is asked to go on for ever. So when many samples
    in a row saw no event, an engine of its own is asked; ever more rarely.
    """

    def __init__(self, engine: Engine) -> None:
        self._engine = engine
        self._events = self._count()
        self._quiet, self._patience = 0, PATIENCE

    def _count(self) -> int:
        return self._engine.collisions + self._engine.wall_collisions

    def nothing_left(self, probe: Callable[[], Engine]) -> bool:
        """Whether the samples go on for nothing; to be asked after each."""
        events = self._count()
        self._quiet = self._quiet + 1 if events == self._events else 0
        self._events = events
        if self._quiet < self._patience:
            return False
        self._quiet, self._patience = 0, 2 * self._patience
        engine = probe()
        while (stop := Stop(engine.advance(math.inf, NO_LIMIT, 1))) is Stop.SLICE:
            pass
        return stop is Stop.IDLE
