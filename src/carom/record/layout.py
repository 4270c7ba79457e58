"""What a recording is made of: names of its chunks, and how things are packed; docs/format.md."""

import io
import json
import sys
import zlib
from dataclasses import fields, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.event_file.layout import carom_version
from carom.kept import Surroundings
from carom.scene import Scene, Spheres
from carom.state import EVENT, State

SCHEMA, SCHEMA_VERSION = "hoomd", (1, 4)  # what OVITO, freud and MDAnalysis look for
APPLICATION = "carom"
FORMAT = 1  #: of carom's own chunks; a file of a higher one is refused

# In every frame.
HEAD = "carom/frame"
EVENTS = "carom/events"
CHECKSUMS = "carom/checksums"
ARRAYS = {  # of the state, by their chunks
    "position": "carom/position",
    "velocity": "carom/velocity",
    "image": "particles/image",
    "collision_count": "carom/collision_count",
    "resting": "carom/resting",
}
# Where a segment begins.
BUILT, SURROUNDINGS = "carom/built", "carom/surroundings"
# Now and then.
CHECKPOINT = "carom/checkpoint"
# Where a program began to write.
MANIFEST, SCENE, SPHERES = "carom/manifest", "carom/scene", "carom/spheres"


def events_name(k: int) -> str:
    """The chunk of the k-th part of a frame's events."""
    return EVENTS if k == 0 else f"{EVENTS}/{k}"


def manifest(scene: Scene | None, times: dict[str, Any]) -> dict[str, Any]:
    """What is told about how a recording came to be; `times` of its frames, too."""
    import platform

    origin = None if scene is None else scene.origin
    return {
        "format": FORMAT,
        "carom": carom_version(),
        "platform": f"{platform.system()} {platform.machine()}",
        "python": platform.python_version(),
        "numpy": np.__version__,
        "command": [Path(sys.argv[0]).name, *sys.argv[1:]],
        "started": datetime.now(UTC).isoformat(timespec="seconds"),
        "scene": None if origin is None else origin.name,
        "options": None if origin is None else origin.options,
        "title": "" if scene is None else scene.title,
        "seed": None if scene is None or scene.seed is None else int(scene.seed),
        "method": "exact",
        **times,
    }


# Bytes in chunks. What reads and writes scene files is heavy and waits until it is used.


def as_bytes(data: bytes) -> NDArray[np.uint8]:
    """Bytes as a chunk."""
    return np.frombuffer(data, np.uint8)


def as_json(data: Any) -> NDArray[np.uint8]:
    """Plain data as a chunk; floats come back to the same bits."""
    return as_bytes(json.dumps(data, default=str).encode())


def checksum(name: str, chunk: NDArray[Any]) -> int:
    """CRC-32 of a chunk with its name, type and shape."""
    head = f"{name} {chunk.dtype.str} {chunk.shape}".encode()
    return zlib.crc32(np.ascontiguousarray(chunk).data, zlib.crc32(head))


def packed(part: Any) -> NDArray[np.uint8]:
    """A dataclass of arrays and numbers as a chunk: the bytes of an .npz file."""
    file = io.BytesIO()
    np.savez(file, **{f.name: getattr(part, f.name) for f in fields(part)})
    return as_bytes(file.getvalue())


def _unpacked(chunk: NDArray[np.uint8]) -> dict[str, Any]:
    with np.load(io.BytesIO(chunk.tobytes()), allow_pickle=False) as arrays:
        return dict(arrays)


def unpacked_state(chunk: NDArray[np.uint8]) -> State:
    """The state that `packed` has packed."""
    arrays = _unpacked(chunk)
    numbers = {name: arrays.pop(name) for name in ("time", "collisions", "wall_collisions")}
    return State(
        **arrays,
        time=float(numbers["time"]),
        collisions=int(numbers["collisions"]),
        wall_collisions=int(numbers["wall_collisions"]),
    )


def packed_surroundings(around: Surroundings) -> NDArray[np.uint8]:
    """Walls, rule, gravity and collide as a scene file without spheres."""
    from carom.scene_file import dump

    values = {f.name: getattr(around, f.name) for f in fields(around)}
    return as_bytes(dump(Scene(_nobody(), **values)).encode())


def unpacked_surroundings(chunk: NDArray[np.uint8]) -> Surroundings:
    """The same, back."""
    from carom.scene_file import parse

    return Surroundings.of(parse(chunk.tobytes().decode(), "the recording's walls and rule"))


def packed_scene(scene: Scene) -> list[tuple[str, NDArray[np.uint8]]]:
    """A scene as two chunks: a scene file without its spheres, and the spheres."""
    from carom.scene_file import dump

    text = dump(replace(scene, spheres=_nobody()))
    return [(SCENE, as_bytes(text.encode())), (SPHERES, packed(scene.spheres))]


def unpacked_scene(text: NDArray[np.uint8], spheres: NDArray[np.uint8]) -> Scene:
    """The same, back; which scene of the library it was is not in it."""
    from carom.scene_file import parse

    scene = parse(text.tobytes().decode(), "the recording's scene")
    return replace(scene, spheres=Spheres(**_unpacked(spheres)))


def _nobody() -> Spheres:
    return Spheres.of(np.zeros((0, 3)))


def packed_events(records: NDArray[Any]) -> NDArray[np.uint8]:
    """Event records, (n,) EVENT, as rows of 40 bytes."""
    rows: NDArray[np.uint8] = np.ascontiguousarray(records).view(np.uint8)
    return rows.reshape(-1, EVENT.itemsize)


def unpacked_events(chunk: NDArray[np.uint8]) -> NDArray[Any]:
    """The same, back."""
    records: NDArray[Any] = np.ascontiguousarray(chunk).reshape(-1).view(EVENT)
    return records
