"""GSD files, appended to so that what is in them stays good through a full disk and a kill.

The layout is that of version 2 of GSD, https://gsd.readthedocs.io: a header, a list of names, an
index of all chunks by frame and name, and the chunks. Package gsd reads it, but cannot be trusted
to write: where a disk is too full for a larger index it goes on without one, writes over the
entries of the first frames, and all is lost.

Here nothing is written over but what is empty, and an entry of the index is written after all it
speaks of is on the disk.
"""

import os
from bisect import bisect_left
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

MAGIC = 0x65DF65DF65DF65DF
VERSION = 2 << 16 | 1
HEADER = np.dtype(
    [
        ("magic", "<u8"), ("index_place", "<u8"), ("index_size", "<u8"), ("names_place", "<u8"),
        ("names_size", "<u8"), ("schema_version", "<u4"), ("version", "<u4"),
        ("application", "S64"), ("schema", "S64"), ("reserved", "V80"),
    ]
)  # fmt: skip
#: A chunk: frame, rows, place, columns, and the numbers of its name and type; place 0 ends them.
ENTRY = np.dtype(
    [
        ("frame", "<u8"), ("rows", "<u8"), ("place", "<i8"), ("columns", "<u4"), ("name", "<u2"),
        ("type", "u1"), ("flags", "u1"),
    ]
)  # fmt: skip
TYPES = ("", "|u1", "<u2", "<u4", "<u8", "|i1", "<i2", "<i4", "<i8", "<f4", "<f8")
NAMES_UNIT = 64  #: bytes that the header counts as one
PIECE = 2**22  #: bytes that are copied at once
PAGE = 4096  #: a kill may cut what is being written where one ends, so no entry lies across


def create(
    path: Path, mode: str, application: str, schema: str, version: tuple[int, int], first: str
) -> None:
    """Make a file without frames; mode "x" keeps one that is there, "w" replaces it.

    The chunk called `first` will be the first in the index of each frame.
    """
    head = np.zeros((), HEADER)
    head["magic"], head["version"] = MAGIC, VERSION
    head["application"], head["schema"] = application.encode(), schema.encode()
    head["schema_version"] = version[0] << 16 | version[1]
    head["names_place"] = HEADER.itemsize
    head["names_size"] = (PAGE - HEADER.itemsize) // NAMES_UNIT
    head["index_place"], head["index_size"] = PAGE, PAGE // ENTRY.itemsize
    with path.open(f"{mode}b") as file:
        file.write((head.tobytes() + first.encode()).ljust(2 * PAGE, b"\0"))


def read_index(path: Path) -> tuple[NDArray[Any], NDArray[Any]]:
    """Header, and index (n,) ENTRY; that stays on the disk until somebody looks at it."""
    head = np.fromfile(path, HEADER, 1)[0]
    size = int(head["index_size"])
    index = np.memmap(path, ENTRY, "r", int(head["index_place"]), (size,))
    places = index["place"]
    return head, index[: bisect_left(range(size), True, key=lambda k: bool(places[k] == 0))]


def begin_of(index: NDArray[Any], frame: int) -> int:
    """Where in an index the entries of a frame begin."""
    frames = index["frame"]
    return bisect_left(range(len(index)), frame, key=lambda k: int(frames[k]))


class Container:
    """A file that grows by frames; those that were committed stay, whatever happens.

    Parameters
    ----------
    path : Path
    frames : int
        Go on after so many; what there is of later ones is taken out by the first `commit`.

    Raises
    ------
    OSError
        If it cannot be written; all methods may. Frames that are ready can still be committed.
    """

    def __init__(self, path: Path, frames: int) -> None:
        head, index = read_index(path)
        self._head = head.copy()
        self._listed, self._torn_end = begin_of(index, frames), len(index)
        del head, index  # some systems do not write to what is mapped
        self._file = path.open("r+b", buffering=0)
        self._end = self._safe_end = self._file.seek(0, os.SEEK_END)
        self._frame = frames
        self._entries: list[tuple[int, ...]] = []  # of the frame under way
        self._ready: list[tuple[int, ...]] = []  # of frames that have ended
        self._file.seek(int(self._head["names_place"]))
        names = self._file.read(self._names_room).partition(b"\0\0")[0].split(b"\0")
        self._names = {name: number for number, name in enumerate(filter(None, names))}
        self._names_used = sum(len(name) + 1 for name in self._names)
        self._new_names = b""

    @property
    def ready(self) -> bool:
        """Whether there are frames to be committed."""
        return bool(self._ready)

    def chunk(self, name: str, data: NDArray[Any]) -> None:
        """Write a chunk of the frame under way, of one or two dimensions."""
        data = np.ascontiguousarray(data)
        number, kind = self._number(name.encode()), TYPES.index(data.dtype.str)
        rows, columns = (*data.shape, 1)[:2]
        self._entries.append((self._frame, rows, self._end, columns, number, kind, 0))
        self._append(data.reshape(-1).view(np.uint8).data)

    def end_frame(self) -> None:
        """End the frame, and make room in the index: nothing can keep it from being committed."""
        if self._new_names:
            self._write_names()
        ready = self._ready + sorted(self._entries, key=lambda entry: entry[4])
        if self._listed + len(ready) > self._head["index_size"]:
            self._enlarge_index(self._listed + len(ready))
        self._ready, self._entries = ready, []
        self._frame += 1
        self._safe_end = self._end

    def commit(self) -> None:
        """Bring all frames that have ended to the disk, and then into the index."""
        self._sync()
        # What is left of a torn frame, the last first: so there is never a gap before others.
        while self._torn_end > self._listed:
            self._torn_end -= 1
            self._write(self._entry_place(self._torn_end), bytes(ENTRY.itemsize))
        entries = np.array(self._ready, ENTRY)
        self._write(self._entry_place(self._listed), entries.tobytes())
        self._listed += len(entries)
        self._ready = []

    def close(self) -> None:
        """Close it; of frames that were not ready nothing is left."""
        with self._file:
            self._file.truncate(self._safe_end)

    @property
    def _names_room(self) -> int:
        return int(self._head["names_size"]) * NAMES_UNIT

    def _entry_place(self, k: int) -> int:
        return int(self._head["index_place"]) + k * ENTRY.itemsize

    def _number(self, name: bytes) -> int:
        if name not in self._names:
            self._names[name] = len(self._names)
            self._new_names += name + b"\0"
        return self._names[name]

    def _write_names(self) -> None:
        used = self._names_used + len(self._new_names)
        if used > self._names_room:
            names = b"".join(name + b"\0" for name in self._names)
            size = 2 * -(-used // NAMES_UNIT)
            place = self._append(names.ljust(size * NAMES_UNIT, b"\0"))
            self._switch(names_place=place, names_size=size)
        else:
            self._write(int(self._head["names_place"]) + self._names_used, self._new_names)
        self._names_used, self._new_names = used, b""

    def _enlarge_index(self, least: int) -> None:
        size = 2 * int(self._head["index_size"])
        while size < least:
            size *= 2
        self._end = -(-self._end // PAGE) * PAGE
        place, used = self._end, self._listed * ENTRY.itemsize
        for begin in range(0, used, PIECE):
            self._file.seek(self._entry_place(0) + begin)
            self._append(self._file.read(min(PIECE, used - begin)))
        while (empty := place + size * ENTRY.itemsize - self._end) > 0:
            self._append(bytes(min(PIECE, empty)))
        self._switch(index_place=place, index_size=size)

    def _switch(self, **values: int) -> None:
        """Let the header speak of what was written to the end of the file."""
        head = self._head.copy()
        for name, value in values.items():
            head[name] = value
        self._sync()
        self._safe_end = self._end
        self._write(0, head.tobytes())
        self._head = head

    def _sync(self) -> None:
        try:
            os.fsync(self._file.fileno())
        except OSError:
            self._ready = []  # some of it may be lost, and another fsync would not tell
            raise

    def _append(self, data: bytes | memoryview) -> int:
        """Write at the end, and say where that is."""
        place = self._end
        self._write(place, data)
        self._end += len(data)
        return place

    def _write(self, place: int, data: bytes | memoryview) -> None:
        """Write all of it; one call may write but a part."""
        self._file.seek(place)
        rest = memoryview(data)
        while len(rest):
            rest = rest[self._file.write(rest) :]
