"""A stretch of motion in few bytes, as replay files hold it; `static/reel.js` is the other side.

Motion is predicted and only what the prediction misses is written. Spheres with impulses since the
frame before collide as `carom.view.impacts` foretells it. From there to the frame, a time h, a
sphere keeps its velocity, but for gravity's gh, and moves by the mean of its two velocities times
h. Of free flight nothing is left to write; of a collision a few digits, because it magnifies how
far the reader is off. They are whole numbers of a quantum, of which deflate makes little where most
are zero.

The prediction begins at what a reader has, not at the truth, so that errors do not add up: a
position is off by half a quantum at most. Both sides do the same sums in the same order, in
doubles with + - × ÷ √ and floor alone, and arrive at the same bits.

A **reel** is one zlib stream of

======== ======================================================================================
4 bytes  length of the next part, little-endian
JSON     format, n, frames, quanta (of length and velocity), columns, speed, scene
scene    a scene message (`carom.view.protocol`) of that many bytes
columns  doubles, frame after frame in each column, as eight byte planes
counts   change of each sphere's count since the frame before, as four byte planes
v, x     what the prediction misses, as four byte planes each: first where counts have changed,
         then where they have not
======== ======================================================================================

Planes hold the lowest bytes of all numbers first, then the next. Numbers run over frames, then x,
y and z, then spheres; signed ones are folded: 0, -1, 1, -2, … become 0, 1, 2, 3, …
"""

import json
import struct
import zlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.errors import InputError
from carom.state import Floats
from carom.view.impacts import Impacts
from carom.view.protocol import decode_scene
from carom.view.wire import REEL_COLUMNS, REEL_FORMAT, STILL

STEPS = 2**16  #: quanta of length across everything that is shown
FINE = 64  #: quanta of length in the smallest radius, at least
SLOW = 32  #: quanta of velocity by which a sphere moves one quantum of length per frame
LARGEST = 2**30  #: of any number written

Unsigned = NDArray[np.uint32]


@dataclass(frozen=True, slots=True, eq=False)
class Reel:
    """What a replay shows.

    Attributes
    ----------
    scene : bytes
        A scene message.
    columns : (F, K) float64
        `wire.REEL_COLUMNS` of each frame.
    position, velocity : (F, 3, n) float64
    counts : (F, n) uint32
        As in frames: impulses, with the top bit where gravity does not act.
    speed : float
        At which it begins to play, in multiples of the scene's pace.
    """

    scene: bytes
    columns: Floats
    position: Floats
    velocity: Floats
    counts: Unsigned
    speed: float = 1.0


def encode(reel: Reel, progress: Callable[[float], object] | None = None) -> bytes:
    """Pack a reel; `progress` is told the time of every frame that is done.

    Raises
    ------
    InputError
        If motion is too wild to be told in whole numbers.
    """
    frames, _, n = reel.position.shape
    about, radius, mass = decode_scene(reel.scene)
    quanta = _quanta(reel, float(radius.min(initial=np.inf)))
    places = np.zeros((frames, 3, n), np.int64)
    speeds = np.zeros((frames, 3, n), np.int64)
    changes = np.diff(reel.counts, axis=0, prepend=np.uint32(0))
    guide = _Guide(Impacts(about, radius, mass), quanta, about["period"])
    for k in range(frames):
        guide.predict_velocity(*_step(reel.columns, k), reel.counts[k])
        speeds[k] = guide.miss_velocity(reel.velocity[k])
        guide.correct_velocity(speeds[k])
        guide.predict_position()
        places[k] = guide.miss_position(reel.position[k])
        guide.correct_position(places[k])
        if progress is not None:
            progress(float(reel.columns[k, 0]))
    if max(np.abs(places).max(initial=0), np.abs(speeds).max(initial=0)) > LARGEST:
        msg = "spheres fly too far or too fast to be kept in a replay; show a shorter stretch of it"
        raise InputError(msg)
    header = {
        "format": REEL_FORMAT,
        "n": n,
        "frames": frames,
        "quanta": quanta,
        "columns": list(REEL_COLUMNS),
        "speed": reel.speed,
        "scene": len(reel.scene),
    }
    text = json.dumps(header, allow_nan=False).encode()
    hit = _hit(changes)
    parts = (
        *(struct.pack("<I", len(text)), text, reel.scene),
        _planes(reel.columns.T.astype("<f8")),
        _planes(changes.astype("<u4")),
        *(_planes(_folded(np.concatenate([a[hit], a[~hit]]))) for a in (speeds, places)),
    )
    return _packed(b"".join(parts))


def decode(data: bytes) -> Reel:
    """Unpack what `encode` has packed."""
    body = zlib.decompress(data)
    (size,) = struct.unpack_from("<I", body)
    header: dict[str, Any] = json.loads(body[4 : 4 + size])
    n, frames, columns = header["n"], header["frames"], len(header["columns"])
    start = 4 + size + header["scene"]
    scene = body[4 + size : start]
    sizes = (columns * frames * 8, frames * n * 4, frames * n * 12, frames * n * 12)
    parts = []
    for length in sizes:
        parts.append(body[start : start + length])
        start += length
    table = _numbers(parts[0], "<f8").reshape(columns, frames).T
    changes = _numbers(parts[1], "<u4").reshape(frames, n)
    counts = np.cumsum(changes, axis=0, dtype=np.uint32)
    hit = _hit(changes)
    speeds, places = (np.empty((frames, 3, n), np.int64) for _ in range(2))
    for misses, part in ((speeds, parts[2]), (places, parts[3])):
        numbers = _unfolded(_numbers(part, "<u4"))
        misses[hit], misses[~hit] = np.split(numbers, [np.count_nonzero(hit)])
    about, radius, mass = decode_scene(scene)
    position, velocity = np.empty((frames, 3, n)), np.empty((frames, 3, n))
    guide = _Guide(Impacts(about, radius, mass), header["quanta"], about["period"])
    for k in range(frames):
        guide.predict_velocity(*_step(table, k), counts[k])
        guide.correct_velocity(speeds[k])
        guide.predict_position()
        guide.correct_position(places[k])
        position[k], velocity[k] = guide.x, guide.v
    return Reel(scene, table, position, velocity, counts, header["speed"])


class _Guide:
    """Where every sphere is by what was written so far."""

    def __init__(self, impacts: Impacts, quanta: Sequence[float], period: Sequence[float]) -> None:
        n = impacts.n
        self.x, self.v, self._before = np.zeros((3, n)), np.zeros((3, n)), np.zeros((3, n))
        self._counts, self._rest = np.zeros(n, np.uint32), np.zeros(n)
        self._impacts = impacts
        self._length, self._speed = quanta
        self._period = period

    def predict_velocity(self, step: float, gravity: Floats, counts: Unsigned) -> None:
        fall = np.where((counts & np.uint32(STILL)) == 0, gravity[:, None], 0.0)
        impulses = ((counts - self._counts) & np.uint32(STILL - 1)).astype(np.int64)
        self.x, self._before, self._rest = self._impacts.fly(self.x, self.v, fall, impulses, step)
        self.v = self._before + fall * self._rest
        self._counts = counts

    def miss_velocity(self, truth: Floats) -> NDArray[np.int64]:
        return _rounded((truth - self.v) / self._speed)

    def correct_velocity(self, miss: NDArray[np.int64]) -> None:
        self.v = self.v + self._speed * miss

    def predict_position(self) -> None:
        self.x = self.x + (self._before + self.v) * (0.5 * self._rest)
        for k, length in enumerate(self._period):
            if length > 0:
                self.x[k] = self.x[k] - length * np.floor(self.x[k] / length + 0.5)

    def miss_position(self, truth: Floats) -> NDArray[np.int64]:
        return _rounded((truth - self.x) / self._length)

    def correct_position(self, miss: NDArray[np.int64]) -> None:
        self.x = self.x + self._length * miss


def _packed(body: bytes) -> bytes:
    # Most of it is zeros in a row. To look for other repetitions, too, takes thirty times as long
    # and makes a fluid no smaller, a dilute gas by a tenth.
    deflate = zlib.compressobj(9, zlib.DEFLATED, zlib.MAX_WBITS, 9, zlib.Z_RLE)
    return deflate.compress(body) + deflate.flush()


def _step(columns: Floats, k: int) -> tuple[float, Floats]:
    """Time since the frame before (0 for the first), and gravity."""
    step = columns[k, 0] - columns[k - 1, 0] if k > 0 else 0.0
    return float(step), columns[k, 1:4]


def _quanta(reel: Reel, smallest: float) -> tuple[float, float]:
    """Of length, and of velocity."""
    if reel.position.size == 0:
        return 1.0, 1.0
    sides = np.ptp(reel.position, axis=(0, 2))
    across = max(float(sides.max()), 2 * smallest)
    reach = max(float(np.abs(reel.position).max()), 1e-300)
    length = max(min(across / STEPS, smallest / FINE), reach / LARGEST)
    steps = np.diff(reel.columns[:, 0])
    usual = float(np.median(steps)) if len(steps) else 0.0
    fastest = float(np.abs(reel.velocity).max())
    slow = length / (SLOW * usual) if usual > 0 else 0.0
    return length, max(slow, fastest / LARGEST * 2) or 1.0


def _hit(changes: Unsigned) -> NDArray[np.bool_]:
    """Whose numbers stand in front: (F, 3, n)."""
    return np.broadcast_to(changes[:, None] != 0, (len(changes), 3, changes.shape[1]))


def _rounded(values: Floats) -> NDArray[np.int64]:
    # What lies beyond is refused later.
    return np.floor(np.clip(values, -4.0 * LARGEST, 4.0 * LARGEST) + 0.5).astype(np.int64)


def _folded(values: NDArray[np.int64]) -> NDArray[Any]:
    return np.where(values >= 0, 2 * values, -2 * values - 1).astype("<u4")


def _unfolded(values: NDArray[Any]) -> NDArray[np.int64]:
    whole = values.astype(np.int64)
    return np.where(whole % 2 == 0, whole // 2, -(whole + 1) // 2)


def _planes(values: NDArray[Any]) -> bytes:
    width = values.dtype.itemsize
    return np.ascontiguousarray(values).reshape(-1).view(np.uint8).reshape(-1, width).T.tobytes()


def _numbers(planes: bytes, kind: str) -> NDArray[Any]:
    width = np.dtype(kind).itemsize
    rows = np.frombuffer(planes, np.uint8).reshape(width, -1)
    return np.ascontiguousarray(rows.T).reshape(-1).view(kind)
