"""Free flights: how long, and how far, a sphere goes from one collision to the next."""

import math

import numpy as np
from numpy.typing import NDArray

from carom import theory
from carom.errors import InputError
from carom.observe.batch import Batch, Moment
from carom.observe.estimate import Estimate
from carom.observe.fluid import UP_TO, Fluid, fluid_of
from carom.observe.observable import Observable
from carom.observe.series import Rates, poisson
from carom.observe.table import Table, Theory
from carom.state import Floats

BINS, MEANS = 50, 8.0  #: the distribution goes up to eight means, in fifty bins
FIRST = 1000  #: flights that wait until their mean is known, and with it the width of the bins
EACH, FEWEST = 16, 64  #: each sixteenth sphere is followed, but 64 at least
#: How much larger errors are than those of independent flights, as measured over many runs: two
#: flights end at once, and a fast sphere stays fast for a while.
TOGETHER = 1.15
ENSKOG = f"independent flights in Maxwell's gas, {UP_TO}"


class FreeTime(Observable):
    """Distribution of the time between two events of a sphere, with spheres or walls.

    The flights of every sixteenth sphere (of 64 at least) are followed by the records of
    events: all of them would slow a run down by a third. Of long ones fewer begin and end
    within the run: the density allows for that. Its errors are those of independent flights,
    times 1.15, as a fast sphere stays fast for a while.
    Theory, for one kind of spheres in a periodic box: `carom.theory.free_time_cdf`, its mean
    `carom.theory.mean_free_time`. Result: `Table`; `mean` is an `Estimate`.
    """

    _title, _unit = "Free time", "time"

    def begin(self, moment: Moment) -> None:
        """Start the flight of every sphere."""
        state, world = moment.state, moment.world
        if world.gravity.any():
            msg = f"{self.name} is of flights on straight lines; take gravity away"
            raise InputError(msg)
        n, free = len(state), np.flatnonzero(~state.fixed)
        if len(free) == 0:
            msg = f"{self.name} is of spheres that move, and all are fixed"
            raise InputError(msg)
        self._followed = np.zeros(n, np.bool_)
        self._followed[free[:: max(1, min(EACH, len(free) // FEWEST))]] = True
        self._since = np.full(n, moment.time)
        self._met = np.zeros(n, np.bool_)  # whether its flight began with an event
        self._counts = np.zeros(BINS + 1, np.int64)
        self._width = math.nan  # of the bins, when it is known
        self._early: list[Floats] = []  # flights until then
        self._ends = Rates()  # ends of flights
        self._gone = Rates()  # what flights that ended came to
        self._fluid, self._said = fluid_of(moment)

    def events(self, batch: Batch) -> None:
        """End two flights at each collision, one at each hit of a wall."""
        n = len(batch)
        pairs = np.flatnonzero(batch.j >= 0)
        who = np.concatenate([batch.i, batch.j[pairs]]).astype(np.int64)
        key = np.concatenate([2 * np.arange(n), 2 * pairs + 1])
        here = self._followed[who]
        # Sorting numbers that hold the sphere and the place is ten times as fast as argsort.
        key = (who[here] << 32) | key[here]
        key.sort()
        sphere, place = key >> 32, key & 0xFFFFFFFF
        event = place >> 1
        first = np.ones(len(key), np.bool_)
        first[1:] = sphere[1:] != sphere[:-1]
        gone = self._lengths(batch, sphere, event, place & 1, first)
        met = np.ones(len(key), np.bool_)
        met[first] = self._met[sphere[first]]
        self._met[sphere] = True
        self._gone.add(batch, np.bincount(event, gone, n).astype(np.float64))
        self._ends.add(batch, np.bincount(event, minlength=n).astype(np.float64))
        self._count(gone[met])
        if math.isnan(self._width) and sum(map(len, self._early)) >= FIRST:
            self._width = self._bin(self._mean_until(batch.end))

    def _lengths(
        self,
        batch: Batch,
        sphere: NDArray[np.int64],
        event: NDArray[np.int64],
        partner: NDArray[np.int64],
        first: NDArray[np.bool_],
    ) -> Floats:
        """How long the flights were that ended, in the order of spheres and then of time."""
        end = batch.time[event]
        start = np.empty(len(end))
        start[1:] = end[:-1]
        start[first] = self._since[sphere[first]]
        self._since[sphere] = end  # of several the last one stays
        return end - start

    def _under_way(self, time: float) -> float:
        """What the flights under way came to until a time."""
        return float((time - self._since)[self._followed].sum())

    def _mean_until(self, time: float) -> float:
        """All that was flown over the number of ends: those that ended are the short ones."""
        flown = float(self._gone.total[1]) + self._under_way(time)
        return flown / float(self._ends.total[1])

    @staticmethod
    def _bin(mean: float) -> float:
        return MEANS / BINS * mean if mean > 0 else 1.0

    def _count(self, gone: Floats) -> None:
        self._early.append(gone)
        if not math.isnan(self._width):
            self._counts += self._sorted(self._width)
            self._early = []

    def _sorted(self, width: float) -> NDArray[np.int64]:
        """How many of the flights that wait are in each bin; the last takes all that are longer."""
        gone = np.concatenate(self._early) if self._early else np.zeros(0)
        place = np.minimum(gone * (1 / width), BINS).astype(np.int64)
        return np.bincount(place, minlength=BINS + 1)

    def mean(self) -> Estimate:
        """Mean over the flights: all that was flown, over the number of ends."""
        self.over_time()
        ends = float(self._ends.total[1])
        if ends == 0:
            msg = f"{self.name} has seen no collision in {self.duration:.6g}; run longer"
            raise InputError(msg)
        value = self._mean_until(self.last().time)
        rate = self._ends.rate()
        return Estimate(value, value * rate.error / rate.value, rate.n_independent, rate.note)

    def theory(self) -> Theory | None:
        """The mean of kinetic theory."""
        if self._fluid is None:
            return Theory(math.nan, self._said) if self._said else None
        return Theory(self._mean(self._fluid), ENSKOG)

    def _mean(self, fluid: Fluid) -> float:
        return float(theory.mean_free_time(*fluid))

    def result(self) -> Table:
        """The distribution so far."""
        mean, expected = self.mean(), self.theory()
        width = self._bin(mean.value) if math.isnan(self._width) else self._width
        counts = self._counts + self._sorted(width)
        if not counts.any():
            msg = f"{self.name} has seen no sphere collide twice in {self.duration:.6g}; run longer"
            raise InputError(msg)
        edges = width * np.arange(BINS + 1, dtype=np.float64)
        x = (edges[1:] + edges[:-1]) / 2
        # Of flights of length x there is room for T - x within the time T.
        room = np.maximum(1 - self._as_time(x) / self.duration, 0)
        with np.errstate(divide="ignore", invalid="ignore"):
            per = 1 / (float(self._ends.total[1]) * width * room)
            density, error = counts[:-1] * per, poisson(counts[:-1]) * (TOGETHER * per)
        line, said = np.full(BINS, math.nan), ""
        if self._fluid is not None:
            line = np.diff(self._below(edges, self._mean(self._fluid))) / width
            said = f", theory {self._mean(self._fluid):.6g}"
        return Table(
            f"{self._title}: mean {mean}{said}",
            {
                self._unit: x,
                "density": density,
                "density_error": error,
                "density_theory": line,
            },
            {self._unit: self._unit, "density": f"1/{self._unit}"},
            "" if expected is None else expected.label,
            (mean.note,) if mean.note else (),
        )

    def _as_time(self, x: Floats) -> Floats:
        return x

    def _below(self, x: Floats, mean: float) -> Floats:
        """How many flights are shorter."""
        below: Floats = theory.free_time_cdf(x, 1 / mean)
        return below


class FreePath(FreeTime):
    """Distribution of the distance that a sphere goes between two events.

    Speeds follow from the start and the impulses. Theory: `carom.theory.free_path_cdf`, its mean
    `carom.theory.mean_free_path`. Otherwise as `FreeTime`.
    """

    _title, _unit = "Free path", "length"

    def begin(self, moment: Moment) -> None:
        """Start the flight of every sphere at its velocity."""
        super().begin(moment)
        self._velocity = moment.state.velocity.T.copy()
        self._speed = np.sqrt((self._velocity**2).sum(axis=0))

    def _lengths(
        self,
        batch: Batch,
        sphere: NDArray[np.int64],
        event: NDArray[np.int64],
        partner: NDArray[np.int64],
        first: NDArray[np.bool_],
    ) -> Floats:
        """Times, by the speed before each event."""
        time = super()._lengths(batch, sphere, event, partner, first)
        weight = (1 - 2 * partner) / batch.spheres.mass[sphere]
        begins = np.flatnonzero(first)
        group = np.cumsum(first) - 1
        square = np.zeros(len(time))
        for axis in range(3):
            kick = batch.impulse[axis][event] * weight
            summed = np.cumsum(kick)
            base = self._velocity[axis][sphere[begins]] - summed[begins] + kick[begins]
            after = summed + base[group]
            square += after * after
            self._velocity[axis][sphere] = after  # of several the last one stays
        after = np.sqrt(square)
        before = np.empty(len(time))
        before[1:] = after[:-1]
        before[first] = self._speed[sphere[begins]]
        self._speed[sphere] = after
        return time * before

    def _under_way(self, time: float) -> float:
        flown = (time - self._since) * self._speed
        return float(flown[self._followed].sum())

    def _mean(self, fluid: Fluid) -> float:
        return float(theory.mean_free_path(fluid.packing_fraction, fluid.radius))

    def _as_time(self, x: Floats) -> Floats:
        flown = float(self._gone.total[1]) + self._under_way(self.last().time)
        return x * (np.count_nonzero(self._followed) * self.duration / flown)

    def _below(self, x: Floats, mean: float) -> Floats:
        below: Floats = theory.free_path_cdf(x, mean)
        return below
