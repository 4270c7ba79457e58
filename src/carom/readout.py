"""What can be read from a simulation, and assigned to it, at any moment."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom import mechanics
from carom.checks import triple
from carom.errors import InputError
from carom.frame import readonly
from carom.motion import Motion
from carom.rules import Smooth
from carom.state import Floats, State
from carom.walls import Wall, as_walls
from carom.world import World

EVERY = slice(None)


class Readout:
    """The properties of `carom.Simulation`; arrays are read-only views of this moment.

    Arrays are assigned whole (``sim.velocity = -sim.velocity``): one value for all spheres,
    or one for each. An array read before a run keeps its old numbers.
    """

    _motion: Motion

    # Arrays.

    @property
    def position(self) -> Floats:
        """Centres, (N, 3) float64; wrapped into [-L/2, L/2) on periodic axes. May be assigned."""
        array: Floats = readonly(self._motion.state.position)
        return array

    @position.setter
    def position(self, value: ArrayLike) -> None:
        self._motion.assign("position", EVERY, value)

    @property
    def unwrapped_position(self) -> Floats:
        """Centres as if periodic axes went on for ever, (N, 3) float64."""
        state = self._motion.state
        array: Floats = readonly(state.position + state.image * self._motion.world.period)
        return array

    @property
    def velocity(self) -> Floats:
        """(N, 3) float64. May be assigned."""
        array: Floats = readonly(self._motion.state.velocity)
        return array

    @velocity.setter
    def velocity(self, value: ArrayLike) -> None:
        self._motion.assign("velocity", EVERY, value)

    @property
    def mass(self) -> Floats:
        """(N,) float64, inf where `fixed`. May be assigned."""
        array: Floats = readonly(self._motion.state.mass)
        return array

    @mass.setter
    def mass(self, value: ArrayLike) -> None:
        self._motion.assign("mass", EVERY, value)

    @property
    def radius(self) -> Floats:
        """(N,) float64. May be assigned."""
        array: Floats = readonly(self._motion.state.radius)
        return array

    @radius.setter
    def radius(self, value: ArrayLike) -> None:
        self._motion.assign("radius", EVERY, value)

    @property
    def color(self) -> NDArray[np.uint32]:
        """Packed 0xRRGGBB, (N,) uint32. May be assigned: names and "#rrggbb" too."""
        array: NDArray[np.uint32] = readonly(self._motion.state.color)
        return array

    @color.setter
    def color(self, value: Any) -> None:
        self._motion.assign("color", EVERY, value)

    @property
    def species(self) -> NDArray[np.uint32]:
        """Labels, (N,) uint32. May be assigned."""
        array: NDArray[np.uint32] = readonly(self._motion.state.species)
        return array

    @species.setter
    def species(self, value: ArrayLike) -> None:
        self._motion.assign("species", EVERY, value)

    @property
    def fixed(self) -> NDArray[np.bool_]:
        """Which spheres nothing can move, (N,) bool."""
        array: NDArray[np.bool_] = readonly(self._motion.state.fixed)
        return array

    @property
    def resting(self) -> NDArray[np.bool_]:
        """Which spheres lie on a wall and have stopped bouncing, (N,) bool."""
        array: NDArray[np.bool_] = readonly(self._motion.state.resting)
        return array

    @property
    def collision_count(self) -> NDArray[np.uint32]:
        """Impulses each sphere has received, from walls too, (N,) uint32."""
        array: NDArray[np.uint32] = readonly(self._motion.state.collision_count)
        return array

    # The world.

    @property
    def walls(self) -> tuple[Wall, ...]:
        """Descriptions of the walls. May be assigned: one wall or several."""
        return self._motion.surroundings.walls

    @walls.setter
    def walls(self, value: Wall | Iterable[Wall]) -> None:
        self._motion.surround(replace(self._motion.surroundings, walls=as_walls(value)))

    @property
    def rule(self) -> Smooth:
        """What happens when two spheres meet. May be assigned."""
        return self._motion.surroundings.rule

    @rule.setter
    def rule(self, value: Smooth) -> None:
        if not isinstance(value, Smooth):
            msg = f"rule must be a Smooth(...), not {value!r}"
            raise InputError(msg)
        self._motion.surround(replace(self._motion.surroundings, rule=value))

    @property
    def gravity(self) -> Floats:
        """Acceleration of every free sphere, (3,) float64. May be assigned."""
        array: Floats = readonly(self._motion.world.gravity)
        return array

    @gravity.setter
    def gravity(self, value: Iterable[float]) -> None:
        changed = replace(self._motion.surroundings, gravity=triple("gravity", value))
        self._motion.surround(changed)

    @property
    def collide(self) -> bool:
        """False if spheres pass through one another."""
        return self._motion.surroundings.collide

    @property
    def world(self) -> World:
        """Everything but the spheres, as numbers."""
        return self._motion.world

    @property
    def state(self) -> State:
        """A copy of everything about the spheres at this moment."""
        return self._motion.state.copy()

    # What has happened.

    @property
    def time(self) -> float:
        """Simulated time."""
        return self._motion.time

    @property
    def collisions(self) -> int:
        """Collisions between spheres since the start."""
        return self._motion.collisions

    @property
    def wall_collisions(self) -> int:
        """Collisions with walls since the start."""
        return self._motion.wall_collisions

    @property
    def events(self) -> NDArray[Any]:
        """Records of the last `run`, oldest first, with fields time, i, j, impulse.

        Pairs have i < j; `impulse` acts on i and its opposite on j. ``j = -1 - k`` is wall
        k; ``j = -2**20 - 1 - k`` came to rest on wall k; ``j = -2**21`` left its rest.
        Only the newest are held, see `keep_events`.
        """
        return self._motion.events

    @property
    def dissipated(self) -> float:
        """Energy that inelastic collisions have taken since the start."""
        return self._motion.dissipated

    @property
    def withheld(self) -> float:
        """Energy that the contact-time cure has kept from being taken, see `Smooth`."""
        return self._motion.withheld

    @property
    def energy_drift(self) -> float:
        """(kinetic + potential + dissipated - start)/start: the error of the arithmetic.

        An assignment, addition or removal between runs makes a new start, and the errors of
        all starts are summed. If the energy at a start is 0, its error is relative to the sizes
        of kinetic and potential energy.
        """
        return self._motion.energy_drift

    @property
    def max_overlap(self) -> float:
        """Largest (sigma - r)/sigma since the start, of collisions and of neighbours now."""
        return self._motion.max_overlap

    @property
    def missed(self) -> int:
        """Collisions that ``method="tick"`` has not seen since the start; 0 for exact methods.

        Counted are those that exact flight from the start of each tick has within it.
        """
        return self._motion.missed

    # Sums over all spheres that are not fixed. Cost: one pass over the arrays.

    @property
    def kinetic_energy(self) -> float:
        """½ Σ m v²."""
        return mechanics.kinetic_energy(self._motion.state)

    @property
    def potential_energy(self) -> float:
        """-Σ m g·x, zero at the origin."""
        return mechanics.potential_energy(self._motion.state, self._motion.world)

    @property
    def momentum(self) -> Floats:
        """Σ m v, (3,) float64."""
        return mechanics.momentum(self._motion.state)

    @property
    def temperature(self) -> float:
        """2K/f, with K about the centre-of-mass motion where that is conserved.

        f = 3N - (number of axes along which momentum is conserved); nan if f = 0.
        """
        return mechanics.temperature(self._motion.state, self._motion.world)

    @property
    def packing_fraction(self) -> float:
        """Volume of the spheres over that of the world; nan where that is open."""
        return mechanics.packing_fraction(self._motion.state, self._motion.world)
