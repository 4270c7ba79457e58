"""`Recorder` follows a motion and writes down everything that happens."""

import math
from dataclasses import asdict
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from carom import mechanics
from carom.checks import number
from carom.errors import InputError
from carom.frame import Frame
from carom.motion import Motion
from carom.observe.batch import Moment
from carom.record import hoomd, layout
from carom.record.recording import Recording
from carom.record.writer import Writer
from carom.scene import Scene
from carom.state import EVENT

FRAMES_PER_SECOND = 30  #: at the scene's pace, where nothing else is asked for
CHECKPOINT_FRAMES = 10  #: frames from one checkpoint to the next, likewise
#: Likewise, after so many frames another must be worth its room: as many events as spheres must
#: have happened since the one before, and so many at least.
FILM_FRAMES, WORTH_A_FRAME = 300, 100
SHORTEST = 1e-6  #: time between frames, in units of the crossing time: files would have no end
#: Events in a chunk, 10 MB. They go to the file when so many are there, so memory is bounded.
MOST_EVENTS = 2**18


class Times(NamedTuple):
    """When there are frames and checkpoints."""

    every: float  #: simulated time between frames
    checkpoint_frames: int  #: each so many frames there is a checkpoint
    thin: bool  #: whether frames are left out of a long run where little happens between them


class Recorder:
    """Writes frames, all events, and checkpoints from which the run can go on with the same bits.

    A change from outside (an assignment, an added sphere, a reset) begins a new segment of the
    file, with all that is needed to go on from there.

    Parameters
    ----------
    motion : Motion
    writer : Writer
    times : Times
    """

    takes_events = True

    def __init__(self, motion: Motion, writer: Writer, times: Times) -> None:
        self._motion, self._writer, self._times = motion, writer, times
        self._opening: list[tuple[str, NDArray[Any]]] = []  # goes into the next frame
        self._first: hoomd.Chunks = {}  # of the file's first frame
        self._standing: hoomd.Chunks = {}
        self._segment, self._open = -1, False
        self._origin, self._step, self._frames = 0.0, 0, 0
        self._overlap = 0.0
        self._last_time, self._last_checkpoint = math.nan, False
        self._events: list[NDArray[np.uint8]] = []
        self._waiting, self._parts = 0, 0

    def begin_file(self, scene: Scene | None) -> None:
        """Put into the first frame what a new file begins with."""
        about = layout.manifest(scene, self._times._asdict())
        self._opening = [(layout.MANIFEST, layout.as_json(about))]
        if scene is not None:
            self._opening += layout.packed_scene(scene)

    def go_on(self, run: Recording, place: int) -> None:
        """Go on with a file from its last frame, at which the motion is now."""
        about = layout.manifest(run.scene, self._times._asdict())
        self._opening = [(layout.MANIFEST, layout.as_json(about))]
        head = run.heads[place]
        self._segment, self._origin = head["segment"], head["origin"]
        self._overlap = head["max_overlap"]
        standard = (name for name in run.file.sums(0) if not name.startswith("carom/"))
        self._first = {name: run.file.read(0, name) for name in standard}
        self._standing = self._own(hoomd.standing(self._motion.state))
        self._last_checkpoint = run.file.has(place, layout.CHECKPOINT)
        self._open, self._last_time = True, self._motion.time
        self._frames = len(run.heads)
        self._next_step()

    @property
    def due(self) -> float:
        """Time of the next frame: a whole number of intervals after the first."""
        return self._origin + self._step * self._times.every

    def _next_step(self) -> None:
        self._step = max(0, math.floor((self._motion.time - self._origin) / self._times.every))
        while self.due <= self._motion.time:
            self._step += 1

    def begin(self, moment: Moment) -> None:
        """Begin a segment, if something has changed."""
        if not self._open:
            self._begin_segment()

    def _begin_segment(self) -> None:
        if self._segment < 0:
            self._origin = self._motion.time
        self._segment += 1
        self._open = True
        saved = self._motion.saved()
        self._opening += [
            (layout.BUILT, layout.packed(saved.built)),
            (layout.SURROUNDINGS, layout.packed_surroundings(saved.surroundings)),
        ]
        self._write(checkpoint=True, new_spheres=True)
        self._next_step()

    def events(self, records: NDArray[Any]) -> None:
        """Take what has happened."""
        self._events.append(layout.packed_events(records))
        self._waiting += len(records)
        while self._waiting >= MOST_EVENTS:  # cut at fixed numbers: the file is always the same
            rows = self._joined_events()
            self._write_events(rows[:MOST_EVENTS])
            self._events, self._waiting = [rows[MOST_EVENTS:]], self._waiting - MOST_EVENTS

    def _joined_events(self) -> NDArray[np.uint8]:
        if len(self._events) == 1:  # as a rule; they are most of what is recorded, and not copied
            return self._events[0]
        return np.concatenate([layout.packed_events(np.zeros(0, EVENT)), *self._events])

    def _write_events(self, rows: NDArray[np.uint8]) -> None:
        self._writer.chunk(layout.events_name(self._parts), rows)
        self._parts += 1

    def moment(self, moment: Moment) -> None:
        """Write a frame, if it is time for one."""
        if self._motion.time >= self.due:
            if self._worth_a_frame():
                turn = self._frames if self._times.thin else self._step
                self._write(checkpoint=turn % self._times.checkpoint_frames == 0)
            self._next_step()

    def _worth_a_frame(self) -> bool:
        events = self._waiting + self._parts * MOST_EVENTS
        enough = max(WORTH_A_FRAME, len(self._motion.state))
        return not self._times.thin or self._frames < FILM_FRAMES or events >= enough

    def end(self, moment: Moment) -> None:
        """Wait for the next run; the same bits can be had from the last checkpoint."""

    def cut(self, moment: Moment) -> None:
        """Finish the segment; the next run begins another."""
        if self._open and (self._waiting or self._parts or self._motion.time != self._last_time):
            self._write(checkpoint=False)
        self._open = False

    def close(self, moment: Moment) -> None:
        """Write how it is now, with a checkpoint to go on from, and close the file."""
        try:
            now = self._motion.time == self._last_time and not (self._waiting or self._parts)
            if not len(self._motion.state):
                pass  # there is nothing that could go on
            elif not self._open:
                self._begin_segment()
            elif not (now and self._last_checkpoint):
                self._write(checkpoint=True)
        finally:
            self._writer.close()

    def _frame(self, *, look_closely: bool) -> Frame:
        """Take this moment; a look at all neighbours for overlaps costs as much as all the rest."""
        motion = self._motion
        if look_closely:
            self._overlap = motion.max_overlap
        errors = self._overlap, motion.energy_drift, motion.missed
        return Frame(motion.state, motion.surroundings, motion.dissipated, motion.withheld, *errors)

    def _own(self, chunks: hoomd.Chunks) -> hoomd.Chunks:
        """Those a frame needs of its own: readers take the others from the first frame."""
        first = self._first
        return {
            name: chunk
            for name, chunk in chunks.items()
            if name not in first or not np.array_equal(chunk, first[name])
        }

    def _write(self, *, checkpoint: bool, new_spheres: bool = False) -> None:
        """Write a frame of now."""
        frame, writer = self._frame(look_closely=checkpoint), self._writer
        for name, chunk in self._opening:
            writer.chunk(name, chunk)
        self._opening = []
        if self._waiting or not self._parts:
            self._write_events(self._joined_events())
        self._events, self._waiting, self._parts = [], 0, 0
        if new_spheres:
            self._standing = self._own(hoomd.standing(frame.state))
        standard = self._standing | self._own(hoomd.moving(frame, self._motion.world))
        for name, chunk in standard.items():
            writer.chunk(name, chunk)
        if not self._first:
            self._first, self._standing = standard, {}
        for name in ("position", "velocity", "collision_count"):
            writer.chunk(layout.ARRAYS[name], getattr(frame.state, name))
        writer.chunk(layout.ARRAYS["resting"], frame.state.resting.view(np.uint8))
        saved = self._motion.saved() if checkpoint else None
        head: dict[str, Any] = {
            "time": frame.time,
            "segment": self._segment,
            "collisions": frame.collisions,
            "wall_collisions": frame.wall_collisions,
            "missed": frame.missed,
            "dissipated": frame.dissipated,
            "withheld": frame.withheld,
            "max_overlap": frame.max_overlap,
            "energy_drift": frame.energy_drift,
            "origin": self._origin,
        }
        if saved is not None:
            head |= {"account": asdict(saved.account), "edited": saved.edited}
            # No bytes: the engine is still to be built.
            writer.chunk(layout.CHECKPOINT, layout.as_bytes(saved.engine or b""))
        writer.chunk(layout.HEAD, layout.as_json(head))
        writer.end_frame(frame.time)
        self._last_time, self._last_checkpoint = frame.time, checkpoint
        self._frames += 1


def times_of(every: Any, checkpoint_every: Any, pace: float) -> Times:
    """When there are frames and checkpoints, from what a user gives or leaves out.

    Raises
    ------
    InputError
        If a time is not above 0, or checkpoints are to come more often than frames.
    """
    step = pace / FRAMES_PER_SECOND if every is None else number("every", every, above=0)
    if checkpoint_every is None:
        return Times(step, CHECKPOINT_FRAMES, thin=every is None)
    frames = number("checkpoint_every", checkpoint_every, above=0) / step
    if round(frames) < 1 or abs(frames - round(frames)) > 1e-6 * frames:
        msg = (
            f"checkpoint_every is {checkpoint_every:g}, but checkpoints come with frames, every "
            f"{step:g}; give a multiple of that"
        )
        raise InputError(msg)
    return Times(step, round(frames), thin=False)


def record(
    motion: Motion,
    path: str | Path,
    *,
    scene: Scene | None,
    every: float | None,
    checkpoint_every: float | None,
    overwrite: bool,
) -> Recorder:
    """Begin a file; the recorder must then join the followers of the motion.

    Raises
    ------
    InputError
        If the times cannot be used, or the file is there and shall not be overwritten.
    FileError
        If the file cannot be written.
    """
    target = Path(path)
    times = times_of(every, checkpoint_every, 1.0 if scene is None else scene.pace)
    least = SHORTEST * mechanics.crossing_time(motion.state, motion.world)
    if times.every < least and motion.state.velocity.any():  # at rest there is no such scale
        msg = (
            f"every={times.every:g} is too short: in that time spheres do not move a millionth of "
            f"their radius; take at least {least:.2g} (a recording knows all moments between)"
        )
        raise InputError(msg)
    if target.exists() and not overwrite:
        msg = (
            f"{target} is there already; give another name, allow it to be overwritten, or go on "
            "with it by resuming"
        )
        raise InputError(msg)
    recorder = Recorder(motion, Writer(target, "w" if overwrite else "x"), times)
    recorder.begin_file(scene)
    return recorder
