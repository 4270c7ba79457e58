"""The distribution of speeds, and how a gas comes to it."""

import math
from typing import NamedTuple

import numpy as np

from carom import mechanics, theory
from carom.errors import InputError
from carom.observe.batch import Moment
from carom.observe.kinds import Kinds, conserves_energy, one_kind, unmoved
from carom.observe.sampled import Sampled
from carom.observe.series import poisson
from carom.observe.table import Table
from carom.state import Floats

BINS = 60
FEWEST = 5.0  #: expected in a bin, or it is joined with its neighbour: what chi-square needs


class ChiSquare(NamedTuple):
    """Whether counts follow a law.

    `value` is chi-square of the bins, `freedom` how many of them are free; `p` is the
    probability that counts are as far off by chance.
    """

    value: float
    freedom: int
    p: float

    @classmethod
    def of(cls, counts: Floats, expected: Floats, given: int) -> "ChiSquare":
        """Join bins of few, and compare; `given` numbers were taken from the counts."""
        groups, filled = np.zeros(len(counts), np.int64), 0.0
        for k in range(len(counts)):
            groups[k] = groups[k - 1] + (filled >= FEWEST) if k else 0
            filled = expected[k] + (filled if k and groups[k] == groups[k - 1] else 0.0)
        if filled < FEWEST:
            groups[groups == groups[-1]] = max(0, groups[-1] - 1)
        o, e = np.bincount(groups, counts), np.bincount(groups, expected)
        value, freedom = float(((o - e) ** 2 / e).sum()), len(o) - given
        if freedom < 1:
            return cls(value, freedom, math.nan)
        # Wilson and Hilferty: the cube root is nearly normal; p is good to 0.003.
        spread = 2 / (9 * freedom)
        z = ((value / freedom) ** (1 / 3) - 1 + spread) / math.sqrt(spread)
        return cls(value, freedom, math.erfc(z / math.sqrt(2)) / 2)


def _moving(moment: Moment, name: str) -> tuple[Kinds, float]:
    """The only kind of spheres, and their temperature; refused where there is none."""
    kinds = one_kind(moment.state, name)
    kT = mechanics.temperature(moment.state, moment.world)
    if not kT > 0:
        msg = f"{name} needs spheres that move against one another; give them velocities"
        raise InputError(msg)
    return kinds, kT


class SpeedDistribution(Sampled):
    """Distribution of speeds about the motion of the whole, against the law it should follow.

    N spheres that share a fixed energy cannot quite follow Maxwell and Boltzmann. Where all
    momentum is conserved the law is exactly `carom.theory.few_speed_cdf`; between walls, where
    none is, it is that of one sphere more. Elsewhere it is Maxwell's at the temperature where
    measuring begins. Errors, and `chi_square`, take samples for independent: look rarely enough
    (each five mean free times, if not told). Result: `Table`.

    Parameters
    ----------
    every, at
        As of `Sampled`.
    """

    apart = 5.0

    def begin(self, moment: Moment) -> None:
        """Choose the bins."""
        super().begin(moment)
        state, world = moment.state, moment.world
        kinds, kT = _moving(moment, self.name)
        self._free = ~state.fixed
        mass, n = float(kinds.mass[0]), int(kinds.count[0])
        thermal = math.sqrt(kT / mass)
        self._edges = 6 * thermal * np.arange(BINS + 1) / BINS
        self._counts = np.zeros(BINS + 1)
        conserved = len(mechanics.conserved_axes(state, world))
        few = n if conserved else n + 1  # walls take the place of one sphere
        if conserves_energy(world) and conserved in (0, 3) and few >= 3:
            self._law = "the law of spheres that share a fixed energy"
            energy = 1.5 * kT * (n - 1 if conserved else n + 1)
            slower = theory.few_speed_cdf(self._edges, few, energy, mass)
        else:
            self._law = "Maxwell's law"
            slower = theory.maxwell_speed_cdf(self._edges, kT, mass)
        share: Floats = np.diff(slower)
        self._share = share / share.sum()

    def sample(self, moment: Moment) -> None:
        """Count."""
        velocity = unmoved(moment.state, moment.world)[self._free]
        speed = np.sqrt((velocity * velocity).sum(axis=1))
        place = np.minimum(speed * (1 / self._edges[1]), BINS).astype(np.int64)
        self._counts += np.bincount(place, minlength=BINS + 1)

    def chi_square(self) -> ChiSquare:
        """Compare with the law; speeds beyond six thermal ones count in the last bin."""
        self.over_samples()
        counts = self._counts[:-1].copy()
        counts[-1] += self._counts[-1]
        return ChiSquare.of(counts, self._share * counts.sum(), given=1)

    def result(self) -> Table:
        """The distribution so far."""
        found = self.chi_square()
        width = self._edges[1]
        per = 1 / (self._counts.sum() * width)
        said = f"chi-square {found.value:.4g} of {found.freedom} degrees of freedom"
        return Table(
            f"Speeds: {said}, p = {found.p:.3f}",
            {
                "speed": (self._edges[1:] + self._edges[:-1]) / 2,
                "density": self._counts[:-1] * per,
                "density_error": poisson(self._counts[:-1]) * per,
                "density_theory": self._share / width,
            },
            {"speed": "length/time", "density": "time/length"},
            self._law,
        )


class HFunction(Sampled):
    """Boltzmann's H, the mean of ln f over the spheres of one kind, as time goes on.

    f(v) comes from a histogram of B speeds of each moment's N spheres, as if all directions were
    alike. That raises H by (B' - 1)/(2 N), B' the bins that are not empty, which is taken off.
    Theory: -(3/2) [1 + ln(2 pi kT/m)], which H falls to. Its error, (B' - 1)/2 N^2 and what ln f
    varies apart from v^2 over N, is that of spheres that share their energy. Result: `Table`
    over time.

    Parameters
    ----------
    every, at
        As of `Sampled`; the beginning is always in it.

    References
    ----------
    L. Boltzmann, Sitzungsber. Akad. Wiss. Wien 66, 275 (1872); the bias: G. A. Miller, in
    Information Theory in Psychology (ed. H. Quastler), Free Press 1955, p. 95.
    """

    _bins = 24

    def begin(self, moment: Moment) -> None:
        """Choose the bins, and look."""
        super().begin(moment)
        state, world = moment.state, moment.world
        kinds, kT = _moving(moment, self.name)
        self._free = ~state.fixed
        thermal = math.sqrt(kT / kinds.mass[0])
        self._width = 4.8 * thermal / self._bins
        self._theory = math.nan
        if conserves_energy(world):
            self._theory = -1.5 * (1 + math.log(2 * math.pi * thermal**2))
        self._readings: list[tuple[float, float, float]] = []
        self._read(moment)

    def sample(self, moment: Moment) -> None:
        """Take the histogram of a moment."""
        if moment.time > self._readings[-1][0]:
            self._read(moment)

    def _read(self, moment: Moment) -> None:
        velocity = unmoved(moment.state, moment.world)[self._free]
        speed = np.sqrt((velocity * velocity).sum(axis=1))
        # The last bin takes all that is faster.
        place = np.minimum(speed / self._width, self._bins - 1).astype(np.int64)
        counts = np.bincount(place, minlength=self._bins)
        shell = 4 / 3 * math.pi * self._width**3 * np.diff(np.arange(self._bins + 1.0) ** 3)
        there = counts > 0
        share = counts[there] / len(speed)
        logs = np.log(share / shell[there])
        mean = float(share @ logs)
        # The energy is given: what ln f has in common with v^2 does not fluctuate.
        square = (np.arange(self._bins)[there] + 0.5) ** 2
        apart, off = square - share @ square, logs - mean
        power = float(share @ apart**2)
        slope = float(share @ (apart * off)) / power if power > 0 else 0.0
        left = float(share @ (off - slope * apart) ** 2)
        bias = (np.count_nonzero(there) - 1) / (2 * len(speed))
        error = math.sqrt(left / len(speed) + bias / len(speed))
        self._readings.append((moment.time, mean - bias, error))

    def result(self) -> Table:
        """All readings."""
        self.last()
        time, value, error = np.array(self._readings).T
        return Table(
            "Boltzmann's H",
            {
                "time": time,
                "h": value,
                "h_error": error,
                "h_theory": np.full(len(time), self._theory),
            },
            {"time": "time"},
            "" if math.isnan(self._theory) else "Maxwell's law, the equilibrium",
        )
