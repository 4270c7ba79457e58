"""Vectors for teaching: the ten operations of the paper, one class, nothing else."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from carom.errors import InputError


@dataclass(frozen=True, slots=True)
class Vector:
    """A vector in three dimensions, as in Processing's PVector, but it never changes.

    Every operation returns a new vector or a number. ``x, y, z = vector`` unpacks it.

    Attributes
    ----------
    x, y, z : float

    Examples
    --------
    >>> velocity = Vector(3.0, 4.0)
    >>> velocity
    Vector(x=3.0, y=4.0, z=0.0)
    >>> x, y, z = velocity
    """

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0

    def __iter__(self) -> Iterator[float]:
        yield self.x
        yield self.y
        yield self.z

    def mag(self) -> float:
        """Magnitude, the length of the vector.

        >>> Vector(3.0, 4.0, 12.0).mag()
        13.0
        """
        return math.hypot(self.x, self.y, self.z)

    def add(self, other: "Vector") -> "Vector":
        """Sum of two vectors.

        >>> Vector(1.0, 2.0, 3.0).add(Vector(10.0, 20.0, 30.0))
        Vector(x=11.0, y=22.0, z=33.0)
        """
        return Vector(self.x + other.x, self.y + other.y, self.z + other.z)

    def sub(self, other: "Vector") -> "Vector":
        """Difference of two vectors: from the tip of `other` to the tip of this one.

        >>> Vector(11.0, 22.0, 33.0).sub(Vector(10.0, 20.0, 30.0))
        Vector(x=1.0, y=2.0, z=3.0)
        """
        return Vector(self.x - other.x, self.y - other.y, self.z - other.z)

    def mult(self, factor: float) -> "Vector":
        """Multiply by a number.

        >>> Vector(1.0, 2.0, 3.0).mult(2.0)
        Vector(x=2.0, y=4.0, z=6.0)
        """
        return Vector(self.x * factor, self.y * factor, self.z * factor)

    def div(self, divisor: float) -> "Vector":
        """Divide by a number.

        Raises
        ------
        InputError
            The number is 0.

        Examples
        --------
        >>> Vector(2.0, 4.0, 6.0).div(2.0)
        Vector(x=1.0, y=2.0, z=3.0)
        """
        if divisor == 0.0:
            msg = f"cannot divide {self} by 0; check the divisor first"
            raise InputError(msg)
        return Vector(self.x / divisor, self.y / divisor, self.z / divisor)

    def dist(self, other: "Vector") -> float:
        """Distance between two points.

        >>> Vector(1.0, 1.0, 1.0).dist(Vector(4.0, 5.0, 1.0))
        5.0
        """
        return self.sub(other).mag()

    def dot(self, other: "Vector") -> float:
        """Dot product: 0 if the two are perpendicular.

        >>> Vector(1.0, 2.0, 3.0).dot(Vector(4.0, 5.0, 6.0))
        32.0
        """
        return self.x * other.x + self.y * other.y + self.z * other.z

    def cross(self, other: "Vector") -> "Vector":
        """Cross product: perpendicular to both.

        >>> Vector(1.0, 0.0, 0.0).cross(Vector(0.0, 1.0, 0.0))
        Vector(x=0.0, y=0.0, z=1.0)
        """
        return Vector(
            self.y * other.z - self.z * other.y,
            self.z * other.x - self.x * other.z,
            self.x * other.y - self.y * other.x,
        )

    def normalize(self) -> "Vector":
        """Unit vector in the same direction.

        Raises
        ------
        InputError
            The vector is zero and has no direction.

        Examples
        --------
        >>> Vector(0.0, 0.0, 5.0).normalize()
        Vector(x=0.0, y=0.0, z=1.0)
        """
        length = self.mag()
        if length == 0.0:
            msg = "cannot normalize Vector(0, 0, 0): it has no direction; check mag() first"
            raise InputError(msg)
        return self.div(length)

    def limit(self, maximum: float) -> "Vector":
        """Shorten to the magnitude `maximum` if it is longer than that.

        Raises
        ------
        InputError
            `maximum` is negative.

        Examples
        --------
        >>> Vector(6.0, 8.0).limit(5.0)
        Vector(x=3.0, y=4.0, z=0.0)
        """
        if not maximum >= 0.0:
            msg = f"a magnitude cannot be limited to {maximum}; give a limit of at least 0"
            raise InputError(msg)
        length = self.mag()
        return self.mult(maximum / length) if length > maximum else self
