"""Lets a simulation run in a thread of its own, at the pace people want to see."""

import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Any

from carom.errors import CaromError, CollapseError, RunError
from carom.view.announcer import Announcer
from carom.view.protocol import Command, encode_text
from carom.view.snapshot import Snapshot
from carom.view.stage import Stage
from carom.view.viewable import Viewable

INTERVAL = 1 / 60  #: seconds between frames
SHARE = 0.7  #: of an interval for computing; the rest is for the frame and the page
PATIENCE = 0.04  #: seconds after which a run that takes longer than foreseen is cut short
IDLE = 0.25  #: seconds between looks around while nothing moves
#: Of several in a row only the newest counts: sliders send many.
SLIDERS = frozenset({"speed", "rule", "walls", "gravity", "scene"})
#: What goes to another moment; all but a step back let time run again after a failure.
JUMPS = frozenset({"restart", "scene", "back", "compare"})

NO_MEMORY = RunError("there is not enough memory for this many spheres; take fewer")

Reply = Callable[[str], None]


class _Enough(Exception):
    """Ends a run between two slices of the engine."""


class Pacer:
    """How much simulated time fits into one interval, learnt from what the last run has cost.

    Denser stretches of time come without warning, so long runs are approached in steps:
    by doubling, faster only while runs cost next to nothing.
    """

    def __init__(self) -> None:
        self._limit = 0.0

    def allow(self, wanted: float) -> float:
        """Return `wanted`, or as much of it as is known to fit."""
        return min(wanted, self._limit) if self._limit > 0 else wanted / 16

    def learn(self, duration: float, seconds: float, budget: float) -> None:
        """Take note that `duration` of simulated time took `seconds` of the `budget`."""
        if seconds > budget:
            self._limit = duration * budget / seconds
        else:
            spare = min(16.0, max(2.0, 0.5 * budget / max(seconds, 1e-9)))
            self._limit = max(self._limit, spare * duration)


class Driver:
    """Runs a simulation in slices, obeys commands between them, hands out snapshots.

    Nothing here waits for a page. A snapshot is made only when `hungry` says that a page
    can take one; without any page the simulation waits.

    Parameters
    ----------
    sim : Viewable
        Used only by the driver's thread while that is alive.
    publish : callable
        Takes each `Snapshot`, in the driver's thread.
    hungry : callable
        Does a page want a snapshot?
    watched : callable
        Is any page there?
    """

    def __init__(
        self,
        sim: Viewable,
        publish: Callable[[Snapshot], None],
        hungry: Callable[[], bool],
        watched: Callable[[], bool],
    ) -> None:
        self._sim, self._publish, self._hungry, self._watched = sim, publish, hungry, watched
        self._wake = threading.Event()
        self._resting = True
        self._stopping = False
        self._lock = threading.Lock()
        self._orders: deque[tuple[Command, Reply]] = deque()
        self._thread = threading.Thread(target=self._main, name="carom-view-run", daemon=True)
        self._pacer = Pacer()
        self._stage = Stage(sim, lambda: self._stopping)
        self._announcer = Announcer(self._stage)
        self._playing, self._speed, self._reached = True, 1.0, 0.0
        self._failure = ""
        self._changed = True
        self._last = time.perf_counter()
        #: What ended the thread before its time, if anything did.
        self.error: BaseException | None = None
        #: Called when the thread ends.
        self.on_end: Callable[[], Any] = lambda: None

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def stop(self) -> None:
        """End the thread, at the latest after one slice of the engine."""
        self._stopping = True
        self._wake.set()
        if self._thread.ident is not None:
            self._thread.join()

    def order(self, command: Command, reply: Reply = lambda text: None) -> None:
        """Ask for what a page can ask for; `reply` is called once, with the answer or ""."""
        with self._lock:
            if self._orders and command.op in SLIDERS and self._orders[-1][0].op == command.op:
                self._orders.pop()[1]("")
            self._orders.append((command, reply))
        self._wake.set()

    def poke(self) -> None:
        """A page can take a frame now: look whether there is one for it."""
        if self._resting:  # while time runs, it looks soon enough
            self._wake.set()

    def _main(self) -> None:
        try:
            self._loop()
        except BaseException as error:
            self.error = error
        self.on_end()

    def _loop(self) -> None:
        self.prepare()
        while not self._stopping:
            moving = self.turn()
            self._rest(self._last + (INTERVAL if moving else IDLE), moving)

    def prepare(self) -> None:
        """Build the engine, while the page loads."""
        self._run(0.0)
        self._last = time.perf_counter()

    def turn(self) -> bool:
        """Obey what was ordered, let time run up to now, hand out; whether time runs."""
        self._obey()
        now = time.perf_counter()
        moving = self._playing and self._watched()
        self._resting = not moving
        if moving:
            self._step(now - self._last)
        self._last = now
        if self._changed and self._hungry():
            self._hand_out()
        return moving

    def catch_up(self) -> None:
        """Take note that somebody else has moved the simulation, or changed it."""
        self._stage.catch_up()
        self._failure, self._changed = "", True

    def _rest(self, until: float, moving: bool) -> None:
        """Wait for the next step. Orders are obeyed at once, and end the wait unless moving."""
        while not self._stopping and not self._orders:
            left = until - time.perf_counter()
            if left <= 0:
                return
            if self._wake.wait(left):
                self._wake.clear()
                if not moving:
                    return

    def _obey(self) -> None:
        """Do what was ordered; pages get a frame between if there is much."""
        end = time.perf_counter() + PATIENCE
        while not self._stopping and time.perf_counter() < end:
            with self._lock:
                if not self._orders:
                    return
                command, reply = self._orders.popleft()
            reply(self._answer(command))
            self._changed = True

    def _answer(self, command: Command) -> str:
        """Do what a page asks for; say why not, or what it has asked for, or nothing."""
        try:
            return self._do(command)
        except CollapseError as error:
            self._fail(error)
        except CaromError as error:
            return encode_text("refused", _sentence(error))
        except MemoryError:
            return encode_text("refused", _sentence(NO_MEMORY))
        return ""

    def _do(self, command: Command) -> str:
        if command.op == "source":
            return encode_text("source", self._announcer.source())
        if command.op == "speed":
            self._speed = command["value"]
        elif command.op in ("play", "pause"):
            self._playing = command.op == "play" and not self._failure
        else:
            self._act(command)
        return ""

    def _act(self, command: Command) -> None:
        if command.op in ("step", "back"):
            self._playing = False
        failed, self._failure = self._failure, ""
        try:
            self._stage.act(command)
        except BaseException:
            self._failure = failed
            raise
        if command.op in JUMPS:
            if command.op == "restart" or failed:
                self._playing = command.op != "back"
            self._reached = 0.0
            self._run(0.0)

    def _step(self, seconds: float) -> None:
        """Run for as much simulated time as `seconds` of the clock stand for."""
        sim = self._sim
        # Time of this thread, not of the clock: what other programs take is not the engine's cost.
        before, start = sim.time, time.thread_time()
        # What the engine cannot do in time is dropped: the motion is slower, never jumpy.
        wanted = sim.pace * self._speed * min(seconds, IDLE)
        self._run(self._pacer.allow(wanted))
        self._changed = True
        done = sim.time - before
        budget = min(SHARE * max(seconds, INTERVAL), PATIENCE)
        self._pacer.learn(done, time.thread_time() - start, budget)
        if seconds > 0:
            share = min(1.0, seconds / 0.5)
            self._reached += share * (done / (sim.pace * seconds) - self._reached)

    def _run(self, duration: float) -> None:
        deadline = time.perf_counter() + PATIENCE

        def look(_: object) -> None:
            if self._stopping or time.perf_counter() > deadline:
                raise _Enough

        try:
            self._stage.run(duration, look)
        except _Enough:
            pass
        except CaromError as error:
            self._fail(error)
        except MemoryError:
            self._fail(NO_MEMORY)

    def _fail(self, error: CaromError) -> None:
        self._failure, self._playing = _sentence(error), False

    def _hand_out(self) -> None:
        self._changed = False
        self._publish(
            self._announcer.snapshot(
                playing=self._playing,
                speed=self._speed,
                reached=self._reached,
                failure=self._failure,
            )
        )


def _sentence(error: CaromError) -> str:
    """What a `CaromError` says, as a sentence on a page."""
    text = str(error)
    return text[:1].upper() + text[1:] + ("" if text.endswith(".") else ".")
