"""What the live view and its page say to each other; `static/protocol.js` is the other side.

Server to page, binary, little-endian. Both kinds begin with the same 24 bytes:

====== ========= ==============================================================
offset type      meaning
====== ========= ==============================================================
0      char[4]   "CARO"
4      u2        version of this protocol
6      u2        kind: 1 frame, 2 scene
8      u4        n, number of spheres
12     u4        epoch: counts jumps of the motion (restarts)
16     u4        frame: flags, 1 = playing, 2 = failed; scene: bytes of its JSON
20     u4        scene number: a frame belongs to the scene sent under this number
====== ========= ==============================================================

A **frame** goes on with doubles, 128 bytes of header in all:

====== ========= ==============================================================
24     f8        t, simulated time
32     f8        clock of the server in seconds, when the simulation was at t
40     f8[3]     g, acceleration of free spheres
64     f8        kinetic energy
72     f8        potential energy
80     f8        energy taken by inelastic collisions
88     f8        energy drift, relative
96     f8        collisions between spheres
104    f8        collisions with walls
112    f8        speed asked for, in multiples of the scene's pace
120    f8        speed reached
128    f4[3n]    positions
..     f4[3n]    velocities
..     u1[n]     impulses received, modulo 128; top bit: no gravity (fixed or resting)
====== ========= ==============================================================

A **scene** goes on with JSON (padded with spaces to a multiple of four bytes), then radius
f4[n], mass f4[n] (infinite where fixed), colour u4[n] (0xRRGGBB) and species u4[n]. It is sent
before the first frame and again when something in it has changed.

Server to page, text: ``{"failure": "one sentence"}`` when the simulation cannot go on.

Page to server, text, at most `MAX_MESSAGE` bytes, an object with exactly these keys:

=========== ==================== ==============================================
op          other keys           meaning
=========== ==================== ==============================================
hello       token, version       must come first
credit      count 1 ... 4        that many more frames may be sent
play, pause                      let time run, or not
speed       value 0.001 ... 100  in multiples of the scene's pace
restart                          back to the start
=========== ==================== ==============================================
"""

import json
import math
import struct
from dataclasses import dataclass
from typing import Any, NoReturn

import numpy as np

from carom.errors import InputError
from carom.state import State

MAGIC = b"CARO"
VERSION = 1
FRAME, SCENE = 1, 2
PLAYING, FAILED = 1, 2
STILL = 0x80  #: bit of a count byte: gravity does not act on this sphere
FRAME_HEADER = struct.Struct("<4sHHIIII13d")
SCENE_HEADER = struct.Struct("<4sHHIIII")
MAX_MESSAGE = 1024
MAX_CREDITS = 4
SLOWEST, FASTEST = 1e-3, 100.0

#: Keys of each operation besides "op".
OPERATIONS: dict[str, frozenset[str]] = {
    "hello": frozenset({"token", "version"}),
    "credit": frozenset({"count"}),
    "play": frozenset(),
    "pause": frozenset(),
    "speed": frozenset({"value"}),
    "restart": frozenset(),
}


@dataclass(frozen=True, slots=True)
class Meters:
    """The numbers of a frame's header that are not the spheres'."""

    clock: float
    gravity: tuple[float, float, float]
    kinetic: float
    potential: float
    dissipated: float
    drift: float
    speed: float
    reached: float
    epoch: int
    scene: int
    playing: bool
    failed: bool


@dataclass(frozen=True, slots=True)
class Command:
    """A checked message from a page."""

    op: str
    count: int = 0
    value: float = 0.0
    token: str = ""
    version: int = 0


def encode_frame(state: State, meters: Meters) -> bytes:
    """Pack one frame, 128 + 25 n bytes."""
    m = meters
    flags = PLAYING * m.playing | FAILED * m.failed
    header = FRAME_HEADER.pack(
        *(MAGIC, VERSION, FRAME, len(state), m.epoch, flags, m.scene),
        *(state.time, m.clock, *m.gravity, m.kinetic, m.potential, m.dissipated, m.drift),
        *(state.collisions, state.wall_collisions, m.speed, m.reached),
    )
    still = state.fixed | state.resting
    counts = (state.collision_count & 0x7F).astype(np.uint8) | still * np.uint8(STILL)
    return b"".join(
        (
            header,
            state.position.astype("<f4").tobytes(),
            state.velocity.astype("<f4").tobytes(),
            counts.tobytes(),
        )
    )


def encode_scene(state: State, number: int, about: dict[str, Any]) -> bytes:
    """Pack the scene message; `about` is its JSON part."""
    text = json.dumps(about, allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    head = (MAGIC, VERSION, SCENE, len(state), 0, len(text), number)
    return b"".join(
        (
            SCENE_HEADER.pack(*head),
            text,
            state.radius.astype("<f4").tobytes(),
            np.where(state.fixed, np.inf, state.mass).astype("<f4").tobytes(),
            state.color.astype("<u4").tobytes(),
            state.species.astype("<u4").tobytes(),
        )
    )


def decode_command(text: object) -> Command:
    """Check a message from a page.

    Raises
    ------
    InputError
        If it is not exactly one of the operations with numbers in range.
    """
    if not isinstance(text, str) or len(text) > MAX_MESSAGE:
        _refuse(f"a message must be text of at most {MAX_MESSAGE} characters")
    try:
        message = json.loads(text, parse_constant=lambda name: _refuse(f"{name} is no number"))
    except (ValueError, RecursionError) as error:
        msg = "a message must be JSON"
        raise InputError(msg) from error
    op = message.get("op") if isinstance(message, dict) else None
    if not isinstance(op, str) or op not in OPERATIONS:
        _refuse("the operation is unknown")
    if message.keys() - {"op"} != OPERATIONS[op]:
        _refuse(f"{op} takes exactly these keys: {', '.join(sorted(OPERATIONS[op])) or 'none'}")
    if op == "hello":
        if not isinstance(message["token"], str):
            _refuse("the token must be text")
        return Command(op, token=message["token"], version=_whole(message, "version", 0, 2**16))
    if op == "credit":
        return Command(op, count=_whole(message, "count", 1, MAX_CREDITS))
    if op == "speed":
        return Command(op, value=_number(message, "value", SLOWEST, FASTEST))
    return Command(op)


def _number(message: dict[str, Any], key: str, low: float, high: float) -> float:
    value = message[key]
    fits = isinstance(value, int | float) and not isinstance(value, bool)
    # Compared before it becomes a float: JSON knows whole numbers no float can hold.
    if not fits or not low <= value <= high or not math.isfinite(value):
        _refuse(f"{key} must be a number from {low} to {high}")
    return float(value)


def _whole(message: dict[str, Any], key: str, low: int, high: int) -> int:
    value = _number(message, key, low, high)
    if value != int(value):
        _refuse(f"{key} must be a whole number")
    return int(value)


def _refuse(why: str) -> NoReturn:
    raise InputError(why)
