"""Events on their way into a file."""

import math
import weakref
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Any, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from carom.errors import unwritable
from carom.event_file.layout import FORMAT, GROUP, KINDS, MEANING, VERSION, carom_version, packed
from carom.event_file.npz import NpzSink
from carom.event_file.parquet import ParquetSink
from carom.event_file.source import ENDINGS, ending
from carom.motion import Motion
from carom.observe.batch import Moment
from carom.walls import wall_names


class Sink(Protocol):
    """A file that takes events in groups."""

    def write(self, records: NDArray[Any]) -> None:
        """Add events."""

    def close(self, about: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> None:
        """Write what is known at the end."""


SINKS: dict[str, type[Sink]] = dict(zip(ENDINGS, (ParquetSink, NpzSink), strict=True))


class OpenFile:
    """A file being written. It knows nothing of the motion and can be closed after that is gone."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.about: dict[str, Any] = {}
        self.arrays: dict[str, NDArray[Any]] = {}
        self.count = 0
        self._waiting: list[NDArray[Any]] = []
        self._sink: Sink | None = None
        with self._giving_up():
            self._sink = SINKS[ending(path)](path)  # type: ignore[call-arg]

    @contextmanager
    def _giving_up(self) -> Iterator[None]:
        """Write no more where it once failed."""
        try:
            yield
        except OSError as error:
            self._sink = None
            raise unwritable(self.path, error) from error

    def add(self, records: NDArray[Any]) -> None:
        """Take events; whole groups are written."""
        if self._sink is None or len(records) == 0:
            return
        self.count += len(records)
        self._waiting.append(records)
        if sum(map(len, self._waiting)) < GROUP:
            return
        together = np.concatenate(self._waiting)
        whole = len(together) // GROUP * GROUP
        self._waiting = [together[whole:].copy()]
        with self._giving_up():
            for k in range(0, whole, GROUP):
                self._sink.write(together[k : k + GROUP])

    def close(self) -> None:
        """Write what is left; a second time does nothing."""
        if self._sink is None:
            return
        with self._giving_up():
            if sum(map(len, self._waiting)):
                self._sink.write(np.concatenate(self._waiting))
            self._sink.close(self.about, self.arrays)
        self._sink, self._waiting = None, []


class EventRecorder:
    """Writes every event of a simulation into a file, see `Simulation.record_events`.

    It ends with `stop`, at the end of a ``with`` block, with `Simulation.close`, and at the
    latest with the program.
    """

    takes_events = True
    due = math.inf

    def __init__(self, motion: Motion, path: str | Path, about: Mapping[str, Any]) -> None:
        self._motion, self._file = motion, OpenFile(Path(path))
        self._file.about.update(about_file(), **about)
        self._was_cut = False
        motion.followers.append(self)
        self._finalizer = weakref.finalize(motion, self._file.close)

    @property
    def path(self) -> Path:
        """The file."""
        return self._file.path

    def __len__(self) -> int:
        """How many events it has taken."""
        return self._file.count

    def stop(self) -> None:
        """Finish the file; the simulation may go on without it.

        Raises
        ------
        FileError
            If the last events cannot be written.
        """
        if self in self._motion.followers:
            self._motion.followers.remove(self)
        self._finalizer()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.stop()

    # What the motion tells it.

    def begin(self, moment: Moment) -> None:
        """Keep where the first run begins, and where the run no longer follows from that."""
        if not self._file.arrays:
            self._keep_start()
        elif self._was_cut:
            self._file.about.setdefault("changed", self._file.about["end"])
        self.end(moment)

    def _keep_start(self) -> None:
        saved, state = self._motion.saved(), self._motion.state
        self._file.arrays = packed(state.copy(), self._motion.world)
        built, account = saved.built, saved.account
        told = ("time", "collisions", "wall_collisions")
        if saved.engine and any(getattr(built, name) != getattr(state, name) for name in told):
            # It was under way: spheres stand at their last events, which the state has rounded.
            self._file.arrays["engine"] = np.frombuffer(saved.engine, np.uint8)
        self._file.about["n"] = len(state)
        self._file.about["walls"] = list(wall_names(self._motion.surroundings.walls))
        self._file.about["before"] = {
            "collisions": built.collisions,
            "wall_collisions": built.wall_collisions,
            "dissipated": account.dissipated,
            "withheld": account.withheld,
            "overlap": account.overlap,
        }

    def cut(self, moment: Moment) -> None:
        """Notice that somebody changes the simulation."""
        self._was_cut = True

    def events(self, records: NDArray[Any]) -> None:
        """Take events."""
        self._file.add(records)

    def moment(self, moment: Moment) -> None:
        """Nothing to look at."""

    def end(self, moment: Moment) -> None:
        """Keep how far the run came."""
        state = moment.state
        self._file.about["end"] = {
            "events": len(self),
            "time": state.time,
            "collisions": state.collisions,
            "wall_collisions": state.wall_collisions,
        }

    def close(self, moment: Moment) -> None:
        """Finish the file."""
        self.stop()


def about_file() -> dict[str, Any]:
    """What every event file says of itself."""
    known = {"format": FORMAT, "version": VERSION, "carom": carom_version()}
    return known | {"columns": MEANING, "kinds": list(KINDS)}
