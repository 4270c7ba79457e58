"""``carom run -o`` and ``--resume``: a run that is recorded, and one that goes on."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from carom.cli import report
from carom.cli.recording import size_text
from carom.cli.source import Source
from carom.errors import InputError
from carom.record import load
from carom.scene import Scene, Spheres
from carom.simulation import Simulation

Output = Annotated[
    Path | None,
    typer.Option("-o", "--output", metavar="RUN.gsd", help="Record everything in this file."),
]
Every = Annotated[
    str | None,
    typer.Option(metavar="TIME", help="Between recorded frames; 1/30 of the pace if left out."),
]
CheckpointEvery = Annotated[
    str | None,
    typer.Option(metavar="TIME", help="Between checkpoints; ten frames if left out."),
]
Resume = Annotated[
    Path | None,
    typer.Option(metavar="RUN.gsd", help="Go on with a recording, in the same file."),
]


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

    def __post_init__(self) -> None:
        values = {"--every": self.every, "--checkpoint-every": self.checkpoint_every}
        given = [name for name, value in values.items() if value is not None]
        given += ["--force"] if self.force else []
        if given and self.output is None:
            msg = f"{given[0]} says how to record; name the file too, as in -o run.gsd"
            raise InputError(msg)

    @property
    def asked(self) -> bool:
        """Whether anything is to be recorded into a new file."""
        return self.output is not None

    def begin(self, sim: Simulation) -> None:
        """Let a simulation be recorded, if that is wanted."""
        if self.output is None:
            return
        if self.output.exists() and not self.force:
            msg = (
                f"{self.output} is there already; give another name, --force to replace it, or "
                f"--resume {self.output} to go on with it"
            )
            raise InputError(msg)
        sim.record(
            self.output,
            every=self.every,
            checkpoint_every=self.checkpoint_every,
            overwrite=self.force,
        )

    def kept(self, resumed: Path | None) -> dict[str, Any]:
        """What is in the file now, for ``--json``; nothing if none was asked for."""
        path = self.output if resumed is None else resumed
        if path is None:
            return {}
        with load(path) as run:
            size = path.stat().st_size
            return {"recording": {"path": str(path), "frames": len(run), "bytes": size}}


def what_was_kept(kept: dict[str, Any]) -> str:
    """The same, for people."""
    file = kept["recording"]
    frames, size = report.count(file["frames"]), size_text(file["bytes"])
    return f"Recorded in {file['path']}: {frames} frames, {size}."


def resumed(path: Path, *, refuse: bool, ends: tuple[Any, ...]) -> tuple[Source, Simulation]:
    """Go on with a recording.

    Parameters
    ----------
    path : Path
    refuse : bool
        Whether something is given that only a new run can have.
    ends : tuple
        The goals, of which one must be given.

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
    sim = Simulation.resume(path)
    scene = sim.scene or Scene(Spheres.of(np.zeros((0, 3))))
    return Source(str(path), {}, scene), sim
