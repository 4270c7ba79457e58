"""From a checkpoint to later frames by the engine: to go on with a recording, and to check it."""

from dataclasses import replace
from typing import Any

import numpy as np

from carom.engine import NO_LIMIT, FastEngine, Stop
from carom.errors import InputError
from carom.event_file.layout import carom_version
from carom.kept import Account, Start
from carom.motion import Motion
from carom.record import layout
from carom.record.file import File
from carom.record.recorder import Recorder, Times
from carom.record.recording import Recording
from carom.record.writer import Writer


def engine_at(run: Recording, place: int) -> FastEngine:
    """The engine as it was at a frame with a checkpoint.

    Raises
    ------
    InputError
        If this version cannot read the checkpoint.
    """
    segment = run.segment(place)
    engine = FastEngine(segment.built, segment.surroundings.world())
    checkpoint = run.file.read(place, layout.CHECKPOINT).tobytes()
    try:
        if checkpoint:
            engine.restore(checkpoint)
    except ValueError:
        msg = (
            f"{run.path} was recorded by carom {run.manifest['carom']}, and carom "
            f"{carom_version()} cannot go on from its checkpoints; use the version that "
            "recorded it"
        )
        raise InputError(msg) from None
    return engine


def reach(engine: FastEngine, head: dict[str, Any]) -> None:
    """Let an engine run to the moment of a frame.

    That is its time, and of simultaneous events no more than had happened.
    """
    missing = head["collisions"] + head["wall_collisions"]
    missing -= engine.collisions + engine.wall_collisions
    if missing > 0:
        _advance(engine, head["time"], missing)
    if engine.time < head["time"]:
        _advance(engine, head["time"], NO_LIMIT)


def _advance(engine: FastEngine, until: float, events: int) -> None:
    begin = engine.collisions + engine.wall_collisions
    stop = Stop.SLICE
    while stop is Stop.SLICE:
        done = engine.collisions + engine.wall_collisions - begin
        stop = engine.advance(until, max_events=events - done)


def difference(engine: FastEngine, file: File, place: int, head: dict[str, Any]) -> str:
    """In what an engine differs from a frame of the file; empty if all bits are the same."""
    state = engine.state()
    for name in ("time", "collisions", "wall_collisions"):
        if getattr(state, name) != head[name]:
            return name
    for name, chunk in layout.ARRAYS.items():
        if not np.array_equal(getattr(state, name), file.inherited(place, chunk)):
            return name
    return ""


def resume(motion: Motion, run: Recording) -> Recorder:
    """Bring a motion to where a recording ends; the recorder must then join its followers.

    Raises
    ------
    InputError
        If the checkpoints, or the bits they lead to, are those of another version.
    FileError
        If the file cannot be read or written.
    """
    writer = Writer(run.path, "r+", frames=len(run.file))
    try:
        recorder = _resumed(motion, run, writer)
    except BaseException:
        writer.close()
        raise
    return recorder


def _resumed(motion: Motion, run: Recording, writer: Writer) -> Recorder:
    last = len(run.heads) - 1
    place = last
    while not run.file.has(place, layout.CHECKPOINT):
        place -= 1
    engine = engine_at(run, place)
    reach(engine, run.heads[last])
    differs = difference(engine, run.file, last, run.heads[last])
    if differs:
        msg = (
            f"{run.path} cannot be resumed: from the checkpoint at {run.heads[place]['time']:.9g} "
            f"carom {carom_version()} on this machine comes to another {differs} than carom "
            f"{run.manifest['carom']} has recorded on {run.manifest['platform']}"
        )
        raise InputError(msg)
    _take_up(motion, run, run.heads[place], engine.checkpoint())
    about = run.manifest
    thin = about.get("thin", False)  # carom 0.1 at first never did
    times = Times(about["every"], about["checkpoint_frames"], thin)
    recorder = Recorder(motion, writer, times)
    recorder.go_on(run, last)
    return recorder


def _take_up(motion: Motion, run: Recording, head: dict[str, Any], checkpoint: bytes) -> None:
    """Bring a motion to the moment of a checkpoint that was made after a frame's."""
    first, segment = run.segment(0), run.segment(len(run.heads) - 1)
    motion.begin(segment.built, segment.surroundings)
    start = Start(first.built, first.surroundings, np.arange(-len(first.built), 0), edited=True)
    account, edited = Account(**head["account"]), head["edited"]
    now = replace(motion.saved(), start=start, account=account, edited=edited, engine=checkpoint)
    motion.return_to(now)
