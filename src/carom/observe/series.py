"""Sums over blocks of a run: for error bars, in memory that does not grow with the run."""

import math

import numpy as np
from numpy.typing import NDArray

from carom.observe.batch import Batch
from carom.observe.blocking import blocking, ratio, settling
from carom.observe.estimate import Estimate
from carom.state import Floats

EVENTS = 64  #: in the smallest block
MOST = 2**14  #: blocks that are held; then two become one


class Series:
    """Rows of numbers, each the sum over equally many consecutive pieces of a run.

    When there are 2^14 rows, each two neighbours become one. That depends on the number of
    pieces alone, so a measurement comes out the same however a run was sliced.

    Parameters
    ----------
    columns : int
    """

    def __init__(self, columns: int) -> None:
        self._rows = np.zeros((MOST, columns))
        self._waiting = np.zeros((0, columns))
        self._count = 0
        self._size = 1  # pieces in a row

    def add(self, pieces: Floats) -> None:
        """Append pieces, (n, columns) float64."""
        waiting = np.concatenate([self._waiting, pieces])
        while rows := min(len(waiting) // self._size, MOST - self._count):
            taken, waiting = waiting[: rows * self._size], waiting[rows * self._size :]
            summed = taken.reshape(rows, self._size, -1).sum(axis=1)
            self._rows[self._count : self._count + rows] = summed
            self._count += rows
            if self._count == MOST:
                half = MOST // 2
                self._rows[:half] = self._rows.reshape(half, 2, -1).sum(axis=1)
                self._count, self._size = half, 2 * self._size
        self._waiting = waiting

    @property
    def rows(self) -> Floats:
        """(n, columns) float64, the complete ones."""
        return self._rows[: self._count]

    @property
    def total(self) -> Floats:
        """(columns,) float64, the sum of all pieces."""
        result: Floats = self.rows.sum(axis=0) + self._waiting.sum(axis=0)
        return result

    def mean(self, column: int) -> Estimate:
        """Mean of one column over the pieces."""
        pieces = self._count * self._size + len(self._waiting)
        if pieces == 0:
            return Estimate(math.nan, math.nan, math.nan)
        means = self.rows[:, column] / self._size
        about = blocking(means)
        value = float(self.total[column]) / pieces
        return Estimate(value, about.error, about.n_independent, settling(means).note)

    def ratio(self, column: int, by: int, total: Floats | None = None) -> Estimate:
        """Sum of one column over the sum of another; `total` if more than the rows is known."""
        sums = self.total if total is None else total
        rows = self.rows
        about = ratio(rows[:, column], rows[:, by])
        value = float(sums[column] / sums[by]) if sums[by] else math.nan
        good = rows[:, by] > 0  # simultaneous events can fill a block without time
        note = settling(rows[good, column] / rows[good, by]).note
        return Estimate(value, about.error, about.n_independent, note)


class Rates:
    """Sums over events, for each unit of time: blocks of 64 events and how long they took.

    Parameters
    ----------
    columns : int
        Of numbers that each event brings.
    """

    def __init__(self, columns: int) -> None:
        self._series = Series(1 + columns)  # the first is time
        self._rest = np.zeros((0, 1 + columns))
        self._silence = 0.0  # since the last event

    def add(self, batch: Batch, values: NDArray[np.float64]) -> None:
        """Take what the events of a batch bring, (n, columns) float64."""
        n = len(batch)
        if n == 0:
            self._silence += batch.end - batch.start
            return
        rows = np.empty((len(self._rest) + n, 1 + values.shape[1]))
        rows[: len(self._rest)] = self._rest
        new = rows[len(self._rest) :]
        new[1:, 0] = np.diff(batch.time)
        new[0, 0] = batch.time[0] - batch.start + self._silence
        new[:, 1:] = values
        self._silence = batch.end - float(batch.time[-1])
        whole = len(rows) // EVENTS
        blocks = rows[: whole * EVENTS].reshape(whole, EVENTS, rows.shape[1])
        self._series.add(np.einsum("ijk->ik", blocks))  # three times as fast as sum(axis=1)
        self._rest = rows[whole * EVENTS :].copy()

    @property
    def total(self) -> Floats:
        """(1 + columns,) float64: the time, and the sum of each column."""
        result: Floats = self._series.total + self._rest.sum(axis=0)
        result[0] += self._silence
        return result

    @property
    def rows(self) -> Floats:
        """(n, 1 + columns) float64: time and sums of complete blocks."""
        return self._series.rows

    def rate(self, column: int) -> Estimate:
        """Sum of a column over the time."""
        return self._series.ratio(1 + column, 0, self.total)
