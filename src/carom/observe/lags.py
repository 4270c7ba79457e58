"""What spheres remember: displacements and velocities after given lags."""

import math
from typing import Any

import numpy as np

from carom import mechanics, theory
from carom.errors import InputError
from carom.observe.batch import Moment
from carom.observe.estimate import Estimate
from carom.observe.fluid import UP_TO, Fluid, fluid_of
from carom.observe.kinds import mean_free_time, one_kind, refuse_losses, refuse_walls, unmoved
from carom.observe.observable import Observable, Schedule, log_times, once
from carom.observe.table import Table, Theory
from carom.state import Floats

ENOUGH = 16  #: windows whose own spread gives the error
MEMORY = f"Enskog, velocities that forget at the rate 2 omega/3, {UP_TO}"


class Lagged(Observable):
    """Base of means over spheres of something between a moment and a later one.

    A window begins when the one before has ended, at the last lag. Of 16 windows or more the
    error is that of their means; of fewer, that of as many independent spheres.

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
        n = len(self.schedule.at)
        self._count = np.zeros(n, np.int64)  # windows
        self._sum, self._squares, self._spheres = np.zeros(n), np.zeros(n), np.zeros(n)
        self._fluid, self._said = fluid_of(moment)
        self._kT = mechanics.temperature(state, world)
        self._open(moment)

    def _natural(self, free_time: float) -> Schedule:
        return self._checked(Schedule(log_times(0.2 * free_time, 60 * free_time, 20)))

    def sample(self, moment: Moment) -> None:
        """Take the mean over spheres for one lag."""
        assert self.schedule is not None
        place = self.samples % len(self.schedule.at)
        of_spheres = self._look(moment, place)
        mean = float(of_spheres.mean())
        self._count[place] += 1
        self._sum[place] += mean
        self._squares[place] += mean * mean
        self._spheres[place] += float(of_spheres.var())
        if place == len(self.schedule.at) - 1:
            self._open(moment)

    def _open(self, moment: Moment) -> None:
        """Open a window."""

    def _look(self, moment: Moment, place: int) -> Floats:
        """One number for each free sphere."""
        raise NotImplementedError

    def _means(self) -> list[Estimate]:
        """One for each lag that was reached."""
        self.over_samples()
        found = []
        for place in range(int(np.count_nonzero(self._count))):
            n = int(self._count[place])
            mean = float(self._sum[place]) / n
            if n >= ENOUGH:
                spread = max(0.0, float(self._squares[place]) / n - mean**2) * n / (n - 1)
                found.append(Estimate(mean, math.sqrt(spread / n), n))
            else:
                spheres = int(np.count_nonzero(self._free))
                spread = float(self._spheres[place]) / n
                found.append(Estimate(mean, math.sqrt(spread / (n * spheres)), n * spheres))
        return found

    def _table(self, title: str, column: str, unit: str, line: Any) -> Table:
        means = self._means()
        assert self.schedule is not None
        time = np.array(self.schedule.at[: len(means)])
        expected = np.full(len(time), math.nan)
        if self._fluid is not None:
            expected = line(self._fluid, time)
        return Table(
            title,
            {
                "time": time,
                column: np.array([e.value for e in means]),
                f"{column}_error": np.array([e.error for e in means]),
                f"{column}_theory": expected,
            },
            {"time": "time", **({column: unit} if unit else {})},
            self._said if self._fluid is None else MEMORY,
        )


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
    theory line, for one kind in a periodic box, is that of an exponential memory with
    Enskog's collision rate omega: 6 D [t - tau (1 - exp(-t/tau))], tau = 3/(2 omega) and
    D = kT tau/m. Result: `Table`.

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
        return self._table("Mean square displacement", "msd", "length^2", self._line)

    def _line(self, fluid: Fluid, t: Floats) -> Floats:
        tau = 1 / forgetting(fluid)
        # About their centre of mass N spheres have 3 N - 3 degrees of freedom.
        freedom = 1 - 1 / np.count_nonzero(self._free)
        square = freedom * fluid.temperature / fluid.mass
        line: Floats = 6 * square * tau * (t - tau * (1 - np.exp(-t / tau)))
        return line


class VACF(Lagged):
    """Velocity autocorrelation <v(0).v(t)>/<v^2> of all free spheres.

    Velocities are about the motion of the whole, where that is conserved. It begins with the
    slope -2 omega/3 exactly; the theory line exp(-2 omega t/3) is Enskog's. Result: `Table`.

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
        square = float((velocity * velocity).sum(axis=1).mean())
        if square == 0:
            msg = f"{self.name} is of spheres that move against one another; give them velocities"
            raise InputError(msg)
        self._from = velocity / square

    def _look(self, moment: Moment, place: int) -> Floats:
        velocity = unmoved(moment.state, moment.world)[self._free]
        products: Floats = (velocity * self._from).sum(axis=1)
        return products

    def result(self) -> Table:
        """Lags that were reached so far."""
        return self._table("Velocity autocorrelation", "vacf", "", self._line)

    def _line(self, fluid: Fluid, t: Floats) -> Floats:
        line: Floats = np.exp(-forgetting(fluid) * t)
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
