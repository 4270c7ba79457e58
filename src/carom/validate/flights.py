"""A dilute gas: how long and far spheres fly; and how fast they are, many and few."""

import math

import numpy as np

from carom import theory
from carom.observe import Batch, Estimate, FreePath, FreeTime, Moment, Observable, SpeedDistribution
from carom.observe.observable import every
from carom.random_numbers import Random
from carom.simulation import Simulation
from carom.state import Floats
from carom.validate import references as known
from carom.validate.row import Check, Found, Panel
from carom.validate.runs import count, fluid, of_blocks, ratio_of_blocks

PHI, N = 0.005, 1000
#: Partners in a gas of this packing fraction know a little of one another.
CHAOS = 2e-3
FREE = "kinetic theory of the dilute gas"
FEW = "R. B. Shirts et al., J. Chem. Phys. 125, 164102 (2006)"


class Times(FreeTime):
    """Free times, all of them."""

    def begin(self, moment: Moment) -> None:
        """None yet."""
        super().begin(moment)
        self.batches: list[Floats] = []

    def _count(self, gone: Floats) -> None:
        super()._count(gone)
        self.batches.append(gone)


class ToNext(Observable):
    """Way of every sphere from a moment to its next collision: Tait's free path."""

    def __init__(self, interval: float) -> None:
        self.schedule = every(interval)

    def begin(self, moment: Moment) -> None:
        """No moment yet."""
        self._means: list[float] = []
        self._waiting = np.zeros(len(moment.state), np.bool_)
        self._way = np.zeros(len(moment.state))

    def events(self, batch: Batch) -> None:
        """End the way of those that collide for the first time."""
        if not self._waiting.any():
            return
        who = np.stack([batch.i, batch.j], axis=1).ravel()
        sphere, first = np.unique(who, return_index=True)
        here = self._waiting[sphere]
        ended = sphere[here]
        self._way[ended] = self._speed[ended] * (batch.time[first[here] // 2] - self._from)
        self._waiting[ended] = False
        if not self._waiting.any():
            self._means.append(float(self._way.mean()))

    def sample(self, moment: Moment) -> None:
        """Begin anew; what still waits then is flown on in the mean of the next."""
        if self._waiting.any():
            return
        self._speed = np.sqrt((moment.state.velocity**2).sum(axis=1))
        self._from = moment.time
        self._waiting[:] = True

    def result(self) -> Estimate:
        """Mean over the moments."""
        return of_blocks(self._means)


def free_flights(size: float) -> list[Found]:
    """Means, moments and survival of free times; free paths after a collision and from a moment."""
    sim = fluid(N, PHI, per_sphere=20)
    mean_time = float(theory.mean_free_time(PHI))
    times, path, tait = Times(), FreePath(), ToNext(3 * mean_time)
    collisions = count(size, 2e6)
    sim.run(collisions=collisions, observe=[times, path, tait])
    found = Found(f"gas, φ = {PHI:g}", N, collisions)
    found.against("flights-time", "mean free time", times.mean(), mean_time, FREE, 1e-3 * mean_time)
    mean_path = float(theory.mean_free_path(PHI))
    found.against("flights-path", "mean free path", path.mean(), mean_path, FREE, 1e-3 * mean_path)
    from_now = known.TAIT * math.pi / 6 / PHI / float(theory.contact_value(PHI))
    found.against(
        "flights-tait", "path from a moment on", tait.result(), from_now, known.QUADRATURE,
        CHAOS * from_now,
    )  # fmt: skip
    parts = [np.concatenate(part) for part in np.array_split(np.array(times.batches, object), 40)]
    counts = np.array([len(part) for part in parts], np.float64)
    mean = sum(part.sum() for part in parts) / counts.sum()
    squares = np.array([(part**2).sum() for part in parts])
    second = ratio_of_blocks(squares / mean**2, counts)
    found.against(
        "flights-squares", "⟨τ²⟩/⟨τ⟩²", second, known.TAU_SQUARED, known.QUADRATURE,
        CHAOS * known.TAU_SQUARED,
    )  # fmt: skip
    # The last by the formula, which is the same quadrature done here.
    survival = {**known.SURVIVAL, 3: 1 - float(theory.free_time_cdf(3.0))}
    for k, expected in survival.items():
        longer = np.array([(part > k * mean).sum() for part in parts], np.float64)
        name = f"share of flights above {k} τ"
        found.against(
            f"flights-above-{k}", name, ratio_of_blocks(longer, counts), expected,
            known.QUADRATURE, CHAOS * expected,
        )  # fmt: skip
    found.panels.append(_density(times))
    return [found]


def _density(times: FreeTime) -> Panel:
    table = times.result()
    seen = table["density"] > 0
    x, line = table["time"][seen], table["density_theory"][seen]
    y, error = table["density"][seen] / line, table["density_error"][seen] / line
    return Panel(
        "Free times", "time, in units of 1/√(kT/m)", "density over theory", x, y, error,
        x, np.ones(len(x)),
    )  # fmt: skip


def small(n: int, size: float) -> tuple[Simulation, int]:
    """A few spheres in a periodic cube, in equilibrium; and how many collisions to measure."""
    return fluid(n, 0.1, per_sphere=400), count(size, 1e6)


class Moments(Observable):
    """<v^4>/<v^2>^2 and <v>/sqrt(<v^2>), at moments far enough apart."""

    def __init__(self, interval: float) -> None:
        self.schedule = every(interval)

    def begin(self, moment: Moment) -> None:
        """None yet."""
        self._sums: list[tuple[float, float, float]] = []

    def sample(self, moment: Moment) -> None:
        """Add up."""
        squares = (moment.state.velocity**2).sum(axis=1)
        self._sums.append(
            (float((squares**2).mean()), float(squares.mean()), float(np.sqrt(squares).mean()))
        )

    def result(self) -> Estimate:
        """<v^4>/<v^2>^2, the energy being given."""
        fourth, second, _ = np.transpose(self._sums)
        return of_blocks(fourth / second**2)

    def mean_speed(self) -> Estimate:
        """<v>/sqrt(<v^2>)."""
        _, second, first = np.transpose(self._sums)
        return of_blocks(first / np.sqrt(second))


def few(size: float) -> list[Found]:
    """Six spheres do not follow Maxwell's law, but one that is exact for six."""
    n, mean_time = 6, float(theory.mean_free_time(0.1))
    sim, collisions = small(n, size / 5)
    moments = Moments(5 * mean_time)
    sim.run(collisions=collisions, observe=moments)
    found = Found("6 spheres, φ = 0.1", n, collisions)
    energy = 1.5 * (n - 1)
    v = np.linspace(0, math.sqrt(2 * energy), 20_001)
    pdf = theory.few_speed_pdf(v, n, energy)
    second = float(np.trapezoid(v**2 * pdf, v))
    fourth = float(np.trapezoid(v**4 * pdf, v)) / second**2
    first = float(np.trapezoid(v * pdf, v)) / math.sqrt(second)
    found.against("few-fourth", "⟨v⁴⟩/⟨v²⟩²", moments.result(), fourth, FEW)
    found.against("few-first", "⟨v⟩/√⟨v²⟩", moments.mean_speed(), first, FEW)
    maxwell = "Maxwell and Boltzmann, for infinitely many"
    found.unlike("few-maxwell", "⟨v⁴⟩/⟨v²⟩²", moments.result(), 5 / 3, maxwell)
    found.unlike(
        "few-maxwell-first",
        "⟨v⟩/√⟨v²⟩",
        moments.mean_speed(),
        math.sqrt(8 / (3 * math.pi)),
        maxwell,
    )
    return [found]


def towards_maxwell(size: float) -> list[Found]:
    """A thousand spheres that all start equally fast come to Maxwell's law."""
    n, phi = 1000, 0.1
    sim = fluid(n, phi, per_sphere=2)
    direction = Random(5).direction(n)
    velocity = direction - direction.mean(axis=0)
    sim.velocity = velocity * math.sqrt((3 * n - 3) / float((velocity**2).sum()))
    sim.run(collisions=20 * n)
    speeds = SpeedDistribution()
    moments = Moments(5 * float(theory.mean_free_time(phi)))
    collisions = count(size, 1e6)
    sim.run(collisions=collisions, observe=[speeds, moments])
    found = Found("1000 spheres, equal speeds at first", n, collisions)
    square = speeds.chi_square()
    off = Estimate(square.value / square.freedom, math.sqrt(2 / square.freedom), square.freedom)
    found.against("maxwell-chi", "χ² of the speeds per bin", off, 1.0, "statistics")
    # Of 3 N - 3 squares with a given sum: times f/(f + 2), and N/(N - 1) for the mean square.
    f = 3 * n - 3
    fourth = 5 / 3 * f / (f + 2)
    found.against(
        "maxwell-fourth", "⟨v⁴⟩/⟨v²⟩²", moments.result(), fourth, "Maxwell, for N spheres"
    )
    v = np.linspace(0, 12, 20_001)
    first = float(np.trapezoid(v * theory.maxwell_speed_pdf(v), v)) / math.sqrt(3)
    found.against("maxwell-first", "⟨v⟩/√⟨v²⟩", moments.mean_speed(), first, "Maxwell", 1 / (4 * f))
    table = speeds.result()
    keep = table["density_theory"] > 1e-5
    x, line = table["speed"][keep], table["density_theory"][keep]
    found.panels.append(
        Panel(
            "Speeds of 1000 spheres",
            "speed",
            "density over theory",
            x,
            table["density"][keep] / line,
            np.nan_to_num(table["density_error"][keep] / line),
            x,
            np.ones(len(x)),
        )
    )
    return [found]


def checks() -> list[Check]:
    """All of this file."""
    return [
        Check("flights", "flights", free_flights, 8.0, 3),
        Check("few", "speeds", few, 1.5, 4),
        Check("maxwell", "speeds", towards_maxwell, 1.2, 4),
    ]
