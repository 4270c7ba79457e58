"""``carom info``, ``check`` and ``convert``: what is in a recording, and what becomes of it."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.table import Table

from carom.cli import report
from carom.errors import InputError
from carom.record import Recording, layout, load
from carom.record.check import Verdict
from carom.record.check import check as checked
from carom.record.convert import convert as converted
from carom.record.recorder import FILM_FRAMES

DAMAGED = 1  #: exit status
UNITS = ("bytes", "kB", "MB", "GB", "TB")

RecordingName = Annotated[Path, typer.Argument(metavar="RUN.gsd", help="A recording.")]
Json = Annotated[
    bool, typer.Option("--json", metavar="", help="Write one JSON object instead of a table.")
]
Quiet = Annotated[
    bool, typer.Option("--quiet", metavar="", help="No progress bar, nothing but the result.")
]
Force = Annotated[
    bool, typer.Option("--force", metavar="", help="Replace a file that is there already.")
]


def info(recording: RecordingName, json: Json = False, quiet: Quiet = False) -> None:
    """Say what is in a recording: spheres, times, collisions, seed, who wrote it."""
    with load(recording) as run:
        facts = described(run)
    if json:
        report.write_json(facts)
    else:
        report.output().print(_table(facts))


def described(run: Recording) -> dict[str, Any]:
    """What a recording is, for ``--json`` and the table."""
    last, heads = run[-1], run.heads
    checkpoints = [h["time"] for k, h in enumerate(heads) if run.file.has(k, layout.CHECKPOINT)]
    size = run.path.stat().st_size
    return {
        "n": len(last),
        "frames": len(run),
        "start": run.start,
        "end": run.end,
        "collisions": last.collisions,
        "wall_collisions": last.wall_collisions,
        "energy_drift": last.energy_drift,
        "max_overlap": last.max_overlap,
        "changes": heads[-1]["segment"],
        "checkpoints": len(checkpoints),
        "last_checkpoint": checkpoints[-1],
        "bytes": size,
        "thin": False,  # in recordings that do not say
        **run.manifest,
    }


def _table(facts: dict[str, Any]) -> Table:
    command = " ".join(map(str, facts["command"]))
    seed = [] if facts["seed"] is None else [f"seed {facts['seed']}"]
    title = report.heading(facts["title"] or facts["scene"] or "Recording", *seed)
    sheet = report.table(title, "", "", "")
    sheet.show_header = False
    sheet.columns[1].style, sheet.columns[1].overflow = "bold", "fold"
    sheet.columns[2].justify, sheet.columns[2].style = "left", "dim"
    sheet.add_row("spheres", report.count(facts["n"]), "")
    step = f"one every {report.decimal(facts['every'])}"
    if facts["thin"] and facts["frames"] > FILM_FRAMES:
        step += " or more"
    sheet.add_row("frames", report.count(facts["frames"]), step)
    times = f"{report.decimal(facts['start'])} to {report.decimal(facts['end'])}"
    sheet.add_row("simulated time", times, _changes(facts["changes"]))
    walls = facts["wall_collisions"]
    note = f"and {report.count(walls)} with walls" if walls else ""
    sheet.add_row("collisions", report.count(facts["collisions"]), note)
    sheet.add_row("energy drift", report.error(facts["energy_drift"]), "")
    checkpoint = f"the last at {report.decimal(facts['last_checkpoint'])}"
    sheet.add_row("checkpoints", report.count(facts["checkpoints"]), checkpoint)
    each = size_text(facts["bytes"] / facts["frames"])
    sheet.add_row("size", size_text(facts["bytes"]), f"{each} a frame")
    sheet.add_row("written by", f"carom {facts['carom']}", facts["platform"])
    sheet.add_row("started", facts["started"], command)
    return sheet


def _changes(number: int) -> str:
    if number == 0:
        return ""
    return "changed once on the way" if number == 1 else f"changed {number} times on the way"


def size_text(size: float) -> str:
    """A number of bytes in units people read."""
    unit = 0
    while size >= 1000 and unit < len(UNITS) - 1:
        size, unit = size / 1000, unit + 1
    return f"{size:.3g} {UNITS[unit]}"


def check(recording: RecordingName, json: Json = False, quiet: Quiet = False) -> None:
    """Compare a recording with its checksums, then run it again and compare all bits."""
    with _progress("check", quiet=quiet or json) as progress:
        verdict = checked(recording, progress)
    if json:
        report.write_json({**vars(verdict), "good": verdict.good})
    elif verdict.frames or verdict.good:
        report.output().print(_sentence(verdict), soft_wrap=True)
    for sentence in [] if json else [*verdict.damage, *verdict.differences]:
        report.complain(sentence)
    if not verdict.good:
        raise typer.Exit(DAMAGED)


def _sentence(verdict: Verdict) -> str:
    looked = f"{report.count(verdict.frames)} frames"
    if verdict.damage:
        return f"{looked}: {report.count(len(verdict.damage))} damaged"
    looked += f" and {report.count(verdict.events)} events"
    if verdict.differences:
        return f"{looked} are as they were written, but run again they come out differently"
    return f"{looked} are as they were written, and run again they come out the same to the bit"


def convert(
    recording: RecordingName,
    target: Annotated[
        Path,
        typer.Argument(
            metavar="FILE",
            help="run.xyz (extended XYZ), run.h5 (H5MD); events.parquet, events.npz (its events).",
        ),
    ],
    force: Force = False,
    json: Json = False,
    quiet: Quiet = False,
) -> None:
    """Write a recording in a format that other programs read."""
    if target.exists() and not force:
        msg = f"{target} is there already; give another name, or --force to replace it"
        raise InputError(msg)
    with load(recording) as run, _progress("convert", quiet=quiet or json) as progress:
        many, what = converted(run, target, progress)
    size = target.stat().st_size
    if json:
        report.write_json({"path": str(target), what: many, "bytes": size})
    elif not quiet:
        line = f"{report.count(many)} {what}, {size_text(size)}, in {target}"
        report.output().print(line, soft_wrap=True)


@contextmanager
def _progress(label: str, *, quiet: bool) -> Iterator[Callable[[int, int], None]]:
    """A progress bar on standard error, if somebody looks at it."""
    with report.bar(quiet=quiet) as bar:
        task = bar.add_task(label, note="")
        yield lambda done, total: bar.update(task, completed=done, total=total)
