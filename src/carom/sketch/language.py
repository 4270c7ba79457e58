"""The words of a sketch: what ``from carom.sketch import *`` brings.

The places, sizes and matrices are Processing's: lengths in pixels, origin at the top left, y
downwards, z towards the viewer.
"""

import math
import sys
from typing import Any

from carom.errors import InputError
from carom.sketch import paint
from carom.sketch.numbers import number, whole
from carom.sketch.paint import Color
from carom.sketch.recorder import BOX, LINE, NONE, SPHERE, current

PI, TWO_PI, HALF_PI = math.pi, 2.0 * math.pi, 0.5 * math.pi
LARGEST_SHEET = 4096
MOST_FRAMES = 240.0  #: per second

# The sheet and the clock.


def size(width: int, height: int) -> None:
    """Choose the size of the picture in pixels; belongs into `setup`."""
    recorder = current("size()")
    recorder.width = whole("size(): width", width, 1, LARGEST_SHEET)
    recorder.height = whole("size(): height", height, 1, LARGEST_SHEET)


def width() -> int:
    """Width of the picture in pixels."""
    return current("width()").width


def height() -> int:
    """Height of the picture in pixels."""
    return current("height()").height


def frame_rate(rate: float) -> None:
    """Choose how often `draw` runs: so many times a second, 60 if you do not say."""
    found = number("frame_rate()", rate)
    if not 0.0 < found <= MOST_FRAMES:
        msg = f"frame_rate() is {rate}; give a number above 0 and up to {MOST_FRAMES:g}"
        raise InputError(msg)
    current("frame_rate()").rate = found


def frame_count() -> int:
    """How often `draw` has run, this time included: 1 in the first frame."""
    return current("frame_count()").frame


def no_loop() -> None:
    """Draw one frame and stop; `redraw` draws another."""
    current("no_loop()").looping = False


def loop() -> None:
    """Draw on after `no_loop`."""
    current("loop()").looping = True


def redraw() -> None:
    """Draw one more frame although `no_loop` was said."""
    current("redraw()").owed += 1


# Where things are drawn.


def push_matrix() -> None:
    """Remember where the origin is and how the axes point; `pop_matrix` comes back to it."""
    caller = sys._getframe(1)
    place = (caller.f_code.co_filename, caller.f_lineno)
    current("push_matrix()").stack.push(place)


def pop_matrix() -> None:
    """Come back to what `push_matrix` remembered last."""
    current("pop_matrix()").stack.pop()


def translate(x: float, y: float, z: float = 0.0) -> None:
    """Move the origin along the axes as they point now."""
    current("translate()").stack.translate(
        number("translate(): x", x), number("translate(): y", y), number("translate(): z", z)
    )


def rotate(angle: float) -> None:
    """Turn everything drawn from now on about the z axis: `rotate_z`."""
    current("rotate()").stack.rotate_z(number("rotate(): angle", angle))


def rotate_x(angle: float) -> None:
    """Turn about the x axis, by an angle in radians: y towards z."""
    current("rotate_x()").stack.rotate_x(number("rotate_x(): angle", angle))


def rotate_y(angle: float) -> None:
    """Turn about the y axis, by an angle in radians: z towards x."""
    current("rotate_y()").stack.rotate_y(number("rotate_y(): angle", angle))


def rotate_z(angle: float) -> None:
    """Turn about the z axis, by an angle in radians: x towards y."""
    current("rotate_z()").stack.rotate_z(number("rotate_z(): angle", angle))


def scale(x: float, y: float | None = None, z: float | None = None) -> None:
    """Stretch the axes: all alike, or each by its own factor."""
    factors = (x, x, x) if y is None else (x, y, 1.0 if z is None else z)
    checked = [
        number(f"scale(): {axis}", factor) for axis, factor in zip("xyz", factors, strict=True)
    ]
    if 0.0 in checked:
        msg = "scale() by 0 makes everything flat; take a small number such as 0.001"
        raise InputError(msg)
    current("scale()").stack.scale(*checked)


# What is drawn.


def sphere(radius: float) -> None:
    """Draw a sphere around the origin: `fill` colours it, `stroke` draws lines on it."""
    recorder = current("sphere()")
    r = number("sphere(): radius", radius)
    if r < 0.0:
        msg = f"sphere(): radius is {radius}; it must be at least 0"
        raise InputError(msg)
    if r > 0.0:
        recorder.shape("sphere()", SPHERE, recorder.stack.stretched(r, r, r))


def sphere_detail(meridians: int) -> None:
    """Choose how many meridians the lines on a sphere have: 24 if you do not say."""
    found = whole("sphere_detail()", meridians, 6, 120)
    current("sphere_detail()").detail = 6 * ((found + 3) // 6)  # as the shader draws them


def box(width: float, height: float | None = None, depth: float | None = None) -> None:
    """Draw a box around the origin: a cube, or three sides of their own."""
    recorder = current("box()")
    sides = [width, width if height is None else height, width if depth is None else depth]
    named = zip(("width", "height", "depth"), sides, strict=True)
    x, y, z = (number(f"box(): {name}", side) for name, side in named)
    recorder.shape("box()", BOX, recorder.stack.stretched(x, y, z))


def line(*ends: float) -> None:
    """Draw a line from a point to another: ``line(x1, y1, x2, y2)`` or with z, six numbers."""
    if len(ends) not in (4, 6):
        msg = f"line() has {len(ends)} numbers; give x1, y1, x2, y2 or x1, y1, z1, x2, y2, z2"
        raise InputError(msg)
    values = [number("line(): end", end) for end in ends]
    half = len(values) // 2
    start, end = [*values[:half], 0.0][:3], [*values[half:], 0.0][:3]
    _segment("line()", start, end)


def point(x: float, y: float, z: float = 0.0) -> None:
    """Draw a dot as wide as `stroke_weight`."""
    place = [number(f"point(): {axis}", v) for axis, v in zip("xyz", (x, y, z), strict=True)]
    _segment("point()", place, place)


def _segment(where: str, start: list[float], end: list[float]) -> None:
    recorder = current(where)
    a, b = recorder.stack.apply(*start), recorder.stack.apply(*end)
    step = (b[0] - a[0], b[1] - a[1], b[2] - a[2])
    recorder.shape(where, LINE, (*step, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, *a))


# How it looks.


def background(*color: Any) -> None:
    """Choose the colour behind everything. Each frame starts on an empty sheet."""
    recorder = current("background()")
    recorder.background = recorder.mode.color("background()", *color)


def fill(*color: Any) -> None:
    """Fill shapes from now on: a grey, three numbers, a name, or a `color`; alpha may follow."""
    recorder = current("fill()")
    recorder.fill = recorder.mode.color("fill()", *color)


def no_fill() -> None:
    """Let shapes be see-through."""
    current("no_fill()").fill = NONE


def stroke(*color: Any) -> None:
    """Draw lines from now on in this colour, written as in `fill`."""
    recorder = current("stroke()")
    recorder.stroke = recorder.mode.color("stroke()", *color)


def no_stroke() -> None:
    """Draw no lines."""
    current("no_stroke()").stroke = NONE


def stroke_weight(weight: float) -> None:
    """Choose how wide lines are, in pixels."""
    found = number("stroke_weight()", weight)
    if not 0.0 < found <= 100.0:
        msg = f"stroke_weight() is {weight}; give a width above 0 and up to 100 pixels"
        raise InputError(msg)
    current("stroke_weight()").weight = found


def color(*values: Any) -> Color:
    """Make a colour to keep, in the present `color_mode`."""
    return current("color()").mode.color("color()", *values)


def color_mode(kind: str, *most: float) -> None:
    """Choose what the numbers of a colour mean: "rgb" or "hsb", and their largest values.

    The paper's is ``color_mode("hsb", 360, 100, 100)``.
    """
    current("color_mode()").mode = paint.color_mode(kind, *most)


def lights() -> None:
    """Do nothing: there is always light. Accepted because sketches of Processing say it."""
    current("lights()")


# Chance.


def random(low: float = 1.0, high: float | None = None) -> float:
    """Draw a number from `low` up to `high`; ``random(high)`` starts at 0.

    The same seed gives the same numbers on every machine.
    """
    recorder = current("random()")
    first = number("random(): low" if high is not None else "random(): high", low)
    if high is None:
        return first * recorder.fraction()
    return first + (number("random(): high", high) - first) * recorder.fraction()


def random_seed(seed: int) -> None:
    """Start the random numbers afresh from a whole number."""
    current("random_seed()").seed(seed)
