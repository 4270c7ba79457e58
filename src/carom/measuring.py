"""`measure`: observables on a run that is over, from what was kept of it."""

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.checks import number
from carom.engine import NO_LIMIT, Engine, Resumable, Stop
from carom.errors import InputError
from carom.event_file import Events, load_events
from carom.fit import check_values
from carom.interrupts import HeldInterrupt
from carom.methods import engine_maker
from carom.observe.feed import Feed
from carom.state import EVENT, State


def measure(
    source: str | Path | Events,
    observe: Any,
    *,
    start: float | None = None,
    until: float | None = None,
    progress: Callable[[float], object] | None = None,
) -> None:
    """Let observables watch a run that is over, as ``run(observe=...)`` would have.

    The run is run again from its start, by the method it was recorded with, and each of its
    events is compared with the recorded one. So the results are those of observing it at
    the time, to the bit. It takes as long as the run did, whatever `start` is.

    Parameters
    ----------
    source : str, Path or Events
        An event file, see `Simulation.record_events`.
    observe : Observable or several
        What to measure, see `carom.observe`; ask each for its `result` afterwards.
    start : float, optional
        Time at which measuring begins; the beginning of the recording if left out.
    until : float, optional
        Time at which it ends; the end of the recording, or where somebody changed the
        simulation, if left out.
    progress : callable, optional
        Called with the simulated time about twenty times a second.

    Raises
    ------
    FileError
        If the file cannot be read.
    InputError
        If it is no event file, a time is outside the recording, an observable has no meaning
        here, or the run does not come out as recorded: another version of carom may have
        computed it.
    """
    replay = Replay(source if isinstance(source, Events) else load_events(source))
    begin = replay.within("start", start, replay.time)
    end = replay.within("until", until, replay.last["time"])
    if end < begin:
        msg = f"start is {begin:.15g}, after until, which is {end:.15g}; give an earlier start"
        raise InputError(msg)
    if begin > replay.time:
        replay.run(begin, progress=progress)
    feed = Feed(observe, replay)
    try:
        replay.run(end, feed, progress)
    except KeyboardInterrupt:
        feed.end(replay)
        raise
    feed.end(replay)


class Replay:
    """A recorded run, run again and compared event by event; observables see it as a moment."""

    def __init__(self, events: Events) -> None:
        self._events = events
        state, self.world = events.start, events.world
        check_values(state)
        self._before = events.about["before"]
        #: Where it ended, or from where on it no longer follows from its start.
        self.last: dict[str, Any] = events.about.get("changed", events.about["end"])
        self._engine = self._made(state)
        self._snapshot: State | None = state
        self._recorded = events.batches()
        self._waiting = np.zeros(0, EVENT)
        self._compared = 0

    def _made(self, state: State) -> Engine:
        """Make an engine that goes on as the recorded one did."""
        about = self._events.about
        counts = {name: self._before[name] for name in ("collisions", "wall_collisions")}
        make = engine_maker(about["method"] or "exact", about["tick"])
        engine = make(replace(state, **counts), self.world, True)
        checkpoint = self._events.checkpoint
        if checkpoint is not None and isinstance(engine, Resumable):
            engine.restore(checkpoint)
        return engine

    @property
    def state(self) -> State:
        """The spheres now."""
        if self._snapshot is None:
            self._snapshot = self._engine.state()
        return self._snapshot

    @property
    def time(self) -> float:
        """Simulated time."""
        return self._engine.time

    @property
    def dissipated(self) -> float:
        """Energy the rules have taken since the start."""
        return float(self._before["dissipated"] + self._engine.dissipated)

    @property
    def withheld(self) -> float:
        """Energy the contact-time cure has kept from being dissipated since the start."""
        return float(self._before["withheld"] + self._engine.withheld)

    @property
    def max_overlap(self) -> float:
        """Largest (sigma - r)/sigma since the start."""
        return float(max(self._before["overlap"], self._engine.max_overlap()))

    def within(self, name: str, time: float | None, default: float) -> float:
        """A time of the recording.

        Raises
        ------
        InputError
            If it is outside.
        """
        if time is None:
            return default
        time, last = number(name, time), self.last["time"]
        if not self.time <= time <= last:
            why = (
                "where the simulation was changed" if "changed" in self._events.about else "its end"
            )
            msg = (
                f"{name} is {time:.15g}, but {self._events.path} can be measured from "
                f"{self.time:.15g} to {last:.15g}, {why}; give a time between"
            )
            raise InputError(msg)
        return time

    def run(
        self,
        until: float,
        feed: Feed | None = None,
        progress: Callable[[float], object] | None = None,
    ) -> None:
        """Go on to a time."""
        to_the_end = until == self.last["time"]
        stop = Stop.SLICE
        with HeldInterrupt() as interrupt:
            while stop is Stop.SLICE:
                left = self._left()
                # The last events are counted: at one moment some may have come, others not.
                goal = math.inf if to_the_end and left else until
                due = goal if feed is None else min(goal, feed.due)
                stop = Stop(self._engine.advance(due, NO_LIMIT, left or NO_LIMIT))
                self._snapshot = None
                records = self._engine.take_events()
                self._compare(records)
                if feed is not None:
                    feed.events(records)
                    feed.moment(self)
                if stop in (Stop.TIME, Stop.COUNT) and self.time < until:
                    stop = Stop.SLICE
                if progress is not None:
                    progress(self.time)
                interrupt.deliver()
        if to_the_end and (self._left() or self.time != until):
            raise self._differs()

    def _left(self) -> int:
        """How many collisions are still to come."""
        done = self._engine.collisions + self._engine.wall_collisions
        return int(self.last["collisions"] + self.last["wall_collisions"] - done)

    def _compare(self, records: NDArray[Any]) -> None:
        """Refuse events that are not the recorded ones."""
        while len(self._waiting) < len(records):
            more = next(self._recorded, None)
            if more is None:
                break
            self._waiting = np.concatenate([self._waiting, more])
        recorded = self._waiting[: len(records)]
        self._waiting = self._waiting[len(records) :]
        self._compared += len(records)
        if recorded.tobytes() != records.tobytes():
            raise self._differs()

    def _differs(self) -> InputError:
        carom = self._events.about["carom"]
        return InputError(
            f"{self._events.path} does not follow from its start: near event {self._compared} the "
            f"run differs from what carom {carom} recorded; measure it with that version"
        )
