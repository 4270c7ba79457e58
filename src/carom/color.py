"""Colours: names, ``#rrggbb``, numbers and HSB, all packed into 0xRRGGBB."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.checks import nearest
from carom.errors import InputError, UnknownNameError

Colors = NDArray[np.uint32]

#: The sixteen basic colours of CSS and a few that people ask for.
NAMES = {
    "black": 0x000000, "silver": 0xC0C0C0, "gray": 0x808080, "white": 0xFFFFFF,
    "maroon": 0x800000, "red": 0xFF0000, "purple": 0x800080, "fuchsia": 0xFF00FF,
    "green": 0x008000, "lime": 0x00FF00, "olive": 0x808000, "yellow": 0xFFFF00,
    "navy": 0x000080, "blue": 0x0000FF, "teal": 0x008080, "aqua": 0x00FFFF,
    "grey": 0x808080, "orange": 0xFFA500, "cyan": 0x00FFFF, "magenta": 0xFF00FF,
    "pink": 0xFFC0CB, "brown": 0xA52A2A, "gold": 0xFFD700, "violet": 0xEE82EE,
}  # fmt: skip

#: One per species, told apart by colour-blind people too: M. Okabe, K. Ito, *Color Universal
#: Design* (2008), with the package's own blue first.
SPECIES = np.array(
    [0x4C9BE8, 0xE69F00, 0x009E73, 0xD55E00, 0xCC79A7, 0xF0E442, 0x0072B2], np.uint32
)


def packed(color: Any) -> int:
    """One colour as 0xRRGGBB.

    Parameters
    ----------
    color : str or int
        A name ("red"), "#rrggbb", or a number already packed.

    Raises
    ------
    UnknownNameError
        For a name that is not known; suggests the nearest.
    InputError
        For anything else that is no colour.

    Examples
    --------
    >>> hex(packed("orange")), hex(packed("#4c9be8"))
    ('0xffa500', '0x4c9be8')
    """
    if isinstance(color, (int, np.integer)) and not isinstance(color, bool):
        if not 0 <= color <= 0xFFFFFF:
            msg = f"color {color} is outside 0 ... 0xffffff; give 0xRRGGBB"
            raise InputError(msg)
        return int(color)
    if not isinstance(color, str):
        msg = f"{color!r} is not a color; give a name, '#rrggbb' or 0xRRGGBB"
        raise InputError(msg)
    if color.startswith("#"):
        digits = color[1:]
        if len(digits) == 6 and all(c in "0123456789abcdefABCDEF" for c in digits):
            return int(digits, 16)
        msg = f"color {color!r} is not of the form '#rrggbb'; give six hexadecimal digits"
        raise InputError(msg)
    if color.lower() not in NAMES:
        msg = f"there is no color {color!r}{nearest(color, NAMES)}"
        raise UnknownNameError(msg)
    return NAMES[color.lower()]


def packed_many(colors: Any, n: int) -> Colors:
    """`n` colours: one for all, or one each.

    Parameters
    ----------
    colors : str, int or a sequence of them
        See `packed`.
    n : int

    Returns
    -------
    (n,) uint32

    Raises
    ------
    InputError
        If one is no colour, or there are not `n`.
    """
    if isinstance(colors, (str, int, np.integer)):
        return np.full(n, packed(colors), np.uint32)
    if isinstance(colors, np.ndarray) and np.issubdtype(colors.dtype, np.integer):
        wrong = (colors < 0) | (colors > 0xFFFFFF)
        listed = np.asarray(colors)
        if wrong.any():
            packed(int(listed[wrong].flat[0]))  # says what is wrong with the first
    else:
        try:
            listed = np.array([packed(c) for c in colors], np.uint32)
        except TypeError:
            packed(colors)  # one thing, and no colour: says so
            raise
    if listed.shape != (n,):
        msg = f"color has shape {listed.shape}; give one color, or one for each of {n} spheres"
        raise InputError(msg)
    return listed.astype(np.uint32)


def hsb(hue: ArrayLike, saturation: ArrayLike, brightness: ArrayLike) -> Colors:
    """Colours in the paper's ``colorMode(HSB, 360, 100, 100)``.

    With s and b as fractions and k_c = (shift_c + hue/60) mod 6 for shifts 5, 3, 1 of red,
    green, blue: c = b - b s max(0, min(k, 4 - k, 1)) (the standard formula of HSV).

    Parameters
    ----------
    hue : array_like
        Degrees on the colour circle, 0 red, 120 green, 240 blue.
    saturation, brightness : array_like
        0 ... 100.

    Returns
    -------
    uint32 array
        0xRRGGBB, of the arguments' common shape.

    Examples
    --------
    >>> hex(hsb(120, 100, 100))
    '0xff00'
    """
    h = np.asarray(hue, np.float64) / 60
    s = np.clip(np.asarray(saturation, np.float64) / 100, 0, 1)
    b = np.clip(np.asarray(brightness, np.float64) / 100, 0, 1)
    result = np.zeros(np.broadcast_shapes(h.shape, s.shape, b.shape), np.uint32)
    for shift, bits in ((5, 16), (3, 8), (1, 0)):
        k = np.mod(shift + h, 6)
        part = b - b * s * np.clip(np.minimum(k, 4 - k), 0, 1)
        result |= np.floor(part * 255 + 0.5).astype(np.uint32) << np.uint32(bits)
    return result
