"""Helfand's moments: transport coefficients from how far integrals of fluxes wander."""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from carom import mechanics
from carom._core import Helfand as Moments
from carom.checks import number
from carom.errors import InputError
from carom.observe.batch import Batch, Moment
from carom.observe.estimate import Estimate
from carom.observe.fluid import Fluid, fluid_of
from carom.observe.kinds import mean_free_time, refuse_losses, refuse_walls, unmoved
from carom.observe.observable import Observable
from carom.observe.series import Series
from carom.observe.table import Table, Theory
from carom.state import Floats, State

LAGS = 24  #: equal steps up to the later lag; at each of them a window begins
AT_ONCE = 4096  #: windows that are worked on together, for the sake of memory


class Kinetic(NamedTuple):
    """A coefficient in Enskog's theory: a part without memory, and one that forgets."""

    instant: float
    remembered: float
    memory: float  # the time in which it forgets
    label: str

    @property
    def value(self) -> float:
        """The coefficient."""
        return self.instant + self.remembered

    def line(self, t: Floats) -> Floats:
        """Its moment at lags t, as an exponential memory gives it."""
        if self.memory == 0:
            return self.value * t
        late = self.memory * (1 - np.exp(-t / self.memory))
        line: Floats = self.instant * t + self.remembered * (t - late)
        return line


class Helfand(Observable):
    """Base of transport coefficients by the Einstein relation of a flux.

    With G the integral of the flux over time, a coefficient is the slope of the moment
    c <[G(t) - G(0)]^2> between two lags. Windows begin at each 24th of the later lag and overlap;
    the error is that of blocks of windows.

    Parameters
    ----------
    between : (float, float), optional
        The two lags. The earlier is moved to the nearest 24th of the later.
    """

    _title, _unit, _lag_unit = "", "", ""  # of the coefficient; the unit times time
    _natural_lags = (5.0, 20.0)  # in mean free times
    _has_mean = False  # whether the flux has a mean, which is taken off

    def __init__(self, between: Any = None) -> None:
        self._between = None if between is None else _two_lags(between)

    def begin(self, moment: Moment) -> None:
        """Refuse a world without equilibrium, or without collisions."""
        state, world = moment.state, moment.world
        refuse_walls(world, self.name, "take carom.Periodic")
        refuse_losses(world, self.name)
        self._kT = mechanics.temperature(state, world)
        if not world.collide or state.fixed.any() or not self._kT > 0:
            msg = f"{self.name} is of spheres that all move and collide"
            raise InputError(msg)
        self._volume = mechanics.volume(world)
        self._fluid, self._said = fluid_of(moment)
        charge = self._charge(state)
        self._kinetic = self._enskog(moment)
        early, late = self._between or self._natural(moment)
        shortest = mean_free_time(state, world)
        if late < shortest:
            msg = (
                f"between ends at {late:.6g}, and spheres fly for {shortest:.6g} before they "
                f"collide; {self.name} needs lags of several such times"
            )
            raise InputError(msg)
        self._step = late / LAGS
        self._early = min(max(round(early / self._step), 1), LAGS - 1)
        velocity = np.ascontiguousarray(unmoved(state, world))
        self._moments = Moments(velocity, state.mass, state.radius, charge, moment.time)
        self._looked = 0  # times at which G was looked at, after the first
        self._kept = self._components(np.zeros((1, 12)))
        self._series = Series(LAGS * (2 if self._has_mean else 1))

    def _charge(self, state: State) -> Floats:
        """What each sphere carries, where a flux of it is asked for."""
        return np.zeros(len(state))

    def _enskog(self, moment: Moment) -> Kinetic | None:
        """What theory says of this fluid."""
        return None if self._fluid is None else self._known(self._fluid)

    def _known(self, fluid: Fluid) -> Kinetic:
        raise NotImplementedError

    def _natural(self, moment: Moment) -> tuple[float, float]:
        """The lags if none are given."""
        scale = mean_free_time(moment.state, moment.world)
        early, late = self._natural_lags
        return early * scale, late * scale

    def _components(self, moments: Floats) -> Floats:
        """(n, C): equivalent components of G, from the (n, 12) of the core."""
        raise NotImplementedError

    def _scale(self) -> float:
        """c, so that c <G^2> rises by the coefficient."""
        return 1 / (2 * self._volume * self._kT)

    def events(self, batch: Batch) -> None:
        """Add up fluxes, and compare G with what it was."""
        assert self.begun is not None
        # A run of just so many steps may end a rounding error before the last of them.
        last = math.floor((batch.end - self.begun) / self._step + 1e-9)
        times: Floats = self.begun + self._step * np.arange(self._looked + 1.0, last + 1)
        records = np.ascontiguousarray(batch.records).view(np.uint8)
        found = self._components(self._moments.advance(records, times))
        self._looked += len(times)
        for k in range(0, len(found), AT_ONCE):
            self._compare(found[k : k + AT_ONCE])

    def _compare(self, new: Floats) -> None:
        """Close the windows that end at the newest times."""
        rows = np.concatenate([self._kept, new])
        self._kept = rows[-LAGS:]
        if len(rows) <= LAGS:
            return
        seen = sliding_window_view(rows, LAGS + 1, axis=0)  # (windows, C, LAGS + 1)
        gained = seen[:, :, -1:] - seen[:, :, -2::-1]
        squares = np.einsum("wcl,wcl->wl", gained, gained) / gained.shape[1]
        self._series.add(np.hstack([squares, gained[:, 0]]) if self._has_mean else squares)

    def _moment(self, weights: Floats) -> Estimate:
        """A sum over lags of weights times moments."""
        fewest = 2 * LAGS if self._has_mean else LAGS  # of one window the mean hides all
        if self._looked < fewest:
            msg = (
                f"{self.name} needs a run of {fewest * self._step:.6g} at least, and has seen "
                f"{self.duration:.6g}; run longer, or give between="
            )
            raise InputError(msg)
        weights = weights * self._scale()
        if not self._has_mean:
            return self._series.weighted(weights)
        # <(G - p t)^2> with the measured mean p, which follows G: of a whole run's rise the share
        # t/T is lost, and put back here.
        whole = self._looked * self._step
        mean = float(self._kept[-1, 0]) / whole
        t = self._step * np.arange(1, LAGS + 1)
        weights = weights / (1 - t / whole)
        both = np.concatenate([weights, -2 * mean * t * weights])
        found, shift = self._series.weighted(both), float(weights @ (mean * t) ** 2)
        return Estimate(found.value + shift, found.error, found.n_independent, found.note)

    def moments(self) -> Table:
        """The moment at each lag, which rises by the coefficient in the end.

        Returns
        -------
        Table
            Columns ``time`` and ``moment``; `plot` draws it.

        Raises
        ------
        InputError
            If the run was shorter than the later lag.
        """
        self.last()
        found = [self._moment(weights) for weights in np.eye(LAGS)]
        time: Floats = self._step * np.arange(1.0, LAGS + 1)
        known = self._kinetic
        return Table(
            self._title,
            {
                "time": time,
                "moment": np.array([e.value for e in found]),
                "moment_error": np.array([e.error for e in found]),
                "moment_theory": np.full(LAGS, math.nan) if known is None else known.line(time),
            },
            {"time": "time", "moment": self._lag_unit},
            self._said if known is None else known.label,
        )

    def result(self) -> Table:
        """The coefficient so far."""
        self.last()
        early, late = self._early * self._step, LAGS * self._step
        weights = np.zeros(LAGS)
        weights[[self._early - 1, -1]] = -1 / (late - early), 1 / (late - early)
        found, known = self._moment(weights), self._kinetic
        expected = Theory(known.value, known.label) if known else None
        table = Table.of_estimates(self._title, {self._title.lower(): (found, expected)})
        columns = dict(table.columns)
        if known:
            columns["ratio"] = columns["value"] / known.value
            columns["ratio_error"] = columns["value_error"] / known.value
        notes = (f"slope between lags of {early:.4g} and {late:.4g}", *table.notes)
        said = table.theory or self._said
        return Table(table.title, columns, {"value": self._unit}, said, notes)

    def plot(self, axes: Any = None) -> Any:
        """Draw the moments, whose slope is the coefficient; see `Table.plot`."""
        return self.moments().plot(axes)


def _two_lags(between: Any) -> tuple[float, float]:
    try:
        early, late = between
    except (TypeError, ValueError):
        msg = f"between must be two lags, not {between!r:.60}"
        raise InputError(msg) from None
    early = number("the first lag of between", early, above=0)
    return early, number("the second lag of between", late, above=early)
