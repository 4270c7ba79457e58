"""Keeping what happens: files that are written while time runs."""

from pathlib import Path
from types import TracebackType
from typing import Self

from carom.errors import InputError
from carom.event_file.recorder import EventRecorder
from carom.methods import Method
from carom.record import load
from carom.record.again import resume
from carom.record.recorder import record
from carom.record.writer import locked
from carom.running import Running
from carom.scene import Scene


class Keeping(Running):
    """The part of `carom.Simulation` that writes files while time runs."""

    _scene: Scene | None
    _method: Method
    _tick: float

    def record_events(self, path: str | Path, *, overwrite: bool = False) -> EventRecorder:
        """Write every event of every run from now on into a file (docs/events.md).

        Recording changes no bit of the motion and holds 2^18 events in memory. The file is
        complete once it is closed: by `EventRecorder.stop`, by `close`, at the end of a ``with``
        block of either, or when the program ends.

        Parameters
        ----------
        path : str or Path
            ``.parquet`` (needs ``pip install "carom[analysis]"``) or ``.npz``.
        overwrite : bool
            Replace a file that is there.

        Returns
        -------
        EventRecorder

        Raises
        ------
        InputError
            If the name ends otherwise, the file is there already, or pyarrow is missing.
        FileError
            If the file cannot be written.
        """
        file = Path(path)
        for other in self._motion.followers:
            if isinstance(other, EventRecorder) and other.path.resolve() == file.resolve():
                msg = f"{file} is being written already; stop that recording first"
                raise InputError(msg)
        if file.exists() and not overwrite:
            msg = f"{file} is there already; give another name, or overwrite=True to replace it"
            raise InputError(msg)
        scene, origin = self._scene, None if self._scene is None else self._scene.origin
        about = {
            "scene": origin and {"name": origin.name, "options": origin.options},
            "seed": None if scene is None or scene.seed is None else int(scene.seed),
            "method": self._method if isinstance(self._method, str) else None,
            "tick": self._tick,
        }
        return EventRecorder(self._motion, file, about)

    def record(
        self,
        path: str | Path,
        *,
        every: float | None = None,
        checkpoint_every: float | None = None,
        overwrite: bool = False,
    ) -> None:
        """Write everything that happens from now on into a file, until `close`.

        `carom.load` reads it, `resume` goes on from it with the same bits, and OVITO, freud and
        MDAnalysis open it. Killed at any instant, it holds all frames completed by then. What
        it costs: docs/record.md.

        Parameters
        ----------
        path : str or Path
            By custom it ends in ``.gsd``.
        every : float, optional
            Simulated time between frames. If left out, thirty pass in a second at `pace`; after
            300, frames are left out until as many events as spheres have happened.
        checkpoint_every : float, optional
            Simulated time between checkpoints, a multiple of `every`; ten times as long if left
            out.
        overwrite : bool
            Replace a file that is there.

        Raises
        ------
        InputError
            If a time cannot be used, the file is there already, or the method is not "exact".
        FileError
            If the file cannot be written. A disk that is full later on ends a run with it.
        """
        if self._method != "exact":
            msg = (
                f"method {self._method!r:.60} cannot be recorded, only 'exact': a recording "
                "promises to go on with the same bits"
            )
            raise InputError(msg)
        options = {"every": every, "checkpoint_every": checkpoint_every}
        recorder = record(self._motion, path, scene=self._scene, overwrite=overwrite, **options)
        self._motion.followers.append(recorder)

    @classmethod
    def resume(cls, path: str | Path) -> Self:
        """Go on with a recording from its last frame, with the same bits, in the same file.

        That a run was interrupted, killed too, leaves no trace: it comes to the same end.

        Parameters
        ----------
        path : str or Path

        Raises
        ------
        InputError
            If it is no recording, or another version of carom comes to other bits.
        FileError
            If it cannot be read and written, is damaged, or another program writes it now.
        """
        lock = locked(Path(path))  # what another program has yet to write cannot be read
        if lock is not None:
            lock.close()
        sim = cls()
        with load(path) as run:
            recorder = resume(sim._motion, run)
            sim._scene = run.scene
        sim._motion.followers.append(recorder)
        return sim

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
