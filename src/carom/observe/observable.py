"""`Observable`: something to measure while time runs."""

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.checks import number
from carom.errors import InputError
from carom.observe.batch import Batch, Moment
from carom.observe.estimate import Estimate
from carom.observe.table import Table, Theory
from carom.state import State
from carom.world import World


class Schedule:
    """Moments at which an observable is shown the state, counted from where it began.

    Parameters
    ----------
    at : sequence of float
        Rising, 0 or more.
    again : float
        After this long all of them come again; inf if they come once.
    """

    def __init__(self, at: Iterable[float], again: float = math.inf) -> None:
        self.at = [float(t) for t in at]
        self.again = again

    def time(self, k: int) -> float:
        """How long after the beginning moment k is; inf if there is none."""
        rounds, place = divmod(k, len(self.at))
        if rounds == 0:
            return self.at[place]
        return rounds * self.again + self.at[place]


def every(interval: Any) -> Schedule:
    """One moment after each interval.

    Raises
    ------
    InputError
        If it is not above 0.
    """
    interval = number("every", interval, above=0)
    return Schedule([interval], interval)


def once(at: Any) -> Schedule:
    """Given moments.

    Raises
    ------
    InputError
        If they are no rising numbers, 0 or more.
    """
    try:
        times = np.atleast_1d(np.asarray(at, np.float64))
    except (TypeError, ValueError):
        times = np.zeros(0)
    if times.ndim != 1 or len(times) == 0 or not np.isfinite(times).all():
        msg = f"at must be one time or a row of times, not {at!r:.60}"
        raise InputError(msg)
    if times[0] < 0 or (np.diff(times) <= 0).any():
        msg = "at must hold rising times, 0 or more, counted from where measuring begins"
        raise InputError(msg)
    return Schedule(times.tolist())


class Observable:
    """Base of all that `carom.Simulation.run` can measure with ``observe=``.

    A class of your own defines `result` and those of `begin`, `events`, `sample` and `end` that
    it needs. All events before a sample have been handed over when it comes. Batches are cut at
    fixed numbers of events, so results do not depend on the machine's speed.
    """

    #: When `sample` is called; may be set in `begin`.
    schedule: Schedule | None = None
    #: Time at which it began, and how many samples were taken; the run keeps these.
    begun: float | None = None
    samples: int = 0
    #: The spheres and the world at the end of the last run that it saw.
    seen: State | None = None
    world: World | None = None

    def begin(self, moment: Moment) -> None:
        """Look at the world when measuring begins, and refuse one where it has no meaning."""

    def events(self, batch: Batch) -> None:
        """Take a batch of events."""

    def sample(self, moment: Moment) -> None:
        """Look at a moment of the schedule."""

    def end(self, moment: Moment) -> None:
        """Look at the end of a run; others may follow."""

    def result(self) -> Estimate | Table:
        """What was measured so far.

        Raises
        ------
        InputError
            If there is too little to say anything.
        """
        raise NotImplementedError

    def theory(self) -> Theory | None:
        """What theory says of an `Estimate`, where it does; tables bring their own column."""
        return None

    @property
    def name(self) -> str:
        """What it is called."""
        return type(self).__name__

    @property
    def duration(self) -> float:
        """How long it has measured.

        Raises
        ------
        InputError
            If it has not begun.
        """
        last = self.last()
        assert self.begun is not None
        return last.time - self.begun

    def last(self) -> State:
        """The spheres at the end of the last run that it saw.

        Raises
        ------
        InputError
            If it has not begun.
        """
        if self.seen is None:
            msg = f"{self.name} has measured nothing yet; give it to run(observe=...)"
            raise InputError(msg)
        return self.seen

    def over_time(self) -> float:
        """Return the duration, of which a mean over time can be taken.

        Raises
        ------
        InputError
            If no time has passed.
        """
        if self.duration == 0:
            msg = f"{self.name} is a mean over time, and no time has passed; run longer"
            raise InputError(msg)
        return self.duration

    def over_samples(self) -> int:
        """Return the number of samples, of which a mean can be taken.

        Raises
        ------
        InputError
            If there is none.
        """
        if self.duration >= 0 and self.samples == 0:
            msg = (
                f"{self.name} has seen no sample in {self.duration:.6g}: the first is due after "
                f"{self.next_sample - (self.begun or 0.0):.6g}; run longer"
            )
            raise InputError(msg)
        return self.samples

    @property
    def next_sample(self) -> float:
        """Time of the next moment to sample; inf if there is none."""
        if self.schedule is None or self.begun is None:
            return math.inf
        return self.begun + self.schedule.time(self.samples)

    @property
    def takes_events(self) -> bool:
        """Whether it wants batches of events."""
        return type(self).events is not Observable.events

    def table(self) -> Table:
        """The result as a table: one row if it is an `Estimate`, with the theory beside it."""
        result = self.result()
        if isinstance(result, Table):
            return result
        return Table.of_estimates(self.name, {self.name: (result, self.theory())})

    def to_pandas(self) -> Any:
        """The result as a pandas DataFrame; see `Table.to_pandas`."""
        return self.table().to_pandas()

    def save(self, path: Any) -> None:
        """Write the result to a file; see `Table.save`."""
        self.table().save(path)

    def plot(self, axes: Any = None) -> Any:
        """Draw the result; see `Table.plot`."""
        return self.table().plot(axes)


def log_times(first: float, last: float, n: int) -> NDArray[np.float64]:
    """Times that rise by equal factors, for the schedule of an observable.

    Parameters
    ----------
    first, last : float
        Above 0.
    n : int
        How many, 2 or more.

    Returns
    -------
    (n,) float64

    Raises
    ------
    InputError
        If they are not above 0 and rising, or n is below 2.

    Examples
    --------
    >>> log_times(0.01, 100, 5).tolist()
    [0.01, 0.1, 1.0, 10.0, 100.0]
    """
    first = number("first", first, above=0)
    last = number("last", last, above=first)
    steps = int(number("n", n, at_least=2)) - 1
    exponent = math.log10(last / first)
    times = np.array([first * 10 ** (exponent * k / steps) for k in range(steps + 1)])
    times[-1] = last
    return times
