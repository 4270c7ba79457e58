"""Where spheres are along an axis."""

import math

import numpy as np
from numpy.typing import NDArray

from carom import mechanics, theory
from carom.checks import number
from carom.errors import InputError
from carom.observe.batch import Moment
from carom.observe.fluid import in_range
from carom.observe.kinds import Kinds, conserves_energy, is_elastic
from carom.observe.sampled import Sampled
from carom.observe.series import Series
from carom.observe.table import Table
from carom.state import Floats, State
from carom.world import PLANE, World

POINTS = 50  #: in a layer, for the mean of a theory over it
MOST_BINS = 1000  #: of more, the sums of a run would fill the memory
_FLOOR = theory.about(theory.barometric_density).ranges["floor_packing_fraction"]
THIN = f"up to packing fraction {_FLOOR.high} at the floor"
CROWDED = f"none, the barometric formula holds {THIN}"


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
        self._bins = int(number("bins", bins, at_least=2, at_most=MOST_BINS))

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
