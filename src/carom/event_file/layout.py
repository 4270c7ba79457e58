"""What an event file holds: its columns, and all that replays the run."""

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.state import CAME_TO_REST, EVENT, WOKE, State
from carom.world import World

FORMAT, VERSION = "carom events", 1
#: Events in a row group of Parquet, or in one array of an .npz: 10 MB.
GROUP = 2**18
#: Names of the numbers in the column `kind`.
KINDS = ("pair", "wall", "came to rest", "woke")
PAIR, WALL, REST, WAKE = range(4)

#: One row, 45 bytes. The first 40 are those of an event record.
ROW: np.dtype[Any] = np.dtype(
    [
        ("time", "f8"),
        ("i", "i4"),
        ("j", "i4"),
        ("impulse_x", "f8"),
        ("impulse_y", "f8"),
        ("impulse_z", "f8"),
        ("kind", "i1"),
        ("wall", "i4"),
    ]
)
COLUMNS = ROW.names or ()
IMPULSE = ("impulse_x", "impulse_y", "impulse_z")
#: What the file says about them, for those who read it without carom.
MEANING = {
    "time": "when, absolute, in units of time of the simulation",
    "i": "sphere; of a pair the one with the smaller number",
    "j": "the other sphere (j > i); below 0 where there is none: see kind and wall",
    "impulse_x": "x component of the impulse on i, in mass times velocity; on j acts its opposite",
    "impulse_y": "y component of the same",
    "impulse_z": "z component of the same",
    "kind": "pair, wall, came to rest (on a wall, with its last impulse) or woke (no impulse)",
    "wall": "number of the wall, from 0; -1 where there is none",
}


def carom_version() -> str:
    """The version that is installed."""
    from importlib.metadata import PackageNotFoundError, version  # takes a tenth of the import

    try:
        return version("carom")
    except PackageNotFoundError:  # run from the source tree
        return "0+unknown"


def columns(records: NDArray[Any]) -> dict[str, NDArray[Any]]:
    """The columns of a file from (n,) EVENT."""
    result = {name: np.ascontiguousarray(records[name]) for name in ("time", "i", "j")}
    for axis, name in enumerate(IMPULSE):
        result[name] = np.ascontiguousarray(records["impulse"][:, axis])
    result["kind"], result["wall"] = _kinds(result["j"])
    return result


def _kinds(j: NDArray[np.int32]) -> tuple[NDArray[np.int8], NDArray[np.int32]]:
    """What happened, and at which wall."""
    kind, wall = np.full(len(j), PAIR, np.int8), np.full(len(j), -1, np.int32)
    alone = np.flatnonzero(j < 0)
    partner = j[alone]
    which = [partner > CAME_TO_REST, partner > WOKE]
    kind[alone] = np.select(which, [WALL, REST], WAKE)
    wall[alone] = np.select(which, [-1 - partner, CAME_TO_REST - partner], -1)
    return kind, wall


def rows(records: NDArray[Any]) -> NDArray[Any]:
    """(n,) ROW from (n,) EVENT."""
    result = np.empty(len(records), ROW)
    # As bytes: field by field takes sixteen times as long.
    plain = np.ascontiguousarray(records).view(np.uint8).reshape(len(records), EVENT.itemsize)
    result.view(np.uint8).reshape(len(records), ROW.itemsize)[:, : EVENT.itemsize] = plain
    result["kind"], result["wall"] = _kinds(records["j"])
    return result


def records(columns: Mapping[str, NDArray[Any]]) -> NDArray[Any]:
    """(n,) EVENT from the columns of a file."""
    result = np.empty(len(columns["time"]), EVENT)
    for name in ("time", "i", "j"):
        result[name] = columns[name]
    for axis, name in enumerate(IMPULSE):
        result["impulse"][:, axis] = columns[name]
    return result


def packed(state: State, world: World) -> dict[str, NDArray[Any]]:
    """Where a run begins, as arrays with names."""
    start = {f"start_{f.name}": np.asarray(getattr(state, f.name)) for f in fields(state)}
    return start | {f"world_{f.name}": np.asarray(getattr(world, f.name)) for f in fields(world)}


def unpacked(arrays: Mapping[str, NDArray[Any]]) -> tuple[State, World]:
    """The same state and world again, to the bit."""

    def value(name: str) -> Any:
        array = arrays[name]
        return array if array.ndim else array.item()

    return (
        State(**{f.name: value(f"start_{f.name}") for f in fields(State)}),
        World(**{f.name: value(f"world_{f.name}") for f in fields(World)}),
    )
