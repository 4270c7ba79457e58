"""The words of the live view's protocol, defined once for both sides.

`carom.view.protocol` packs and checks with these tables. `javascript` writes them as the module
``static/wire.js``, which this renews where it stands::

    python -c "from carom.view import wire; print(wire.javascript(), end='')" > wire.js
"""

import json
import math
import struct
from dataclasses import dataclass
from typing import Any, NoReturn, Protocol

from carom.errors import InputError

MAGIC = b"CARO"
VERSION = 3
SOCKET_PATH = "/live"
#: Kinds of binary messages.
FRAME, SCENE, SKETCH = 1, 2, 3
#: Bits of a frame's flags.
PLAYING, FAILED, TWIN, REVERSED = 1, 2, 4, 8
#: Bit of a sphere's count: gravity does not act on it (fixed or resting).
STILL = 0x80000000
MAX_CREDITS = 4  #: frames a page may let the server send ahead
MAX_MESSAGE = 4096  #: characters a page may send at once
SLOWEST, FASTEST = 1e-3, 100.0  #: speeds, in multiples of a scene's pace
LARGEST = 1e9  #: of any coordinate or velocity that a page may send
#: Close codes; 1008 and 1013 are RFC 6455's, 4000 and up are for applications.
REFUSED, TOO_MANY, WRONG_TOKEN = 1008, 1013, 4001

#: What every binary message begins with: name and `struct` letter.
HEADER = (
    ("magic", "4s"),
    ("version", "H"),
    ("kind", "H"),
    ("n", "I"),
    ("epoch", "I"),
    ("flags", "I"),
    ("scene", "I"),
)
#: The doubles that follow in a frame.
METERS = (
    *("t", "clock", "gravity_x", "gravity_y", "gravity_z"),
    *("kinetic", "potential", "dissipated", "drift", "collisions", "wall_collisions"),
    *("speed", "reached", "momentum_x", "momentum_y", "momentum_z"),
    *("temperature", "missed", "overlap", "full_energy", "full_speed"),
)
#: Numbers of each frame of a replay (`carom.view.reel`), by the names of `METERS`.
REEL_COLUMNS = (
    *("t", "gravity_x", "gravity_y", "gravity_z", "kinetic", "potential", "dissipated", "drift"),
    *("collisions", "wall_collisions", "momentum_x", "momentum_y", "momentum_z", "temperature"),
    *("full_energy", "full_speed"),
)
REEL_FORMAT = 3
SCENE_HEADER = struct.Struct("<" + "".join(letter for _, letter in HEADER))
FRAME_HEADER = struct.Struct(SCENE_HEADER.format + "d" * len(METERS))
#: Bytes of one sphere in a frame: x and v as three floats each, and a count.
SPHERE_BYTES = 28


class Value(Protocol):
    """What a key of a page's message may hold."""

    def check(self, key: str, value: Any) -> Any:
        """Return the value, or raise `InputError`."""


@dataclass(frozen=True, slots=True)
class Number:
    """A number from `low` to `high`."""

    low: float
    high: float

    def check(self, key: str, value: Any) -> float:
        """Return a float."""
        fits = isinstance(value, int | float) and not isinstance(value, bool)
        # Compared before it becomes a float: JSON knows whole numbers no float can hold.
        if not fits or not self.low <= value <= self.high or not math.isfinite(value):
            refuse(f"{key} must be a number from {self.low} to {self.high}")
        return float(value)


@dataclass(frozen=True, slots=True)
class Whole:
    """A whole number from `low` to `high`."""

    low: int
    high: int

    def check(self, key: str, value: Any) -> int:
        """Return an int."""
        number = Number(self.low, self.high).check(key, value)
        if number != int(number):
            refuse(f"{key} must be a whole number")
        return int(number)


@dataclass(frozen=True, slots=True)
class Text:
    """Text of at most `most` characters."""

    most: int

    def check(self, key: str, value: Any) -> str:
        """Return the text."""
        if not isinstance(value, str) or len(value) > self.most:
            refuse(f"{key} must be text of at most {self.most} characters")
        return value


@dataclass(frozen=True, slots=True)
class Truth:
    """True or false."""

    def check(self, key: str, value: Any) -> bool:
        """Return a bool."""
        if not isinstance(value, bool):
            refuse(f"{key} must be true or false")
        return value


@dataclass(frozen=True, slots=True)
class Triple:
    """Three numbers, none larger than `most`."""

    most: float

    def check(self, key: str, value: Any) -> tuple[float, float, float]:
        """Return a tuple of floats."""
        if not isinstance(value, list) or len(value) != 3:
            refuse(f"{key} must be three numbers")
        x, y, z = (Number(-self.most, self.most).check(key, part) for part in value)
        return x, y, z


@dataclass(frozen=True, slots=True)
class Options:
    """Options of a scene by name; the scene itself checks what they mean."""

    most: int

    def check(self, key: str, value: Any) -> dict[str, Any]:
        """Return a dict of numbers, texts and truths."""
        if not isinstance(value, dict) or len(value) > self.most:
            refuse(f"{key} must be an object with at most {self.most} keys")
        for name, option in value.items():
            if not isinstance(option, bool):
                kind: Value = Text(200) if isinstance(option, str) else Number(-1e300, 1e300)
                kind.check(f"{key}.{name[:40]}", option)
        return value


PLACE = Triple(LARGEST)
INDEX = Whole(0, 2**31 - 1)

#: Every operation of a page, and exactly the keys it takes besides "op".
OPERATIONS: dict[str, dict[str, Value]] = {
    "hello": {"token": Text(200), "version": Whole(0, 2**16)},
    "credit": {"count": Whole(1, MAX_CREDITS)},
    "play": {},
    "pause": {},
    "speed": {"value": Number(SLOWEST, FASTEST)},
    "restart": {},
    "step": {},
    "back": {},
    "reverse": {},
    "rule": {"restitution": Number(0, 1)},
    "walls": {"restitution": Number(0, 1)},
    "gravity": {"value": Triple(1e6)},
    "scene": {"name": Text(100), "options": Options(40)},
    "add": {
        "position": PLACE,
        "velocity": PLACE,
        "radius": Number(1e-9, LARGEST),
        "mass": Number(1e-12, 1e12),
        "color": Whole(0, 0xFFFFFF),
    },
    "remove": {"index": INDEX},
    "push": {"index": INDEX, "velocity": PLACE},
    "compare": {"on": Truth()},
    "source": {},
}


def refuse(why: str) -> NoReturn:
    """Raise the `InputError` that ends a connection."""
    raise InputError(why)


def javascript() -> str:
    """The same tables as the page's module ``wire.js``."""
    offsets, place = {}, 0
    for name, letter in (*HEADER, *((name, "d") for name in METERS)):
        offsets[name] = place
        place += struct.calcsize("<" + letter)
    constants = {
        "MAGIC": int.from_bytes(MAGIC, "little"),
        "VERSION": VERSION,
        "SOCKET_PATH": SOCKET_PATH,
        **{"FRAME": FRAME, "SCENE": SCENE, "SKETCH": SKETCH},
        **{"PLAYING": PLAYING, "FAILED": FAILED, "TWIN": TWIN, "REVERSED": REVERSED},
        "STILL": STILL,
        **{"MAX_CREDITS": MAX_CREDITS, "SLOWEST": SLOWEST, "FASTEST": int(FASTEST)},
        "WRONG_TOKEN": WRONG_TOKEN,
        "SCENE_HEADER_BYTES": SCENE_HEADER.size,
        "FRAME_HEADER_BYTES": FRAME_HEADER.size,
        "SPHERE_BYTES": SPHERE_BYTES,
        "REEL_FORMAT": REEL_FORMAT,
        "REEL_COLUMNS": list(REEL_COLUMNS),
    }
    lines = [
        "// Made by carom/view/wire.py, which explains it; a test compares the two.",
        *(f"export const {name} = {json.dumps(value)};" for name, value in constants.items()),
        "/** Where each number of a message's header stands, in bytes. */",
        "export const AT = {",
        *(f"  {name}: {offset}," for name, offset in offsets.items()),
        "};",
        "/** The keys of each operation a page may ask for, besides `op`. */",
        "export const OPERATIONS = {",
        *(f"  {name}: {json.dumps(list(keys))}," for name, keys in OPERATIONS.items()),
        "};",
    ]
    return "\n".join(lines) + "\n"
