"""What observables are handed: batches of events, and moments."""

from functools import cached_property
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from carom.state import Floats, State
from carom.world import World

Ints = NDArray[np.int32]


class Twin(Protocol):
    """Another run in the same world: what of an engine observables need."""

    @property
    def time(self) -> float:
        """Simulated time."""

    def advance(self, until: float) -> object:
        """Run to a time, or a part of the way."""

    def state(self) -> State:
        """Its spheres now."""


class Moment(Protocol):
    """What there is to read when time stands still."""

    def going_on(self, state: State) -> Twin:
        """Another run, of these spheres in this world; this one does not notice."""

    @property
    def state(self) -> State:
        """The spheres; its arrays must stay as they are."""

    @property
    def world(self) -> World:
        """Everything but the spheres."""

    @property
    def time(self) -> float:
        """Simulated time."""

    @property
    def dissipated(self) -> float:
        """Energy the rules have taken since the start."""

    @property
    def withheld(self) -> float:
        """Energy the contact-time cure has kept from being dissipated since the start."""

    @property
    def max_overlap(self) -> float:
        """Largest (sigma - r)/sigma since the start."""


class Batch:
    """All events of a stretch of time, in their order.

    Attributes
    ----------
    records : (n,) EVENT
        With absolute times; as `carom.Simulation.events`.
    start, end : float
        The stretch of time; the next batch starts where this one ends.
    spheres : State
        Where the run began: masses, radii, species and flags are still those.
    world : World
    """

    def __init__(
        self, records: NDArray[Any], start: float, end: float, spheres: State, world: World
    ) -> None:
        self.records, self.start, self.end = records, start, end
        self.spheres, self.world = spheres, world

    def __len__(self) -> int:
        return len(self.records)

    # Columns lie 40 bytes apart in the records; whatever is used twice is copied once.

    @cached_property
    def time(self) -> Floats:
        """(n,) float64."""
        return np.ascontiguousarray(self.records["time"])

    @cached_property
    def i(self) -> Ints:
        """(n,) int32."""
        return np.ascontiguousarray(self.records["i"])

    @cached_property
    def j(self) -> Ints:
        """(n,) int32, the partner: a sphere, or below 0 a wall."""
        return np.ascontiguousarray(self.records["j"])

    @cached_property
    def impulse(self) -> Floats:
        """(3, n) float64, acting on i."""
        return np.ascontiguousarray(self.records["impulse"].T)

    @cached_property
    def size(self) -> Floats:
        """(n,) float64, lengths of the impulses."""
        x, y, z = self.impulse
        result: Floats = np.sqrt(x * x + y * y + z * z)
        return result

    @cached_property
    def is_pair(self) -> NDArray[np.bool_]:
        """(n,) bool, whether two spheres met."""
        return self.j >= 0

    @cached_property
    def all_pairs(self) -> bool:
        """Whether all are between spheres."""
        return bool(self.is_pair.all())
