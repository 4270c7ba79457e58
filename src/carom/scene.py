"""A scene: spheres and their world, described once, built when needed."""

from collections.abc import Iterable
from dataclasses import dataclass, field, fields
from typing import Any, Literal, Self, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom import fit
from carom.checks import Triple, nearest, number, triple
from carom.color import SPECIES, Colors, packed_many
from carom.errors import InputError, UnknownNameError
from carom.markup import html_picture, html_table
from carom.rules import Smooth
from carom.state import Floats, State
from carom.walls import Open, Wall, as_walls, wall_names, world
from carom.world import World

Coloring = Literal["energy", "own", "speed", "species"]


@dataclass(frozen=True, eq=False)
class Spheres:
    """N spheres as arrays; made with `Spheres.of`, joined with ``+``.

    Attributes
    ----------
    position, velocity : (N, 3) float64
    radius, mass : (N,) float64
        Mass is inf where `fixed`.
    color : (N,) uint32
        Packed 0xRRGGBB.
    species : (N,) uint32
    fixed : (N,) bool
        Fixed spheres never move, and may overlap walls and each other.
    """

    position: Floats
    velocity: Floats
    radius: Floats
    mass: Floats
    color: Colors
    species: NDArray[np.uint32]
    fixed: NDArray[np.bool_]

    @classmethod
    def of(
        cls,
        position: ArrayLike,
        velocity: ArrayLike = 0.0,
        radius: ArrayLike = 0.5,
        mass: ArrayLike = 1.0,
        color: Any = None,
        species: ArrayLike = 0,
        fixed: ArrayLike = False,
    ) -> Self:
        """Spheres at `position`; everything else may be one value for all.

        Parameters
        ----------
        position : (N, 3) or (3,) array_like
        velocity : (N, 3), (3,) or scalar array_like
        radius, mass : (N,) or scalar array_like
            The mass of a fixed sphere is not used.
        color : str, int or sequence of them, optional
            Names, "#rrggbb" or 0xRRGGBB; if left out, one colour per species.
        species : (N,) or scalar array_like of int
        fixed : (N,) or scalar array_like of bool

        Raises
        ------
        InputError
            If shapes do not fit, or something is no number or colour.

        Examples
        --------
        >>> len(Spheres.of([(0, 0, 0), (2, 0, 0)], mass=[1, 2]))
        2
        """
        x = np.atleast_2d(_array("position", position, np.float64))
        if x.shape == (1, 0):
            x = x.reshape(0, 3)
        if x.ndim != 2 or x.shape[1] != 3:
            msg = f"position has shape {x.shape}; give three numbers (x, y, z) per sphere"
            raise InputError(msg)
        n = len(x)
        kind = _array("species", species, np.int64)
        if kind.size and (kind.min() < 0 or kind.max() >= 2**32):
            msg = f"species {kind.min()} ... {kind.max()} must lie in 0 ... 2**32 - 1"
            raise InputError(msg)
        still = _spread("fixed", _array("fixed", fixed, np.bool_), (n,))
        mass_of_all = _spread("mass", _array("mass", mass, np.float64), (n,))
        kind = _spread("species", kind, (n,)).astype(np.uint32)
        return cls(
            position=x,
            velocity=_spread("velocity", _array("velocity", velocity, np.float64), (n, 3)),
            radius=_spread("radius", _array("radius", radius, np.float64), (n,)),
            mass=np.where(still, np.inf, mass_of_all),
            color=SPECIES[kind % len(SPECIES)] if color is None else packed_many(color, n),
            species=kind,
            fixed=still,
        )

    def __post_init__(self) -> None:
        for f in fields(self):
            array = np.array(getattr(self, f.name))
            array.setflags(write=False)
            object.__setattr__(self, f.name, array)

    def __len__(self) -> int:
        return len(self.radius)

    def __add__(self, other: "Spheres") -> "Spheres":
        pairs = ((getattr(self, f.name), getattr(other, f.name)) for f in fields(self))
        return Spheres(*(np.concatenate(pair) for pair in pairs))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Spheres) and all(
            np.array_equal(getattr(self, f.name), getattr(other, f.name)) for f in fields(self)
        )

    __hash__ = None  # type: ignore[assignment]  # equality compares arrays

    def state(self) -> State:
        """Copy these spheres into a `State` at time 0."""
        state = State.empty(len(self))
        for f in fields(self):
            setattr(state, f.name, getattr(self, f.name).copy())
        return state


def _array(name: str, values: Any, dtype: Any) -> NDArray[Any]:
    """`values` as an array of numbers, or a sentence."""
    try:
        array = np.asarray(values)
    except ValueError as error:  # rows of different length
        msg = f"{name} has rows of different length; give one row of numbers per sphere"
        raise InputError(msg) from error
    allowed = {"f": "fiu", "i": "iu", "b": "b"}[np.dtype(dtype).kind]
    if array.dtype.kind not in allowed and array.size:
        what = {"f": "numbers", "i": "whole numbers", "b": "True or False"}[np.dtype(dtype).kind]
        msg = f"{name} must be {what}, not {values!r:.60}"
        raise InputError(msg)
    return array.astype(dtype)


def _spread(name: str, array: NDArray[Any], shape: tuple[int, ...]) -> NDArray[Any]:
    """One value for all, or one for each."""
    try:
        return np.broadcast_to(array, shape)
    except ValueError as error:
        msg = f"{name} has shape {array.shape}, which does not fit {shape[0]} spheres"
        raise InputError(msg) from error


@dataclass(frozen=True, slots=True)
class Camera:
    """Where the view looks from, and what at; z points up.

    Parameters
    ----------
    position, target : (3,) floats

    Raises
    ------
    InputError
        If a number is not finite, or the two are one point.
    """

    position: Triple
    target: Triple = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        object.__setattr__(self, "position", triple("camera position", self.position))
        object.__setattr__(self, "target", triple("camera target", self.target))
        if self.position == self.target:
            msg = f"the camera is at its own target {self.target}; move one of them"
            raise InputError(msg)


@dataclass(frozen=True, slots=True)
class Origin:
    """Which scene of the library a `Scene` is.

    Attributes
    ----------
    name : str
        As on the command line.
    options : dict
        All options by their names in Python, those left out with their defaults.
    made : Scene, optional
        As the library made it, to see what was replaced since. Not part of equality.
    """

    name: str
    options: dict[str, Any]
    made: "Scene | None" = field(default=None, repr=False, compare=False)


@dataclass(frozen=True)
class Scene:
    """Everything a run starts from; nothing in it changes.

    Parameters
    ----------
    spheres : Spheres
    walls : wall or walls
        They act together; open space if left out.
    rule : Smooth
        What happens when two spheres meet.
    gravity : (3,) floats
        Acceleration of every free sphere.
    collide : bool
        False makes an ideal gas: spheres pass through one another, and may start so.
    seed : int, optional
        What the random numbers of the scene came from.
    pace : float
        Simulated time per second at speed 1x.
    camera : Camera, optional
        The view fits the scene if left out.
    color : {"energy", "own", "speed", "species"}
        What the view colours by; "energy" is the paper's saturation.
    title : str
    wire : bool
        Draw spheres as wires, as the paper does.
    origin : Origin, optional
        Set by the scenes of the library. It is a remark: two scenes that differ in it alone
        are equal, and `dataclasses.replace` keeps it.

    Raises
    ------
    InputError
        If a value cannot be used. Whether the spheres fit their world is checked by `build`.

    Examples
    --------
    >>> scene = Scene(Spheres.of((0, 0, 0), velocity=(1, 0, 0)))
    >>> state, world = scene.build()
    >>> len(state), len(world.walls)
    (1, 0)
    """

    spheres: Spheres
    walls: tuple[Wall, ...] = (Open(),)
    rule: Smooth = field(default_factory=Smooth)
    gravity: Triple = (0.0, 0.0, 0.0)
    collide: bool = True
    seed: int | None = None
    pace: float = 1.0
    camera: Camera | None = None
    color: Coloring = "energy"
    title: str = ""
    wire: bool = False
    origin: Origin | None = field(default=None, compare=False)

    def __post_init__(self) -> None:
        _only(Spheres, "spheres", self.spheres)
        _only(Smooth, "rule", self.rule)
        _only((Camera, type(None)), "camera", self.camera)
        _only((Origin, type(None)), "origin", self.origin)
        _only((int, np.integer, type(None)), "seed", self.seed)
        _only((bool, np.bool_), "collide", self.collide)
        _only((bool, np.bool_), "wire", self.wire)
        _only(str, "title", self.title)
        walls: Wall | Iterable[Wall] = self.walls
        object.__setattr__(self, "walls", as_walls(walls))
        object.__setattr__(self, "gravity", triple("gravity", self.gravity))
        object.__setattr__(self, "pace", number("pace", self.pace, above=0))
        if self.color not in get_args(Coloring):
            msg = (
                f"there is no coloring {self.color!r}{nearest(str(self.color), get_args(Coloring))}"
            )
            raise UnknownNameError(msg)

    def _repr_html_(self) -> str:
        # By hand: a scene that cannot be built yet is shown too.
        rows = [
            ("spheres", f"{len(self.spheres)}"),
            ("walls", ", ".join(type(wall).__name__ for wall in self.walls)),
            ("rule", repr(self.rule)),
            *([("gravity", f"{self.gravity}")] if any(self.gravity) else []),
            *([] if self.collide else [("collide", "no: spheres pass through one another")]),
            ("pace", f"{self.pace:g} time units per second"),
            *([] if self.origin is None else [("from", f"{self.origin.name}")]),
        ]
        return html_table(self.title or "Scene", rows) + html_picture(self._repr_png_())

    def build(self) -> tuple[State, World]:
        """Check everything and hand out what an engine is built from.

        Returns
        -------
        State
            With positions wrapped into the box on periodic axes; the caller may change it.
        World

        Raises
        ------
        OverlapError
            If spheres reach into one another or through a wall.
        InputError
            If there are no spheres, a number cannot be used, or the world contradicts itself.
        """
        the_world = world(self.walls, self.rule, self.gravity, self.collide)
        if len(self.spheres) == 0:
            msg = "the scene has no spheres; add at least one"
            raise InputError(msg)
        state = self.spheres.state()
        fit.check_values(state)
        state.position, state.image = fit.wrap(state.position, the_world.period)
        fit.check(state, the_world, wall_names(self.walls))
        return state, the_world

    def _repr_png_(self) -> bytes | None:
        """Show a notebook its start; None, as notebooks expect, where that cannot be built."""
        from carom.pictures.picture import small_png

        try:
            state, the_world = self.build()
        except InputError:
            return None
        return small_png(state, the_world, self)


def _only(kinds: Any, name: str, value: Any) -> None:
    if not isinstance(value, kinds):
        listed = kinds if isinstance(kinds, tuple) else (kinds,)
        names = " or ".join(k.__name__ for k in listed if k is not type(None))
        msg = f"{name} must be of type {names}, not {value!r:.60}"
        raise InputError(msg)
