"""Where spheres are: around one another, and along an axis."""

import math

import numpy as np
from numpy.typing import NDArray

from carom import mechanics, theory
from carom.checks import number
from carom.errors import InputError
from carom.observe.batch import Moment
from carom.observe.fluid import in_range
from carom.observe.kinds import Kinds, conserves_energy, is_elastic, refuse_walls
from carom.observe.sampled import Sampled
from carom.observe.series import Series, poisson
from carom.observe.table import Table
from carom.state import Floats, State
from carom.world import PLANE, World

POINTS = 50  #: in a layer, for the mean of a theory over it
_FLOOR = theory.about(theory.barometric_density).ranges["floor_packing_fraction"]
THIN = f"up to packing fraction {_FLOOR.high} at the floor"
CROWDED = f"none, the barometric formula holds {THIN}"
CENTRES = 500  #: spheres around which one sample counts the others


class RDF(Sampled):
    """Radial distribution g(r): spheres at a distance, over those that chance would put there.

    In a periodic box, over all spheres alike. Each sample looks around 500 spheres, others each
    time. Errors are those of independent counts. Result: `Table`, at the middles of 0.02
    mean diameters, from where the smallest spheres touch.

    Parameters
    ----------
    reach : float, optional
        Largest distance; three mean diameters if left out, or half the shortest side.
    every, at
        As of `Sampled`, but a hundred mean free times if left out: counting pairs takes long.

    References
    ----------
    M. P. Allen, D. J. Tildesley, Computer Simulation of Liquids, 2nd ed., Oxford 2017,
    section 8.2.
    """

    apart = 100.0

    def __init__(
        self, reach: float | None = None, every: float | None = None, *, at: object = None
    ) -> None:
        super().__init__(every, at=at)
        self._asked = None if reach is None else number("reach", reach, above=0)

    def begin(self, moment: Moment) -> None:
        """Refuse what has no mean density."""
        super().begin(moment)
        state, world = moment.state, moment.world
        refuse_walls(world, self.name, "take carom.Periodic, or there is no mean density")
        diameter, half = 2 * float(state.radius.mean()), float(world.period.min()) / 2
        self._reach = min(3 * diameter, half) if self._asked is None else self._asked
        if self._reach > half:
            msg = f"reach is {self._reach:g}, more than half the shortest side, {half:.6g}"
            raise InputError(msg)
        bins = max(1, round(self._reach / (0.02 * diameter)))
        self._counts = np.zeros(bins)
        self._contact = 2 * float(state.radius.min()) if world.collide else 0.0
        if self._contact >= self._reach or len(state) < 2:
            msg = f"{self.name} reaches to {self._reach:.6g}, where no two spheres can be"
            raise InputError(msg)
        self._centres, self._offset = 0, 0
        self._density = (len(state) - 1) / mechanics.volume(world)

    def sample(self, moment: Moment) -> None:
        """Count the others around some spheres."""
        n = len(moment.state)
        some = min(n, CENTRES)
        # Neighbours in number are often neighbours in space: take them from everywhere.
        centres = (self._offset + np.arange(some) * n // some) % n
        self._offset += 1
        distance = distances(moment.state.position, moment.world.period, centres, self._reach)
        found, _ = np.histogram(distance, len(self._counts), (0, self._reach))
        self._counts += found
        self._centres += some

    def result(self) -> Table:
        """g(r) so far."""
        self.over_samples()
        edges = np.linspace(0, self._reach, len(self._counts) + 1)
        edges = edges[np.searchsorted(edges, self._contact, "right") - 1 :]
        counts = self._counts[len(self._counts) + 1 - len(edges) :]
        expected = self._centres * self._density * 4 / 3 * math.pi * np.diff(edges**3)
        return Table(
            "Radial distribution",
            {
                "distance": (edges[1:] + edges[:-1]) / 2,
                "g": counts / expected,
                "g_error": poisson(counts) / expected,
            },
            {"distance": "length"},
        )


def distances(position: Floats, period: Floats, centres: NDArray[np.int64], reach: float) -> Floats:
    """Distances up to `reach` from some spheres to all others, by cells as long as that."""
    cells = np.maximum(1, np.floor(period / reach)).astype(np.int64)
    if (cells < 3).any():
        cells[:] = 1
    place = np.floor((position / period + 0.5) * cells).astype(np.int64) % cells
    number_of = (place[:, 0] * cells[1] + place[:, 1]) * cells[2] + place[:, 2]
    order = np.argsort(number_of, kind="stable")
    starts = np.searchsorted(number_of[order], np.arange(cells.prod() + 1))
    steps = np.arange(-1, 2) if cells[0] > 1 else np.zeros(1, np.int64)
    found = []
    for step in np.stack(np.meshgrid(steps, steps, steps), -1).reshape(-1, 3):
        beside = (place[centres] + step) % cells
        cell = (beside[:, 0] * cells[1] + beside[:, 1]) * cells[2] + beside[:, 2]
        many = starts[cell + 1] - starts[cell]
        from_ = np.repeat(centres, many)
        within = np.arange(many.sum()) - np.repeat(np.cumsum(many) - many, many)
        to = order[np.repeat(starts[cell], many) + within]
        apart = position[to] - position[from_]
        apart -= period * np.rint(apart / period)
        square = (apart * apart).sum(axis=1)
        found.append(np.sqrt(square[(square <= reach * reach) & (to != from_)]))
    result: Floats = np.concatenate(found)
    return result


class _Profile(Sampled):
    """Base of profiles along an axis.

    Parameters
    ----------
    axis : {"x", "y", "z"}
    bins : int
        Equal layers between the ends of the axis.
    every, at
        As of `Sampled`.
    """

    def __init__(
        self, axis: str = "z", bins: int = 40, every: float | None = None, *, at: object = None
    ) -> None:
        super().__init__(every, at=at)
        if axis not in ("x", "y", "z"):
            msg = f"axis is {axis!r}; it is 'x', 'y' or 'z'"
            raise InputError(msg)
        self._axis = "xyz".index(axis)
        self._bins = int(number("bins", bins, at_least=2))

    def begin(self, moment: Moment) -> None:
        """Find the ends of the axis and the area across it."""
        super().begin(moment)
        state, world = moment.state, moment.world
        flat = (world.walls["kind"] == PLANE).all()
        volume = mechanics.volume(world)
        self._low, self._high = _ends(world, self._axis)
        if not (flat and volume > 0 and math.isfinite(self._low + self._high)):
            msg = (
                f"{self.name} needs a box: each axis periodic or between two flat walls that face "
                "one another"
            )
            raise InputError(msg)
        self._free = ~state.fixed
        self._area = volume / (self._high - self._low)
        self._series = Series(2 * self._bins)

    def _layers(self, state: State) -> NDArray[np.int64]:
        """The layer in which each sphere has its centre."""
        along = state.position[:, self._axis]
        layer = (along - self._low) * (self._bins / (self._high - self._low))
        return np.clip(layer.astype(np.int64), 0, self._bins - 1)

    def _table(self, title: str, column: str, unit: str, measured: Floats, theory: str) -> Table:
        name = "xyz"[self._axis]
        edges = np.linspace(self._low, self._high, self._bins + 1)
        value, error, line = measured
        return Table(
            title,
            {
                name: (edges[1:] + edges[:-1]) / 2,
                column: value,
                f"{column}_error": error,
                f"{column}_theory": line,
            },
            {name: "length", column: unit},
            theory,
        )


class DensityProfile(_Profile):
    """Number density of centres in layers across an axis.

    Theory, of one kind of spheres without walls: uniform; with gravity along the axis, of a
    dilute gas: `carom.theory.barometric_density` between the ends that centres can reach, with
    the mean temperature. Result: `Table`.

    Parameters
    ----------
    axis, bins, every, at
        As of `_Profile`: "x", "y" or "z"; the number of layers; as of `Sampled`.
    """

    def begin(self, moment: Moment) -> None:
        """Prepare the theory."""
        super().begin(moment)
        kinds = Kinds(moment.state)
        self._single = kinds if len(kinds) == 1 and not moment.state.fixed.any() else None

    def sample(self, moment: Moment) -> None:
        """Count."""
        state = moment.state
        layer = self._layers(state)[self._free]
        row = np.zeros((1, 2 * self._bins))
        row[0, : self._bins] = np.bincount(layer, minlength=self._bins)
        row[0, self._bins] = mechanics.temperature(state, moment.world)
        self._series.add(row)

    def result(self) -> Table:
        """Densities so far."""
        self.over_samples()
        layer = self._area * (self._high - self._low) / self._bins
        found = [self._series.mean(k) for k in range(self._bins)]
        line, said = self._line()
        measured = np.array([[e.value / layer, e.error / layer] for e in found]).T
        return self._table(
            "Density profile", "density", "1/length^3", np.vstack([measured, line]), said
        )

    def _line(self) -> tuple[Floats, str]:
        nothing = np.full(self._bins, math.nan), ""
        assert self.world is not None
        if self._single is None:
            return nothing
        n = int(self._single.count[0])
        if len(self.world.walls) == 0:
            return np.full(self._bins, n / self._area / (self._high - self._low)), "uniform"
        pull = float(self.world.gravity[self._axis])
        across = np.delete(self.world.gravity, self._axis)
        kT = self._series.mean(self._bins).value
        if pull == 0 or across.any() or not is_elastic(self.world) or not kT > 0:
            return nothing
        radius, mass = float(self._single.radius[0]), float(self._single.mass[0])
        # Points in layers, and how high each is above the lowest place that a centre can reach.
        steps = (np.arange(self._bins * POINTS) + 0.5) / (self._bins * POINTS)
        height = steps * (self._high - self._low) - radius
        if pull > 0:
            height = height[::-1]
        room = self._high - self._low - 2 * radius
        inside = (height >= 0) & (height <= room)
        # The formula is that of a column without a lid: of this one it is the lower part.
        column = n / self._area / -math.expm1(-mass * abs(pull) * room / kT)
        size = radius if self.world.collide else 0.0
        density = in_range(
            theory.barometric_density, height[inside], column, abs(pull), kT, mass, size
        )
        if density is None:
            return nothing[0], CROWDED
        points = np.zeros(len(height))
        points[inside] = density
        line = points.reshape(self._bins, POINTS).mean(axis=1)
        layer = self._area * (self._high - self._low) / self._bins
        return line * (n / (line.sum() * layer)), f"barometric formula, {THIN}"


class TemperatureProfile(_Profile):
    """Temperature, <m v^2>/3, in layers across an axis.

    Theory: the same everywhere where energy is conserved. A layer that no sphere entered has
    none. Result: `Table`.

    Parameters
    ----------
    axis, bins, every, at
        As of `DensityProfile`.
    """

    def begin(self, moment: Moment) -> None:
        """Prepare the theory."""
        super().begin(moment)
        self._theory = math.nan
        if conserves_energy(moment.world):
            self._theory = mechanics.temperature(moment.state, moment.world)

    def sample(self, moment: Moment) -> None:
        """Add up."""
        state = moment.state
        layer = self._layers(state)[self._free]
        velocity = state.velocity[self._free]
        squares = state.mass[self._free] * (velocity * velocity).sum(axis=1) / 3
        heat = np.bincount(layer, squares, self._bins)
        count = np.bincount(layer, minlength=self._bins)
        self._series.add(np.concatenate([heat, count])[None])

    def result(self) -> Table:
        """Temperatures so far."""
        self.over_samples()
        found = [self._series.ratio(k, self._bins + k) for k in range(self._bins)]
        line = np.full(self._bins, self._theory)
        measured = np.array([[e.value, e.error] for e in found]).T
        said = "" if math.isnan(self._theory) else "equilibrium"
        return self._table(
            "Temperature profile", "temperature", "energy", np.vstack([measured, line]), said
        )


def _ends(world: World, axis: int) -> tuple[float, float]:
    """Where an axis begins and ends; nan where it does not."""
    if world.period[axis] > 0:
        half = float(world.period[axis]) / 2
        return -half, half
    normal = world.walls["normal"][:, axis]
    low, high = world.walls["offset"][normal == 1], world.walls["offset"][normal == -1]
    if len(low) == 0 or len(high) == 0:
        return math.nan, math.nan
    return float(low.max()), float(-high.max())
