"""``carom compare``: exact motion and the paper's ticks, side by side."""

from typing import Any

from rich.console import Group
from rich.text import Text

import carom
from carom.cli import report
from carom.cli.running import Goal, execute
from carom.cli.source import Source


def compare(source: Source, aim: Goal, tick: float | None, *, quiet: bool) -> dict[str, Any]:
    """Run a scene both ways from the same start.

    Returns
    -------
    dict
        With entries ``exact`` and ``tick``, each of `carom.cli.report.numbers` and
        ``missed``: collisions that exact flight from the run's own state has within each
        tick and that the tick did not register.

    Raises
    ------
    KeyboardInterrupt
        At Ctrl-C: half a comparison says nothing.
    """
    exact = source.simulation("exact")
    ticking = exact.in_ticks(tick)
    data: dict[str, Any] = {
        "scene": source.name,
        "options": source.options,
        "seed": source.scene.seed,
        "version": carom.__version__,
        "tick_length": ticking.tick,
        "n": len(source.scene.spheres),
        "until": aim.value,
    }
    for name, sim in {"exact": exact, "tick": ticking}.items():
        outcome = execute(sim, aim, quiet=quiet, label=name)
        if not outcome.complete:
            raise KeyboardInterrupt
        data[name] = {**report.numbers(sim, outcome.seconds), "missed": sim.missed}
    return data


def side_by_side(source: Source, data: dict[str, Any]) -> Group:
    """The two runs as a table, and what to see in it."""
    exact, tick = data["exact"], data["tick"]
    length = report.decimal(data["tick_length"])
    title = report.heading(source.scene.title or source.name, f"{report.count(data['n'])} spheres")
    sheet = report.table(title, "", "exact", f"ticks of {length}")
    lines = [
        ("simulated time", "time", report.decimal),
        ("collisions", "collisions", report.count),
        ("collisions missed", "missed", report.count),
        ("energy drift", "energy_drift", report.error),
        ("deepest overlap", "max_overlap", report.error),
    ]
    for label, key, write in lines:
        cells = [Text(write(run[key]), style=_judged(key, run[key])) for run in (exact, tick)]
        sheet.add_row(label, *cells)
    return Group(sheet, Text(_moral(exact, tick)))


def _judged(key: str, value: float) -> str:
    """Green for what is right but for rounding, yellow for what is not."""
    if key not in ("missed", "energy_drift", "max_overlap"):
        return ""
    return "green" if abs(value) < 1e-9 else "yellow"


def _moral(exact: dict[str, Any], tick: dict[str, Any]) -> str:
    met = tick["missed"] + tick["collisions"]
    if met == 0:
        return "Nothing collided in this time; run longer with --until."
    share = 100 * tick["missed"] / met
    deep = 100 * tick["max_overlap"]
    return (
        f"Looking once per tick, the paper's method missed {report.count(tick['missed'])} of "
        f"{report.count(met)} collisions ({share:.0f} %) and let spheres sink into one another "
        f"by up to {deep:.0f} % of the distance at which they touch. Exact motion solves for "
        f"every contact: it misses none, and the deepest overlap is rounding "
        f"({report.error(exact['max_overlap'])})."
    )
