"""One sphere of a simulation, seen live."""

from typing import Any, Protocol

import numpy as np

from carom.errors import InputError
from carom.state import Floats, State


class Owner(Protocol):
    """Whoever holds the spheres a `Ball` looks at."""

    @property
    def state(self) -> State:
        """The spheres as they are now."""

    def assign(self, name: str, index: int, value: Any) -> None:
        """Replace one row of one array, or refuse with `InputError`."""


class Ball:
    """A live view of one sphere: always as it is now, and settable.

    `Simulation.add` returns one. After ``sim.run(...)`` the same ball shows the new numbers.

    Examples
    --------
    >>> import carom
    >>> sim = carom.Simulation()
    >>> ball = sim.add(position=(1, 0, 0), velocity=(0, 3, 4))
    >>> float(ball.speed)
    5.0
    >>> ball.velocity = (0, 0, 0)
    >>> ball.speed
    0.0
    """

    __slots__ = ("_index", "_owner")

    def __init__(self, owner: Owner, index: int) -> None:
        self._owner = owner
        self._index = index

    def _row(self, name: str) -> Any:
        row = getattr(self._state(), name)[self._index]
        if isinstance(row, np.ndarray):
            row.flags.writeable = False  # a change in place would go unnoticed
        return row

    def _assign(self, name: str, value: Any) -> None:
        self._state()
        self._owner.assign(name, self._index, value)

    def _state(self) -> State:
        state = self._owner.state
        if self._index >= len(state):
            msg = (
                f"ball {self._index} is gone: the simulation was reset to {len(state)} spheres; "
                "add it again"
            )
            raise InputError(msg)
        return state

    @property
    def index(self) -> int:
        """Place of this ball in the arrays of its simulation."""
        return self._index

    @property
    def position(self) -> Floats:
        """Centre, (3,) float64; wrapped into the box on periodic axes."""
        row: Floats = self._row("position")
        return row

    @position.setter
    def position(self, value: Any) -> None:
        self._assign("position", value)

    @property
    def velocity(self) -> Floats:
        """(3,) float64."""
        row: Floats = self._row("velocity")
        return row

    @velocity.setter
    def velocity(self, value: Any) -> None:
        self._assign("velocity", value)

    @property
    def speed(self) -> float:
        """|v|."""
        return float(np.linalg.norm(self.velocity))

    @property
    def mass(self) -> float:
        """Inf if the ball is fixed."""
        return float(self._row("mass"))

    @mass.setter
    def mass(self, value: float) -> None:
        self._assign("mass", value)

    @property
    def radius(self) -> float:
        """Half the diameter."""
        return float(self._row("radius"))

    @radius.setter
    def radius(self, value: float) -> None:
        self._assign("radius", value)

    @property
    def kinetic_energy(self) -> float:
        """½ m v²; 0 if the ball is fixed."""
        return 0.0 if self.fixed else 0.5 * self.mass * float(self.velocity @ self.velocity)

    @property
    def color(self) -> int:
        """Packed 0xRRGGBB; may be set by name ("red") or as "#rrggbb" too."""
        return int(self._row("color"))

    @color.setter
    def color(self, value: int | str) -> None:
        self._assign("color", value)

    @property
    def species(self) -> int:
        """A label, 0 or more, for colouring and measuring."""
        return int(self._row("species"))

    @species.setter
    def species(self, value: int) -> None:
        self._assign("species", value)

    @property
    def fixed(self) -> bool:
        """Whether nothing moves this ball."""
        return bool(self._row("fixed"))

    def __repr__(self) -> str:
        x, v = (", ".join(f"{c:.6g}" for c in row) for row in (self.position, self.velocity))
        return f"<Ball {self._index}: position ({x}), velocity ({v})>"
