"""The matrix stack: the environment moves, not the object."""

import math
from dataclasses import dataclass, field

from carom.errors import InputError

#: Four columns of three numbers: where the x, y and z axes point now, and where the origin is.
Matrix = tuple[
    float, float, float, float, float, float, float, float, float, float, float, float
]  # fmt: skip

IDENTITY: Matrix = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
DEEPEST = 256  #: pushes without a pop; a program that forgets the pop would grow for ever


@dataclass
class MatrixStack:
    """The matrix that everything drawn goes through, and those kept for later.

    Attributes
    ----------
    top : Matrix
    kept : list
        Matrices pushed and not yet popped, each with the place in the program that pushed it.

    Examples
    --------
    >>> stack = MatrixStack()
    >>> stack.translate(10.0, 0.0, 0.0)
    >>> stack.rotate_z(math.pi)
    >>> stack.apply(1.0, 0.0, 0.0)[0]
    9.0
    """

    top: Matrix = IDENTITY
    kept: list[tuple[Matrix, tuple[str, int]]] = field(default_factory=list)

    def push(self, place: tuple[str, int] = ("", 0)) -> None:
        """Keep the matrix, to come back to with `pop`."""
        if len(self.kept) >= DEEPEST:
            msg = (
                f"push_matrix() was called {DEEPEST + 1} times without pop_matrix(); "
                "write one pop_matrix() for each push_matrix()"
            )
            raise InputError(msg)
        self.kept.append((self.top, place))

    def pop(self) -> None:
        """Come back to the matrix kept last."""
        if not self.kept:
            msg = "pop_matrix() without push_matrix(): nothing was kept; push_matrix() comes first"
            raise InputError(msg)
        self.top, _ = self.kept.pop()

    def apply(self, x: float, y: float, z: float) -> tuple[float, float, float]:
        """Where a point lands."""
        a, b, c, d, e, f, g, h, i, p, q, r = self.top
        return (
            a * x + d * y + g * z + p,
            b * x + e * y + h * z + q,
            c * x + f * y + i * z + r,
        )

    def translate(self, x: float, y: float, z: float) -> None:
        """Move the origin along the axes as they point now."""
        self.top = (*self.top[:9], *self.apply(x, y, z))

    def scale(self, x: float, y: float, z: float) -> None:
        """Stretch the axes."""
        self.top = self.stretched(x, y, z)

    def rotate_x(self, angle: float) -> None:
        """Turn y towards z."""
        a, b, c, d, e, f, g, h, i, *origin = self.top
        k, s = math.cos(angle), math.sin(angle)
        y = (k * d + s * g, k * e + s * h, k * f + s * i)
        z = (k * g - s * d, k * h - s * e, k * i - s * f)
        self.top = _matrix(a, b, c, *y, *z, *origin)

    def rotate_y(self, angle: float) -> None:
        """Turn z towards x."""
        a, b, c, d, e, f, g, h, i, *origin = self.top
        k, s = math.cos(angle), math.sin(angle)
        z = (k * g + s * a, k * h + s * b, k * i + s * c)
        x = (k * a - s * g, k * b - s * h, k * c - s * i)
        self.top = _matrix(*x, d, e, f, *z, *origin)

    def rotate_z(self, angle: float) -> None:
        """Turn x towards y."""
        a, b, c, d, e, f, g, h, i, *origin = self.top
        k, s = math.cos(angle), math.sin(angle)
        x = (k * a + s * d, k * b + s * e, k * c + s * f)
        y = (k * d - s * a, k * e - s * b, k * f - s * c)
        self.top = _matrix(*x, *y, g, h, i, *origin)

    def stretched(self, x: float, y: float, z: float) -> Matrix:
        """The matrix that `scale` would make."""
        a, b, c, d, e, f, g, h, i, p, q, r = self.top
        return (a * x, b * x, c * x, d * y, e * y, f * y, g * z, h * z, i * z, p, q, r)


def _matrix(*parts: float) -> Matrix:
    a, b, c, d, e, f, g, h, i, p, q, r = parts
    return a, b, c, d, e, f, g, h, i, p, q, r
