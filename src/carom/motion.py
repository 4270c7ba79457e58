"""Spheres under way: what is now, what has happened, and the engine that goes on from there."""

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom import edits, fit, mechanics
from carom.engine import NO_LIMIT, Engine, Resumable, Stop
from carom.errors import InputError
from carom.followers import Follower, Listener
from carom.frame import Frame
from carom.interrupts import HeldInterrupt
from carom.kept import Account, EventKeeper, Serials, Start, Surroundings
from carom.scene import Spheres
from carom.state import State
from carom.walls import wall_names
from carom.watch import Watch
from carom.world import World

MakeEngine = Callable[[State, World], Engine]
#: The same; True asks for an engine that keeps event records.
MakeLogging = Callable[[State, World, bool], Engine]


@dataclass(frozen=True, eq=False)
class Saved:
    """A moment of a `Motion`, to go back to.

    `engine` is a checkpoint of an engine built from `built` in this `world`; None means that
    the next run builds one. The big things are shared with the motion and with each other.
    """

    of: "Motion"
    start: Start | None
    surroundings: Surroundings
    world: World
    serial: Serials
    edited: bool
    account: Account
    built: State
    engine: bytes | None

    @property
    def nbytes(self) -> int:
        """Memory held at most, in bytes."""
        arrays = (getattr(self.built, f.name) for f in fields(self.built))
        held = sum(a.nbytes for a in arrays if isinstance(a, np.ndarray))
        return held + self.serial.nbytes + len(self.engine or b"")


class Motion:
    """A state, its surroundings, and an engine built from both when it is first needed.

    A change from outside drops the engine; the next run builds one from the state of that
    moment. What an engine has counted since it was built is banked before it goes.

    Parameters
    ----------
    state : State
    surroundings : Surroundings
    make_engine : callable
        ``(state, world, log) -> Engine``; `log` says whether event records are wanted.
    keep_events : int
        How many of the newest events of a run `events` holds.
    strict : bool
        False for engines that let spheres overlap: once they have run, placement is not
        checked any more.
    """

    def __init__(
        self,
        state: State,
        surroundings: Surroundings,
        make_engine: MakeLogging,
        keep_events: int,
        strict: bool = True,
    ) -> None:
        self._make_engine = make_engine
        self._strict = strict
        self._kept = EventKeeper(keep_events)
        self._logs = keep_events > 0
        self._born = 0
        #: They hear of every run and of every change between; see `carom.followers`.
        self.followers: list[Follower] = []
        self.begin(state, surroundings)

    def begin(self, state: State, surroundings: Surroundings) -> None:
        """Start afresh from other spheres: views of the old ones are void."""
        self._begin(Start(state, surroundings, self._new_serials(len(state)), edited=False))

    def _begin(self, start: Start) -> None:
        self._cut()
        self._engine: Engine | None = None
        self._snapshot: State | None = start.state
        self._built = start.state
        self._start: Start | None = None
        self._serial = start.serial
        #: Whether spheres were added, removed or assigned to since `begin`.
        self.edited = start.edited
        self.surroundings, self.world = start.surroundings, start.surroundings.world()
        self._account = Account(mechanics.energy(start.state, self.world))
        self._kept.clear()

    def _cut(self) -> None:
        for follower in self.followers:
            follower.cut(self)

    def _new_serials(self, n: int) -> Serials:
        """Numbers no sphere of this motion has had. They ascend, so a search finds one."""
        self._born += n
        return np.arange(self._born - n, self._born)

    # What is now, and what has happened.

    @property
    def state(self) -> State:
        """The state now; `change` takes another one, its arrays must stay as they are."""
        if self._snapshot is None and self._engine is not None:
            self._snapshot = self._engine.state()
        assert self._snapshot is not None
        return self._snapshot

    def frame(self) -> Frame:
        """Take this moment as something that lasts."""
        errors = self.max_overlap, self.energy_drift, self.missed
        return Frame(self.state, self.surroundings, self.dissipated, self.withheld, *errors)

    @property
    def start(self) -> Start:
        """Where the first run began; here and now if there was none."""
        return self._start or Start(self.state, self.surroundings, self._serial, self.edited)

    @property
    def keep_events(self) -> int:
        """How many of the newest events are held."""
        return self._kept.limit

    def serial(self, index: int) -> int:
        """What stands for one sphere for ever, whatever its place in the arrays."""
        return int(self._serial[index])

    def place(self, serial: int) -> int | None:
        """Where that sphere is in the arrays now; None if it is gone."""
        index = int(np.searchsorted(self._serial, serial))
        there = index < len(self._serial) and self._serial[index] == serial
        return index if there else None

    @property
    def time(self) -> float:
        """Simulated time."""
        return self._engine.time if self._engine else self.state.time

    @property
    def collisions(self) -> int:
        """Collisions between spheres since the start."""
        return self._engine.collisions if self._engine else self.state.collisions

    @property
    def wall_collisions(self) -> int:
        """Collisions with walls since the start."""
        return self._engine.wall_collisions if self._engine else self.state.wall_collisions

    @property
    def dissipated(self) -> float:
        """Energy the rules have taken since the start."""
        return self._account.dissipated + (self._engine.dissipated if self._engine else 0.0)

    @property
    def withheld(self) -> float:
        """Energy the contact-time cure has kept from being dissipated since the start."""
        return self._account.withheld + (self._engine.withheld if self._engine else 0.0)

    @property
    def max_overlap(self) -> float:
        """Largest (sigma - r)/sigma since the start."""
        return max(self._account.overlap, self._engine.max_overlap() if self._engine else 0.0)

    @property
    def missed(self) -> int:
        """Collisions that a method of fixed steps has not seen since the start."""
        return self._account.missed + int(getattr(self._engine, "missed", 0))

    @property
    def collapse(self) -> tuple[float, int, int] | None:
        """(time, i, j) of an inelastic collapse that ended the last run."""
        return self._engine.collapse if self._engine else None

    @property
    def events(self) -> NDArray[Any]:
        """Records of the last run."""
        return self._kept.records()

    @property
    def energy_drift(self) -> float:
        """Error of the energy, relative to what there was, summed over the changes between."""
        account, engine = self._account, self._engine
        taken = engine.dissipated if engine else 0.0
        energy, sizes = mechanics.energy_and_size(self.state, self.world)
        error = energy + taken - account.energy
        given = abs(account.energy)
        # Where kinetic and potential energy cancel, the sum is no measure but their sizes are.
        scale = given if given > 1e-9 * sizes else sizes
        return account.drift + (error / scale if scale > 0 else 0.0)

    # Changes from outside.

    def change(
        self,
        state: State,
        surroundings: Surroundings | None = None,
        serial: Serials | None = None,
    ) -> None:
        """Go on from another state, or in other surroundings, or with other spheres."""
        there = self.world if surroundings is None else surroundings.world()
        self._cut()
        # Energy that a change brings is given, so the drift goes on counting errors only.
        self._account = self._closed(mechanics.energy(state, there))
        self._engine, self._snapshot, self.world = None, state, there
        if surroundings is not None:
            self.surroundings = surroundings
        if serial is not None:
            self._serial = serial

    def _closed(self, energy: float) -> Account:
        """The account with which another engine begins at this energy."""
        errors = self.max_overlap, self.energy_drift, self.missed
        return Account(energy, self.dissipated, self.withheld, *errors)

    def assign(self, name: str, index: int | slice, value: Any) -> None:
        """Replace one array, or one row of it, if the result can be run."""
        after = edits.assigned(self.state, name, index, value, self.world.period)
        if name in ("position", "radius"):
            self._check(after, self.world, self.surroundings)
        else:
            fit.check_values(after)
            if name == "velocity" and self._strict:  # not along the inside of a round wall
                fit.check_walls(after, self.world, wall_names(self.surroundings.walls))
        self._edit(after)

    def extend(self, spheres: Spheres) -> None:
        """Add spheres, if they fit."""
        after = edits.joined(self.state, spheres, self.world.period)
        self._check(after, self.world, self.surroundings)
        self._edit(after, serial=np.append(self._serial, self._new_serials(len(spheres))))

    def remove(self, index: int) -> None:
        """Take one sphere away; the others keep their order."""
        after = edits.without(self.state, index)
        self._edit(after, serial=np.delete(self._serial, index))

    def _edit(self, state: State, serial: Serials | None = None) -> None:
        self.change(state, serial=serial)
        self.edited = True

    def surround(self, surroundings: Surroundings) -> None:
        """Change walls, rule or gravity; whatever was resting wakes."""
        there = surroundings.world()
        state = replace(self.state, resting=np.zeros(len(self.state), np.bool_))
        if surroundings.walls != self.surroundings.walls:
            state.position, boxes = fit.wrap(state.position, there.period)
            state.image = np.where(there.period == self.world.period, state.image, boxes)
            self._check(state, there, surroundings)
        self.change(state, surroundings)

    def _check(self, state: State, there: World, surroundings: Surroundings) -> None:
        if self._strict or self._start is None:
            fit.check(state, there, wall_names(surroundings.walls))
        else:
            fit.check_values(state)

    # Time goes on.

    def restart(self) -> None:
        """Go back to where the first run began: spheres, surroundings, counters."""
        self._begin(self.start)

    def saved(self) -> Saved:
        """Save this moment for `return_to`."""
        built, bits, account = self.state, None, self._account
        if isinstance(self._engine, Resumable):
            built, bits = self._built, self._engine.checkpoint()
        elif self._engine is not None:
            account = self._closed(mechanics.energy(built, self.world))
        around = self.surroundings, self.world, self._serial, self.edited
        return Saved(self, self._start, *around, account, built, bits)

    def return_to(self, saved: Saved) -> None:
        """Go back to exactly that moment; the events of the last run are gone."""
        if saved.of is not self:
            msg = "this bookmark is of another simulation; return to one of this simulation's own"
            raise InputError(msg)
        self._cut()
        engine: Engine | None = None
        if saved.engine is not None:
            same = self._built is saved.built and self.world is saved.world
            engine = self._engine if same else None
            engine = engine or self._make_engine(saved.built, saved.world, self._logs)
            assert isinstance(engine, Resumable)
            engine.restore(saved.engine)
        self._engine, self._built = engine, saved.built
        self._snapshot = saved.built if engine is None else None
        self._start, self._serial, self._account = saved.start, saved.serial, saved.account
        self.surroundings, self.world = saved.surroundings, saved.world
        self.edited = saved.edited
        self._kept.clear()

    def advance(
        self,
        until: float = math.inf,
        collisions: int = NO_LIMIT,
        events: int = NO_LIMIT,
        progress: Callable[[], object] | None = None,
        feed: Listener | None = None,
    ) -> Stop:
        """Run to a time or for a count; Ctrl-C and `progress` get a turn between slices.

        `feed` and the followers get all events, and the moments they ask for: the engine stops
        exactly there.
        """
        self._kept.clear()
        self._start = self.start
        listeners = [*self.followers, *([] if feed is None else [feed])]
        engine = self._ready(log=any(one.takes_events for one in listeners))
        for follower in self.followers:
            follower.begin(self)
        pairs, walls = engine.collisions, engine.wall_collisions
        watch = Watch(engine)
        stop = Stop.SLICE
        try:
            with HeldInterrupt() as interrupt:
                while stop is Stop.SLICE:
                    hits = engine.collisions - pairs
                    total = hits + engine.wall_collisions - walls
                    due = min([until, *(one.due for one in listeners)])
                    stop = Stop(engine.advance(due, collisions - hits, events - total))
                    self._snapshot = None
                    records = engine.take_events()
                    self._kept.append(records)
                    for one in listeners:
                        one.events(records)
                    for one in listeners:
                        one.moment(self)
                    if stop is Stop.TIME and due < until:
                        stop = Stop.SLICE
                        if until == math.inf and watch.nothing_left(self._probe):
                            stop = Stop.IDLE
                    if progress is not None:
                        progress()
                    interrupt.deliver()
        except KeyboardInterrupt:
            for one in listeners:
                one.end(self)
            raise
        for one in listeners:
            one.end(self)
        return stop

    def _ready(self, log: bool) -> Engine:
        """The engine, built if there is none, and keeping records if they are wanted."""
        if self._engine is None:
            self._built = self.state
            self._logs = log or self._kept.limit > 0
            self._engine = self._make_engine(self._built, self.world, self._logs)
        elif log and not self._logs:
            self._logs = True
            if isinstance(self._engine, Resumable):  # others keep records always
                logging = self._make_engine(self._built, self.world, True)
                assert isinstance(logging, Resumable)
                logging.restore(self._engine.checkpoint())
                self._engine = logging
        return self._engine

    def _probe(self) -> Engine:
        """An engine that goes on from here without any trace."""
        return self.going_on(self.state)

    def going_on(self, state: State) -> Engine:
        """Another engine, which goes on from these spheres in this world without any trace."""
        return self._make_engine(state, self.world, False)
