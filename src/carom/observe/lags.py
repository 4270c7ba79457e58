"""What spheres remember: displacements and velocities after given lags."""

import math
from typing import Any

import numpy as np

from carom import mechanics, theory
from carom.errors import InputError
from carom.observe.batch import Moment
from carom.observe.estimate import Estimate
from carom.observe.fluid import UP_TO, Fluid, fluid_of, in_range, is_gas
from carom.observe.kinds import (
    MOST_KINDS,
    Kinds,
    legend,
    letters,
    mean_free_time,
    one_kind,
    refuse_losses,
    refuse_walls,
    unmoved,
)
from carom.observe.observable import Observable, Schedule, log_times, once
from carom.observe.table import Table, Theory
from carom.state import Floats

ENOUGH = 16  #: windows whose own spread gives the error
MEMORY = f"Enskog, velocities that forget exponentially, {UP_TO}"


class Lagged(Observable):
    """Base of means over spheres of something between a moment and a later one.

    A window begins when the one before has ended, at the last lag. Of 16 windows or more the
    error is that of their means; of fewer, that of as many independent spheres. Where there are
    several kinds of spheres (radius and mass) each has a column besides that of all.

    Parameters
    ----------
    at : sequence of float, optional
        The lags, rising and above 0; twenty from 0.2 to 60 mean free times if left out.
    """

    def __init__(self, at: Any = None) -> None:
        self._lags = None if at is None else self._checked(once(at))

    @staticmethod
    def _checked(lags: Schedule) -> Schedule:
        if lags.at[0] == 0:
            msg = "at holds a lag of 0; lags are above 0"
            raise InputError(msg)
        return Schedule(lags.at, lags.at[-1])

    def begin(self, moment: Moment) -> None:
        """Open the first window."""
        state, world = moment.state, moment.world
        self._free = ~state.fixed
        if not self._free.any():
            msg = f"{self.name} is of spheres that move, and all are fixed"
            raise InputError(msg)
        self.schedule = self._lags or self._natural(mean_free_time(state, world))
        self._kinds = kinds = Kinds(state)
        self._groups = [np.ones(len(self._free[self._free]), np.bool_)]
        if 1 < len(kinds) <= MOST_KINDS:
            self._groups += [kinds.of[self._free] == k for k in range(len(kinds))]
        n, groups = len(self.schedule.at), len(self._groups)
        self._count = np.zeros(n, np.int64)  # windows
        self._sum, self._squares, self._spheres = np.zeros((3, groups, n))
        self._scale = np.ones(groups)
        self._fluid, self._said = fluid_of(moment)
        self._forgets = forgetting_of_kinds(moment, kinds)
        self._kT = mechanics.temperature(state, world)
        self._open(moment)

    def _natural(self, free_time: float) -> Schedule:
        return self._checked(Schedule(log_times(0.2 * free_time, 60 * free_time, 20)))

    def sample(self, moment: Moment) -> None:
        """Take the mean over spheres for one lag."""
        assert self.schedule is not None
        place = self.samples % len(self.schedule.at)
        of_spheres = self._look(moment, place)
        self._count[place] += 1
        for k, group in enumerate(self._groups):
            values = (of_spheres if k == 0 else of_spheres[group]) / self._scale[k]
            mean = float(values.mean())
            self._sum[k, place] += mean
            self._squares[k, place] += mean * mean
            self._spheres[k, place] += float(values.var())
        if place == len(self.schedule.at) - 1:
            self._open(moment)

    def _open(self, moment: Moment) -> None:
        """Open a window."""

    def _look(self, moment: Moment, place: int) -> Floats:
        """One number for each free sphere."""
        raise NotImplementedError

    def _means(self, k: int = 0) -> list[Estimate]:
        """One for each lag that was reached, of one group of spheres; all are the first."""
        found = []
        for place in range(int(np.count_nonzero(self._count))):
            n = int(self._count[place])
            mean = float(self._sum[k, place]) / n
            if n >= ENOUGH:
                spread = max(0.0, float(self._squares[k, place]) / n - mean**2) * n / (n - 1)
                found.append(Estimate(mean, math.sqrt(spread / n), n))
            else:
                spheres = int(np.count_nonzero(self._groups[k]))
                spread = float(self._spheres[k, place]) / n
                found.append(Estimate(mean, math.sqrt(spread / (n * spheres)), n * spheres))
        return found

    def _table(self, title: str, column: str, unit: str) -> Table:
        self.over_samples()
        assert self.schedule is not None
        time = np.array(self.schedule.at[: np.count_nonzero(self._count)])
        columns, units, several = {"time": time}, {"time": "time"}, len(self._groups) > 1
        names = [column, *(f"{column}_{letter}" for letter in letters(self._kinds) if several)]
        for k, name in enumerate(names):
            means = self._means(k)
            columns[name] = np.array([e.value for e in means])
            columns[f"{name}_error"] = np.array([e.error for e in means])
            columns[f"{name}_theory"] = self._expected(k, time)
            units |= {name: unit} if unit else {}
        known = self._fluid is not None or self._forgets is not None
        notes = (legend(self._kinds),) if several else ()
        return Table(title, columns, units, MEMORY if known else self._said, notes)

    def _expected(self, k: int, time: Floats) -> Floats:
        """Theory's line for one group; nan for kinds together, of which each has its own."""
        if self._fluid is not None:
            return self._line(forgetting(self._fluid), self._fluid.mass, time)
        if k == 0 or self._forgets is None:
            return np.full(len(time), math.nan)
        return self._line(float(self._forgets[k - 1]), float(self._kinds.mass[k - 1]), time)

    def _line(self, rate: float, mass: float, t: Floats) -> Floats:
        """Theory's line for spheres of a mass whose velocities forget at a rate."""
        raise NotImplementedError


def forgetting_of_kinds(moment: Moment, kinds: Kinds) -> Floats | None:
    """The rate at which velocities of each of several kinds forget, by Enskog; None where unknown.

    A collision of i with j takes (4/3) m_j/(m_i + m_j) of the velocity of i, on average.
    """
    state, world = moment.state, moment.world
    if not (is_gas(state, world) and 1 < len(kinds) <= MOST_KINDS):
        return None
    volume, kT = mechanics.volume(world), mechanics.temperature(state, world)
    rates = in_range(theory.pair_rates, kinds.radius, volume, kinds.count, kinds.mass, kT)
    if rates is None:
        return None
    mass = kinds.mass
    found: Floats = (rates * (4 / 3 * mass / (mass[:, None] + mass))).sum(axis=1)
    return found


def forgetting(fluid: Fluid) -> float:
    """2 omega/3: the rate at which velocities forget in kinetic theory."""
    return float(2 / 3 * theory.collision_rate(*fluid))


def places(moment: Moment, free: Any) -> Floats:
    """Unwrapped positions of free spheres, about the centre of mass where it moves freely."""
    state, world = moment.state, moment.world
    position = state.position + state.image * world.period
    axes = mechanics.conserved_axes(state, world)
    weight = state.mass[free] / state.mass[free].sum()
    found: Floats = position[free]
    found[:, axes] -= weight @ found[:, axes]
    return found


class MSD(Lagged):
    """Mean square displacement <|r(t) - r(0)|^2> of all free spheres.

    Positions are unwrapped; the motion of the centre of mass is taken off where it is free. The
    theory line of each kind in a periodic box is that of an exponential memory with
    Enskog's collision rates: 6 D [t - tau (1 - exp(-t/tau))], D = kT tau/m and, for kind i, 1/tau =
    sum over kinds j of (4/3) nu_ij m_j/(m_i + m_j), which is 2 omega/3 of one kind. Result:
    `Table`.

    Parameters
    ----------
    at
        As of `Lagged`.

    References
    ----------
    J.-P. Hansen, I. R. McDonald, Theory of Simple Liquids, 4th ed., Academic Press 2013,
    sections 7.2 and 7.3.
    """

    def _open(self, moment: Moment) -> None:
        self._from = places(moment, self._free)

    def _look(self, moment: Moment, place: int) -> Floats:
        moved = places(moment, self._free) - self._from
        squares: Floats = (moved * moved).sum(axis=1)
        return squares

    def result(self) -> Table:
        """Lags that were reached so far."""
        return self._table("Mean square displacement", "msd", "length^2")

    def _line(self, rate: float, mass: float, t: Floats) -> Floats:
        tau = 1 / rate
        # About the centre of mass of all, of mass M, velocities have (1 - m/M) kT/m.
        whole = float(self._kinds.count @ self._kinds.mass)
        square = (1 - mass / whole) * self._kT / mass
        line: Floats = 6 * square * tau * (t - tau * (1 - np.exp(-t / tau)))
        return line


class VACF(Lagged):
    """Velocity autocorrelation <v(0).v(t)>/<v^2> of all free spheres.

    Velocities are about the motion of the whole, where that is conserved. It begins with the
    slope -1/tau exactly; the theory line exp(-t/tau) of each kind is Enskog's, tau as of
    `MSD`. Result: `Table`.

    Parameters
    ----------
    at
        As of `Lagged`.

    References
    ----------
    As of `MSD`; the memory of a fluid's flow goes on longer: B. J. Alder, T. E. Wainwright,
    Phys. Rev. A 1, 18 (1970), doi:10.1103/PhysRevA.1.18.
    """

    def _open(self, moment: Moment) -> None:
        velocity = unmoved(moment.state, moment.world)[self._free]
        squares = (velocity * velocity).sum(axis=1)
        self._scale = np.array([float(squares[group].mean()) for group in self._groups])
        if not (self._scale > 0).all():
            msg = f"{self.name} is of spheres that move against one another; give them velocities"
            raise InputError(msg)
        self._from = velocity

    def _look(self, moment: Moment, place: int) -> Floats:
        velocity = unmoved(moment.state, moment.world)[self._free]
        products: Floats = (velocity * self._from).sum(axis=1)
        return products

    def result(self) -> Table:
        """Lags that were reached so far."""
        return self._table("Velocity autocorrelation", "vacf", "")

    def _line(self, rate: float, mass: float, t: Floats) -> Floats:
        line: Floats = np.exp(-rate * t)
        return line


class Diffusion(MSD):
    """Self-diffusion coefficient of one kind of spheres in a periodic cube.

    From the rise of the mean square displacement between two lags, D = d<r^2>/6 dt. Spheres
    drag their own periodic images along; `carom.theory.finite_size_diffusion` allows for that,
    with the shear viscosity, Enskog's if it is not given, which is a tenth or two off in a
    dense fluid. That error is not in the error bar. Theory: `carom.theory.self_diffusion`.
    Result: `Table` with both values; only that of this box where no viscosity is known.

    Parameters
    ----------
    between : (float, float), optional
        The two lags; 40 and 200 mean free times if left out.
    viscosity : float, optional
        A measured one.
    """

    def __init__(
        self, between: tuple[float, float] | None = None, viscosity: float | None = None
    ) -> None:
        super().__init__(between)
        if self._lags is not None and len(self._lags.at) != 2:
            msg = f"between must be two lags, not {len(self._lags.at)}"
            raise InputError(msg)
        self._viscosity = viscosity

    def _natural(self, free_time: float) -> Schedule:
        return self._checked(Schedule([40 * free_time, 200 * free_time]))

    def begin(self, moment: Moment) -> None:
        """Refuse a world in which spheres cannot go far."""
        state, world = moment.state, moment.world
        refuse_walls(world, self.name, "take carom.Periodic, as walls bound displacements")
        refuse_losses(world, self.name)
        if np.ptp(world.period) > 0:
            msg = f"{self.name} knows the size correction of a cube only; make all sides equal"
            raise InputError(msg)
        if not world.collide or state.fixed.any():
            msg = f"{self.name} is of spheres that all move and collide"
            raise InputError(msg)
        one_kind(state, self.name)
        super().begin(moment)

    def _look(self, moment: Moment, place: int) -> Floats:
        squares = super()._look(moment, place)
        if place == 0:
            self._first = squares
            return squares
        assert self.schedule is not None
        early, late = self.schedule.at
        return (squares - self._first) / (6 * (late - early))

    def result(self) -> Table:
        """D in this box, and in one without end."""
        self.over_samples()
        means = self._means()
        if len(means) < 2:
            assert self.schedule is not None
            msg = (
                f"{self.name} needs a run of {self.schedule.at[1]:.6g} at least, and has seen "
                f"{self.duration:.6g}; run longer, or give between="
            )
            raise InputError(msg)
        side = float(self.world.period[0]) if self.world else math.nan
        rows: dict[str, tuple[Estimate, Theory | None]] = {
            f"D in a cube of {side:.6g}": (means[1], None)
        }
        note = "no size correction: it takes a viscosity, and theory has none; give viscosity="
        eta, expected = self._viscosity, None
        if self._fluid is not None:
            eta = eta or float(theory.shear_viscosity(*self._fluid))
            expected = Theory(float(theory.self_diffusion(*self._fluid)), f"Enskog, {UP_TO}")
        if eta is not None:
            shift = float(theory.finite_size_diffusion(side, eta, self._kT))
            beyond = Estimate(means[1].value + shift, means[1].error, means[1].n_independent)
            rows["D, infinite"] = (beyond, expected)
            note = f"size correction {shift:.4g} with viscosity {eta:.4g}"
        table = Table.of_estimates("Diffusion", rows)
        said = table.theory or self._said
        return Table(table.title, table.columns, {"value": "length^2/time"}, said, (note,))
