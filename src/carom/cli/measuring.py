"""``carom measure``: observables on a run that is over."""

from pathlib import Path
from typing import Annotated, Any

import typer

import carom
from carom.cli import report
from carom.cli.observing import as_data, observables, sheets, tables
from carom.cli.source import parsed
from carom.errors import InputError
from carom.event_file import Events, load_events
from carom.event_file.source import ENDINGS
from carom.observe import Observable, Table
from carom.observe.table import FORMATS
from carom.record import Recording, load


def measure(
    file: Annotated[
        Path,
        typer.Argument(metavar="FILE", help="Events (.parquet, .npz) or a recording (.gsd)."),
    ],
    observable: Annotated[
        str, typer.Argument(metavar="A,B", help="What to measure: compressibility, msd ...")
    ],
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="OUT", help="Write it: .csv, .json or .npz."),
    ] = None,
    begin: Annotated[
        str | None,
        typer.Option("--from", metavar="TIME", help="Simulated time at which measuring begins."),
    ] = None,
    until: Annotated[
        str | None, typer.Option(metavar="TIME", help="Simulated time at which it ends.")
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", metavar="", help="Write one JSON object instead of a table.")
    ] = False,
    quiet: Annotated[
        bool, typer.Option("--quiet", metavar="", help="No progress bar, nothing but the result.")
    ] = False,
) -> None:
    """Measure in a run that is over, as if it had been observed.

    Several observables with -o go to files of their own: out-msd.csv, out-rdf.csv.
    """
    observed = observables(observable, "carom measure")
    targets = _targets(output, list(observed))
    start, end = parsed("from", begin), parsed("until", until)
    source: Events | Recording
    source = load_events(file) if file.suffix.lower() in ENDINGS else load(file)
    _measured(source, observed, start, end, quiet=quiet or json)
    results = tables(observed)
    written = _written(targets, results)
    first = next(iter(observed.values()))
    if json:
        report.write_json(
            {
                "file": str(file),
                "n": len(first.last()),
                "start": first.begun,
                "until": first.last().time,
                "version": carom.__version__,
                "written": [str(path) for path in written],
                "observed": as_data(results),
            }
        )
        return
    facts = f"{report.count(len(first.last()))} spheres"
    times = f"time {report.decimal(first.begun or 0.0)} to {report.decimal(first.last().time)}"
    report.output().print(report.heading(file.name, facts, times))
    for part in sheets(results):
        report.output().print(part)
    for path in written if not quiet else []:
        report.output().print(f"Written to {path}.", soft_wrap=True, markup=False)


def _targets(output: Path | None, names: list[str]) -> dict[str, Path]:
    """Files of the results; a name that cannot be is refused before anything runs."""
    if output is None:
        return {}
    if output.suffix not in FORMATS:
        msg = f"{output} is none of {', '.join(FORMATS)}; give its name one of these ends"
        raise InputError(msg)
    if len(names) == 1:
        return {names[0]: output}
    return {name: output.with_stem(f"{output.stem}-{name}") for name in names}


def _measured(
    source: Events | Recording,
    observed: dict[str, Observable],
    start: float | None,
    end: float | None,
    *,
    quiet: bool,
) -> None:
    """Measure, with a progress bar on standard error if somebody looks at it."""
    with report.bar(quiet=quiet) as progress:
        total = source.end if end is None else end
        task = progress.add_task(source.path.name, total=total, note="")
        carom.measure(
            source,
            list(observed.values()),
            start=start,
            until=end,
            progress=lambda now: progress.update(task, completed=now),
        )


def _written(targets: dict[str, Path], results: dict[str, Table | str]) -> list[Path]:
    """Write the tables; what was too little to measure has none."""
    written = []
    for name, path in targets.items():
        found: Any = results[name]
        if isinstance(found, Table):
            found.save(path)
            written.append(path)
    return written
