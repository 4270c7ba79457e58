"""Builds scenes that pages ask for, in a thread that can be given up."""

import ctypes
import threading
from collections.abc import Callable
from typing import Any

from carom import scenes
from carom.errors import CaromError, InputError, RunError
from carom.scene import Scene

PATIENCE = 20.0  #: seconds a scene may take; dense random ones take minutes
LOOK = 0.05  #: seconds between looks whether the view is closing


class _GivenUp(SystemExit):
    """Raised in the thread that builds, between two lines; it says nothing if it gets out."""


class Builder:
    """Builds one scene at a time.

    Parameters
    ----------
    stopping : callable
        Whether the view is closing; then nobody waits for the scene any more.
    """

    def __init__(self, stopping: Callable[[], bool]) -> None:
        self._stopping = stopping
        self._thread: threading.Thread | None = None

    def build(self, name: str, options: dict[str, Any]) -> Scene:
        """Build a scene of the library.

        Raises
        ------
        InputError
            If there is no such scene, or it takes too long.
        """
        if self._thread is not None and self._thread.is_alive():
            msg = "a scene that was asked for before is still being built; wait a little"
            raise InputError(msg)
        made: list[Scene | BaseException] = []

        def work() -> None:
            try:
                made.append(scenes.build(name, options))
            except (Exception, _GivenUp) as error:
                made.append(error)

        self._thread = threading.Thread(target=work, name="carom-view-build", daemon=True)
        self._thread.start()
        try:
            self._wait(name)
        except CaromError:
            _give_up(self._thread)
            raise
        if isinstance(made[0], BaseException):
            raise made[0]
        return made[0]

    def _wait(self, name: str) -> None:
        assert self._thread is not None
        waited = 0.0
        while self._thread.is_alive():
            self._thread.join(LOOK)
            waited += LOOK
            if self._stopping():
                msg = "the view is closing"
                raise RunError(msg)
            if waited > PATIENCE:
                msg = f"{name} takes longer than {PATIENCE:g} seconds to build; take fewer spheres"
                raise InputError(msg)


def _give_up(thread: threading.Thread) -> None:
    """End a thread at its next line of Python; numpy finishes what it is at."""
    assert thread.ident is not None
    leave = ctypes.py_object(_GivenUp)
    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread.ident), leave)
    thread.join(1.0)
