"""Where spheres may be: frozen descriptions, all centred on the origin, and their `World`.

Each refuses a size that is not positive and finite, and a restitution outside [0, 1], with
an `InputError`.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Literal, Self

import numpy as np

from carom.checks import Triple, number, triple
from carom.errors import InputError
from carom.rules import Smooth
from carom.state import Floats
from carom.world import CYLINDER, PLANE, SPHERE, WALL, World

Reflection = Literal["specular", "bounce-back"]
AXES = "xyz"


class _Hard:
    """The parts all hard walls share: checked sizes, restitution and reflection."""

    __slots__ = ()
    restitution: float
    reflection: Reflection

    def _check(self, sizes: Sequence[str]) -> None:
        kind = type(self).__name__
        for name in sizes:
            value = number(f"{name} of the {kind}", getattr(self, name), above=0)
            object.__setattr__(self, name, value)
        e = number(f"restitution of the {kind}", self.restitution, at_least=0, at_most=1)
        object.__setattr__(self, "restitution", e)
        if self.reflection not in ("specular", "bounce-back"):
            msg = f"{kind}: reflection must be 'specular' or 'bounce-back', not {self.reflection!r}"
            raise InputError(msg)


@dataclass(frozen=True, slots=True)
class Box(_Hard):
    """A box with six hard walls: ``|x| <= lx/2``, ``|y| <= ly/2``, ``|z| <= lz/2``.

    Counts as six walls in events: x-, x+, y-, y+, z-, z+. At a wall with normal n (into
    the box) a sphere's v . n becomes -e v . n and the tangential velocity stays;
    with ``reflection="bounce-back"`` the whole velocity turns round, v -> -e v.

    Parameters
    ----------
    lx, ly, lz : float
        Lengths of the sides.
    restitution : float
        e, 0 <= e <= 1.
    reflection : {"specular", "bounce-back"}

    Examples
    --------
    >>> Box(10, 10, 10, restitution=0.9).lx
    10.0
    """

    lx: float
    ly: float
    lz: float
    restitution: float = 1.0
    reflection: Reflection = "specular"

    def __post_init__(self) -> None:
        self._check(("lx", "ly", "lz"))

    @classmethod
    def examples(cls) -> list[Self]:
        """One of each kind, for tests that run over all walls."""
        return [cls(10, 10, 10), cls(8, 9, 10, 0.9), cls(8, 8, 8, reflection="bounce-back")]


@dataclass(frozen=True, slots=True)
class Periodic:
    """A world that repeats: on each periodic axis x and x + l are the same place.

    A sphere that leaves at l/2 comes back at -l/2, and meets the images of the others.
    Counts as no wall in events.

    Parameters
    ----------
    lx, ly, lz : float or None
        Length of each axis; None where the axis is not periodic.

    Raises
    ------
    InputError
        If a length is not positive and finite, or no axis is periodic.

    Examples
    --------
    >>> Periodic(10, 10, None)
    Periodic(lx=10.0, ly=10.0, lz=None)
    """

    lx: float | None
    ly: float | None
    lz: float | None

    def __post_init__(self) -> None:
        if self.lx is None and self.ly is None and self.lz is None:
            msg = "Periodic(None, None, None) has no periodic axis; give a length or use Open()"
            raise InputError(msg)
        for name in ("lx", "ly", "lz"):
            if (value := getattr(self, name)) is not None:
                object.__setattr__(self, name, number(f"{name} of Periodic", value, above=0))

    @classmethod
    def examples(cls) -> list[Self]:
        """One of each kind, for tests that run over all walls."""
        return [cls(10, 10, 10), cls(8, 9, None), cls(None, None, 12)]


@dataclass(frozen=True, slots=True)
class Sphere(_Hard):
    """A *container*: spheres live inside a hollow sphere ``|r| <= radius`` about the origin.

    (The balls themselves are made by `Simulation.add` or `Spheres.of`.) A ball of radius R
    hits it where its centre is ``radius - R`` from the origin; the normal points to the
    centre and the impulse is that of a wall, see `Box`.

    Parameters
    ----------
    radius : float
        Of the container.
    restitution : float
        e, 0 <= e <= 1.
    reflection : {"specular", "bounce-back"}

    Examples
    --------
    >>> Sphere(500, reflection="bounce-back").radius
    500.0
    """

    radius: float
    restitution: float = 1.0
    reflection: Reflection = "specular"

    def __post_init__(self) -> None:
        self._check(("radius",))

    @classmethod
    def examples(cls) -> list[Self]:
        """One of each kind, for tests that run over all walls."""
        return [cls(6), cls(6, 0.8), cls(6, reflection="bounce-back")]


@dataclass(frozen=True, slots=True)
class Cylinder(_Hard):
    """A closed tube about the z axis: ``x^2 + y^2 <= radius^2`` and ``|z| <= length/2``.

    Counts as three walls in events: side, bottom (z-), top (z+). The impulse is that of a
    wall, see `Box`.

    Parameters
    ----------
    radius, length : float
    restitution : float
        e, 0 <= e <= 1.
    reflection : {"specular", "bounce-back"}

    Examples
    --------
    >>> Cylinder(radius=3, length=10)
    Cylinder(radius=3.0, length=10.0, restitution=1.0, reflection='specular')
    """

    radius: float
    length: float
    restitution: float = 1.0
    reflection: Reflection = "specular"

    def __post_init__(self) -> None:
        self._check(("radius", "length"))

    @classmethod
    def examples(cls) -> list[Self]:
        """One of each kind, for tests that run over all walls."""
        return [cls(5, 12), cls(5, 12, 0.8), cls(5, 12, reflection="bounce-back")]


@dataclass(frozen=True, slots=True)
class Plane(_Hard):
    """One flat wall: spheres stay where ``n . x >= offset``.

    n is the unit vector along `normal`, so `offset` is a distance whatever the length of
    `normal`. A sphere of radius R hits the plane at n . x = offset + R; the impulse is
    that of a wall, see `Box`.

    Parameters
    ----------
    normal : (3,) floats
        Points from the wall to the spheres.
    offset : float
        Distance of the plane from the origin, along the normal.
    restitution : float
        e, 0 <= e <= 1.
    reflection : {"specular", "bounce-back"}

    Examples
    --------
    A floor five below the origin:

    >>> Plane((0, 0, 1), -5).offset
    -5.0
    """

    normal: Triple
    offset: float
    restitution: float = 1.0
    reflection: Reflection = "specular"

    def __post_init__(self) -> None:
        self._check(())
        normal = triple("normal of the Plane", self.normal)
        if normal == (0, 0, 0):
            msg = "normal of the Plane is (0, 0, 0); give the direction in which the spheres are"
            raise InputError(msg)
        object.__setattr__(self, "normal", normal)
        object.__setattr__(self, "offset", number("offset of the Plane", self.offset))

    @property
    def unit_normal(self) -> Triple:
        """`normal` divided by its length."""
        n = np.array(self.normal)
        n /= np.abs(n).max()  # so that the squares of huge or tiny components stay finite
        n /= np.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
        return float(n[0]), float(n[1]), float(n[2])

    @classmethod
    def examples(cls) -> list[Self]:
        """One of each kind, for tests that run over all walls."""
        return [cls((0, 0, 1), -5), cls((1, 1, 0), -5, 0.8), cls((0, 1, 0), -5, 1, "bounce-back")]


@dataclass(frozen=True, slots=True)
class Open:
    """No wall at all: space goes on for ever."""

    @classmethod
    def examples(cls) -> list[Self]:
        """One of each kind, for tests that run over all walls."""
        return [cls()]


Wall = Box | Periodic | Sphere | Cylinder | Plane | Open
KINDS: tuple[type[Wall], ...] = (Box, Periodic, Sphere, Cylinder, Plane, Open)


def as_walls(walls: Wall | Iterable[Wall]) -> tuple[Wall, ...]:
    """One wall or several as a tuple; none at all is open space.

    Raises
    ------
    InputError
        If something in it is not a wall.
    """
    if isinstance(walls, KINDS):
        return (walls,)
    listed = tuple(walls) if isinstance(walls, Iterable) else (walls,)
    for wall in listed:
        if not isinstance(wall, KINDS):
            names = ", ".join(kind.__name__ for kind in KINDS)
            msg = f"{wall!r} is not a wall; use one of {names}"
            raise InputError(msg)
    return listed or (Open(),)


def world(
    walls: Wall | Iterable[Wall] = (),
    rule: Smooth | None = None,
    gravity: Iterable[float] = (0.0, 0.0, 0.0),
    collide: bool = True,
) -> World:
    """Flatten descriptions into the numbers an engine is built from.

    Parameters
    ----------
    walls : wall or walls
        They act together and count in this order: a Box as six (x-, x+, y-, y+, z-, z+), a
        Cylinder as three (side, bottom, top), Periodic and Open as none.
    rule : Smooth, optional
        What happens when two spheres meet; elastic if left out.
    gravity : (3,) floats
        Acceleration of every free sphere.
    collide : bool
        False: spheres pass through one another.

    Raises
    ------
    InputError
        If a periodic axis has two lengths, or gravity along it, or a wall that closes it.
    """
    listed = as_walls(walls)
    if not isinstance(rule := rule or Smooth(), Smooth):
        msg = f"rule must be a Smooth(...), not {rule!r}"
        raise InputError(msg)
    g = triple("gravity", gravity)
    period = _period(listed)
    for axis in np.flatnonzero(period):
        if g[axis] != 0:
            msg = (
                f"gravity {g} has a part along {AXES[axis]}, which is periodic: spheres would "
                f"fall for ever; set gravity[{axis}] to 0 or close the axis with walls"
            )
            raise InputError(msg)
        for wall in listed:
            _refuse_closing(wall, int(axis))
    rows = [row for wall in listed for row in _flatten(wall)]
    return World(
        period=period,
        walls=np.array(rows, dtype=WALL) if rows else np.zeros(0, WALL),
        restitution=rule.restitution,
        contact_time=rule.contact_time or 0.0,
        gravity=np.array(g),
        collide=bool(collide),
    )


def _period(walls: tuple[Wall, ...]) -> Floats:
    """Length of each axis, 0 where it is not periodic."""
    period = np.zeros(3)
    for wall in walls:
        if isinstance(wall, Periodic):
            for axis, length in enumerate((wall.lx, wall.ly, wall.lz)):
                if length is None:
                    continue
                if period[axis]:
                    msg = (
                        f"two Periodic walls give the {AXES[axis]} axis a length "
                        f"({period[axis]:g} and {length:g}); leave None in one of them"
                    )
                    raise InputError(msg)
                period[axis] = length
    return period


def _refuse_closing(wall: Wall, axis: int) -> None:
    """Refuse a wall that stands in the way of a periodic axis."""
    name = AXES[axis]
    if isinstance(wall, Plane) and wall.normal[axis] != 0:
        msg = (
            f"the Plane with normal {wall.normal} cuts the {name} axis, which is periodic; "
            f"set normal[{axis}] to 0 or leave the axis None in Periodic"
        )
        raise InputError(msg)
    if isinstance(wall, (Box, Sphere, Cylinder)):
        msg = (
            f"the {type(wall).__name__} closes the {name} axis, which is periodic; leave the "
            "axis None in Periodic, or use Plane walls on the other axes"
        )
        raise InputError(msg)


def _flatten(wall: Wall) -> list[tuple[Any, ...]]:
    """Rows of dtype `WALL`."""
    if isinstance(wall, (Periodic, Open)):
        return []
    back, e = int(wall.reflection == "bounce-back"), wall.restitution
    if isinstance(wall, Sphere):
        return [(SPHERE, back, (0, 0, 0), wall.radius, e)]
    if isinstance(wall, Plane):
        return [(PLANE, back, wall.unit_normal, wall.offset, e)]
    if isinstance(wall, Cylinder):
        half = -wall.length / 2
        side = (CYLINDER, back, (0, 0, 0), wall.radius, e)
        return [side, (PLANE, back, (0, 0, 1), half, e), (PLANE, back, (0, 0, -1), half, e)]
    rows: list[tuple[Any, ...]] = []
    for axis, length in enumerate((wall.lx, wall.ly, wall.lz)):
        for sign in (1.0, -1.0):
            normal = [0.0, 0.0, 0.0]
            normal[axis] = sign
            rows.append((PLANE, back, tuple(normal), -length / 2, e))
    return rows


def wall_names(walls: Wall | Iterable[Wall]) -> list[str]:
    """Name each flattened wall for messages, in the order events count them.

    Examples
    --------
    >>> wall_names([Plane((0, 0, 1), 0), Box(1, 1, 1)])[:3]
    ['the Plane', 'the x- wall of the Box', 'the x+ wall of the Box']
    """
    names: list[str] = []
    for wall in as_walls(walls):
        if isinstance(wall, Box):
            names += [f"the {axis}{sign} wall of the Box" for axis in AXES for sign in "-+"]
        elif isinstance(wall, Cylinder):
            names += [f"the {part} of the Cylinder" for part in ("side", "bottom", "top")]
        elif isinstance(wall, (Sphere, Plane)):
            names.append(f"the {type(wall).__name__}")
    return names
