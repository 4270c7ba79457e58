"""Checking a recording: its bytes against their checksums, its motion against the engine."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from carom.errors import InputError
from carom.event_file.layout import carom_version
from carom.record import layout
from carom.record.again import difference, engine_at, reach
from carom.record.file import Damaged, File
from carom.record.recording import Recording

Progress = Callable[[int, int], object]  #: frames done, frames in all


@dataclass(frozen=True)
class Verdict:
    """What a check has found.

    Attributes
    ----------
    frames, events : int
        That were looked at.
    damage : list of str
        A sentence for each frame that is not what was written.
    differences : list of str
        A sentence for each segment that the engine does not follow.
    """

    frames: int
    events: int
    damage: list[str]
    differences: list[str]

    @property
    def good(self) -> bool:
        """Whether all is well."""
        return not self.damage and not self.differences


def check(path: str | Path, progress: Progress | None = None) -> Verdict:
    """Compare each chunk with its checksum, then run everything again and compare all bits.

    Parameters
    ----------
    path : str or Path
    progress : callable, optional
        ``(done, all)``, called after each frame.

    Raises
    ------
    FileError
        If the file cannot be read.
    InputError
        If it is no recording, or of a later format.
    """
    try:
        file = File(path)
        damage = _damage(file)
        frames = len(file)
        file.close()
        if damage:
            return Verdict(frames, 0, damage, [])
        with Recording(path) as run:
            return _replayed(run, progress or (lambda done, total: None))
    except Damaged as error:
        return Verdict(0, 0, [str(error)], [])


def _damage(file: File) -> list[str]:
    """What of each frame is not as it was written."""
    damage = []
    for frame in range(len(file)):
        try:
            written = {*file.sums(frame), layout.CHECKSUMS}
            found = {*file.names(frame)}
            if written != found:
                odd = ", ".join(sorted(written ^ found))
                raise file.damage(frame, f"these chunks are missing or out of place: {odd};")
            for name in file.sums(frame):
                file.read(frame, name)
        except Damaged as error:
            damage.append(str(error))
    return damage


def _replayed(run: Recording, progress: Progress) -> Verdict:
    differences: list[str] = []
    events, begin = 0, 0
    heads, total = run.heads, len(run.heads)
    while begin < total:
        end = begin + 1
        while end < total and heads[end]["segment"] == heads[begin]["segment"]:
            end += 1
        try:
            for place, count in _follow(run, begin, end):
                events += count
                progress(place + 1, total)
        except InputError as error:
            differences.append(str(error))
        begin = end
    return Verdict(len(run), events, [], differences)


def _follow(run: Recording, begin: int, end: int) -> Iterator[tuple[int, int]]:
    """Run through the frames of a segment; yields each with the number of its events."""
    engine, heads = engine_at(run, begin), run.heads
    account = heads[begin]["account"]
    for place in range(begin, end):
        head = heads[place]
        reach(engine, head)
        events, again = run.file.events(place), engine.take_events()
        differs = difference(engine, run.file, place, head)
        if not np.array_equal(events.view(np.uint8), again.view(np.uint8)):
            differs = differs or "events"
        if head["dissipated"] != account["dissipated"] + engine.dissipated:
            differs = differs or "dissipated"
        if run.file.has(place, layout.CHECKPOINT):
            engine = engine_at(run, place)  # what follows shows whether it is right
            differs = differs or difference(engine, run.file, place, head)
        if differs:
            msg = (
                f"frame {place}, time {head['time']:.9g}: {differs} as recorded by carom "
                f"{run.manifest['carom']} differs from what carom {carom_version()} "
                "comes to on this machine"
            )
            raise InputError(msg)
        yield place, len(events)
