"""The same stored start gives the same bits: on every processor, with every compiler.

`data/fingerprints.json` holds start states in whole numbers, lengths and speeds in units of
1/1024, and for each the SHA-256 of what becomes of it after so many events. If a formula of the
engine is changed on purpose, and only then, write the digests anew (starts stay as they are)::

    python -m tests.golden.test_fingerprints

and say so in the changelog: from that version on the same scene takes another path.
"""

import hashlib
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from carom._core import simd_levels
from carom.engine import FastEngine, Stop
from carom.state import State
from carom.world import WALL, World

FILE = Path(__file__).parent / "data" / "fingerprints.json"
STORED: dict[str, Any] = json.loads(FILE.read_text())
UNIT = 1 / 1024


def start(scene: dict[str, Any]) -> State:
    """Columns x y z, vx vy vz, radius; the mass in whole units, 0 for a fixed sphere."""
    table = np.array(scene["spheres"], np.int64)
    state = State.empty(len(table))
    state.position[:] = table[:, 0:3] * UNIT
    state.velocity[:] = table[:, 3:6] * UNIT
    state.radius[:] = table[:, 6] * UNIT
    state.mass[:] = table[:, 7]
    state.fixed[:] = table[:, 7] == 0
    state.mass[state.fixed] = np.inf
    return state


def world(scene: dict[str, Any]) -> World:
    return World(
        period=np.array(scene.get("period", (0.0, 0.0, 0.0))),
        walls=np.array([tuple(wall) for wall in scene.get("walls", ())], WALL),
        restitution=scene.get("restitution", 1.0),
        contact_time=scene.get("contact_time", 0.0),
        gravity=np.array(scene.get("gravity", (0.0, 0.0, 0.0))),
    )


def fingerprint(scene: dict[str, Any], **bookkeeping: Any) -> str:
    """Digest of the state and of who met whom, after the scene's number of events."""
    engine = FastEngine(start(scene), world(scene), **bookkeeping)
    records, stop, left = [], Stop.SLICE, scene["events"]
    while stop is Stop.SLICE:
        stop = engine.advance(math.inf, max_events=left)
        left = scene["events"] - engine.collisions - engine.wall_collisions
        records.append(engine.take_events())
    assert stop is Stop.COUNT
    end, events = engine.state(), np.concatenate(records)
    digest = hashlib.sha256()
    for column in (end.position, end.velocity, np.array(end.time)):
        digest.update(column.astype("<f8").tobytes())
    for column in (end.image, end.collision_count, end.resting, events["i"], events["j"]):
        digest.update(column.astype("<i8").tobytes())
    return digest.hexdigest()


each_scene = pytest.mark.parametrize("name", STORED)


@each_scene
def test_the_path_is_the_stored_one(name):
    assert fingerprint(STORED[name]) == STORED[name]["sha256"]


@each_scene
@pytest.mark.parametrize("simd", simd_levels())
@pytest.mark.parametrize("grid", [0, 1])
@pytest.mark.parametrize("ahead", [0, 1])
def test_with_every_instruction_set_on_a_grid_or_in_lists_looking_ahead_or_not(
    name, simd, grid, ahead
):
    path = fingerprint(STORED[name], simd=simd, grid=grid, ahead=ahead)
    assert path == STORED[name]["sha256"]


@each_scene
@pytest.mark.parametrize(
    "bookkeeping",
    [
        {"margin": 0.1, "ahead": 1},
        {"margin": 0.7, "cell": 6.0},
        {"cell": 3.0, "grid": 1, "ahead": 1},
        {"sort": False},
        {"sort": False, "grid": 1},
    ],
    ids=str,
)
def test_with_other_shells_and_cells(name, bookkeeping):
    assert fingerprint(STORED[name], **bookkeeping) == STORED[name]["sha256"]


def test_scenes_sort_and_use_the_grid():
    """Of what is compared above something is there to compare."""
    sizes = [len(scene["spheres"]) for scene in STORED.values()]
    assert len(sizes) >= 10
    assert sum(size >= 1024 for size in sizes) >= 2
    assert sum(uses_grid(scene) for scene in STORED.values()) >= 3


def uses_grid(scene: dict[str, Any]) -> bool:
    """Whether the engine does something else when told to use a grid."""
    did = []
    for grid in (0, 1):
        engine = FastEngine(start(scene), world(scene), grid=grid)
        engine.advance(math.inf, max_events=scene["events"] // 4)
        did.append(engine.work())
    return did[0] != did[1]


def written(scenes: dict[str, Any]) -> str:
    """The file's text, one sphere to a line."""
    text = json.dumps(scenes, indent=1)
    lines = []
    for line in text.split("\n"):
        inner = lines and line.startswith("    ")  # numbers within a row
        closing = lines and line.strip() in ("]", "],") and line.startswith("   ]")
        if inner or closing:
            lines[-1] += line.strip() + (" " if inner and line.endswith(",") else "")
        else:
            lines.append(line)
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    for stored in STORED.values():
        stored["sha256"] = fingerprint(stored)
    FILE.write_text(written(STORED))
