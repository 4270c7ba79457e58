"""Ctrl-C that waits for a good moment."""

import signal
import threading
from collections.abc import Callable
from types import FrameType, TracebackType
from typing import Any, Self


class HeldInterrupt:
    """Holds back Ctrl-C inside a ``with`` block until `deliver` is called or the block ends.

    An engine written in Python would otherwise be cut short between two halves of one
    collision. Only the main thread of a program receives Ctrl-C; elsewhere this does nothing.
    A second Ctrl-C is not held back.
    """

    def __enter__(self) -> Self:
        self._pending: tuple[int, FrameType | None] | None = None
        self._previous: Callable[[int, FrameType | None], Any] | None = None
        if threading.current_thread() is threading.main_thread():
            previous = signal.getsignal(signal.SIGINT)
            if callable(previous):
                self._previous = previous
                signal.signal(signal.SIGINT, self._hold)
        return self

    def _hold(self, number: int, frame: FrameType | None) -> None:
        if self._pending is not None and self._previous is not None:
            self._previous(number, frame)
        self._pending = (number, frame)

    def deliver(self) -> None:
        """Hand a held Ctrl-C to whoever would have had it: as a rule, raise KeyboardInterrupt."""
        if self._pending is not None and self._previous is not None:
            pending, self._pending = self._pending, None
            self._previous(*pending)

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._previous is not None:
            signal.signal(signal.SIGINT, self._previous)
            if error is None:
                self.deliver()
