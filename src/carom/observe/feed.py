"""Who wants the floor next, and when? Observables get their events and moments here."""

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom import mechanics
from carom.errors import InputError
from carom.observe.batch import Batch, Moment
from carom.observe.observable import Observable
from carom.state import EVENT, State

#: Events in a batch: enough that NumPy's calls cost little, few enough for the cache. Cut at
#: this fixed number, sums round the same whatever the machine's speed.
BATCH = 8192
#: Radii that spheres move between two samples, at least.
LEAST = 1e-6


class Cutter:
    """Hands events on in batches of a fixed size to observables that share it."""

    def __init__(self, observables: list[Observable], moment: Moment) -> None:
        self._observables = observables
        self._start = moment.time
        self._around = moment.state, moment.world
        self._rest = np.zeros(0, EVENT)

    def add(self, records: NDArray[Any]) -> None:
        """Take events as they come."""
        records = np.concatenate([self._rest, records]) if len(self._rest) else records
        whole = len(records) // BATCH * BATCH
        for k in range(0, whole, BATCH):
            part = records[k : k + BATCH]
            self._hand_on(part, float(part["time"][-1]))
        self._rest = records[whole:]

    def flush(self, end: float) -> None:
        """Hand on what is left, up to a time."""
        if len(self._rest):  # the clock and the record of one event may round differently
            end = max(end, float(self._rest["time"][-1]))
        self._hand_on(self._rest, end)
        self._rest = np.zeros(0, EVENT)

    def _hand_on(self, records: NDArray[Any], end: float) -> None:
        batch = Batch(records, self._start, end, *self._around)
        self._start = end
        for observable in self._observables:
            observable.events(batch)


class Feed:
    """All observables of one run.

    Parameters
    ----------
    observe : Observable or several
    moment : Moment
        Where the run begins.

    Raises
    ------
    InputError
        If one is no observable, is given twice, has no meaning in this world, or was measured
        elsewhere before.
    """

    def __init__(self, observe: Any, moment: Moment) -> None:
        self._all = as_observables(observe)
        for observable in self._all:
            _check_or_begin(observable, moment)
        takers = [o for o in self._all if o.takes_events]
        only = [o for o in takers if o.schedule is None]
        # Those with samples get their events before each; the others must not notice that.
        self._own = {id(o): Cutter([o], moment) for o in takers if o.schedule is not None}
        self._cutters = [*self._own.values(), *([Cutter(only, moment)] if only else [])]
        self.takes_events = len(takers) > 0
        self._sample(moment)

    @property
    def due(self) -> float:
        """Time at which somebody wants to see the state; inf if nobody ever does."""
        return min((o.next_sample for o in self._all), default=math.inf)

    def events(self, records: NDArray[Any]) -> None:
        """Pass on events."""
        for cutter in self._cutters:
            cutter.add(records)

    def moment(self, moment: Moment) -> None:
        """Let those look whose time has come."""
        if moment.time >= self.due:
            self._sample(moment)

    def _sample(self, moment: Moment) -> None:
        for observable in self._all:
            while observable.next_sample <= moment.time:
                if id(observable) in self._own:
                    self._own[id(observable)].flush(moment.time)
                observable.sample(moment)
                observable.samples += 1

    def end(self, moment: Moment) -> None:
        """Finish the run; all have then seen all of it."""
        for cutter in self._cutters:
            cutter.flush(moment.time)
        for observable in self._all:
            observable.end(moment)
            observable.seen, observable.world = moment.state, moment.world


def as_observables(observe: Any) -> list[Observable]:
    """A list of observables from one or several.

    Raises
    ------
    InputError
        If something else is among them, or one twice.
    """
    several = isinstance(observe, Iterable) and not isinstance(observe, (str, bytes))
    found = list(observe) if several else [observe]
    for one in found:
        if not isinstance(one, Observable):
            msg = f"observe= takes observables such as carom.observe.MSD(), not {one!r:.60}"
            raise InputError(msg)
    if len({id(one) for one in found}) < len(found):
        msg = "observe= holds one observable twice; give each once"
        raise InputError(msg)
    return found


def _check_or_begin(observable: Observable, moment: Moment) -> None:
    if observable.seen is None:
        observable.begun = moment.time
        observable.begin(moment)
        _check_pace(observable, moment)
    elif observable.world is not moment.world or not _same(observable.seen, moment.state):
        msg = (
            f"this {observable.name} has measured up to time {observable.seen.time:.6g}, and since "
            "then the simulation ran or was changed without it; take a new one"
        )
        raise InputError(msg)


def _check_pace(observable: Observable, moment: Moment) -> None:
    """Refuse to look so often that time would never get anywhere."""
    again = math.inf if observable.schedule is None else observable.schedule.again
    least = LEAST * mechanics.crossing_time(moment.state, moment.world)
    if again < least:
        msg = (
            f"{observable.name} would look at the spheres each {again:g}, and no run would get "
            f"far; let it look at most once in {least:.2g}, in which spheres move 1e-6 radii"
        )
        raise InputError(msg)


def _same(a: State, b: State) -> bool:
    if a is b:
        return True
    same = a.time == b.time and len(a) == len(b)
    return same and all(
        np.array_equal(getattr(a, name), getattr(b, name))
        for name in ("position", "velocity", "radius", "mass")
    )
