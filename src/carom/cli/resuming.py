"""``carom run -o`` and ``--resume``: a run that is recorded, and one that goes on."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from carom.cli import report
from carom.cli.recording import size_text
from carom.cli.source import Source, parsed, whole
from carom.errors import InputError
from carom.event_file import load_events
from carom.event_file.source import ENDINGS
from carom.record import load
from carom.scene import Scene, Spheres
from carom.simulation import Simulation

Output = Annotated[
    Path | None,
    typer.Option("-o", "--output", metavar="RUN.gsd", help="Record everything in this file."),
]
Every = Annotated[
    str | None,
    typer.Option(
        metavar="TIME", help="Between recorded frames; 1/30 of the pace if left out, later more."
    ),
]
CheckpointEvery = Annotated[
    str | None,
    typer.Option(metavar="TIME", help="Between checkpoints; ten frames if left out."),
]
EventFile = Annotated[
    Path | None,
    typer.Option(metavar="FILE", help="Write every event into FILE.parquet or FILE.npz."),
]
Resume = Annotated[
    Path | None,
    typer.Option(metavar="RUN.gsd", help="Go on with a recording, in the same file."),
]


def counted(events: str | None) -> int | None:
    """The number of events to run for; a file's name belongs elsewhere."""
    if events is not None and events.endswith(ENDINGS):
        msg = f"--events is how many to run for; to write them, say --record-events {events}"
        raise InputError(msg)
    return whole("events", events)


@dataclass(frozen=True)
class Plan:
    """What is to be recorded.

    Raises
    ------
    InputError
        If there are options for a recording that nobody asked for.
    """

    output: Path | None
    every: float | None
    checkpoint_every: float | None
    force: bool
    events: Path | None

    def __post_init__(self) -> None:
        values = {"--every": self.every, "--checkpoint-every": self.checkpoint_every}
        given = [name for name, value in values.items() if value is not None]
        given += ["--force"] if self.force and self.events is None else []
        if given and self.output is None:
            msg = f"{given[0]} says how to record; name the file too, as in -o run.gsd"
            raise InputError(msg)

    @property
    def asked(self) -> bool:
        """Whether anything is to be recorded into a new file."""
        return self.output is not None or self.events is not None

    def begin(self, sim: Simulation) -> None:
        """Let a simulation be recorded, if that is wanted."""
        if self.output is not None and self.output.suffix.lower() != ".gsd":
            msg = f"a recording is a .gsd file; name it {self.output}.gsd instead of {self.output}"
            raise InputError(msg)
        for path in (self.events, self.output):
            if path is not None and path.exists() and not self.force:
                resume = f", or --resume {path} to go on with it" if path == self.output else ""
                msg = f"{path} is there already; give another name, --force to replace it{resume}"
                raise InputError(msg)
        if self.events is not None:
            sim.record_events(self.events, overwrite=self.force)
        if self.output is not None:
            every, checkpoint_every = self.every, self.checkpoint_every
            options = {"every": every, "checkpoint_every": checkpoint_every}
            sim.record(self.output, overwrite=self.force, **options)

    def kept(self, resumed: Path | None) -> dict[str, Any]:
        """What is in the file now, for ``--json``; nothing if none was asked for."""
        path = self.output if resumed is None else resumed
        kept: dict[str, Any] = {}
        if path is not None:
            with load(path) as run:
                size = path.stat().st_size
                kept["recording"] = {"path": str(path), "frames": len(run), "bytes": size}
        if self.events is not None:
            events, size = load_events(self.events), self.events.stat().st_size
            kept["events"] = {"path": str(self.events), "events": len(events), "bytes": size}
        return kept


def what_was_kept(kept: dict[str, Any]) -> str:
    """The same, for people."""
    lines = []
    for file in kept.values():
        what = "frames" if "frames" in file else "events"
        number, size = report.count(file[what]), size_text(file["bytes"])
        lines.append(f"Recorded in {file['path']}: {number} {what}, {size}.")
    return "\n".join(lines)


def resumed(path: Path, *, refuse: bool, ends: tuple[Any, ...]) -> tuple[Source, Simulation]:
    """Go on with a recording.

    Parameters
    ----------
    path : Path
    refuse : bool
        Whether something is given that only a new run can have.
    ends : tuple
        The goals, of which one must be given: a time, and counts.

    Raises
    ------
    InputError
        If it is not that simple, or the file is no recording.
    """
    if refuse:
        msg = (
            f"--resume goes on with the scene, the method and the file of {path}; leave a scene "
            "and its options, --method, --tick, --seed and -o away"
        )
        raise InputError(msg)
    if all(end is None for end in ends):
        msg = f"say how far {path} shall go on, with --until, --collisions or --events"
        raise InputError(msg)
    until = parsed("until", ends[0])
    with load(path) as run:
        if until is not None and until < run.end:
            msg = f"--until is {until:.9g}, but {path} ends at {run.end:.9g}; give a later time"
            raise InputError(msg)
    sim = Simulation.resume(path)
    scene = sim.scene or Scene(Spheres.of(np.zeros((0, 3))))
    return Source(str(path), {}, scene), sim
