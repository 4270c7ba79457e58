"""``carom bench --observables``: how much slower each observable makes a run."""

from collections.abc import Mapping
from fnmatch import fnmatchcase
from typing import Any

from rich.text import Text

from carom.bench import observing, results
from carom.checks import nearest
from carom.cli import report
from carom.cli.bench_files import where
from carom.errors import InputError, UnknownNameError
from carom.observe import OBSERVABLES

FILE = "observables.json"


def bench(
    only: str | None,
    repetitions: int,
    output: str | None,
    others: Mapping[str, object],
    *,
    as_json: bool,
    quiet: bool,
) -> None:
    """Measure and print; `others` are the options that have no meaning here.

    Raises
    ------
    InputError
        If one of those is given.
    """
    for option, value in others.items():
        if value not in (None, False):
            msg = f"give either --observables or {option}: the fluid of observables is always one"
            raise InputError(msg)
    names = named(only)
    path = where(output, FILE, chosen=only is not None)
    with report.progress("bench", quiet=quiet or as_json) as tell:
        found = observing.result(observing.measured(names, repetitions, tell))
    if path:
        results.write(path, found)
    if as_json:
        report.write_json(found)
        return
    report.output().print(sheet(found))
    if not quiet:
        kept = f"Written to {path}." if path else "Nothing is written; keep it with -o FILE.json."
        report.output().print(kept)


def named(only: str | None) -> list[str]:
    """The observables whose names match; all if nothing is asked for.

    Raises
    ------
    UnknownNameError
        If a name matches nothing.
    """
    if only is None:
        return list(OBSERVABLES)
    found: dict[str, None] = {}
    for pattern in only.split(","):
        some = [name for name in OBSERVABLES if fnmatchcase(name, pattern)]
        if not some:
            msg = f"there is no observable {pattern!r}{nearest(pattern, OBSERVABLES)}"
            raise UnknownNameError(msg)
        found.update(dict.fromkeys(some))
    return list(found)


def sheet(found: dict[str, Any]) -> Any:
    """The costs; red above the bound."""
    bound = found["bound"]
    title = report.heading(
        "What measuring costs",
        f"N {report.count(found['n'])}, φ {found['packing_fraction']:g}",
        f"bound {100 * bound:.0f} %",
    )
    table = report.table(title, "", "slower by", "repetitions", "samples")
    for row in found["rows"]:
        low, high = (100 * (each(row["ratios"]) - 1) for each in (min, max))
        style = "bold red" if row["over"] else "green"
        mark = " over" if row["over"] else ""
        table.add_row(
            row["name"],
            Text(f"{100 * row['slower']:.0f} %{mark}", style=style),
            f"{low:.0f} – {high:.0f} %",
            report.count(row["samples"]),
        )
    return table
