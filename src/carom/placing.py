"""Spheres come and go: what a simulation is filled with, and what is taken out again."""

import operator
from typing import Any

from numpy.typing import ArrayLike

from carom.ball import Ball
from carom.checks import nearest
from carom.errors import InputError, UnknownNameError
from carom.readout import Readout
from carom.scene import Spheres


class Placing(Readout):
    """The part of `carom.Simulation` that adds, finds and removes spheres."""

    def add(
        self,
        position: ArrayLike = (0.0, 0.0, 0.0),
        velocity: ArrayLike = (0.0, 0.0, 0.0),
        radius: float = 0.5,
        mass: float = 1.0,
        color: str | int | None = None,
        species: int = 0,
        fixed: bool = False,
    ) -> Ball:
        """Add one sphere, now, and return a live view of it.

        Parameters
        ----------
        position, velocity : (3,) array_like
        radius, mass : float
        color : str or int, optional
            A name ("red"), "#rrggbb" or 0xRRGGBB; one per species if left out.
        species : int
            A label, for colouring and measuring.
        fixed : bool
            Nothing moves it: its mass is infinite and it counts in no energy or momentum.

        Raises
        ------
        OverlapError
            If it reaches into another sphere (names the pair and the depth) or a wall.
        InputError
            If a value cannot be used.
        """
        spheres = Spheres.of(position, velocity, radius, mass, color, species, fixed)
        if len(spheres) != 1:
            msg = f"add() takes one sphere and got {len(spheres)} positions; use add_many()"
            raise InputError(msg)
        self._motion.extend(spheres)
        return Ball(self._motion, len(self) - 1)

    def add_many(self, position: ArrayLike, **options: Any) -> slice:
        """Add spheres and return where they stand in the arrays.

        Parameters
        ----------
        position : (N, 3) array_like
        **options
            velocity (N, 3), radius, mass, color, species, fixed (N,): one value for all,
            or one each; see `add`.

        Raises
        ------
        OverlapError, InputError
            See `add`. Then none is added.
        """
        names = ("velocity", "radius", "mass", "color", "species", "fixed")
        for name in options:
            if name not in names:
                msg = f"a sphere has no {name!r}{nearest(name, names)}"
                raise UnknownNameError(msg)
        first = len(self)
        self._motion.extend(Spheres.of(position, **options))
        return slice(first, len(self))

    def __len__(self) -> int:
        return len(self._motion.state)

    def __getitem__(self, index: int) -> Ball:
        """Return a live view of sphere `index`."""
        return Ball(self._motion, range(len(self))[index])

    def remove(self, index: int) -> None:
        """Take one sphere away, now; those behind it move up by one place.

        Each `Ball` follows its sphere. The clock, the counters and the last run's events stay.

        Parameters
        ----------
        index : int
            Place in the arrays; negative ones count from the end.

        Raises
        ------
        InputError
            If there is no such sphere.
        """
        try:
            place = range(len(self))[operator.index(index)]
        except (IndexError, TypeError):
            n = len(self)
            numbers = f"give a whole number from 0 to {n - 1}" if n else "there are none left"
            msg = f"there is no sphere {index!r} to remove; {numbers}"
            raise InputError(msg) from None
        self._motion.remove(place)
