"""What collisions do to spheres between two frames, as both sides of a reel foretell it.

Of a frame a reader knows how many impulses each sphere has had since the frame before; when and
from whom mostly follows. Spheres with impulses to come fly on until the first two of them touch
(or one meets a flat wall), rebound, and fly on. Where that is wrong, the reel writes what it
misses: so only size, never truth, hangs on it.

`static/impacts.js` does the same sums in the same order, in doubles with + - × ÷ √ and floor, and
arrives at the same bits.
"""

import itertools
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.state import Floats
from carom.world import PLANE

LATE = 1.1  #: of the time between frames: an impact that seems due a little later has happened too
ROUNDS = 32  #: of impacts between two frames; later ones are not foretold
PORTION = 2**18  #: pairs that are looked at together: they must fit into the processor's cache
STRIPS = 256.0  #: where there is no period; strips that many further on are the same again

Indices = NDArray[np.int64]


class Impacts:
    """Foretells the collisions of a scene.

    Parameters
    ----------
    about : dict
        The JSON part of a scene message.
    radius, mass : (n,) float64
        Of the same message; mass is infinite where fixed.
    """

    def __init__(self, about: dict[str, Any], radius: Floats, mass: Floats) -> None:
        self._period: Sequence[float] = about["period"]
        self._walls = [wall for wall in about["walls"] if wall["kind"] == PLANE]
        self._collide: bool = about["collide"]
        self._restitution: float = about["restitution"]
        self._radius, self._inverse = radius, 1 / mass
        self.n = len(radius)

    def fly(
        self, x: Floats, v: Floats, fall: Floats, impulses: Indices, step: float
    ) -> tuple[Floats, Floats, Floats]:
        """Let spheres fly, and collide as often as they have impulses.

        Parameters
        ----------
        x, v, fall : (3, n) float64
            Positions, velocities and accelerations at the frame before.
        impulses : (n,) int64
        step : float
            Time until the frame.

        Returns
        -------
        x, v : (3, n) float64
            Right after the last impact of each sphere.
        rest : (n,) float64
            Time from then until the frame.
        """
        rest = np.full(len(impulses), step)
        some = np.flatnonzero(impulses)
        if step <= 0 or len(some) == 0:
            return x, v, rest
        x, v = x.copy(), v.copy()
        flight = _Flight(x[:, some], v[:, some], fall[:, some], impulses[some])
        radius, inverse = self._radius[some], self._inverse[some]
        pairs = self._near(flight, radius, step) if self._collide else np.zeros((2, 0), np.int64)
        for _ in range(ROUNDS):
            pairs = pairs[:, (flight.left[pairs] > 0).all(axis=0)]
            meetings = [self._meetings(flight, pairs, radius), *self._bounces(flight, radius)]
            t, i, j = (np.concatenate(part) for part in zip(*meetings, strict=True))
            chosen = _first(t, i, j, step)
            if len(chosen[0]) == 0:
                break
            self._rebound(flight, inverse, *chosen)
        x[:, some], v[:, some] = flight.x, flight.v
        rest[some] = step - flight.t
        return x, v, rest

    def _near(self, flight: "_Flight", radius: Floats, step: float) -> Indices:
        """Pairs of spheres that may meet, some of them twice: sweeps along strips of the world."""
        pull, speed = _size(flight.fall), _size(flight.v)
        # A sphere may be struck, and then be faster.
        fast = np.sort(speed)[9 * len(speed) // 10]
        reach = radius + step * (speed + fast + pull * step)
        side = flight.x.max(axis=1) - flight.x.min(axis=1)
        along, across, _ = np.argsort(-side, kind="stable").tolist()
        found = [np.zeros((2, 0), np.int64)]
        for some in _strips(flight.x[across], reach, self._period[across]):
            found += self._sweep(flight.x[:, some], reach[some], along, some)
        return np.concatenate(found, axis=1)

    def _sweep(self, x: Floats, reach: Floats, axis: int, names: Indices) -> list[Indices]:
        period = [length or np.inf for length in self._period]
        low, high = x[axis] - reach, x[axis] + reach
        order = np.argsort(low, kind="stable")
        # Behind the last sphere come all once more, one period on.
        low, high = np.concatenate([low[order], low[order] + period[axis]]), high[order]
        order = np.concatenate([order, order])
        x, reach, names = x[:, order], reach[order], names[order]
        here = np.arange(len(high))
        # Those that follow, up to the first that begins behind the end; at the seam it may be late.
        end = np.searchsorted(np.maximum.accumulate(low), high)
        many = np.minimum(end, here + len(high)) - here - 1
        others = [k for k in range(3) if k != axis]
        found = []
        for some in _portions(many):
            i = np.repeat(here[some], many[some])
            j = (
                i
                + 1
                + np.arange(len(i))
                - np.repeat(np.cumsum(many[some]) - many[some], many[some])
            )
            for k in (*others, axis):
                gap, both = np.abs(x[k, i] - x[k, j]), reach[i] + reach[j]
                close = (gap < both) | (gap > period[k] - both)
                i, j = i[close], j[close]
            found.append(np.sort([names[i], names[j]], axis=0))
        return found

    def _meetings(
        self, flight: "_Flight", pairs: Indices, radius: Floats
    ) -> tuple[Floats, Indices, Indices]:
        """When, and who with whom: |d + w s| is the sum of the radii."""
        i, j = pairs
        begin = np.maximum(flight.t[i], flight.t[j])
        (x, v), (y, w) = flight.at(i, begin), flight.at(j, begin)
        d, w = self._nearest(x - y), v - w
        reach = radius[i] + radius[j]
        closing, apart, speed = _dot(d, w), _dot(d, d) - reach * reach, _dot(w, w)
        root = closing * closing - speed * apart
        meet = (closing < 0) & (root >= 0)
        closing, apart, root = closing[meet], apart[meet], root[meet]
        when = begin[meet] + np.maximum(apart, 0.0) / (np.sqrt(root) - closing)
        return when, i[meet], j[meet]

    def _bounces(self, flight: "_Flight", radius: Floats) -> list[tuple[Floats, Indices, Indices]]:
        """When spheres meet flat walls: -1 - k for wall k."""
        i = np.flatnonzero(flight.left > 0)
        found = []
        for k, wall in enumerate(self._walls):
            normal = wall["normal"]
            gap = np.maximum(_along(normal, flight.x[:, i]) - wall["offset"] - radius[i], 0.0)
            speed, pull = _along(normal, flight.v[:, i]), _along(normal, flight.fall[:, i])
            square = speed * speed - 2.0 * pull * gap
            meet = (square >= 0) & ((speed < 0) | (pull < 0))
            gap, speed, pull = gap[meet], speed[meet], pull[meet]
            root = np.sqrt(square[meet])
            down = speed < 0
            above = np.where(down, 2.0 * gap, speed + root)
            below = np.where(down, root - speed, -pull)
            who = i[meet]
            found.append((flight.t[who] + above / below, who, np.full(len(who), -1 - k)))
        return found

    def _rebound(self, flight: "_Flight", inverse: Floats, t: Floats, i: Any, j: Any) -> None:
        """Bring spheres to their impacts, and give them their impulses."""
        two = j >= 0
        flight.move(np.concatenate([i, j[two]]), np.concatenate([t, t[two]]))
        for k, wall in enumerate(self._walls):
            who, normal = i[j == -1 - k], wall["normal"]
            kick = (1.0 + wall["restitution"]) * _along(normal, flight.v[:, who])
            flight.v[:, who] -= np.array(normal)[:, None] * kick
        i, j = i[two], j[two]
        d = self._nearest(flight.x[:, i] - flight.x[:, j])
        share = (inverse[i] + inverse[j]) * _dot(d, d)
        push = (1.0 + self._restitution) * _dot(d, flight.v[:, i] - flight.v[:, j])
        push = np.divide(push, share, out=np.zeros_like(push), where=share > 0)
        flight.v[:, i] -= d * (push * inverse[i])
        flight.v[:, j] += d * (push * inverse[j])

    def _nearest(self, d: Floats) -> Floats:
        for k, length in enumerate(self._period):
            if length > 0:
                d[k] = d[k] - length * np.floor(d[k] / length + 0.5)
        return d


class _Flight:
    """Spheres on their way, each at the time of its last impact."""

    def __init__(self, x: Floats, v: Floats, fall: Floats, left: Indices) -> None:
        self.x, self.v, self.fall, self.left = x, v, fall, left
        self.t = np.zeros(len(left))

    def at(self, i: Indices, t: Floats) -> tuple[Floats, Floats]:
        """Positions and velocities at a time."""
        s = t - self.t[i]
        x = self.x[:, i] + self.v[:, i] * s + self.fall[:, i] * (0.5 * s * s)
        return x, self.v[:, i] + self.fall[:, i] * s

    def move(self, i: Indices, t: Floats) -> None:
        """Bring spheres to their impacts."""
        self.x[:, i], self.v[:, i] = self.at(i, t)
        self.t[i] = t
        self.left[i] -= 1


def _strips(x: Floats, reach: Floats, length: float) -> list[Indices]:
    """Spheres by the strips of one axis that they may touch; `length`: of the period, or 0."""
    m, width = len(x), 4.0 * np.sort(reach)[len(reach) // 2]
    count = max(1.0, np.floor(length / width)) if length > 0 else STRIPS
    width = length / count if length > 0 else width
    first, last = np.floor((x - reach) / width), np.floor((x + reach) / width)
    spans = np.minimum(last - first + 1.0, count).astype(np.int64)
    who = np.repeat(np.arange(m), spans)
    more = np.arange(len(who)) - np.repeat(np.cumsum(spans) - spans, spans)
    strip = np.mod(first[who] + more, count)
    order = np.argsort(strip, kind="stable")
    return np.split(who[order], np.flatnonzero(np.diff(strip[order])) + 1)


def _portions(many: Indices) -> list[slice]:
    """Slices of rows with `PORTION` pairs in all, or one row; `many`: the pairs of each row."""
    rank = np.cumsum(many) // PORTION
    cuts = [0, *(np.flatnonzero(np.diff(rank)) + 1).tolist(), len(many)]
    return [slice(a, b) for a, b in itertools.pairwise(cuts)]


def _first(t: Floats, i: Indices, j: Indices, step: float) -> tuple[Floats, Indices, Indices]:
    """Of all that may happen, what is next for everybody concerned."""
    due = t <= LATE * step
    t, i, j = t[due], i[due], j[due]
    taken: set[int] = set()
    chosen = []
    for k in np.lexsort((j, i, t)).tolist():
        both = {int(i[k]), int(j[k])} if j[k] >= 0 else {int(i[k])}
        if taken.isdisjoint(both):
            chosen.append(k)
        taken |= both
    return t[chosen], i[chosen], j[chosen]


def _along(normal: Sequence[float], a: Floats) -> Floats:
    along: Floats = normal[0] * a[0] + normal[1] * a[1] + normal[2] * a[2]
    return along


def _dot(a: Floats, b: Floats) -> Floats:
    dot: Floats = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    return dot


def _size(a: Floats) -> Floats:
    size: Floats = np.sqrt(_dot(a, a))
    return size
