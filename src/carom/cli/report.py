"""How results look in a terminal."""

import json
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from rich.box import ROUNDED
from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn
from rich.table import Table
from rich.text import Text

from carom.simulation import Simulation

ACCENT = "bold cyan"


def output() -> Console:
    """Standard output, made anew so that it is where it is now."""
    return Console(highlight=False)


def notes() -> Console:
    """Standard error: progress and complaints, so that results can be piped."""
    return Console(stderr=True, highlight=False)


def complain(sentence: str) -> None:
    """One line on standard error, never folded: programs may read it."""
    line = Text("carom: ", style="bold red").append(sentence, style="default not bold")
    notes().print(line, soft_wrap=True)


def warn_of_network(address: str) -> None:
    """Say on standard error what it means that others can see a view, and their address of it."""
    line = Text("To let others watch: ").append(address, style="cyan underline")
    notes().print(line, soft_wrap=True)
    warning = (
        "Warning: everybody in this network who has the first address can control the "
        "simulation, and who has the second can watch it; nothing is encrypted. "
        "Use it among people you trust."
    )
    notes().print(warning, style="yellow", soft_wrap=True)


def write_json(data: Any) -> None:
    """Write one JSON document on standard output."""
    output().print(json.dumps(data, allow_nan=False), soft_wrap=True, markup=False)


def bar(*, quiet: bool) -> Progress:
    """A progress bar on standard error, if somebody looks at it; a task has a `note` beside it."""
    console = notes()
    return Progress(
        TextColumn("{task.description}", style="bold"),
        BarColumn(bar_width=None),
        TaskProgressColumn(),
        TextColumn("{task.fields[note]}", style="cyan"),
        TimeRemainingColumn(compact=True),
        console=console,
        transient=True,
        disable=quiet or not console.is_terminal,
    )


@contextmanager
def progress(what: str, *, quiet: bool) -> Iterator[Callable[[str, str, float], None]]:
    """A progress bar on standard error, if somebody looks at it.

    What it hands over is told of each step: what is done, whose, its share of the whole.
    """
    with bar(quiet=quiet) as shown:
        task = shown.add_task(what, total=1.0, note="")

        def tell(step: str, name: str, share: float) -> None:
            shown.update(task, advance=share, note=f"{name} {step}")

        yield tell


def table(title: Text | None, *columns: str) -> Table:
    """Make an empty table in the house's looks; the first column is text, the others numbers."""
    sheet = Table(
        title=title,
        title_justify="left",
        box=ROUNDED,
        border_style="dim",
        header_style=ACCENT,
        show_header=any(columns),
        padding=(0, 1),
    )
    for place, name in enumerate(columns):
        sheet.add_column(name, justify="right" if place else "left", overflow="fold")
    return sheet


def heading(title: str, *facts: str) -> Text:
    """A title, and facts about it in a quieter voice."""
    text = Text(title, style="bold")
    for fact in facts:
        text.append(" · ", style="dim not bold").append(fact, style="not bold")
    return text


def count(value: float) -> str:
    """A count, in groups of three."""
    return f"{round(value):,}"


def rate(value: float) -> str:
    """A count per second, in words where it is large."""
    if value >= 1e6:
        return f"{value / 1e6:.2f} million"
    return count(value)


def seconds(value: float) -> str:
    """A wall-clock time."""
    return f"{value:.2f} s" if value >= 0.1 else f"{1000 * value:.1f} ms"


def error(value: float) -> str:
    """A relative error: only its size matters."""
    if abs(value) >= 1e-3:
        return f"{100 * value:.1f} %"
    return "0" if value == 0 else f"{value:.1e}"


def decimal(value: float) -> str:
    """A measured number, with as many digits as one reads."""
    return f"{value:.6g}"


def vector(values: Any) -> str:
    """Three components."""
    return "(" + ", ".join(f"{x:.3g}" if abs(x) > 1e-4 else f"{x:.1g}" for x in values) + ")"


def numbers(sim: Simulation, seconds: float, before: int = 0) -> dict[str, Any]:
    """What every run reports, under the names of the JSON output.

    `before` are collisions that were there when the clock was started.
    """
    return {
        "time": sim.time,
        "collisions": sim.collisions,
        "wall_collisions": sim.wall_collisions,
        "collisions_per_second": (sim.collisions - before) / seconds if seconds > 0 else 0.0,
        "energy_drift": sim.energy_drift,
        "momentum": sim.momentum.tolist(),
        "max_overlap": sim.max_overlap,
        "n": len(sim),
    }
