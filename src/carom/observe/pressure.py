"""Pressure: from the collisions of spheres, and from those with walls."""

import math

import numpy as np

from carom import mechanics, theory
from carom.errors import InputError
from carom.observe.batch import Batch, Moment
from carom.observe.estimate import Estimate
from carom.observe.fluid import FREEZES, UP_TO, in_range
from carom.observe.kinds import (
    conserves_energy,
    mean_free_time,
    refuse_losses,
    refuse_walls,
    unmoved,
)
from carom.observe.observable import Observable, every
from carom.observe.room import is_still_gas, reduced_pressure, room_for, wall_impulses
from carom.observe.series import Rates, Series
from carom.observe.table import Table, Theory
from carom.state import Floats, State
from carom.world import World

AXES = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
WALLED = f"a fluid between walls, theory.wall_pressure, {UP_TO}"


def _fluid_z(state: State, world: World) -> Theory:
    """The compressibility factor of the fluid; nan where it freezes."""
    if not world.collide:
        return Theory(1.0, "ideal gas")
    if np.ptp(state.radius) == 0:
        phi = mechanics.packing_fraction(state, world)
        z = in_range(theory.kolafa_labik_malijevsky, phi)
        name = "Kolafa, Labik and Malijevsky"
    else:
        z, name = in_range(theory.bmcsl, state.radius, mechanics.volume(world)), "BMCSL"
    return Theory(math.nan, FREEZES) if z is None else Theory(z, f"{name}, a fluid {UP_TO}")


def _instead(world: World) -> str:
    if len(world.walls):
        return "use WallPressure (wall-pressure) between walls"
    return "open space has no pressure: give the world walls, or carom.Periodic"


class Compressibility(Observable):
    """Compressibility factor Z = P V/(N kT) of a periodic fluid or crystal, by the virial.

    Each impulse **J** acts along the line of centres, whose length is sigma, so ::

        Z = 1 + sum sigma |J|/(3 N kT t)

    with kT = `carom.Simulation.temperature`. Result: `Estimate`, without unit.

    References
    ----------
    J. J. Erpenbeck, W. W. Wood, in Modern Theoretical Chemistry 6 (ed. B. J. Berne), Plenum 1977.
    """

    def begin(self, moment: Moment) -> None:
        """Refuse what has no volume, or no temperature that lasts."""
        state, world = moment.state, moment.world
        refuse_walls(world, self.name, _instead(world))
        refuse_losses(world, self.name)
        self._scale = 3 * len(state) * mechanics.temperature(state, world)
        if state.fixed.any() or not self._scale > 0:
            msg = f"{self.name} is of spheres that all move; make none fixed, and give velocities"
            raise InputError(msg)
        self._sigma = None if np.ptp(state.radius) == 0 else 2 * state.radius
        self._single = 2 * float(state.radius[0])
        self._rates = Rates()
        self._theory = _fluid_z(state, world)

    def events(self, batch: Batch) -> None:
        """Add sigma |J| of each collision."""
        sigma = self._sigma
        both = self._single if sigma is None else (sigma[batch.i] + sigma[batch.j]) / 2
        self._rates.add(batch, batch.size * both)

    def result(self) -> Estimate:
        """Z so far."""
        self.over_time()
        virial = self._rates.rate()
        return Estimate(
            1 + virial.value / self._scale,
            virial.error / self._scale,
            virial.n_independent,
            virial.note,
        )

    def theory(self) -> Theory | None:
        """Z of the fluid: Kolafa, Labik and Malijevsky, or BMCSL for several sizes."""
        return self._theory if self.seen is not None else None


class PressureTensor(Observable):
    """Pressure tensor of a periodic system.

    ::

        P_ab V = <sum m v_a v_b> + sum sigma n_a J_b / t

    The first part is looked at after each three mean free times, about the motion of the whole; the
    second adds all collisions between. Theory is Z n kT, less kT/V, as N spheres at rest together
    lack the motion of one. Result: `Table` with the six components.

    Parameters
    ----------
    every : float, optional
        Time between two looks at the velocities; three mean free times if left out.

    References
    ----------
    M. P. Allen, D. J. Tildesley, Computer Simulation of Liquids, 2nd ed., Oxford 2017,
    section 2.4.
    """

    def __init__(self, every: float | None = None) -> None:
        self._interval = every

    def begin(self, moment: Moment) -> None:
        """Refuse what has no volume."""
        state, world = moment.state, moment.world
        refuse_walls(world, self.name, _instead(world))
        if state.fixed.any():
            msg = f"{self.name} is of spheres that all move; make none fixed"
            raise InputError(msg)
        lasts = 3 * mean_free_time(state, world) if self._interval is None else self._interval
        self.schedule = every(lasts)
        self._volume = mechanics.volume(world)
        self._series = Series(7)
        self._sum = np.zeros(6)
        self._since = moment.time
        self._theory: Theory | None = None
        if conserves_energy(world):
            z = _fluid_z(state, world)
            one = mechanics.temperature(state, world) / self._volume
            self._theory = Theory((len(state) * z.value - 1) * one, z.label)

    def events(self, batch: Batch) -> None:
        """Add sigma n_a J_b of each collision, n = J/|J|."""
        radius, impulse = batch.spheres.radius, batch.impulse
        weighted = impulse * ((radius[batch.i] + radius[batch.j]) / batch.size)
        products = weighted @ impulse.T
        self._sum += [products[a, b] for a, b in AXES]

    def sample(self, moment: Moment) -> None:
        """Look at the velocities, and close an interval."""
        velocity = unmoved(moment.state, moment.world).T.copy()
        products = (velocity * moment.state.mass) @ velocity.T
        lasted = moment.time - self._since
        kinetic = np.array([products[a, b] for a, b in AXES]) * lasted
        self._series.add(np.concatenate([[lasted], self._sum + kinetic])[None])
        self._sum[:] = 0
        self._since = moment.time

    def result(self) -> Table:
        """The components so far."""
        self.over_samples()
        found = [self._series.ratio(1 + k, 0) for k in range(6)]
        isotropic = self._theory.value if self._theory else math.nan
        diagonal = np.array([a == b for a, b in AXES])
        return Table(
            "Pressure tensor",
            {
                "component": np.array(["xyz"[a] + "xyz"[b] for a, b in AXES]),
                "pressure": np.array([e.value for e in found]) / self._volume,
                "pressure_error": np.array([e.error for e in found]) / self._volume,
                "pressure_theory": np.where(diagonal, isotropic, 0.0 * isotropic),
            },
            {"pressure": "energy/length^3"},
            self._theory.label if self._theory else "",
            tuple(dict.fromkeys(e.note for e in found if e.note)),
        )


class WallPressure(Observable):
    """Pressure on each wall: sum of |J_n| over area and time.

    The area is that which the centres of spheres can reach, see `carom.observe.room`. Theory is
    `carom.theory.wall_pressure`. Spheres at rest on a wall give it no impulse, so their weight
    is not in it. Result: `Table` with a row for each wall, in the order of event records.
    """

    def begin(self, moment: Moment) -> None:
        """Refuse a world without walls of finite area."""
        state, world = moment.state, moment.world
        free = ~state.fixed
        room = room_for(world, float(state.radius[free].mean()) if free.any() else 0.0)
        if not np.isfinite(room.areas).any():
            msg = (
                f"{self.name} needs a wall of finite area, and here is none; close the room with "
                "walls, or use Compressibility in a periodic box"
            )
            raise InputError(msg)
        self._areas: Floats = room.areas
        self._rates = Rates(len(room.areas))
        self._theory = Theory(math.nan, "")
        if is_still_gas(world, state, room):
            reduced = reduced_pressure(world, state, room)
            value = math.nan if reduced is None else reduced * mechanics.temperature(state, world)
            self._theory = Theory(value, FREEZES if reduced is None else WALLED)

    def events(self, batch: Batch) -> None:
        """Add |J_n| of each hit of a wall."""
        wall, along = wall_impulses(batch.j, batch.impulse, batch.world.walls)
        self._rates.add(batch, along, wall)

    def result(self) -> Table:
        """The pressures so far; nan for walls without a finite area."""
        self.over_time()
        found = [self._rates.rate(k) for k in range(len(self._areas))]
        return Table(
            "Pressure on walls",
            {
                "wall": np.arange(len(found)),
                "pressure": np.array([e.value for e in found]) / self._areas,
                "pressure_error": np.array([e.error for e in found]) / self._areas,
                "pressure_theory": np.full(len(found), self._theory.value),
            },
            {"pressure": "energy/length^3"},
            self._theory.label,
            tuple(dict.fromkeys(e.note for e in found if e.note)),
        )
