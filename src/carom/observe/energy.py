"""Energy and where it goes, temperatures, and how good the arithmetic was."""

import math

import numpy as np

from carom import mechanics
from carom.errors import InputError
from carom.observe.batch import Batch, Moment
from carom.observe.estimate import Estimate
from carom.observe.kinds import Kinds, conserves_energy, labels, unmoved
from carom.observe.observable import Observable
from carom.observe.sampled import Sampled
from carom.observe.series import Series
from carom.observe.table import Table
from carom.state import CAME_TO_REST, WOKE

COLUMNS = (
    "time",
    "kinetic",
    "potential",
    "dissipated_by_spheres",
    "dissipated_by_walls",
    "withheld",
)


class Energy(Sampled):
    """Kinetic and potential energy at moments, and what was dissipated since it began, by cause.

    The beginning, and the end of each run, are always among the moments.

    The restitution of walls took J^2 (1 - e)/(2 m (1 + e)) at each hit, rest J^2/(2 m); the rule
    of spheres took what else is missing. `withheld` is what the contact-time cure has kept from
    being taken. Result: `Table` over time; these are readings, which have no statistical error.

    Parameters
    ----------
    every, at
        As of `Sampled`.
    """

    def begin(self, moment: Moment) -> None:
        """Take the first reading."""
        super().begin(moment)
        self._before = moment.dissipated, moment.withheld
        self._walls = 0.0
        self._readings: list[tuple[float, ...]] = []
        self._read(moment)

    def events(self, batch: Batch) -> None:
        """Add what walls took."""
        if batch.all_pairs:
            return
        hits = (batch.j < 0) & (batch.j != WOKE)
        partner, size = batch.j[hits], batch.size[hits]
        resting = partner <= CAME_TO_REST
        wall = np.where(resting, CAME_TO_REST - partner, -1 - partner)
        e = np.where(resting, 0.0, batch.world.walls["restitution"][wall])
        mass = batch.spheres.mass[batch.i[hits]]
        self._walls += float((size**2 * (1 - e) / (2 * mass * (1 + e))).sum())

    def sample(self, moment: Moment) -> None:
        """Take a reading."""
        if moment.time > self._readings[-1][0]:
            self._read(moment)

    def end(self, moment: Moment) -> None:
        """Take a last reading."""
        self.sample(moment)

    def _read(self, moment: Moment) -> None:
        dissipated, withheld = moment.dissipated, moment.withheld
        self._readings.append(
            (
                moment.time,
                mechanics.kinetic_energy(moment.state),
                mechanics.potential_energy(moment.state, moment.world),
                dissipated - self._before[0] - self._walls,
                self._walls,
                withheld - self._before[1],
            )
        )

    def result(self) -> Table:
        """All readings."""
        self.last()
        columns = dict(zip(COLUMNS, np.array(self._readings).T, strict=True))
        units = dict.fromkeys(COLUMNS[1:], "energy")
        return Table("Energy", columns, {"time": "time", **units})


class Temperature(Sampled):
    """Temperature of each kind of spheres along each axis, averaged over samples.

    kT = <m v_a^2>, about the motion of the whole along axes where momentum is conserved, where
    kind k has 1 - m_k/M degrees of freedom for each sphere and axis. Theory: all are equal
    where energy is conserved. Result: `Table`, a row for each kind.

    Parameters
    ----------
    every, at
        As of `Sampled`.
    """

    def begin(self, moment: Moment) -> None:
        """Group the spheres."""
        super().begin(moment)
        state, world = moment.state, moment.world
        self._kinds = kinds = Kinds.few(state, self.name)
        if len(kinds) == 0:
            msg = f"{self.name} is of spheres that move, and all are fixed"
            raise InputError(msg)
        whole = float(kinds.count @ kinds.mass)
        conserved = np.zeros(3)
        conserved[mechanics.conserved_axes(state, world)] = 1
        self._freedom = kinds.count[:, None] * (1 - kinds.mass[:, None] / whole * conserved)
        self._series = Series(4 * len(kinds))
        self._theory = math.nan
        if conserves_energy(world):
            self._theory = mechanics.temperature(state, world)

    def sample(self, moment: Moment) -> None:
        """Add up."""
        velocity = unmoved(moment.state, moment.world)
        kinds, kT = self._kinds, np.empty((len(self._kinds), 4))
        for kind in range(len(kinds)):
            mine = velocity[kinds.of == kind]
            with np.errstate(divide="ignore", invalid="ignore"):
                squares = kinds.mass[kind] * (mine * mine).sum(axis=0)
                kT[kind, :3] = squares / self._freedom[kind]
                kT[kind, 3] = squares.sum() / self._freedom[kind].sum()
        self._series.add(kT.reshape(1, -1))

    def result(self) -> Table:
        """Means so far."""
        self.over_samples()
        kinds = self._kinds
        columns: dict[str, np.ndarray] = {"kind": labels(kinds)}
        names = ("temperature", "along_x", "along_y", "along_z")
        notes: list[str] = []
        for name, place in zip(names, (3, 0, 1, 2), strict=True):
            found = [self._series.mean(4 * kind + place) for kind in range(len(kinds))]
            columns[name] = np.array([e.value for e in found])
            columns[f"{name}_error"] = np.array([e.error for e in found])
            notes += [e.note for e in found if e.note]
        columns["temperature_theory"] = np.full(len(kinds), self._theory)
        said = "" if math.isnan(self._theory) else "equipartition"
        units = dict.fromkeys(names, "energy")
        return Table("Temperature", columns, units, said, tuple(dict.fromkeys(notes)))


class MaxOverlap(Observable):
    """Largest (sigma - r)/sigma of a collision since the simulation's start: the rounding.

    Neighbours at the end count too. Result: `Estimate` whose error is 0: it is a reading.
    """

    def begin(self, moment: Moment) -> None:
        """Nothing was seen yet."""
        self._largest = 0.0

    def end(self, moment: Moment) -> None:
        """Read it."""
        self._largest = max(self._largest, moment.max_overlap)

    def result(self) -> Estimate:
        """The largest so far."""
        self.last()
        return Estimate(self._largest, 0.0, math.nan)
