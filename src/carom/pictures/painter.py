"""Draws states: the core's raster, told what the page would show."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom._core import Raster
from carom.checks import nearest, number
from carom.color import Colors
from carom.errors import InputError, UnknownNameError
from carom.pictures.eye import Eye, Viewpoint, lamp, look
from carom.pictures.look import (
    COLORS,
    THEMES,
    Color,
    Palette,
    Theme,
    colors_of,
    full_count,
    is_paper,
    parts,
    some_colors,
)
from carom.pictures.room import Room
from carom.pictures.scales import Scales
from carom.state import Floats, State
from carom.world import World

Pixels = NDArray[np.uint8]

#: Spheres that a ray meets on its way, about: from the first on a crowd takes light away, from
#: the second on single shadows are lost among the others.
CROWDED, DENSE = 0.5, 5.0
FLOOR_ONLY_FROM = 3000  #: spheres, from which only the floor gets spots under them
CELL = 3  #: typical radii: the crowd's cells
SOFTEST = 0.18  #: typical radii: a half-shadow's least radius
DEEPEST = 0.3  #: of the room: half-shadows widen no more behind that
SMALLEST, LARGEST = 16, 8192  #: pixels along a side
SAMPLES = {"draft": 1, "good": 2}  #: along each side of a pixel, by quality


@dataclass(frozen=True)
class Style:
    """How pictures look; see `carom.render` for what each means."""

    size: tuple[int, int] = (1280, 720)
    camera: Viewpoint | None = None
    color: Color = "own"
    theme: Theme = "dark"
    shadows: bool = True
    quality: str = "good"
    wire: bool = False
    paper: bool = False

    def __post_init__(self) -> None:
        if not isinstance(self.size, tuple | list) or len(self.size) != 2:
            msg = f"size must be (width, height) in pixels, not {self.size!r:.60}"
            raise InputError(msg)
        if self.camera is not None and not hasattr(self.camera, "target"):
            msg = f"camera must be a Camera, not {self.camera!r:.60}"
            raise InputError(msg)
        for name, side in zip(("width", "height"), self.size, strict=True):
            if number(f"the picture's {name}", side, at_least=SMALLEST, at_most=LARGEST) % 1:
                msg = f"the picture's {name} is {side:g}; give whole pixels"
                raise InputError(msg)
        for what, value, known in (
            ("coloring", self.color, COLORS),
            ("theme", self.theme, THEMES),
            ("quality", self.quality, SAMPLES),
        ):
            if value not in known:
                msg = f"there is no {what} {value!r}{nearest(str(value), known)}"
                raise UnknownNameError(msg)

    @classmethod
    def of(cls, scene: Any, *, color: Any = None, camera: Any = None, **rest: Any) -> "Style":
        """The style that a scene (or None) asks for, where nothing else is said."""
        if scene is None:
            return cls(color=color or "own", camera=camera, **rest)
        return cls(
            color=color or scene.color,
            camera=camera or scene.camera,
            wire=scene.wire,
            paper=is_paper(scene),
            **rest,
        )

    @property
    def palette(self) -> Palette:
        """Colours of the theme."""
        return THEMES[self.theme]


class Painter:
    """Paints states of one world from one place.

    The first state says what there is to see.

    Parameters
    ----------
    state : State
    world : World
    style : Style

    Attributes
    ----------
    scales : Scales
        Of colours; they end where the first state needs it, until they are told to follow others.
    """

    def __init__(self, state: State, world: World, style: Style) -> None:
        self.style = style
        self.scales = Scales(style.paper)
        self.scales.follow(state, world)
        self._period = world.period
        self.room = Room.of(state, world)
        self.eye = look(self.room, world.gravity, style.size, style.camera)
        cover = _cover(state.radius, self.room)
        values = _look(state, self.room, self.eye, style, cover)
        self._raster = Raster(
            *style.size,
            SAMPLES[style.quality],
            self.eye.pixel,
            np.array([self.eye.place, self.eye.right, self.eye.up, self.eye.forward]),
            values,
            _faces(self.room, self.eye, style, cover, len(state)),
            _edges(self.room, self.eye),
            self.room.shells,
        )

    def end_of_scale(self, state: State) -> float:
        """Energy, speed or number of collisions at the end of the scale of colours."""
        if self.style.color == "collisions":
            return full_count(state.collision_count)
        energy, speed = self.scales.ends
        return speed if self.style.color == "speed" else energy

    def gamut(self, state: State) -> list[Pixels]:
        """Pictures of a state in all the colours that its spheres may take."""
        shares = (np.arange(len(state))[:, None] * 0.618 + [0, 0.25, 0.5, 0.75]) % 1
        return [self._draw(state, some_colors(state, self.style.color, s)) for s in shares.T]

    def paint(self, state: State) -> Pixels:
        """Draw a picture, (height, width, 3) uint8."""
        return self._draw(state, colors_of(state, self.style.color, self.end_of_scale(state)))

    def _draw(self, state: State, colors: Colors) -> Pixels:
        place, radius = state.position, state.radius
        for axis in np.flatnonzero(self._period):
            # A sphere that reaches over the border is seen on both sides.
            x = place[:, axis]
            over = np.flatnonzero(np.abs(x) + radius > self._period[axis] / 2)
            copies = place[over]
            copies[:, axis] -= np.sign(copies[:, axis]) * self._period[axis]
            place = np.concatenate([place, copies])
            radius = np.concatenate([radius, radius[over]])
            colors = np.concatenate([colors, colors[over]])
        contiguous = np.ascontiguousarray
        return self._raster.draw(
            contiguous(place), contiguous(radius), contiguous(colors), len(state)
        )


def _cover(radius: Floats, room: Room) -> float:
    """How many spheres a ray meets on its way through the room, about."""
    a, b, c = np.ptp(room.points, axis=0) + 2 * room.margin
    return float(np.pi * (radius**2).sum() / max(a * b, b * c, c * a, 1e-30))


def _look(state: State, room: Room, eye: Eye, style: Style, cover: float) -> dict[str, object]:
    palette = style.palette
    typical = float(np.sort(state.radius)[len(state) // 2]) if len(state) else 1.0
    towards = lamp(eye, room)
    light = room.points @ towards
    colors = {name: getattr(palette, name) for name in ("back", "line", "shell", "surface")}
    return {
        **{name: parts(color).tolist() for name, color in colors.items()},
        "key": list(palette.key),
        "sky": list(palette.sky),
        "ground": list(palette.ground),
        "tint": [palette.tint] * 3,
        "lamp": towards.tolist(),
        "up": eye.above.tolist(),
        "low": (room.points.min(axis=0) - room.margin).tolist(),
        "high": (room.points.max(axis=0) + room.margin).tolist(),
        "fog_from": eye.distance - 0.4 * eye.reach,
        "fog_per_length": 1 / (2.6 * eye.reach),
        "fog_most": palette.fog,
        "line_width": 1.25 * max(1.0, style.size[1] / 720),
        "soft": SOFTEST * typical,
        "deepest": DEEPEST * float(np.ptp(light) + 2 * (room.margin + state.radius.max(initial=0))),
        "shadowed": 1 / (1 + 0.5 * cover),
        "crowd_cell": CELL * typical if cover > CROWDED else 0.0,
        "wire": bool(style.wire),
        "shadows": bool(style.shadows) and cover <= DENSE,
    }


def _faces(room: Room, eye: Eye, style: Style, cover: float, n: int) -> Floats:
    """The rows that the core wants, see ``core/raster/picture.hpp``."""
    palette = style.palette
    rows = []
    for face in room.seen_from(eye.place):
        floor = face.endless or face.normal @ eye.above > 0.9
        lengths = np.linalg.norm(face.sides, axis=1)
        spots = style.shadows and (floor or n <= FLOOR_ONLY_FROM)
        rows.append(
            [
                *face.corner, *(face.sides / lengths[:, None]).ravel(), *face.normal, *lengths,
                *face.grid,
                palette.floor if floor else palette.wall,
                0.2 if face.endless else 0.12 if floor else 0.06,
                float(face.endless),
                palette.shade if floor else 0.4 * palette.shade,
                palette.contact / (1 + 0.3 * cover) if spots else 0.0,
            ]
        )  # fmt: skip
    return np.array(rows, np.float64).reshape(-1, 23)


def _edges(room: Room, eye: Eye) -> Floats:
    """Lines, fainter where the box turns towards the eye."""
    rows = []
    for edge in room.edges:
        sight = eye.place - (edge.begin + edge.end) / 2
        alpha = 0.34 if (edge.outward @ sight).min() > 0 else 0.66
        rows.append([*edge.begin, *edge.end, alpha, edge.dash])
    return np.array(rows, np.float64).reshape(-1, 8)
