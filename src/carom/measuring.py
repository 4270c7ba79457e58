"""`measure`: observables on a run that is over, from what was kept of it."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.checks import number
from carom.engine import NO_LIMIT, Engine, Resumable, Stop
from carom.errors import InputError
from carom.event_file import Events, load_events
from carom.event_file.source import ENDINGS
from carom.fit import check_values
from carom.interrupts import HeldInterrupt
from carom.kept import Account
from carom.methods import engine_maker
from carom.motion import MakeLogging
from carom.observe.feed import Feed
from carom.record import Recording, layout, load
from carom.record.again import engine_at
from carom.state import EVENT, State
from carom.world import World


def measure(
    source: str | Path | Events | Recording,
    observe: Any,
    *,
    start: float | None = None,
    until: float | None = None,
    progress: Callable[[float], object] | None = None,
) -> None:
    """Let observables watch a run that is over, as ``run(observe=...)`` would have.

    The run is run again by the method it was recorded with (an engine of your own is taken to be
    exact), and each of its events is compared with the recorded one. So the results are those of
    observing it at the time, to the bit. An event file is run from its beginning, whatever `start`
    is; a recording from the last checkpoint before.

    Parameters
    ----------
    source : str, Path, Events or Recording
        An event file (`Simulation.record_events`) or a recording (`Simulation.record`).
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
        If it is neither, a time is outside the recording, an observable has no meaning
        here, or the run does not come out as recorded: another version of carom may have
        computed it.
    """
    options: dict[str, Any] = {"start": start, "until": until, "progress": progress}
    if isinstance(source, str | Path):
        if Path(source).suffix.lower() in ENDINGS:
            measure(load_events(source), observe, **options)
        else:
            with load(source) as recording:
                measure(recording, observe, **options)
        return
    if isinstance(source, Events):
        run = of_events(source)
    elif not isinstance(source, Recording):
        msg = f"source must be a file, or what load_events() or load() returned, not {source!r:.60}"
        raise InputError(msg)
    else:
        run = of_recording(source, source.start if start is None else number("start", start))
    replay = Replay(run)
    begin = replay.within("start", start, run.begin)
    end = replay.within("until", until, run.end)
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


@dataclass(frozen=True)
class Recorded:
    """What replays a run, and what it must come to.

    Attributes
    ----------
    path : Path
    carom : str
        The version that recorded it.
    world : World
    make : callable
        What builds its engines.
    engine : Engine
        As it was at some moment before measuring begins.
    account : Account
        What had been counted when the engine was built.
    events : iterator of (n,) EVENT
        Those after that moment.
    begin, end : float
        Times between which it can be measured.
    count : int or None
        Collisions and wall collisions at the end, where more may happen at the same time.
    changed : bool
        Whether somebody changed the simulation at the end.
    """

    path: Path
    carom: str
    world: World
    make: MakeLogging
    engine: Engine
    account: Account
    events: Iterator[NDArray[Any]]
    begin: float
    end: float
    count: int | None
    changed: bool


def of_events(events: Events) -> Recorded:
    """What an event file replays, up to where it no longer follows from its start."""
    about, state = events.about, events.start
    check_values(state)
    before = dict(about["before"])
    make = engine_maker(about["method"] or "exact", about["tick"])
    counts = {name: before.pop(name) for name in ("collisions", "wall_collisions")}
    engine = make(replace(state, **counts), events.world, True)
    if events.checkpoint is not None and isinstance(engine, Resumable):
        engine.restore(events.checkpoint)
    last = about.get("changed", about["end"])
    return Recorded(
        path=events.path,
        carom=about["carom"],
        world=events.world,
        make=make,
        engine=engine,
        account=Account(math.nan, **before),
        events=events.batches(),
        begin=state.time,
        end=last["time"],
        count=last["collisions"] + last["wall_collisions"],
        changed="changed" in about,
    )


def of_recording(run: Recording, start: float) -> Recorded:
    """What a recording replays from the last checkpoint before `start`, up to the next change."""
    heads = run.heads
    of = [k for k, head in enumerate(heads) if head["time"] <= start]
    segment = heads[of[-1] if of else 0]["segment"]
    places = [k for k, head in enumerate(heads) if head["segment"] == segment]
    known = [k for k in places if run.file.has(k, layout.CHECKPOINT)]
    place = max((k for k in known if heads[k]["time"] <= start), default=known[0])
    last = heads[places[-1]]
    later = [head["time"] for head in heads[places[-1] + 1 :]]
    undone = min(later, default=math.inf) < last["time"]
    return Recorded(
        path=run.path,
        carom=run.manifest["carom"],
        world=run.segment(place).surroundings.world(),
        make=engine_maker("exact", 1.0),  # nothing else can be recorded
        engine=engine_at(run, place),
        account=Account(**heads[place]["account"]),
        events=(run.file.events(k) for k in places if k > place),
        begin=heads[places[0]]["time"],
        end=min([last["time"], *later]),
        count=None if undone else last["collisions"] + last["wall_collisions"],
        changed=bool(later),
    )


class Replay:
    """A recorded run, run again and compared event by event; observables see it as a moment."""

    def __init__(self, run: Recorded) -> None:
        self._run, self._engine, self.world = run, run.engine, run.world
        self._snapshot: State | None = None
        self._waiting = np.zeros(0, EVENT)
        self._compared = 0

    def going_on(self, state: State) -> Engine:
        """Another engine, which goes on from these spheres in this world without any trace."""
        return self._run.make(state, self.world, False)

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
        return self._run.account.dissipated + self._engine.dissipated

    @property
    def withheld(self) -> float:
        """Energy the contact-time cure has kept from being dissipated since the start."""
        return self._run.account.withheld + self._engine.withheld

    @property
    def max_overlap(self) -> float:
        """Largest (sigma - r)/sigma since the start."""
        return max(self._run.account.overlap, self._engine.max_overlap())

    def within(self, name: str, time: float | None, default: float) -> float:
        """A time of the recording.

        Raises
        ------
        InputError
            If it is outside.
        """
        if time is None:
            return default
        time, run = number(name, time), self._run
        if not run.begin <= time <= run.end:
            why = "where the simulation was changed" if run.changed else "its end"
            msg = (
                f"{name} is {time:.15g}, but {run.path} can be measured from {run.begin:.15g} to "
                f"{run.end:.15g}, {why}; give a time between"
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
        to_the_end = until == self._run.end and self._run.count is not None
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
        return 0 if self._run.count is None else self._run.count - done

    def _compare(self, records: NDArray[Any]) -> None:
        """Refuse events that are not the recorded ones."""
        while len(self._waiting) < len(records):
            more = next(self._run.events, None)
            if more is None:
                break
            self._waiting = np.concatenate([self._waiting, more])
        recorded = self._waiting[: len(records)]
        self._waiting = self._waiting[len(records) :]
        self._compared += len(records)
        if recorded.tobytes() != records.tobytes():
            raise self._differs()

    def _differs(self) -> InputError:
        return InputError(
            f"{self._run.path} does not follow from its start: near event {self._compared} the run "
            f"differs from what carom {self._run.carom} recorded; measure it with that version"
        )
