"""A thread that writes chunks to a file, so that the engine need not wait for the disk."""

import atexit
import math
import queue
import threading
import time
from contextlib import suppress
from pathlib import Path
from typing import IO, Any

from numpy.typing import NDArray

from carom.errors import FULL, FileError
from carom.event_file.layout import carom_version
from carom.record import layout
from carom.record.container import Container, create

#: Bytes that may wait for the disk; then the engine waits too, so memory stays bounded.
WAITING = 64 * 2**20
FRAMES_WAITING = 256  #: frames that may wait, however small: a kill loses them
GATHERING = 0.1  #: seconds in which frames gather before they are committed; a kill loses them
_END, _CLOSE = "end of frame", "close"


def locked(path: Path) -> IO[bytes] | None:
    """Keep other programs from recording into this file, which would destroy it; closing lets go.

    Raises
    ------
    FileError
        If another program is writing it.
    """
    try:
        import fcntl
    except ImportError:  # Windows
        return None
    try:
        lock = path.open("rb")
    except OSError:  # opening it to write says what is wrong
        return None
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        lock.close()
        msg = f"another program is writing {path} now; wait for its end, or end it"
        raise FileError(msg) from None
    return lock


class Writer:
    """An open file. Chunks gather to frames; each frame is in it, whole, or not at all.

    Parameters
    ----------
    path : Path
    mode : str
        "x" makes a new file, "w" replaces one, "r+" goes on with one.
    frames : int
        Of a file that is gone on with.

    Raises
    ------
    FileError
        If the file cannot be written; later calls raise it too.
    """

    def __init__(self, path: Path, mode: str, frames: int = 0) -> None:
        self.path = path
        self._safe = "what it held before is safe" if mode == "r+" else ""
        self._lock: IO[bytes] | None = None
        if mode != "x":
            self._lock = locked(path)
        try:
            if mode != "r+":
                application = f"{layout.APPLICATION} {carom_version()}"
                schema = layout.SCHEMA, layout.SCHEMA_VERSION
                create(path, mode, application, *schema, first=layout.CHECKSUMS)
            self._file = Container(path, frames)
        except OSError as error:
            self._unlock()
            raise self._refusal(error) from error
        if self._lock is None:
            self._lock = locked(path)
        self._sums: dict[str, int] = {}
        self._moment = 0.0  # of the last frame that is whole
        self._committed, self._due = -math.inf, math.inf  # the last time, and the next
        self._error: Exception | None = None
        self._queue: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._waiting, self._space = 0, threading.Condition()
        self._thread = threading.Thread(target=self._work, name="carom recorder", daemon=True)
        self._thread.start()
        atexit.register(self.close)  # a program that ends without close() keeps its frames

    def _unlock(self) -> None:
        if self._lock is not None:
            self._lock.close()

    def chunk(self, name: str, data: NDArray[Any]) -> None:
        """Add a chunk to the frame; the array must stay as it is."""
        self._put((name, data))

    def end_frame(self, moment: float) -> None:
        """Seal the frame, with a checksum of each of its chunks."""
        self._put((_END, moment))

    def close(self) -> None:
        """Wait until everything is written, and close the file."""
        atexit.unregister(self.close)
        if self._thread.is_alive():
            self._queue.put((_CLOSE, None))
            self._thread.join()
            self._unlock()
        self._complain()

    def _put(self, job: tuple[str, Any]) -> None:
        self._complain()
        with self._space:
            while self._waiting > WAITING:
                self._space.wait()
            self._waiting += _size(job)
        self._queue.put(job)

    def _complain(self) -> None:
        if self._error is not None:
            raise self._refusal(self._error) from self._error

    def _refusal(self, error: Exception) -> FileError:
        reason = getattr(error, "strerror", None) or str(error) or type(error).__name__
        full = getattr(error, "errno", None) in FULL
        remedy = "make room there" if full else "check the folder and its permissions"
        return FileError(f"cannot write {self.path}: {reason}; {self._safe or remedy}")

    # In the thread.

    def _work(self) -> None:
        job: tuple[str, Any] | None = None
        while job is None or job[0] != _CLOSE:
            job = self._next()
            try:
                if job is not None and self._error is None:  # otherwise it only makes place
                    self._do(*job)
                if time.monotonic() >= self._due:
                    self._commit()
            except Exception as error:
                self._fail(error)
            if job is not None:
                with self._space:
                    self._waiting -= _size(job)
                    self._space.notify()

    def _next(self) -> tuple[str, Any] | None:
        """Wait for the next job, but no longer than frames may wait."""
        left = None if self._due == math.inf else max(0.0, self._due - time.monotonic())
        with suppress(queue.Empty):
            found: tuple[str, Any] = self._queue.get(timeout=left)
            return found
        return None

    def _do(self, name: str, data: Any) -> None:
        if name == _CLOSE:
            self._commit()
            self._file.close()
        elif name != _END:
            self._file.chunk(name, data)
            self._sums[name] = layout.checksum(name, data)
        else:
            self._file.chunk(layout.CHECKSUMS, layout.as_json(self._sums))
            self._file.end_frame()
            self._sums, self._moment = {}, data
            self._due = min(self._due, self._committed + GATHERING)

    def _commit(self) -> None:
        self._due = math.inf
        if self._file.ready:
            self._file.commit()
            self._committed = time.monotonic()
            self._safe = f"what was recorded until time {self._moment:.9g} is safe"

    def _fail(self, error: Exception) -> None:
        """Keep what can be kept; whoever puts or closes next is told."""
        self._due = math.inf
        for keep in (self._commit, self._file.close):
            with suppress(Exception):
                keep()
        self._error = error


def _size(job: tuple[str, Any]) -> int:
    if job[0] == _END:
        return WAITING // FRAMES_WAITING
    return 1000 + getattr(job[1], "nbytes", 0)
