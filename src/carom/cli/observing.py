"""``--observe``: which observables, and how their results look."""

from collections.abc import Sequence

import typer
from rich.console import Group, RenderableType
from rich.table import Table as Grid
from rich.text import Text

from carom.checks import nearest
from carom.cli import report
from carom.errors import InputError, UnknownNameError
from carom.observe import OBSERVABLES, Observable, Table

MOST_ROWS = 40  #: of a table on a terminal; --json has all


def observables(names: str | None, what: str = "--observe") -> dict[str, Observable]:
    """Make the observables that a list of names asks for; `what` takes such lists.

    For ``list`` all names are printed, and the program ends.

    Raises
    ------
    UnknownNameError
        If there is no such name; the message has all of them, or the nearest.
    InputError
        If a name comes twice.
    """
    found: dict[str, Observable] = {}
    if names is not None and names.strip().lower() == "list":
        report.output().print(catalogue())
        raise typer.Exit
    for name in [] if names is None else names.split(","):
        plain = name.strip().lower().replace("_", "-")
        if plain not in OBSERVABLES:
            known = f"{what} takes names with commas between them: {', '.join(OBSERVABLES)}"
            if not plain:
                raise UnknownNameError(known)
            close = nearest(plain, OBSERVABLES)
            hint = close if close.startswith("; did") else f"; {known}"
            msg = f"there is no observable {plain!r}{hint}"
            raise UnknownNameError(msg)
        if plain in found:
            msg = f"{what} names {plain} twice; once is enough"
            raise InputError(msg)
        found[plain] = OBSERVABLES[plain]()
    return found


def catalogue() -> RenderableType:
    """Each observable, and what it is in a sentence."""
    lines = Grid.grid("", "", padding=(0, 2))
    lines.columns[0].style = report.ACCENT
    for name, observable in OBSERVABLES.items():
        lines.add_row(name, Text((observable.__doc__ or "").partition("\n")[0]))
    return lines


def tables(observed: dict[str, Observable]) -> dict[str, Table | str]:
    """Results by name; a sentence where there was too little to measure."""
    results: dict[str, Table | str] = {}
    for name, observable in observed.items():
        try:
            results[name] = observable.table()
        except InputError as error:
            results[name] = str(error)
    return results


def as_data(results: dict[str, Table | str]) -> dict[str, object]:
    """The same for ``--json``."""
    return {
        name: {"error": found} if isinstance(found, str) else found.as_data()
        for name, found in results.items()
    }


def sheets(results: dict[str, Table | str]) -> Sequence[RenderableType]:
    """The same for people; single numbers stand together."""
    parts: list[RenderableType] = []
    single = report.table(Text("Measured", style="bold"), "", "value", "theory", "independent")
    notes: list[str] = []
    for name, found in results.items():
        if isinstance(found, str):
            notes.append(f"{name} · {found}")
        elif "quantity" in found.columns and len(found) == 1:
            many = found["n_independent"][0]
            theory = found["value_theory"][0]
            single.add_row(
                name,
                str(found.estimate("value", 0)),
                "" if theory != theory else report.decimal(theory),
                "" if many != many else report.count(many),
            )
            notes += [f"{name} · {note}" for note in found.footnotes()]
        else:
            parts.append(_sheet(found))
            notes += [f"{name} · {note}" for note in [*found.footnotes(), *_shortened(found)]]
    if single.row_count:
        parts.insert(0, single)
    return [*parts, *(Text(note, style="dim") for note in notes)]


def _sheet(found: Table) -> RenderableType:
    sheet = report.table(None, *found.heading())
    for row in found.rows()[:: _step(found)]:
        sheet.add_row(*row)
    # Above a table of few columns a title of its own would be broken into lines.
    return Group(Text(found.title, style="bold"), sheet)


def _step(found: Table) -> int:
    return -(-len(found) // MOST_ROWS)


def _shortened(found: Table) -> list[str]:
    """What to say where not all rows are shown."""
    if _step(found) < 2:
        return []
    return [f"1 row in {_step(found)} of {len(found)} is shown; --json has all"]
