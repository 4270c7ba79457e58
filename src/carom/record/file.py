"""A recording's file, opened to be read: what it is, and whether its bytes are what was written."""

import json
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.errors import FileError, InputError
from carom.event_file.layout import carom_version
from carom.record import layout
from carom.record.container import MAGIC, begin_of, read_index

#: What reading a chunk of a damaged file may raise; its size, too, may be nonsense.
_UNREADABLE = (KeyError, MemoryError, OSError, RuntimeError, TypeError, ValueError)


class Damaged(FileError):
    """Bytes that are not what was written."""


class File:
    """Frames and their chunks, each compared with its checksum when it is read.

    Parameters
    ----------
    path : str or Path

    Raises
    ------
    FileError
        If it cannot be read, or is cut short.
    InputError
        If it is no recording, or of a later format.
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self._gsd = _opened(self.path)
        self._sums: dict[int, dict[str, int]] = {}
        self._frames = int(self._gsd.nframes)
        if self._frames > 0 and self._cut_off():
            self._frames -= 1
        if self._frames == 0:
            msg = f"{path} is a recording without a frame: nothing was written before it ended"
            self.close()
            raise FileError(msg)
        if layout.CHECKSUMS not in self.names(0):
            msg = (
                f"{path} was written by {self._gsd.application or 'another program'}, not recorded "
                "by carom: it has neither exact states nor events; open it with gsd.hoomd"
            )
            self.close()
            raise InputError(msg)
        format_version = self.json(0, layout.MANIFEST)["format"]
        if format_version > layout.FORMAT:
            msg = (
                f"{path} has format {format_version}, and carom {carom_version()} reads up "
                f"to {layout.FORMAT}; update carom"
            )
            self.close()
            raise InputError(msg)

    def __len__(self) -> int:
        return self._frames

    def close(self) -> None:
        """Let go of the file."""
        self._gsd.close()

    def _cut_off(self) -> bool:
        """Whether a kill has kept the last frame from coming into the index whole."""
        last = self._frames - 1
        try:
            complete = len(self.sums(last)) + 1
        except Damaged:  # whoever reads it is told
            return False
        _, index = read_index(self.path)
        return len(index) - begin_of(index, last) < complete

    def names(self, frame: int) -> list[str]:
        """Names of the chunks that a frame has, as the file's index says."""
        try:
            known = self._gsd.find_matching_chunk_names("")
        except UnicodeDecodeError:
            raise self.damage(frame, "the names cannot be read") from None
        return [name for name in known if self._gsd.chunk_exists(frame, name)]

    def sums(self, frame: int) -> dict[str, int]:
        """Checksums of a frame, by the names of its chunks."""
        if frame not in self._sums:
            try:
                raw = self._gsd.read_chunk(frame, layout.CHECKSUMS)
                sums = dict(json.loads(raw.tobytes()))
            except _UNREADABLE:
                raise self.damage(frame, "its checksums cannot be read") from None
            if len(self._sums) > 64:  # of many thousand frames they would take much memory
                self._sums.clear()
            self._sums[frame] = sums
        return self._sums[frame]

    def has(self, frame: int, name: str) -> bool:
        """Whether a frame was written with a chunk of this name."""
        return name in self.sums(frame)

    def read(self, frame: int, name: str) -> NDArray[Any]:
        """A chunk of a frame.

        Raises
        ------
        Damaged
            If it is not what was written.
        """
        written = self.sums(frame).get(name)
        try:
            chunk: NDArray[Any] = self._gsd.read_chunk(frame, name)
        except _UNREADABLE:
            raise self.damage(frame, f"{name} cannot be read") from None
        if layout.checksum(name, chunk) != written:
            raise self.damage(frame, f"{name} is not what was written")
        return chunk

    def inherited(self, frame: int, name: str) -> NDArray[Any]:
        """A chunk of a frame, or the first frame's where it has none of its own."""
        return self.read(frame if self.has(frame, name) else 0, name)

    def json(self, frame: int, name: str) -> dict[str, Any]:
        """A chunk of a frame that holds JSON."""
        found: dict[str, Any] = json.loads(self.read(frame, name).tobytes())
        return found

    def events(self, frame: int) -> NDArray[Any]:
        """What has happened since the frame before, (n,) EVENT."""
        parts, k = [], 0
        while self.has(frame, layout.events_name(k)):
            parts.append(layout.unpacked_events(self.read(frame, layout.events_name(k))))
            k += 1
        return np.concatenate(parts)

    def damage(self, frame: int, what: str) -> Damaged:
        """The sentence about a frame that is not as it was written."""
        return Damaged(f"{self.path} is damaged: of frame {frame} {what}; take another copy")


def _opened(path: Path) -> Any:
    import gsd.fl

    try:
        return gsd.fl.open(str(path), "r")
    except OSError as error:
        msg = f"cannot read {path}: {error.strerror or error}; check the name and its permissions"
        raise FileError(msg) from error
    except RuntimeError as error:
        if not path.read_bytes()[:8].startswith(MAGIC.to_bytes(8, "little")):
            msg = f"{path} is no recording (no GSD file); give one that carom has recorded"
            raise InputError(msg) from None
        msg = f"{path} is cut short or damaged: its index cannot be read; take another copy"
        raise Damaged(msg) from error
