"""How often spheres meet."""

import math

import numpy as np
from numpy.typing import NDArray

from carom import mechanics, theory
from carom.errors import InputError
from carom.observe.batch import Batch, Moment
from carom.observe.fluid import FREEZES, UP_TO, fluid_of, in_range, is_gas
from carom.observe.kinds import Kinds, labels
from carom.observe.observable import Observable
from carom.observe.series import Rates
from carom.observe.table import Table
from carom.state import Floats


class CollisionRate(Observable):
    """How often a sphere of one kind meets those of another, for each unit of time.

    A kind is a radius and a mass; fixed spheres and walls do not count. With one kind it is
    omega = 2 collisions/(N t): a collision counts for both partners. Theory, in a periodic box ::

        nu_ab = n_b sigma_ab^2 chi_ab sqrt(8 pi kT/mu_ab)

    as in `carom.theory.pair_rates`; of one kind it is `carom.theory.collision_rate`, with a better
    contact value chi. Result: `Table`, a row for each ordered pair of kinds.

    References
    ----------
    S. Chapman, T. G. Cowling, The Mathematical Theory of Non-Uniform Gases, 3rd ed., Cambridge
    1970, chapters 5 and 16.
    """

    def begin(self, moment: Moment) -> None:
        """Group the spheres."""
        state, world = moment.state, moment.world
        if not world.collide:
            msg = f"{self.name} has nothing to count where collide=False"
            raise InputError(msg)
        self._kinds = kinds = Kinds.few(state, self.name)
        if len(kinds) == 0:
            msg = f"{self.name} is of spheres that move, and all are fixed"
            raise InputError(msg)
        # Pair (a, b) and (b, a) share a column; fixed spheres get the one left out.
        low, high = np.triu_indices(len(kinds))
        self._column = np.full((len(kinds) + 1, len(kinds) + 1), -1)
        self._column[low, high] = self._column[high, low] = np.arange(len(low))
        self._rates = Rates(len(low))
        self._theory, self._said = self._expected(moment)

    def _expected(self, moment: Moment) -> tuple[Floats, str]:
        """Rates by theory, and whose they are."""
        state, world, kinds = moment.state, moment.world, self._kinds
        nothing = np.full((len(kinds), len(kinds)), math.nan)
        if not is_gas(state, world):
            return nothing, ""
        fluid, _ = fluid_of(moment)
        if fluid is not None:
            rate = theory.collision_rate(*fluid)
            name = "Kolafa, Labik and Malijevsky"
            return np.full((1, 1), rate), f"Enskog, contact value of {name}, {UP_TO}"
        volume, kT = mechanics.volume(world), mechanics.temperature(state, world)
        rates = in_range(theory.pair_rates, kinds.radius, volume, kinds.count, kinds.mass, kT)
        if rates is None:
            return nothing, FREEZES
        return rates, f"Enskog, contact values of BMCSL, {UP_TO}"

    def events(self, batch: Batch) -> None:
        """Count."""
        if len(self._kinds) == 1 and batch.all_pairs and not batch.spheres.fixed.any():
            self._rates.add(batch, np.ones(len(batch)))
            return
        kind = self._kinds.of
        partner = np.where(batch.is_pair, kind[batch.j * batch.is_pair], -1)
        self._rates.add(batch, np.ones(len(batch)), self._column[kind[batch.i], partner])

    def result(self) -> Table:
        """The rates so far."""
        self.over_time()
        kinds, names = self._kinds, labels(self._kinds)
        a, b = (x.ravel() for x in np.indices((len(kinds), len(kinds))))
        found = [self._rates.rate(int(self._column[x, y])) for x, y in zip(a, b, strict=True)]
        # A collision of two alike is one for each of them.
        per = np.where(a == b, 2, 1) / kinds.count[a]
        return Table(
            "Collision rates, of one sphere",
            {
                "of": names[a],
                "with": names[b],
                "rate": np.array([e.value for e in found]) * per,
                "rate_error": np.array([e.error for e in found]) * per,
                "rate_theory": self._theory[a, b],
            },
            {"rate": "1/time"},
            self._said,
            tuple(dict.fromkeys(e.note for e in found if e.note)),
        )


class CollisionsPerSphere(Observable):
    """How many collisions each sphere had, with walls too.

    It reads the spheres' own counters where measuring begins and ends, and so costs nothing.
    Result: `Table` of the distribution.
    """

    def begin(self, moment: Moment) -> None:
        """Read the counters."""
        self._free = ~moment.state.fixed
        self._before = moment.state.collision_count.copy()

    def counts(self) -> NDArray[np.int64]:
        """Collisions of each sphere that is not fixed, (N,) int64."""
        since = self.last().collision_count - self._before  # wraps round, as the counters do
        return since[self._free].astype(np.int64)

    def result(self) -> Table:
        """How many spheres had how many."""
        counts = self.counts()
        if len(counts) == 0:
            msg = f"{self.name} is of spheres that move, and all are fixed"
            raise InputError(msg)
        times = np.arange(counts.min(), counts.max() + 1)
        return Table(
            f"Collisions of a sphere: mean {counts.mean():.6g}, variance {counts.var():.4g}",
            {"collisions": times, "spheres": np.bincount(counts - counts.min())},
        )
