"""Keeping what happens: files that are written while time runs."""

from pathlib import Path
from types import TracebackType
from typing import Self

from carom.errors import InputError
from carom.event_file.recorder import EventRecorder
from carom.methods import Method
from carom.running import Running
from carom.scene import Scene


class Keeping(Running):
    """The part of `carom.Simulation` that writes files while time runs."""

    _scene: Scene | None
    _method: Method
    _tick: float

    def record_events(self, path: str | Path) -> EventRecorder:
        """Write every event of every run from now on into a file (docs/events.md).

        Recording changes no bit of the motion and holds 2^18 events in memory. The file is
        complete once it is closed: by `EventRecorder.stop`, by `close`, at the end of a ``with``
        block of either, or when the program ends. One that exists is written over.

        Parameters
        ----------
        path : str or Path
            ``.parquet`` (needs ``pip install carom[analysis]``) or ``.npz``.

        Returns
        -------
        EventRecorder

        Raises
        ------
        InputError
            If the name ends otherwise, or pyarrow is missing, or this simulation writes it already.
        FileError
            If the file cannot be written.
        """
        file = Path(path)
        for other in self._motion.followers:
            if isinstance(other, EventRecorder) and other.path.resolve() == file.resolve():
                msg = f"{file} is being written already; stop that recording first"
                raise InputError(msg)
        scene, origin = self._scene, None if self._scene is None else self._scene.origin
        about = {
            "scene": origin and {"name": origin.name, "options": origin.options},
            "seed": None if scene is None or scene.seed is None else int(scene.seed),
            "method": self._method if isinstance(self._method, str) else None,
            "tick": self._tick,
        }
        return EventRecorder(self._motion, file, about)

    def close(self) -> None:
        """Finish all files that are being written; the simulation may go on without them.

        A simulation used with ``with`` does so at the end of the block.

        Raises
        ------
        FileError
            If something could not be written.
        """
        followers, self._motion.followers = self._motion.followers, []
        errors = []
        for follower in followers:
            try:
                follower.close(self._motion)
            except OSError as error:  # the others still finish theirs
                errors.append(error)
        if errors:
            raise errors[0]

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
