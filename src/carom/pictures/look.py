"""Colours of pictures, the same as the page's: themes, scales, and what a sphere's colour says."""

import math
from dataclasses import dataclass
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from carom.color import SPECIES, Colors
from carom.state import Floats, State

Color = Literal["energy", "speed", "collisions", "own", "species"]
Theme = Literal["dark", "light"]
COLORS: tuple[Color, ...] = get_args(Color)

#: From slow to fast, and from few collisions to many.
SPEEDS = (0x4059D6, 0x4C8FE6, 0x55BCCB, 0xB4D98A, 0xFFE65A)
COLLISIONS = (0x5B2A86, 0x9C2F7F, 0xDB4F5F, 0xF98E4B, 0xFDE7A0)
FEWEST = 5  #: collisions at the end of the scale, at least: one step must not look like all


@dataclass(frozen=True)
class Palette:
    """Colours of a theme as 0xRRGGBB, amounts of light, and how opaque walls are.

    `shade` and `contact` are the darkness of shadows and of spots under spheres.
    """

    back: int
    line: int
    shell: int
    surface: int
    text: int
    floor: float
    wall: float
    key: tuple[float, float, float]
    sky: tuple[float, float, float]
    ground: tuple[float, float, float]
    tint: float
    shade: float
    contact: float
    fog: float = 0.5


THEMES: dict[str, Palette] = {
    "dark": Palette(
        back=0x1A2231, line=0xA9BAD6, shell=0x35D97C, surface=0x3D4A63, text=0xE6EDF8,
        floor=0.72, wall=0.16,
        key=(1.2, 1.16, 1.1), sky=(0.34, 0.38, 0.46), ground=(0.09, 0.095, 0.12),
        tint=0.06, shade=0.6, contact=0.75,
    ),
    "light": Palette(
        back=0xFAFBFD, line=0x40506B, shell=0x0D9A4A, surface=0xE4E8EF, text=0x1F2937,
        floor=0.85, wall=0.3,
        key=(0.95, 0.93, 0.9), sky=(0.5, 0.52, 0.56), ground=(0.24, 0.24, 0.25),
        tint=-0.46, shade=0.26, contact=0.42,
    ),
}  # fmt: skip


def parts(color: int | Colors) -> Floats:
    """Red, green and blue from 0 to 1, along a last axis."""
    packed = np.asarray(color, np.uint32)[..., None]
    rgb: Floats = (packed >> np.array([16, 8, 0], np.uint32) & 255) / 255
    return rgb


def whole(rgb: Floats) -> Colors:
    """The same packed again."""
    levels: Colors = (np.clip(rgb, 0, 1) * 255 + 0.5).astype(np.uint32)
    red, green, blue = np.moveaxis(levels, -1, 0)
    packed: Colors = red << np.uint32(16) | green << np.uint32(8) | blue
    return packed


def saturated(own: Floats, saturation: Floats) -> Floats:
    """The paper's HSB colour: hue and brightness are the sphere's own, saturation its energy."""
    most, least = own.max(axis=-1, keepdims=True), own.min(axis=-1, keepdims=True)
    grey = most == least
    hue = np.where(grey, [1.0, 0.0, 0.0], (own - least) / np.where(grey, 1.0, most - least))
    result: Floats = most * (1 + np.asarray(saturation)[..., None] * (hue - 1))
    return result


def along(scale: tuple[int, ...], place: Floats) -> Floats:
    """Colours on a scale, from 0 to 1."""
    stops = parts(np.array(scale, np.uint32))
    at = np.linspace(0, 1, len(scale))
    return np.stack([np.interp(place, at, channel) for channel in stops.T], axis=-1)


def colors_of(state: State, color: Color, full: float) -> Colors:
    """The colour of each sphere, 0xRRGGBB.

    `full` is the energy, speed or number of collisions at the end of the scale.
    """
    much: Floats = np.zeros(len(state))
    if color == "collisions":
        much = state.collision_count / full
    elif color in ("energy", "speed"):
        squares = np.einsum("ij,ij->i", state.velocity, state.velocity)
        much = np.sqrt(squares) / full
        if color == "energy":
            much = np.where(state.fixed, 0.0, state.mass) * squares / 2 / full
    return some_colors(state, color, np.clip(much, 0, 1))


def some_colors(state: State, color: Color, shares: Floats) -> Colors:
    """The colour of each sphere at a place on the scale, from 0 to 1."""
    if color == "own":
        return state.color
    if color == "species":
        species: Colors = SPECIES[state.species % len(SPECIES)]
        return species
    if color == "energy":
        return whole(saturated(parts(state.color), shares))
    return whole(along(SPEEDS if color == "speed" else COLLISIONS, shares))


def full_count(counts: NDArray[np.uint32]) -> float:
    """The end of the scale of collisions: 1, 2 or 5 times a power of ten, rounded up."""
    most = max(FEWEST, int(counts.max(initial=0)))
    power = 10.0 ** math.floor(math.log10(most))
    return next(step * power for step in (1, 2, 5, 10) if step * power >= most)


def is_paper(scene: Any) -> bool:
    """Whether a scene (or None) has the look of the paper."""
    return scene is not None and bool(scene.wire) and scene.color == "energy"
