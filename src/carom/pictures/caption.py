"""Words in a picture: title, clock, and what the colours mean; drawn with Pillow."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from types import ModuleType
from typing import Any

import numpy as np

from carom.color import SPECIES
from carom.errors import InputError
from carom.pictures.letters import Letters
from carom.pictures.look import COLLISIONS, SPEEDS, along, parts, saturated
from carom.pictures.painter import Pixels, Style
from carom.state import Floats, State

LEAST = 11.5  #: size of letters in pixels; smaller ones run together
LINE = 1.3  #: sizes of its letters from line to line, at least
DIGITS = 3  #: of the time, before the point, for which a long title leaves room
HUES = 5  #: rows of the energy scale: a sphere keeps its own hue


def pillow() -> tuple[ModuleType, ModuleType, ModuleType]:
    """Pillow's Image, ImageDraw and ImageFont.

    Raises
    ------
    InputError
        If it is not installed.
    """
    try:
        from PIL import Image, ImageDraw, ImageFont
    except ImportError as missing:
        msg = (
            'words in pictures, and GIF files, need Pillow: pip install "carom[video]", '
            "or leave the words out with caption=False (--no-caption)"
        )
        raise InputError(msg) from missing
    return Image, ImageDraw, ImageFont


def short(value: float) -> str:
    """Three digits; powers of ten where there would be many zeros."""
    if value == 0 or 1e-3 <= abs(value) < 1e5:
        return f"{float(f'{value:.3g}'):g}"
    power = math.floor(math.log10(abs(value)))
    return f"{value / 10.0**power:.3g}e{power}"


@dataclass(frozen=True)
class Legend:
    """What colours mean: bars over a scale, or dots with words.

    Attributes
    ----------
    bars : list of (K, 3) float64
        Colours along each bar.
    name : str
        Of the quantity.
    dots : list of (color, text)
    """

    bars: list[Floats]
    name: str = ""
    dots: tuple[tuple[Floats, str], ...] = ()

    @classmethod
    def of(cls, state: State, style: Style) -> "Legend":
        """The legend of pictures that begin with a state."""
        place = np.linspace(0, 1, 64)
        if style.color == "energy":
            all_ = list(dict.fromkeys(state.color[:4096].tolist()))
            rows = min(HUES, len(all_))
            some = [all_[k * len(all_) // rows] for k in range(rows)]
            return cls([saturated(parts(own)[None], place) for own in some], "kinetic energy")
        if style.color == "speed":
            return cls([along(SPEEDS, place)], "speed")
        if style.color == "collisions":
            return cls([along(COLLISIONS, place)], "collisions so far")
        if style.color == "species":
            kinds, counts = np.unique(state.species, return_counts=True)
            kept = list(zip(kinds.tolist(), counts.tolist(), strict=True))[: len(SPECIES)]
            dots = (
                (parts(SPECIES[kind % len(SPECIES)]), f"species {kind}: {many}")
                for kind, many in kept
            )
            return cls([], dots=tuple(dots))
        return cls([])


class Caption:
    """Writes into pictures of one style.

    Parameters
    ----------
    title : str
    legend : Legend
    style : Style
    step : float
        Time between two pictures: the clock has as many decimals as tell them apart.
    """

    def __init__(self, title: str, legend: Legend, style: Style, step: float) -> None:
        self._image, self._draw, font = pillow()
        self._legend = legend
        # Small pictures need words that are larger in proportion.
        self._unit = min(style.size[1], 1.2 * style.size[0]) / 720
        self._unit *= max(1.0, (480 / style.size[1]) ** 0.5)
        letters = Letters(title, font)
        self._title = letters.text
        self._fonts = {
            name: letters.sized(max(LEAST, size * self._unit))
            for name, size in (("title", 25), ("clock", 22), ("legend", 17))
        }
        self._still: _Overlay | None = None
        self._still_for = 0.0
        self._decimals = min(9, max(2, math.ceil(-math.log10(step) - 1e-9))) if step > 0 else 2
        palette = style.palette
        self._ink, self._back = _rgb(parts(palette.text)), _rgb(parts(palette.back))
        self._faint = _rgb(parts(palette.line))

    def write(self, pixels: Pixels, time: float, full: float) -> Pixels:
        """Add the words of a moment; `full` is the end of the scale of colours."""
        if self._still is None or self._still_for != full:
            self._still = _Overlay(lambda ground: self._draw_still(ground, full), pixels)
            self._still_for = full
        result = self._still.over(pixels)
        edge = 28 * self._unit
        strip = result[: math.ceil(edge + 2 * self._fonts["clock"].size)]
        image = self._image.fromarray(strip)
        clock = f"time {time:.{self._decimals}f}"
        place = (image.size[0] - edge, edge)
        self._text(self._draw.Draw(image), place, clock, "clock", "rt", self._ink)
        strip[:] = np.asarray(image)
        return result

    def _draw_still(self, pixels: Pixels, full: float) -> Pixels:
        """What stays from picture to picture: title and legend."""
        image = self._image.fromarray(pixels)
        draw = self._draw.Draw(image)
        edge = 28 * self._unit
        clock = self._fonts["clock"].getlength(f"time {10**DIGITS:.{self._decimals}f}")
        title = _fitted(self._title, self._fonts["title"], image.size[0] - 3 * edge - clock)
        self._text(draw, (edge, edge), title, "title", "lt", self._ink)
        self._draw_legend(draw, edge, image.size[1] - edge, full)
        return np.asarray(image)

    def _text(
        self, draw: Any, place: tuple[float, float], text: str, name: str, anchor: str, ink: Any
    ) -> None:
        # A rim of the background's colour keeps words readable over spheres.
        rim = max(1, round(1.5 * self._unit))
        font = self._fonts[name]
        draw.text(
            place, text, ink, font, anchor, stroke_width=rim, stroke_fill=self._back
        )  # fmt: skip

    def _draw_legend(self, draw: Any, left: float, bottom: float, full: float) -> None:
        unit, legend = self._unit, self._legend
        font = self._fonts["legend"]
        line = max(25 * unit, LINE * font.size)
        for k, (color, text) in enumerate(reversed(legend.dots)):
            middle, r = bottom - (k + 0.5) * line, 7 * unit
            spot = (left, middle - r, left + 2 * r, middle + r)
            draw.ellipse(spot, _rgb(color), self._back, max(1, round(unit)))
            self._text(draw, (left + 24 * unit, middle), text, "legend", "lm", self._ink)
        if not legend.bars:
            return
        end = short(full) if legend.name.startswith("collisions") else f"{short(full)} +"
        width = max(250 * unit, font.getlength(f"0  {legend.name}  {end}"))
        self._text(draw, (left, bottom), "0", "legend", "ls", self._ink)
        # In the middle of what the numbers leave free.
        middle = left + (width + font.getlength("0") - font.getlength(end)) / 2
        self._text(draw, (middle, bottom), legend.name, "legend", "ms", self._ink)
        self._text(draw, (left + width, bottom), end, "legend", "rs", self._ink)
        high = (15 if len(legend.bars) == 1 else 9) * unit
        top = bottom - line - len(legend.bars) * high
        for row, bar in enumerate(legend.bars):
            upper, lower = round(top + row * high), round(top + (row + 1) * high) - 1
            ends = round(left), round(left + width)
            for x in range(*ends):
                color = bar[(x - ends[0]) * len(bar) // (ends[1] - ends[0])]
                draw.line((x, upper, x, lower), _rgb(color))
        frame = (round(left) - 1, round(top) - 1, round(left + width), lower + 1)
        draw.rectangle(frame, None, self._faint, max(1, round(unit)))


def _fitted(text: str, font: Any, room: float) -> str:
    """As much of a text as there is room for in pixels; dots say where some is missing."""
    if font.getlength(text) <= room:
        return text
    while text and font.getlength(f"{text}...") > room:
        text = text[:-1].rstrip()
    return f"{text}..." if len(text) > 3 else ""


class _Overlay:
    """Something drawn once, to be laid over many pictures.

    Drawn on black and on white, it shows its colour and how much of the ground it lets through.

    Parameters
    ----------
    draw : callable
        Draws on pixels and returns the result.
    pixels : (height, width, 3) uint8
        A picture of that size.
    """

    def __init__(self, draw: Callable[[Pixels], Pixels], pixels: Pixels) -> None:
        black, white = (draw(np.full_like(pixels, level)) for level in (0, 255))
        through = np.clip(white.astype(np.int16) - black, 0, 255)
        covered = (through < 255).any(axis=2)
        self._parts = []
        # The upper and the lower half: title and legend lie far apart.
        middle = len(pixels) // 2
        for half in (slice(0, middle), slice(middle, None)):
            rows, columns = (np.flatnonzero(covered[half].any(axis=axis)) for axis in (1, 0))
            if not len(rows):
                continue
            first = half.start + rows[0]
            at = np.s_[first : half.start + rows[-1] + 1, columns[0] : columns[-1] + 1]
            self._parts.append((at, black[at].astype(np.uint16), through[at].astype(np.uint16)))

    def over(self, pixels: Pixels) -> Pixels:
        """A picture with it."""
        result = pixels.copy()
        for at, color, through in self._parts:
            result[at] = np.minimum(color + (result[at] * through + 127) // 255, 255)
        return result


def _rgb(color: Floats) -> tuple[int, int, int]:
    red, green, blue = (int(255 * part + 0.5) for part in color)
    return red, green, blue
