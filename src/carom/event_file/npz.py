"""Event files in NumPy's own format: a zip archive of arrays."""

import json
import zipfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.event_file.layout import rows
from carom.event_file.source import Source, Span, refused

#: Of the arrays that hold the events, in their order.
PART = "events_{:05}"


class NpzSink:
    """Writes one array of events after the other."""

    def __init__(self, path: Path) -> None:
        self._zip = zipfile.ZipFile(path, "w")
        self._spans: list[Span] = []

    def write(self, records: NDArray[Any]) -> None:
        """Add events."""
        self._add(PART.format(len(self._spans)), rows(records))
        time = records["time"]
        self._spans.append(Span(len(time), float(time.min()), float(time.max())))

    def _add(self, name: str, array: NDArray[Any]) -> None:
        with self._zip.open(f"{name}.npy", "w", force_zip64=True) as out:
            np.lib.format.write_array(out, array, allow_pickle=False)

    def close(self, about: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> None:
        """Write what is known at the end, and the directory of the archive."""
        with self._zip:
            for name, array in arrays.items():
                self._add(name, array)
            self._add("spans", np.array(self._spans, np.float64).reshape(-1, 3))
            self._add("about", np.array(json.dumps(about)))


class NpzSource(Source):
    """Reads an .npz."""

    def __init__(self, path: Path) -> None:
        self._path = path
        with path.open("rb") as stream:  # np.load itself would leave a bad file open
            try:
                file = np.load(stream, allow_pickle=False)
                names = set(file.files)
            except (zipfile.BadZipFile, ValueError, EOFError, AttributeError) as error:
                reason = "it is no .npz, cut short, or not closed because its program was killed"
                raise refused(path, reason) from error
            if not {"about", "spans"} <= names:
                raise refused(path, "this .npz was not written by record_events()")
            self.about = json.loads(str(file["about"]))
            self.spans = [Span(int(n), *times) for n, *times in file["spans"].tolist()]

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Where the run began."""
        with np.load(self._path, allow_pickle=False) as file:
            return {name: file[name] for name in file.files if not name.startswith("events_")}

    def read(self, part: int, names: Sequence[str]) -> dict[str, NDArray[Any]]:
        """Read columns of one array."""
        with np.load(self._path, allow_pickle=False) as file:
            events = file[PART.format(part)]
        return {name: events[name] for name in names}
