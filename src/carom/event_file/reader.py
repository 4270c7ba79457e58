"""`load_events`: events of a file, read as they are asked for."""

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.errors import FileError, InputError
from carom.event_file import layout
from carom.event_file.layout import FORMAT, IMPULSE, KINDS, ROW, VERSION
from carom.event_file.npz import NpzSource
from carom.event_file.parquet import ParquetSource
from carom.event_file.source import ENDINGS, Source, ending, refused
from carom.observe.batch import Ints
from carom.state import EVENT, Floats, State
from carom.world import World

SOURCES = dict(zip(ENDINGS, (ParquetSource, NpzSource), strict=True))
#: What is needed to make event records.
NEEDED = ("time", "i", "j", *IMPULSE)


class Events:
    """Events in a file; a column is read when it is asked for.

    Made by `load_events`.

    Attributes
    ----------
    path : Path
    about : dict
        ``carom`` (the version that wrote it), ``n``, ``seed``, ``scene`` (a scene file's text),
        ``method``, ``tick``, ``end``, and ``changed`` if somebody changed the simulation.
    """

    def __init__(self, path: Path, source: Source) -> None:
        self.path, self.about = path, source.about
        self._source = source

    def __len__(self) -> int:
        return sum(span.size for span in self._source.spans)

    def __repr__(self) -> str:
        return f"<Events: {len(self)} of {self.path.name}, up to time {self.end:.6g}>"

    # Columns.

    @cached_property
    def time(self) -> Floats:
        """When, (n,) float64."""
        return self._column("time")

    @cached_property
    def i(self) -> Ints:
        """Spheres, (n,) int32; of a pair the one with the smaller number."""
        return self._column("i")

    @cached_property
    def j(self) -> Ints:
        """Their partners, (n,) int32: spheres, or below 0 walls, see `carom.EVENT`."""
        return self._column("j")

    @cached_property
    def impulse(self) -> Floats:
        """Impulses on i, (n, 3) float64; on j act their opposites."""
        return np.column_stack([self._column(name) for name in IMPULSE])

    @cached_property
    def kind(self) -> NDArray[np.int8]:
        """0 a pair, 1 a wall, 2 came to rest on a wall, 3 left its rest; (n,) int8."""
        return self._column("kind")

    @cached_property
    def wall(self) -> Ints:
        """Numbers of walls, -1 where there is none; (n,) int32."""
        return self._column("wall")

    def _column(self, name: str) -> NDArray[Any]:
        parts = range(len(self._source.spans))
        read = [self._source.read(k, [name])[name] for k in parts]
        return np.concatenate([np.zeros(0, ROW[name]), *read])

    # Records.

    def between(self, start: float = -math.inf, until: float = math.inf) -> NDArray[Any]:
        """Records with start <= time < until, as those of `Simulation.events`.

        Only the parts of the file that hold such times are read, 2^18 events each.

        Returns
        -------
        (n,) EVENT
        """
        found = [records[_within(records, start, until)] for records in self._parts(start, until)]
        return np.concatenate([np.zeros(0, EVENT), *found])

    def batches(self) -> Iterator[NDArray[Any]]:
        """All records in their order, 2^18 or fewer at a time.

        Yields
        ------
        (n,) EVENT
        """
        return self._parts(-math.inf, math.inf)

    def _parts(self, start: float, until: float) -> Iterator[NDArray[Any]]:
        for k, span in enumerate(self._source.spans):
            if span.last >= start and span.first < until:
                yield layout.records(self._source.read(k, NEEDED))

    def to_pandas(self, start: float = -math.inf, until: float = math.inf) -> Any:
        """The columns of the file as a pandas DataFrame, of events with start <= time < until.

        Raises
        ------
        InputError
            If pandas is not installed.
        """
        try:
            import pandas
        except ImportError as error:
            msg = 'to_pandas() needs pandas: pip install "carom[analysis]"'
            raise InputError(msg) from error
        columns: dict[str, Any] = dict(layout.columns(self.between(start, until)))
        columns["kind"] = pandas.Categorical.from_codes(columns["kind"], list(KINDS))
        frame = pandas.DataFrame(columns)
        frame.attrs.update(self.about)
        return frame

    # The run.

    @property
    def end(self) -> float:
        """Time at which the last run ended; nan if there was none."""
        return float(self.about["end"]["time"]) if "end" in self.about else math.nan

    @cached_property
    def _begun(self) -> tuple[State, World]:
        return layout.unpacked(self._arrays)

    @cached_property
    def _arrays(self) -> dict[str, NDArray[Any]]:
        if "end" not in self.about:
            msg = f"{self.path} was closed before anything ran: it has no start and no events"
            raise InputError(msg)
        return self._source.arrays()

    @property
    def start(self) -> State:
        """The spheres where the first run began."""
        return replace(self._begun[0])

    @property
    def world(self) -> World:
        """Walls, periods, restitution and gravity where the first run began."""
        return self._begun[1]

    @property
    def checkpoint(self) -> bytes | None:
        """What the engine kept of that moment, if it was under way."""
        return self._arrays["engine"].tobytes() if "engine" in self._arrays else None


def _within(records: NDArray[Any], start: float, until: float) -> NDArray[np.bool_]:
    time = records["time"]
    within: NDArray[np.bool_] = (time >= start) & (time < until)
    return within


def load_events(path: str | Path) -> Events:
    """Open an event file, see `Simulation.record_events`.

    Parameters
    ----------
    path : str or Path
        ``.parquet`` or ``.npz``.

    Raises
    ------
    FileError
        If the file cannot be read.
    InputError
        If it is no event file, is cut short, or was written by a newer carom than this one can
        read; or pyarrow is not installed and it is Parquet.
    """
    file = Path(path)
    make = SOURCES[ending(file)]
    try:
        source = make(file)
    except FileNotFoundError as error:
        msg = f"cannot read {file}: there is no such file"
        raise FileError(msg) from error
    except OSError as error:
        msg = f"cannot read {file}: {error.strerror or error}"
        raise FileError(msg) from error
    about = source.about
    if about.get("format") != FORMAT:
        raise refused(file, "it holds something else")
    if about["version"] > VERSION:
        msg = (
            f"{file} was written by carom {about['carom']} in format {about['version']}, and this "
            f"carom reads up to {VERSION}; install a newer carom"
        )
        raise InputError(msg)
    return Events(file, source)
