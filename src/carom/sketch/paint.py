"""Colours as a sketch writes them: greys, red-green-blue, hue-saturation-brightness, names."""

import math
from dataclasses import dataclass
from typing import Any, Literal

from carom.color import packed
from carom.errors import InputError
from carom.sketch.numbers import number

MODES = ("rgb", "hsb")


@dataclass(frozen=True, slots=True)
class Color:
    """A colour and how opaque it is, 0 ... 255 each."""

    red: int
    green: int
    blue: int
    alpha: int = 255

    @property
    def rgba(self) -> int:
        """One whole number whose bytes, in memory, are red, green, blue, alpha."""
        return self.red | self.green << 8 | self.blue << 16 | self.alpha << 24


@dataclass(frozen=True, slots=True)
class ColorMode:
    """What the numbers of a colour mean.

    Attributes
    ----------
    kind : {"rgb", "hsb"}
    most : tuple of 4 floats
        Largest value of each of the three numbers, and of alpha.
    """

    kind: Literal["rgb", "hsb"] = "rgb"
    most: tuple[float, float, float, float] = (255.0, 255.0, 255.0, 255.0)

    def color(self, where: str, *values: Any) -> Color:
        """Read a colour: grey; grey, alpha; three numbers; three and alpha; or a name.

        Numbers beyond their limits are brought inside, a hue goes round.

        Raises
        ------
        InputError
            If it is none of these.

        Examples
        --------
        >>> ColorMode().color("fill()", 255, 0, 0)
        Color(red=255, green=0, blue=0, alpha=255)
        >>> ColorMode("hsb", (360, 100, 100, 255)).color("fill()", 120, 100, 100).green
        255
        """
        if not 1 <= len(values) <= 4:
            msg = f"{where} has {len(values)} values; give a grey, three numbers, or a colour"
            raise InputError(msg)
        opaque = self._part(where, "alpha", values[-1], 3) if len(values) % 2 == 0 else 1.0
        first = values[0]
        if len(values) <= 2 and isinstance(first, Color):
            return Color(first.red, first.green, first.blue, round(first.alpha * opaque))
        if len(values) <= 2 and isinstance(first, str):
            code = packed(first)
            return Color(code >> 16, code >> 8 & 255, code & 255, _byte(opaque))
        if len(values) <= 2:
            # A grey is measured as brightness is, not as hue.
            grey = _byte(self._part(where, "grey", first, 2 if self.kind == "hsb" else 0))
            return Color(grey, grey, grey, _byte(opaque))
        names = (
            ("red", "green", "blue") if self.kind == "rgb" else ("hue", "saturation", "brightness")
        )
        if self.kind == "hsb":
            hue = number(f"{where}: hue", first) / self.most[0]
            s, b = (self._part(where, names[k], values[k], k) for k in (1, 2))
            red, green, blue = _from_hsb(6.0 * hue, s, b)
        else:
            red, green, blue = (self._part(where, names[k], values[k], k) for k in range(3))
        return Color(_byte(red), _byte(green), _byte(blue), _byte(opaque))

    def _part(self, where: str, name: str, value: Any, place: int) -> float:
        """A value as a fraction of its largest."""
        return min(1.0, max(0.0, number(f"{where}: {name}", value) / self.most[place]))


def color_mode(kind: Any, *most: Any) -> ColorMode:
    """Read the arguments of ``color_mode()``.

    Raises
    ------
    InputError
        If the mode is unknown or a limit is not positive.
    """
    name = str(kind).lower()
    if name not in MODES:
        msg = f"color_mode() is {kind!r}; it is 'rgb' or 'hsb'"
        raise InputError(msg)
    if len(most) not in (0, 1, 3, 4):
        msg = f"color_mode() has {len(most)} limits; give none, one for all, three, or four"
        raise InputError(msg)
    limits = [number("color_mode(): limit", value) for value in most] or [255.0]
    if min(limits) <= 0:
        msg = f"color_mode(): limit is {min(limits)}; it must be larger than 0"
        raise InputError(msg)
    if len(limits) == 1:
        limits = limits * 4
    a, b, c, alpha = (*limits, 255.0)[:4]
    return ColorMode("rgb" if name == "rgb" else "hsb", (a, b, c, alpha))


def _from_hsb(h: float, s: float, b: float) -> tuple[float, float, float]:
    """`carom.color.hsb` for one colour, without arrays: a sketch asks for many, one by one.

    Parameters
    ----------
    h : float
        Hue in sixths of the circle.
    s, b : float
        0 ... 1.
    """
    red, green, blue = (
        b - b * s * max(0.0, min(k, 4.0 - k, 1.0)) for k in ((n + h) % 6.0 for n in (5.0, 3.0, 1.0))
    )
    return red, green, blue


def _byte(part: float) -> int:
    return math.floor(part * 255.0 + 0.5)
