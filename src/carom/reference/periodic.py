"""Periodic boxes: which images of a pair can meet, and for how long that is known."""

import math
from collections.abc import Iterator
from itertools import product

from carom.reference.times import NEVER, Vec, quadratic_roots

#: Whole boxes along each axis.
Image = tuple[int, int, int]
NO_IMAGE: Image = (0, 0, 0)


def shifted(r: Vec, m: Image, period: Vec) -> Vec:
    """``r - m L``."""
    return (r[0] - m[0] * period[0], r[1] - m[1] * period[1], r[2] - m[2] * period[2])


def wrapped(position: Vec, image: Image, period: Vec) -> tuple[Vec, Image]:
    """The same place with each periodic coordinate in [-L/2, L/2), and its box."""
    x, n = list(position), list(image)
    for k, length in enumerate(period):
        if length == 0.0:
            continue
        boxes = round(x[k] / length)
        if x[k] - boxes * length >= 0.5 * length:
            boxes += 1
        elif x[k] - boxes * length < -0.5 * length:
            boxes -= 1
        x[k] -= boxes * length
        n[k] += boxes
    return (x[0], x[1], x[2]), (n[0], n[1], n[2])


def images_met(
    r: Vec, v: Vec, period: Vec, reach: float, begin: float, end: float
) -> Iterator[Image]:
    """Every image m for which r + v t - m L can be as near as `reach` within [begin, end].

    On a periodic axis the motion is uniform (gravity along it is refused), so the interval
    it sweeps is that between its two ends. An open axis has the image 0 only.
    """
    x, y, z = (
        _boxes_met(r[k], v[k], period[k], reach, begin, end) if period[k] > 0.0 else range(1)
        for k in range(3)
    )
    return product(x, y, z)


def _boxes_met(x: float, u: float, length: float, reach: float, begin: float, end: float) -> range:
    """The images of one axis that x + u t can be as near to as `reach`."""
    ends = (x, x) if u == 0.0 else (x + u * begin, x + u * end)
    # One part in 10^9 more: rounding must not lose an image; one too many costs nothing.
    wide = reach + 1e-9 * (reach + length)
    low, high = min(ends) - wide, max(ends) + wide
    return range(math.ceil(low / length), math.floor(high / length) + 1)


def half_a_box(v: Vec, period: Vec) -> float:
    """Time in which a relative velocity v crosses half the box on some periodic axis."""
    crossings = [0.5 * length / abs(u) for u, length in zip(v, period, strict=True) if u * length]
    return min(crossings, default=NEVER)


def parted_for_ever(r: Vec, v: Vec, a: Vec, period: Vec, reach: float) -> float:
    """Time after which an open axis alone keeps two points further apart than `reach`."""
    axes = zip(r, v, a, period, strict=True)
    return min((_last_near(x, u, w, reach) for x, u, w, ell in axes if ell == 0.0), default=NEVER)


def _last_near(x: float, u: float, w: float, reach: float) -> float:
    """Last t with |x + u t + w t^2 / 2| <= reach; -inf if there is none."""
    if u == 0.0 and w == 0.0:
        return NEVER if abs(x) <= reach else -NEVER
    if w == 0.0:
        return (math.copysign(reach, u) - x) / u
    if w < 0.0:
        x, u, w = -x, -u, -w
    return max(quadratic_roots(0.5 * w, u, x - reach), default=-NEVER)
