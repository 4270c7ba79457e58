"""A thread that writes chunks to a file, so that the engine need not wait for the disk."""

import atexit
import queue
import threading
from pathlib import Path
from typing import IO, Any

from numpy.typing import NDArray

from carom.errors import FileError
from carom.record import layout

#: Bytes that may wait for the disk; then the engine waits too, so memory stays bounded.
WAITING = 64 * 2**20
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

    Raises
    ------
    FileError
        If the file cannot be written; later calls raise it too.
    """

    def __init__(self, path: Path, mode: str) -> None:
        import gsd.fl

        self.path = path
        self._safe = ""
        self._lock: IO[bytes] | None = None
        if mode != "x":
            self._lock = locked(path)
        try:
            self._file = gsd.fl.open(
                name=str(path),
                mode=mode,
                application=f"{layout.APPLICATION} {layout.carom_version()}",
                schema=layout.SCHEMA,
                schema_version=layout.SCHEMA_VERSION,
            )
        except (OSError, RuntimeError) as error:
            self._unlock()
            raise self._refusal(error) from error
        if self._lock is None:
            self._lock = locked(path)
        self._sums: dict[str, int] = {}
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
        return FileError(
            f"cannot write {self.path}: {reason}; {self._safe or 'check the folder and its rights'}"
        )

    def _work(self) -> None:
        job: tuple[str, Any] = ("", None)
        while job[0] != _CLOSE:
            job = self._queue.get()
            try:
                if job[0] == _CLOSE:
                    self._file.close()
                elif self._error is None:  # otherwise it only makes place
                    self._do(*job)
            except Exception as error:  # whoever puts or closes next raises it
                self._error = self._error or error
            with self._space:
                self._waiting -= _size(job)
                self._space.notify()

    def _do(self, name: str, data: Any) -> None:
        if name != _END:
            self._file.write_chunk(name, data)
            self._sums[name] = layout.checksum(name, data)
            return
        self._file.write_chunk(layout.CHECKSUMS, layout.as_json(self._sums))
        self._file.end_frame()
        self._sums = {}
        # Each by itself: of frames brought to the disk together a full disk may spoil all, and a
        # kill would lose them by the thousand.
        self._file.flush()
        self._safe = f"what was recorded until time {data:.9g} is safe"


def _size(job: tuple[str, Any]) -> int:
    return 1000 + getattr(job[1], "nbytes", 0)
