"""A row in a process of its own: its peak of memory is its own, and an end is an end.

The process reads one word a line, ``measure``, ``row`` or ``profile``, and answers with one line
of JSON. Several may live side by side and take turns, so that what else the machine does meets
all of them.
"""

import json
import signal
import subprocess
import sys
from collections.abc import Iterable
from types import TracebackType
from typing import Any, Self, TextIO

from carom.bench.cases import named
from carom.bench.run import Run
from carom.errors import CaromError, RunError


class Worker:
    """The process of one case, seen from outside.

    It is built and warmed up when the block is entered, and gone when it is left.

    Parameters
    ----------
    name : str
        Of the case.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-m", "carom.bench.worker", name],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._process.kill()
        self._process.communicate()

    def ask(self, word: str) -> Any:
        """Let it do one thing, and return what it says.

        Raises
        ------
        RunError
            If an answer is wrong, or the process has come to an end.
        """
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        try:
            self._process.stdin.write(word + "\n")
            self._process.stdin.flush()
            line = self._process.stdout.readline()
        except BrokenPipeError:
            line = ""
        if not line:
            status = self._process.wait()
            msg = (
                f"{self._name}: its process ended with status {status}; "
                "if the system stopped it, it took too much memory: leave it out"
            )
            raise RunError(msg)
        said = json.loads(line)
        if isinstance(said, dict) and "error" in said:
            raise RunError(said["error"])
        return said


def work(name: str, words: Iterable[str], out: TextIO) -> None:
    """Do what is asked, word by word."""
    try:
        run = Run(named(name))
        todo = {"ready": lambda: None, "measure": run.measure, "row": run.row}
        todo["profile"] = run.profile
        for word in words:
            print(json.dumps(todo[word.strip()]()), file=out, flush=True)
    except CaromError as error:
        print(json.dumps({"error": str(error)}), file=out, flush=True)
    except MemoryError:
        msg = f"{name}: there is not enough memory for it; leave it out"
        print(json.dumps({"error": msg}), file=out, flush=True)


if __name__ == "__main__":
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the parent, which ends this
    work(sys.argv[1], sys.stdin, sys.stdout)
