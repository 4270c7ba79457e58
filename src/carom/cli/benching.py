"""``carom bench``: how fast it is on this machine, and that the answers are right."""

from fnmatch import fnmatchcase
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.text import Text

from carom.bench import cases, results, suite
from carom.bench.cases import Case
from carom.checks import nearest, number
from carom.cli import bench_observables, report
from carom.cli.bench_files import where
from carom.cli.source import parsed, whole
from carom.errors import InputError, UnknownNameError

FAILED = 1
FULL_FILE, QUICK_FILE = "speed.json", "quick.json"

Strings = str | None


def bench(
    full: Annotated[
        bool,
        typer.Option(
            "--full", metavar="", help="All: up to 10 million spheres, and what could be slow."
        ),
    ] = False,
    only: Annotated[
        Strings,
        typer.Option(metavar="NAME,...", help="These of all; * stands for anything."),
    ] = None,
    n: Annotated[
        Strings,
        typer.Option("--n", "-n", metavar="N,...", help="Numbers of spheres of the fluids."),
    ] = None,
    phi: Annotated[
        Strings, typer.Option(metavar="PHI,...", help="Packing fractions of the fluids.")
    ] = None,
    observables: Annotated[
        bool,
        typer.Option(
            "--observables", metavar="", help="What measuring costs: each that --observe knows."
        ),
    ] = False,
    repetitions: Annotated[
        str, typer.Option(metavar="COUNT", help="How often each is timed.")
    ] = "5",
    profile: Annotated[
        bool, typer.Option("--profile", metavar="", help="Say where the time goes, too.")
    ] = False,
    compare: Annotated[
        Strings, typer.Option(metavar="FILE", help="An earlier result to hold this one against.")
    ] = None,
    output: Annotated[
        Strings,
        typer.Option(
            "-o",
            metavar="FILE.json",
            help="Where to keep the result. In a checkout of carom it is benchmarks/results "
            "unless you choose cases.",
        ),
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", metavar="", help="Write the result as JSON, not as tables.")
    ] = False,
    quiet: Annotated[
        bool, typer.Option("--quiet", metavar="", help="No progress bar, nothing but the result.")
    ] = False,
) -> None:
    """Measure collisions per second on this machine, and assert the answers.

    Without options: uniform fluids of 4 000 and 32 000 spheres at packing fractions 0.05, 0.25
    and 0.49.
    """
    times = int(number("--repetitions", whole("repetitions", repetitions), at_least=1))
    if observables:
        others = {
            "--full": full,
            "--n": n,
            "--phi": phi,
            "--profile": profile,
            "--compare": compare,
        }
        bench_observables.bench(only, times, output, others, as_json=json, quiet=quiet)
        return
    chosen = choice(full, only, n, phi)
    before = results.read(Path(compare)) if compare else None
    if before:
        _assert_shared(chosen, before, str(compare))
    chosen_some = any(option is not None for option in (only, n, phi))
    path = where(output, FULL_FILE if full else QUICK_FILE, chosen=chosen_some)
    fit, large = suite.fitting(chosen)
    rows = _run(fit, times, profile=profile, quiet=quiet or json)
    found = results.result(rows, [case.name for case in large])
    if path:
        results.write(path, found)
    if json:
        report.write_json({**found, **({"compared": _as_data(found, before)} if before else {})})
    else:
        _print(found, before, profile)
        if not quiet:
            _print_notes(found, path)
    broken = suite.broken(rows)
    for sentence in broken:
        report.complain(sentence)
    if broken:
        raise typer.Exit(FAILED)


def choice(full: bool, only: Strings, n: Strings, phi: Strings) -> list[Case]:
    """The cases that the options name.

    Raises
    ------
    InputError
        If options contradict one another, a number cannot be used, or a name matches nothing.
    """
    if n is not None or phi is not None:
        if full:
            msg = "give either --full or --n and --phi: they choose different fluids"
            raise InputError(msg)
        sizes = tuple(_wholes("n", n)) if n is not None else cases.QUICK_SIZES
        phis = tuple(_numbers("phi", phi)) if phi is not None else cases.PHIS
        found = cases.grid(sizes, phis)
    else:
        found = cases.full() if full or only else cases.quick()
    return cases.with_uniform(_named(found, only) if only else found)


def _wholes(name: str, text: str) -> list[int]:
    return [value for part in text.split(",") if (value := whole(name, part)) is not None]


def _numbers(name: str, text: str) -> list[float]:
    return [value for part in text.split(",") if (value := parsed(name, part)) is not None]


def _named(found: list[Case], patterns: str) -> list[Case]:
    matching = []
    for pattern in patterns.split(","):
        some = [case for case in found if fnmatchcase(case.name, pattern)]
        if not some:
            msg = f"there is no case {pattern!r}{nearest(pattern, [c.name for c in found])}"
            raise UnknownNameError(msg)
        matching += some
    return matching


def _assert_shared(chosen: list[Case], before: dict[str, Any], path: str) -> None:
    """Say it before a minute of work that there will be nothing to compare."""
    names = [row["name"] for row in before["rows"]]
    if not {case.name for case in chosen} & set(names):
        msg = (
            f"{path} has none of the cases to be run, but {', '.join(names)}; "
            "choose them with --only or with --n and --phi"
        )
        raise InputError(msg)


def _run(
    chosen: list[Case], repetitions: int, *, profile: bool, quiet: bool
) -> list[dict[str, Any]]:
    """Measure with a progress bar."""
    with report.progress("bench", quiet=quiet) as tell:
        return suite.measured(chosen, repetitions, profile=profile, progress=tell)


def _print(found: dict[str, Any], before: dict[str, Any] | None, profile: bool) -> None:
    rows = found["rows"]
    report.output().print(_speeds(found["machine"], rows))
    held = [row for row in rows if "bound" in row]
    if held:
        report.output().print(_bounds(held))
    if profile:
        report.output().print(_shares(rows), _work(rows))
    if before:
        _print_comparison(found, before)


def _row_names(row: dict[str, Any]) -> tuple[str, str, str]:
    phi = row["packing_fraction"]
    kind = "fluid" if row["name"].startswith("fluid-") else row["name"]
    return kind, report.count(row["n"]), "" if phi is None else f"{phi:g}"


def _speeds(machine: dict[str, Any], rows: list[dict[str, Any]]) -> Any:
    facts = [machine["cpu"], machine["simd"]]
    if machine["clock_ghz"]:
        facts.insert(1, f"{machine['clock_ghz']:g} GHz")
    columns = "N", "φ", "million/s", "best", "ns", "bytes"
    sheet = report.table(report.heading("carom bench", *facts), "", *columns)
    for row in rows:
        median, best = row["median_nanoseconds"], row["best_nanoseconds"]
        sheet.add_row(
            *_row_names(row),
            Text(f"{1e3 / median:.3f}", style="bold"),
            f"{1e3 / best:.3f}",
            f"{median:,.0f}",
            f"{row['engine_bytes'] / row['n']:,.0f}",
        )
    return sheet


def _bounds(rows: list[dict[str, Any]]) -> Any:
    title = report.heading("Cost per collision", "best repetitions")
    sheet = report.table(title, "", "N", "times", "bound", "uniform case")
    for row in rows:
        style = "green" if row["ratio"] <= row["bound"] else "bold red"
        ratio = Text(f"{row['ratio']:.2f}", style=style)
        kind, n, _ = _row_names(row)
        sheet.add_row(kind, n, ratio, f"{row['bound']:g}", row["uniform"])
    return sheet


def _shares(rows: list[dict[str, Any]]) -> Any:
    names = list(rows[0]["profile"]["shares"])
    sheet = report.table(report.heading("Where the time goes", "percent"), "", "N", "φ", *names)
    for row in rows:
        shares = row["profile"]["shares"]
        sheet.add_row(*_row_names(row), *(f"{100 * shares[name]:.0f}" for name in names))
    return sheet


def _work(rows: list[dict[str, Any]]) -> Any:
    names = list(rows[0]["profile"]["work"])
    sheet = report.table(report.heading("Work per collision"), "", "N", "φ", *names)
    for row in rows:
        work = row["profile"]["work"]
        sheet.add_row(*_row_names(row), *(f"{work[name]:.2f}" for name in names))
    return sheet


def _as_data(found: dict[str, Any], before: dict[str, Any]) -> dict[str, Any]:
    """The comparison for ``--json``."""
    compared = results.compare(found, before)
    return {
        "rows": [each._asdict() for each in compared],
        "median": results.geometric_mean([each.median for each in compared]),
        "best": results.geometric_mean([each.best for each in compared]),
        "differences": results.differences(found, before),
    }


def _print_comparison(found: dict[str, Any], before: dict[str, Any]) -> None:
    data = _as_data(found, before)
    old = f"{before['machine'].get('carom')} of {before.get('date')}"
    title = report.heading("Times as fast as before", f"carom {old}")
    sheet = report.table(title, "", "by medians", "by bests")
    for row in data["rows"]:
        sheet.add_row(row["name"], *(_ratio(row[key]) for key in ("median", "best")))
    sheet.add_section()
    sheet.add_row("geometric mean", *(_ratio(data[key]) for key in ("median", "best")))
    report.output().print(sheet)
    others = [row["name"] for row in data["rows"] if not row["same_answer"]]
    if others:
        report.complain(f"the answers differ in {', '.join(others)}: these are other computations")
    if data["differences"]:
        report.complain(f"the machines differ: {'; '.join(data['differences'])}")


def _ratio(value: float) -> Text:
    style = "green" if value > 1.05 else "red" if value < 0.95 else ""
    return Text(f"{value:.2f}", style=style)


def _print_notes(found: dict[str, Any], path: Path | None) -> None:
    say = report.output().print
    rates = [row["rate"] for row in found["rows"] if row["rate"]]
    if rates:
        worst = max(abs(rate["measured"] / rate["expected"] - 1) for rate in rates)
        say(
            f"Rates of collision agree with Enskog and Carnahan-Starling to {100 * worst:.2f} %; "
            "energy is kept, nothing overlaps."
        )
    if found["left_out"]:
        say(f"Left out, for want of memory: {', '.join(found['left_out'])}.")
    say(f"Written to {path}." if path else "Nothing is written; keep the result with -o FILE.json.")
