"""One instant of a motion: what was there, to be shown or measured."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom import mechanics
from carom.checks import number
from carom.errors import InputError
from carom.kept import Surroundings
from carom.rules import Smooth
from carom.state import Floats, State
from carom.walls import Wall
from carom.world import World


def readonly(array: NDArray[Any]) -> Any:
    """A view that refuses changes in place, which no engine would notice."""
    view = array.view()
    view.flags.writeable = False
    return view


@dataclass(frozen=True, eq=False)
class Frame:
    """Spheres and their world at one instant; later motion does not change it.

    Attributes
    ----------
    state : State
        Everything about the spheres; its arrays are read-only.
    surroundings : Surroundings
        Walls, rule, gravity and collide as people write them.
    dissipated, withheld : float
        Energy that the rules have taken since the start, and that the contact-time cure has
        kept from being taken.
    max_overlap : float
        Largest (sigma - r)/sigma since the start.
    energy_drift : float
        Relative error of the energy, see `Simulation.energy_drift`.
    missed : int
        Collisions that a method of fixed steps has not seen.

    Examples
    --------
    >>> import carom
    >>> sim = carom.Simulation(carom.scenes.two_balls())
    >>> for frame in sim.frames(every=1, until=2):
    ...     print(frame.time, len(frame), frame.kinetic_energy)
    0.0 2 1.125
    1.0 2 1.125
    2.0 2 1.125
    """

    state: State
    surroundings: Surroundings
    dissipated: float = 0.0
    withheld: float = 0.0
    max_overlap: float = 0.0
    energy_drift: float = 0.0
    missed: int = 0

    def __post_init__(self) -> None:
        values = {f.name: getattr(self.state, f.name) for f in fields(self.state)}
        arrays = {k: readonly(v) for k, v in values.items() if isinstance(v, np.ndarray)}
        object.__setattr__(self, "state", replace(self.state, **arrays))

    def __len__(self) -> int:
        return len(self.state)

    def __repr__(self) -> str:
        return f"<Frame: {len(self)} spheres, time {self.time:.6g}, {self.collisions} collisions>"

    # The spheres.

    @property
    def position(self) -> Floats:
        """Centres, (N, 3) float64; wrapped into [-L/2, L/2) on periodic axes."""
        return self.state.position

    @property
    def unwrapped_position(self) -> Floats:
        """Centres as if periodic axes went on for ever, (N, 3) float64."""
        unwrapped: Floats = self.state.position + self.state.image * self.world.period
        return unwrapped

    @property
    def velocity(self) -> Floats:
        """(N, 3) float64."""
        return self.state.velocity

    @property
    def mass(self) -> Floats:
        """(N,) float64, inf where `fixed`."""
        return self.state.mass

    @property
    def radius(self) -> Floats:
        """(N,) float64."""
        return self.state.radius

    @property
    def color(self) -> NDArray[np.uint32]:
        """Packed 0xRRGGBB, (N,) uint32."""
        return self.state.color

    @property
    def species(self) -> NDArray[np.uint32]:
        """Labels, (N,) uint32."""
        return self.state.species

    @property
    def fixed(self) -> NDArray[np.bool_]:
        """Which spheres nothing can move, (N,) bool."""
        return self.state.fixed

    @property
    def resting(self) -> NDArray[np.bool_]:
        """Which spheres lie on a wall and have stopped bouncing, (N,) bool."""
        return self.state.resting

    @property
    def collision_count(self) -> NDArray[np.uint32]:
        """Impulses each sphere has received, from walls too, (N,) uint32."""
        return self.state.collision_count

    @property
    def time(self) -> float:
        """Simulated time."""
        return self.state.time

    @property
    def collisions(self) -> int:
        """Collisions between spheres since the start."""
        return self.state.collisions

    @property
    def wall_collisions(self) -> int:
        """Collisions with walls since the start."""
        return self.state.wall_collisions

    # The world.

    @cached_property
    def world(self) -> World:
        """Everything but the spheres, as numbers."""
        return self.surroundings.world()

    @property
    def walls(self) -> tuple[Wall, ...]:
        """Descriptions of the walls."""
        return self.surroundings.walls

    @property
    def rule(self) -> Smooth:
        """What happens when two spheres meet."""
        return self.surroundings.rule

    @property
    def gravity(self) -> Floats:
        """Acceleration of every free sphere, (3,) float64."""
        gravity: Floats = readonly(self.world.gravity)
        return gravity

    @property
    def collide(self) -> bool:
        """False if spheres pass through one another."""
        return self.surroundings.collide

    # Sums over all spheres that are not fixed. Cost: one pass over the arrays.

    @property
    def kinetic_energy(self) -> float:
        """½ Σ m v²."""
        return mechanics.kinetic_energy(self.state)

    @property
    def potential_energy(self) -> float:
        """-Σ m g·x, zero at the origin."""
        return mechanics.potential_energy(self.state, self.world)

    @property
    def momentum(self) -> Floats:
        """Σ m v, (3,) float64."""
        return mechanics.momentum(self.state)

    @property
    def temperature(self) -> float:
        """2K/f, see `Simulation.temperature`."""
        return mechanics.temperature(self.state, self.world)

    @property
    def packing_fraction(self) -> float:
        """Volume of the spheres over that of the world; nan where that is open."""
        return mechanics.packing_fraction(self.state, self.world)


MOST_MOMENTS = 1e8  #: stops of one run; more would take for ever


def moments(
    begin: float, *, every: float | None, at: Iterable[float] | None, until: float | None
) -> Iterator[float]:
    """Times to stop at: `begin` and each interval after it, or given ones; none after `until`.

    Raises
    ------
    InputError
        If not exactly one of `every` and `at` is given, or a number cannot be used. Of `at` each
        is looked at when its turn comes.
    """
    if (every is None) == (at is None):
        msg = f"frames() takes every= or at=, exactly one of them; got {every=} and {at=!r:.60}"
        raise InputError(msg)
    end = None if until is None else number("until", until)
    if at is not None:
        return _given(at, end)
    step = number("every", every, above=0)
    if end is not None and (end - begin) / step > MOST_MOMENTS:
        msg = (
            f"every={step:g} makes {(end - begin) / step:.1e} frames until {end:g}, and at most "
            f"{MOST_MOMENTS:.0e} can be looked at: take at least {(end - begin) / MOST_MOMENTS:.2g}"
        )
        raise InputError(msg)
    return _regular(begin, step, end)


def _regular(begin: float, every: float, end: float | None) -> Iterator[float]:
    k = 0
    # The last one may miss the end by the rounding of k * every alone.
    while end is None or begin + k * every <= end + 1e-9 * every:
        time = begin + k * every
        yield time if end is None else min(time, end)
        k += 1


def _given(at: Iterable[float], end: float | None) -> Iterator[float]:
    before = None
    for value in at:
        time = number("a time of at", value)
        if before is not None and time < before:
            msg = f"at must hold rising times, but {time:.15g} comes after {before:.15g}"
            raise InputError(msg)
        if end is not None and time > end:
            return
        yield time
        before = time
