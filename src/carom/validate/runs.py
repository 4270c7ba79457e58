"""What the checks share: simulations in equilibrium, means of blocks, pieces of runs."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.bench import starts
from carom.observe import Batch, Estimate, Moment, Observable
from carom.observe.blocking import ratio
from carom.simulation import Simulation
from carom.state import Floats
from carom.walls import Periodic


def fluid(n: int, packing_fraction: float, per_sphere: float = 100) -> Simulation:
    """Equal spheres in a periodic cube at kT = 1, after so many collisions of each.

    They start on lattice sites of which a fifth are empty, so that they melt just below freezing.
    """
    state, world = starts.fluid(n, packing_fraction)
    sim = Simulation(walls=Periodic(*world.period))
    sim.add_many(state.position, velocity=state.velocity)
    sim.run(collisions=int(per_sphere * n / 2))
    return sim


def of_blocks(values: Any) -> Estimate:
    """Mean of numbers that know nothing of one another, with Student's correction."""
    values = np.asarray(values, np.float64)
    n = len(values)
    error = float(values.std(ddof=1)) / math.sqrt(n) * (1 + 1 / (2 * (n - 1)))
    return Estimate(float(values.mean()), error, n)


def ratio_of_blocks(sums: Floats, weights: Floats) -> Estimate:
    """Sum over sum, of blocks that know nothing of one another."""
    value = float(sums.sum() / weights.sum())
    off = of_blocks((sums - value * weights) / weights.mean())
    return Estimate(value, off.error, off.n_independent)


def scaled(estimate: Estimate, factor: float, shift: float = 0.0) -> Estimate:
    """Return factor x + shift."""
    return Estimate(
        factor * estimate.value + shift, abs(factor) * estimate.error, estimate.n_independent
    )


def count(size: float, at_one: float) -> int:
    """A number of collisions."""
    return max(1, int(size * at_one))


class Impulses(Observable):
    """Mean impulse |J| of a collision of two spheres."""

    def begin(self, moment: Moment) -> None:
        """Nothing yet."""
        self._sums: list[tuple[float, float]] = []

    def events(self, batch: Batch) -> None:
        """Add up in blocks."""
        size = batch.size[batch.is_pair]
        self._sums += [(float(part.sum()), float(len(part))) for part in np.array_split(size, 8)]

    def result(self) -> Estimate:
        """The mean so far."""
        sums = np.array(self._sums)
        sums = sums[sums[:, 1] > 0]
        return ratio(sums[:, 0], sums[:, 1])


def mean_of(records: NDArray[Any]) -> Floats:
    """Lengths of the impulses of event records."""
    impulse = records["impulse"]
    lengths: Floats = np.sqrt((impulse * impulse).sum(axis=1))
    return lengths


def columns(row: dict[str, str], *names: str) -> Floats:
    """Numbers of a row of a table."""
    return np.array([float(row[name]) for name in names])
