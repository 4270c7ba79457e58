"""When spheres meet one another and the walls: every event time, one plain function each.

Nothing here has a tolerance. A contact is the first t >= 0 at which an overlap function f is
<= 0 and falling (Bannerman, Strobl, Formella and Pöschel, Comput. Part. Mech. 1, 191, 2014,
section 3, doi:10.1007/s40571-014-0021-8). Times are offsets from the moment at which the
arguments hold; `NEVER` means no contact.
"""

import math
from collections.abc import Callable
from itertools import count, pairwise

Vec = tuple[float, float, float]

NEVER = math.inf
ZERO: Vec = (0.0, 0.0, 0.0)


def dot(a: Vec, b: Vec) -> float:
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vec, b: Vec) -> Vec:
    """Vector product."""
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def sub(a: Vec, b: Vec) -> Vec:
    """``a - b``."""
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def plus(a: Vec, s: float, b: Vec) -> Vec:
    """``a + s b``."""
    return (a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2])


def meeting(r: Vec, v: Vec, a: Vec, distance: float, *, just_met: bool = False) -> float:
    """Time at which two points with relative motion (r, v, a) come as near as `distance`.

    Parameters
    ----------
    r, v, a : Vec
        Relative position, velocity and constant acceleration.
    distance : float
        Sum of the two radii.
    just_met : bool
        They have collided at t = 0, so they are parting, whatever rounding says: without
        relative acceleration they never meet again, and with it not before they have turned.
        (After e = 0 rounding would repeat t = 0 for ever in one case of eight.)
    """
    if a != ZERO:
        return _first_falling_contact(r, v, a, distance, outside=True, parting=just_met)
    if just_met:
        return NEVER
    b = dot(r, v)
    if b >= 0.0:
        return NEVER
    w = cross(r, v)
    # b^2 - v^2 c, in the form whose error grows with the distance and not with its square.
    d = dot(v, v) * distance * distance - dot(w, w)
    if d <= 0.0:
        return NEVER
    c = dot(r, r) - distance * distance
    return max(0.0, c / (math.sqrt(d) - b))


def leaving(r: Vec, v: Vec, a: Vec, distance: float) -> float:
    """Time at which a point inside a sphere of radius `distance` about the origin reaches it.

    A cylinder is the same with the components along its axis set to 0.
    """
    if a != ZERO:
        return _first_falling_contact(r, v, a, distance, outside=False)
    speed2 = dot(v, v)
    if speed2 == 0.0:
        return NEVER
    b = dot(r, v)
    w = cross(r, v)
    d = speed2 * distance * distance - dot(w, w)
    if d <= 0.0:
        # Rounding has put a grazing point outside: it is out at its nearest approach.
        return max(0.0, -b / speed2)
    if b < 0.0:
        return (math.sqrt(d) - b) / speed2
    c = dot(r, r) - distance * distance
    return max(0.0, -c / (b + math.sqrt(d)))


def landing(f: float, rate: float, bend: float) -> float:
    """Time at which the gap ``f + rate t + bend t^2 / 2`` to a plane closes."""
    d = rate * rate - 2.0 * bend * f
    if bend < 0.0:
        if f <= 0.0 and rate < 0.0:
            return 0.0
        if d <= 0.0:
            return max(0.0, -rate / bend)
        return (rate + math.sqrt(d)) / -bend if rate >= 0.0 else 2.0 * f / (math.sqrt(d) - rate)
    if rate >= 0.0 or d <= 0.0:
        return NEVER
    return max(0.0, 2.0 * f / (math.sqrt(d) - rate))


def _first_falling_contact(
    r: Vec, v: Vec, a: Vec, distance: float, *, outside: bool, parting: bool = False
) -> float:
    """First t >= 0 with f <= 0 and falling, f = +-(|r + v t + a t^2 / 2|^2 - distance^2).

    The quartic is cut at its turning points. On the first falling piece that ends at f <= 0
    lies the event: at its root, or at the piece's start if f <= 0 there already.
    """
    sign = 1.0 if outside else -1.0

    def place(t: float) -> Vec:
        return plus(plus(r, t, v), 0.5 * t * t, a)

    def f(t: float) -> float:
        p = place(t)
        length = math.sqrt(dot(p, p))
        return sign * (length - distance) * (length + distance)

    def slope(t: float) -> float:
        return sign * 2.0 * dot(place(t), plus(v, t, a))

    turns = [0.0, *_turning_points(r, v, a)]
    for start, end in pairwise(turns):
        if parting and start == 0.0:
            continue
        if slope(0.5 * (start + end)) < 0.0 and f(end) <= 0.0:
            return start if f(start) <= 0.0 else _root(f, slope, start, end)
    last = turns[-1]
    if outside:  # f -> +infinity: the last piece rises
        return NEVER
    if f(last) <= 0.0:
        return last
    return _root(f, slope, last, _beyond(f, last, _time_scale(r, v, a, distance)))


def _turning_points(r: Vec, v: Vec, a: Vec) -> list[float]:
    """The t > 0 at which |r + v t + a t^2 / 2| turns, ascending.

    They are roots of a cubic, each between two neighbouring roots of its derivative
    ``v^2 + r.a + 3 (v.a) t + (3/2) a^2 t^2``.
    """

    def cubic(t: float) -> float:
        return dot(plus(plus(r, t, v), 0.5 * t * t, a), plus(v, t, a))

    def cubic_slope(t: float) -> float:
        velocity = plus(v, t, a)
        return dot(velocity, velocity) + dot(plus(plus(r, t, v), 0.5 * t * t, a), a)

    bends = quadratic_roots(1.5 * dot(a, a), 3.0 * dot(v, a), dot(v, v) + dot(r, a))
    cuts = [0.0, *(t for t in bends if t > 0.0)]
    if cubic(cuts[-1]) < 0.0:
        cuts.append(_beyond(lambda t: -cubic(t), cuts[-1], _time_scale(r, v, a, 0.0)))
    turns = [t for t in cuts if t > 0.0 and cubic(t) == 0.0]
    for low, high in pairwise(cuts):
        if cubic(low) < 0.0 < cubic(high) or cubic(high) < 0.0 < cubic(low):
            turns.append(_root(cubic, cubic_slope, low, high))
    return sorted(turns)


def quadratic_roots(a: float, b: float, c: float) -> list[float]:
    """Real roots of ``a t^2 + b t + c`` with a > 0, ascending, without cancellation."""
    d = b * b - 4.0 * a * c
    if d <= 0.0:
        return []
    q = -0.5 * (b + math.copysign(math.sqrt(d), b))
    return sorted((q / a, c / q)) if q != 0.0 else [0.0]


def _time_scale(r: Vec, v: Vec, a: Vec, distance: float) -> float:
    """A positive time in which the motion changes by about its own size."""
    size = math.sqrt(dot(a, a))
    return math.sqrt(dot(v, v)) / size + math.sqrt((math.sqrt(dot(r, r)) + distance) / size)


def _beyond(f: Callable[[float], float], start: float, step: float) -> float:
    """Some t > start with f(t) < 0, for an f that falls for ever in the end."""
    while not f(start + step) < 0.0:
        step *= 2.0
    return start + step


def _root(
    f: Callable[[float], float], slope: Callable[[float], float], low: float, high: float
) -> float:
    """Root of a monotone f between `low` and `high`: Newton, kept inside the bracket."""
    rising = f(low) < 0.0
    t = 0.5 * (low + high)
    for step in count():
        value = f(t)
        if (value < 0.0) == rising:
            low = t
        else:
            high = t
        rate = slope(t)
        # Newton settles in a few steps; in the noise of f it may wander, so then bisect.
        guess = t - value / rate if rate != 0.0 and step < 50 else low
        if not low < guess < high:
            guess = 0.5 * (low + high)
            if not low < guess < high:  # two neighbouring numbers
                break
        if abs(guess - t) <= 1e-16 * abs(t):
            break
        t = guess
    return t
