"""``carom validate``: known answers, held against what this machine computes."""

from pathlib import Path
from typing import Annotated, Any

import typer
from rich.text import Text

from carom.cli import report
from carom.errors import FileError, RunError
from carom.validate import catalogue, figures, results, suite
from carom.validate.catalogue import FAMILIES
from carom.validate.row import Check

FAILED, INTERRUPTED = 1, 130


def validate(
    quick: Annotated[
        bool,
        typer.Option("--quick", metavar="", help="Shorter runs: about a minute, not four."),
    ] = False,
    only: Annotated[
        str | None,
        typer.Option(metavar="NAME,...", help="These families or checks; * stands for anything."),
    ] = None,
    output: Annotated[
        str | None,
        typer.Option(
            "-o",
            metavar="DIR",
            help="Keep the report there, as Markdown, JSON and pictures; what an earlier one has "
            "besides stays.",
        ),
    ] = None,
    json: Annotated[
        bool, typer.Option("--json", metavar="", help="Write the report as JSON, not as a table.")
    ] = False,
    quiet: Annotated[
        bool, typer.Option("--quiet", metavar="", help="No progress bar, nothing but the result.")
    ] = False,
) -> None:
    """Hold carom against exact answers, literature, other programs and theory.

    Each number has its error, and may be 4 standard errors off. Ctrl-C keeps what is done.
    """
    mode = suite.QUICK if quick else suite.FULL
    checks = catalogue.chosen(only)
    folder, before = _folder(output)
    done, interrupted = _run(checks, mode, folder, before, quiet=quiet or json)
    now = results.report(done)
    if json:
        report.write_json(now)
    elif done:
        _print(now, mode)
    if folder and done:
        _draw(folder, results.report(done, before), {check["family"] for check in done}, quiet)
    if interrupted:
        report.complain(f"stopped after {len(done)} of {len(checks)} checks; what is done is kept")
        raise typer.Exit(INTERRUPTED)
    if results.red(now):
        raise typer.Exit(FAILED)


def _folder(output: str | None) -> tuple[Path | None, dict[str, Any] | None]:
    """Where the report goes, and what is there; that it cannot go there is said at once."""
    if output is None:
        return None, None
    folder = Path(output)
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        msg = f"cannot make the folder {folder}: {error.strerror}; choose another with -o"
        raise FileError(msg) from error
    file = folder / results.FILE
    return folder, results.read(file) if file.exists() else None


def _run(
    checks: list[Check],
    mode: str,
    folder: Path | None,
    before: dict[str, Any] | None,
    *,
    quiet: bool,
) -> tuple[list[dict[str, Any]], bool]:
    """Work through all checks, with a bar on standard error if somebody looks at it."""
    done: list[dict[str, Any]] = []
    costs = {check.name: suite.seconds(check, mode) for check in checks}
    with report.bar(quiet=quiet) as bar:
        task = bar.add_task("validate", total=sum(costs.values()), note="")
        try:
            for check in suite.results(checks, mode):
                done.append(check)
                if folder:
                    results.write(folder, results.report(done, before))
                bar.update(task, advance=costs[check["check"]], note=check["check"])
        except KeyboardInterrupt:
            return done, True
    return done, False


def _print(data: dict[str, Any], mode: str) -> None:
    title = report.heading("carom validate", mode, "± and (…): one standard error")
    sheet = report.table(title, "", "measured", "reference", "off", "")
    for family, checks in results.by_family(data).items():
        sheet.add_section()
        sheet.add_row(Text(FAMILIES[family], style=report.ACCENT))
        state = ""
        for check in checks:
            if check["failure"]:
                report.complain(f"{check['check']}: {check['failure']}")
                sheet.add_row(check["check"], "", "", "", Text("RED", style="bold red"))
            for row in check["rows"]:
                if row["state"] != state:
                    state = row["state"]
                    sheet.add_row(Text(f" {_of(row)}", style="dim"))
                sheet.add_row(
                    f"  {row['quantity']}",
                    results.measured(row),
                    results.reference(row),
                    results.deviation(row),
                    _verdict(row),
                )
    report.output().print(sheet)
    found, red = results.rows(data), results.red(data)
    say = report.output().print
    if red:
        say(Text(f"{len(red)} of {len(found)} rows are red: {', '.join(red)}.", style="bold red"))
    else:
        say(Text(f"All {len(found)} rows are as they should be.", style="green"))


def _of(row: dict[str, Any]) -> str:
    """What was measured, and from how much."""
    many = row["collisions"]
    size = f"N = {row['n']}" if row["n"] > 2 else ""
    from_ = (f"{many:.1e}".replace("e+0", "e") if many >= 1e4 else f"{many}") + " collisions"
    return ", ".join(filter(None, [row["state"], size, from_ if many else ""]))


def _verdict(row: dict[str, Any]) -> Text:
    return Text(results.verdict(row), style="green" if row["passed"] else "bold red")


def _draw(folder: Path, data: dict[str, Any], families: set[str], quiet: bool) -> None:
    try:
        figures.draw(folder, data, families)
    except FileError:
        raise
    except RunError as error:  # the numbers are there, and pictures are an extra
        report.complain(str(error))
    if not quiet:
        report.output().print(f"Written to {folder}.")
