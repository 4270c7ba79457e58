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

    def serial(self, index: int) -> int:
        """What stands for one sphere for ever, whatever its place in the arrays."""

    def place(self, serial: int) -> int | None:
        """Where that sphere is in the arrays now; None if it is gone."""


class Ball:
    """A live view of one sphere: always as it is now, and settable.

    `Simulation.add` returns one. After ``sim.run(...)`` the same ball shows the new numbers,
    and it follows its sphere when another one is removed.

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

    __slots__ = ("_index", "_owner", "_serial")

    def __init__(self, owner: Owner, index: int) -> None:
        self._owner = owner
        self._index = index
        self._serial = owner.serial(index)

    def _row(self, name: str) -> Any:
        row = getattr(self._owner.state, name)[self.index]
        if isinstance(row, np.ndarray):
            row.flags.writeable = False  # a change in place would go unnoticed
        return row

    def _assign(self, name: str, value: Any) -> None:
        self._owner.assign(name, self.index, value)

    @property
    def index(self) -> int:
        """Place of this ball in the arrays of its simulation."""
        place = self._owner.place(self._serial)
        if place is None:
            msg = (
                f"ball {self._index} is gone: it was removed, or the simulation went back to a "
                "time without it; add it again"
            )
            raise InputError(msg)
        self._index = place
        return place

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
        return f"<Ball {self.index}: position ({x}), velocity ({v})>"
