"""Runs a sketch at its own pace, obeys the page, hands out pictures."""

import threading
import time
from collections.abc import Callable

from carom.errors import CaromError
from carom.sketch.message import encode
from carom.sketch.program import Program
from carom.sketch.recorder import Picture
from carom.view.protocol import Command, encode_text
from carom.view.snapshot import Snapshot

SLICE = 0.2  #: seconds; Windows delivers Ctrl-C only between waits
BEHIND = 0.25  #: seconds a program may fall behind before its clock is set anew
PATIENCE = 3.0  #: seconds after which a frame that does not end is talked about
OPERATIONS = ("play", "pause", "step", "restart")


class Runner:
    """Calls `Program` frame after frame, in the thread that calls `run`.

    That is the main thread, so that Ctrl-C ends even a ``draw()`` without end. Nothing here
    waits for a page: a frame is sent when `hungry` says that a page takes one, and the newest
    wins. While nobody is there the program waits.

    Parameters
    ----------
    program : Program
        Loaded.
    publish, hungry, watched : callable
        See `carom.view.server.Server`.
    on_error : callable
        Told of each error of the program.
    """

    def __init__(
        self,
        program: Program,
        publish: Callable[[Snapshot], None],
        hungry: Callable[[], bool],
        watched: Callable[[], bool],
        on_error: Callable[[CaromError], None] = lambda error: None,
    ) -> None:
        self._program, self._on_error = program, on_error
        self._publish, self._hungry, self._watched = publish, hungry, watched
        self._wake = threading.Event()
        self._lock = threading.Lock()  # of the orders
        self._orders: list[tuple[str, Callable[[str], None]]] = []
        self._playing, self._steps, self._due = True, 0, 0.0
        self._picture, self._epoch, self._changed = Picture(), 0, True
        self._frames: tuple[float, int] = (0.0, 0)
        self._reached = 0.0
        self._outlet = threading.Lock()  # of everything below: the watchman speaks too
        self._number = self._failures = 0
        self._failure = ""
        self._since = 0.0  # when the program's code was entered; 0 outside
        self.stopping = False

    @property
    def failed(self) -> bool:
        """Whether an error of the program stands in the way."""
        return self._failure != ""

    # Called from other threads.

    def order(self, command: Command, reply: Callable[[str], None]) -> None:
        """Take a command of a page; `reply` is called once, with the answer or ""."""
        if command.op not in OPERATIONS:
            reply(encode_text("refused", "A sketch has no such control."))
            return
        with self._lock:
            self._orders.append((command.op, reply))
        self._wake.set()

    def poke(self) -> None:
        """A page can take a frame now."""
        self._wake.set()

    def stop(self) -> None:
        """End `run` after the frame that is being drawn."""
        self.stopping = True
        self._wake.set()

    # In the program's thread.

    def run(self) -> None:
        """Draw until `stop` is called, or Ctrl-C is pressed, or the program leaves."""
        watchman = threading.Thread(target=self._watch, name="carom-sketch-watch", daemon=True)
        watchman.start()
        try:
            self._try(self._program.setup)
            while not self.stopping:
                self._obey()
                if self._is_due():
                    self._frame()
                if self._changed and self._hungry():
                    self._hand_out()
                self._rest()
        finally:
            self.stopping = True

    def _obey(self) -> None:
        with self._lock:
            orders, self._orders = self._orders, []
        for op, reply in orders:
            self._changed = True
            reply("")
            if op == "restart":
                self._epoch += 1
                self._playing, self._steps = True, 0
                self._due = 0.0  # a new epoch never shows a frame of the old one
                self._fail("")
                self._try(self._program.start)
            elif op == "step":
                self._playing = False
                self._steps += 1
            else:
                self._playing = op == "play"

    def _is_due(self) -> bool:
        recorder = self._program.recorder
        if self.failed or not self._watched():
            return False
        wanted = self._playing and (recorder.looping or recorder.owed > 0 or recorder.frame == 0)
        return self._steps > 0 or (wanted and time.perf_counter() >= self._due)

    def _frame(self) -> None:
        recorder = self._program.recorder
        now = time.perf_counter()
        period = 1.0 / recorder.rate
        self._due = self._due + period if now - self._due < BEHIND else now + period
        if not recorder.looping:
            recorder.owed = max(0, recorder.owed - 1)
        self._steps = max(0, self._steps - 1)
        self._try(self._draw)
        self._changed = True
        self._count(now)

    def _draw(self) -> None:
        self._picture = self._program.draw()

    def _count(self, now: float) -> None:
        """Measure the frames per second, over half a second."""
        begin, frames = self._frames
        if now - begin > 2.0:  # it has paused
            self._frames, self._reached = (now, 0), 0.0
        elif now - begin >= 0.5:
            self._reached = (frames + 1) / (now - begin)
            self._frames = (now, 0)
        else:
            self._frames = (begin, frames + 1)

    def _try(self, what: Callable[[], None]) -> None:
        """Run some of the program; its errors stop it and are told."""
        self._since = time.perf_counter()
        try:
            what()
        except CaromError as error:
            self._since = 0.0
            self._fail(str(error))
            self._on_error(error)
        finally:
            self._since = 0.0

    def _fail(self, sentence: str) -> None:
        with self._outlet:
            self._failures += sentence != self._failure
            self._failure = sentence
        self._changed = True

    def _rest(self) -> None:
        """Wait for the next frame; orders and hungry pages end the wait."""
        left = self._due - time.perf_counter()
        idle = self.failed or not self._playing or not self._program.recorder.looping
        self._wake.wait(SLICE if idle or not self._watched() else min(SLICE, max(0.0, left)))
        self._wake.clear()

    def _hand_out(self) -> None:
        self._changed = False
        with self._outlet:
            self._send()

    def _send(self, warning: str = "") -> None:
        printed = self._program.printed
        frame = encode(
            self._picture,
            epoch=self._epoch,
            playing=self._playing and not self.failed,
            failed=self.failed,
            rate=self._program.recorder.rate,
            reached=self._reached,
        )
        notes = {
            "title": (1, encode_text("title", self._program.path.name)),
            "failure": (
                2 * self._failures + bool(warning),
                encode_text("failure", warning or self._failure),
            ),
            "printed": (printed.number, encode_text("printed", printed.tail)),
        }
        self._number += 1
        self._publish(Snapshot(self._number, (frame,), notes=notes))

    def _watch(self) -> None:
        """In a thread of its own: say so when the program's code does not come back."""
        told = 0.0
        while not self.stopping:
            time.sleep(SLICE)
            since = self._since
            if since == 0.0 or since == told or time.perf_counter() - since < PATIENCE:
                continue
            told = since
            with self._outlet:
                self._send(
                    f"{self._program.path.name} has been busy for {PATIENCE:g} s without an end to "
                    "draw() or setup(); if it hangs, Ctrl-C in the terminal ends it"
                )
            self._changed = True  # so that the warning goes when the frame comes
