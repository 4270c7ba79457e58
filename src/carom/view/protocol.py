"""What the live view and its page say to each other; `static/protocol.js` is the other side.

The tables of numbers, flags and operations are in `carom.view.wire`. In words:

**Server to page, binary**, little-endian. Both kinds begin with `wire.HEADER`: "CARO", version,
kind (1 frame, 2 scene), n spheres, the epoch, flags, the scene's number. The epoch counts jumps of
the motion (restarts, steps back, reversals); a frame belongs to the scene sent under its number.

A **frame** goes on with the doubles of `wire.METERS`, then positions f4[3n], velocities f4[3n] and
counts u4[n]: impulses received since the start, with the top bit set where gravity does not act.
While exact motion and ticks run side by side, a second frame of the ticks follows each, flagged
TWIN.

A **scene** has the size of its JSON part instead of flags. It goes on with that JSON (padded with
spaces to a multiple of four bytes), then radius f4[n], mass f4[n] (infinite where fixed), colour
u4[n] (0xRRGGBB) and species u4[n]. It is sent before the first frame and again when something in
it has changed.

**Server to page, text**: JSON objects with one key. Notes are repeated to pages that come later
and sent again when they change; answers go to the page that asked.

========= =================== ==================================================================
key       when                value
========= =================== ==================================================================
catalogue once, note          scenes of the library with their options
role      once, note          "control" or "watch"
failure   note                a sentence, "" when all is well again
settings  note                restitution, wall_restitution, contact_time, gravity, comparing, tick
event     note                the collision that a step has led to: t, i, j, impulse, serial
walls     note                pressure of each wall (null: endless), theory, duration averaged
refused   answer              a sentence: why a command could not be done
source    answer              python, toml, command: the simulation as text
========= =================== ==================================================================

**Page to server**: text of at most `wire.MAX_MESSAGE` characters, a JSON object with "op" and
exactly the keys of `wire.OPERATIONS`.
"""

import json
from dataclasses import dataclass, field
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from carom.errors import InputError
from carom.state import Floats, State
from carom.view import wire
from carom.view.wire import FRAME_HEADER, SCENE_HEADER, refuse


class Moment(Protocol):
    """What a frame takes of a `State`, or of a simulation without copying it."""

    def __len__(self) -> int: ...

    @property
    def position(self) -> Floats:
        """(n, 3)."""

    @property
    def velocity(self) -> Floats:
        """(n, 3)."""

    @property
    def collision_count(self) -> NDArray[np.uint32]:
        """(n,)."""

    @property
    def fixed(self) -> NDArray[np.bool_]:
        """(n,)."""

    @property
    def resting(self) -> NDArray[np.bool_]:
        """(n,)."""

    @property
    def time(self) -> float:
        """Simulated time."""

    @property
    def collisions(self) -> int:
        """Between spheres."""

    @property
    def wall_collisions(self) -> int:
        """With walls."""


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
    momentum: tuple[float, float, float]
    temperature: float
    full_energy: float
    full_speed: float
    epoch: int
    scene: int
    missed: int = 0
    overlap: float = 0.0
    playing: bool = True
    failed: bool = False
    twin: bool = False
    reversed: bool = False


@dataclass(frozen=True, slots=True)
class Command:
    """A checked message from a page: an operation and its values by key."""

    op: str
    values: dict[str, Any] = field(default_factory=dict)

    def __getitem__(self, key: str) -> Any:
        return self.values[key]


def encode_frame(now: Moment, meters: Meters) -> bytes:
    """Pack one frame, `wire.FRAME_HEADER.size` + 28 n bytes."""
    m = meters
    flags = (
        wire.PLAYING * m.playing
        | wire.FAILED * m.failed
        | wire.TWIN * m.twin
        | wire.REVERSED * m.reversed
    )
    header = FRAME_HEADER.pack(
        *(wire.MAGIC, wire.VERSION, wire.FRAME, len(now), m.epoch, flags, m.scene),
        *(now.time, m.clock, *m.gravity, m.kinetic, m.potential, m.dissipated, m.drift),
        *(now.collisions, now.wall_collisions, m.speed, m.reached),
        *(*m.momentum, m.temperature, m.missed, m.overlap),
        *(m.full_energy, m.full_speed),
    )
    return b"".join(
        (
            header,
            now.position.astype("<f4").tobytes(),
            now.velocity.astype("<f4").tobytes(),
            counts_of(now).astype("<u4").tobytes(),
        )
    )


def counts_of(now: Moment) -> NDArray[np.uint32]:
    """Impulses of each sphere, with the top bit where gravity does not act."""
    still = (now.fixed | now.resting).astype(np.uint32)
    return now.collision_count & np.uint32(wire.STILL - 1) | still * np.uint32(wire.STILL)


def encode_scene(state: State, number: int, about: dict[str, Any]) -> bytes:
    """Pack the scene message; `about` is its JSON part."""
    text = json.dumps(about, allow_nan=False).encode()
    text += b" " * (-len(text) % 4)
    head = (wire.MAGIC, wire.VERSION, wire.SCENE, len(state), 0, len(text), number)
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


def decode_scene(message: bytes) -> tuple[dict[str, Any], Floats, Floats]:
    """Unpack of a scene message its JSON part, radii and masses."""
    *_, n, _, size, _ = SCENE_HEADER.unpack_from(message)
    start = SCENE_HEADER.size
    about: dict[str, Any] = json.loads(message[start : start + size])
    radius, mass = np.frombuffer(message, "<f4", 2 * n, start + size).reshape(2, n).astype(float)
    return about, radius, mass


def encode_text(key: str, value: Any) -> str:
    """Write a text message."""
    return json.dumps({key: value}, allow_nan=False)


def decode_command(text: object) -> Command:
    """Check a message from a page.

    Raises
    ------
    InputError
        If it is not exactly one of the operations with values that fit.
    """
    if not isinstance(text, str) or len(text) > wire.MAX_MESSAGE:
        refuse(f"a message must be text of at most {wire.MAX_MESSAGE} characters")
    try:
        message = json.loads(text, parse_constant=lambda name: refuse(f"{name} is no number"))
    except (ValueError, RecursionError) as error:
        msg = "a message must be JSON"
        raise InputError(msg) from error
    op = message.pop("op", None) if isinstance(message, dict) else None
    if not isinstance(op, str) or op not in wire.OPERATIONS:
        refuse("the operation is unknown")
    keys = wire.OPERATIONS[op]
    if message.keys() != keys.keys():
        refuse(f"{op} takes exactly these keys: {', '.join(sorted(keys)) or 'none'}")
    return Command(op, {key: kind.check(key, message[key]) for key, kind in keys.items()})
