"""``carom run``: a progress bar while it runs, a table when it is done."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from rich.console import Group
from rich.text import Text

import carom
from carom.cli import report
from carom.cli.source import Source
from carom.errors import InputError
from carom.observe import Observable
from carom.simulation import Simulation

#: Without a goal a scene runs for what passes in these seconds at speed 1.
DEFAULT_SECONDS = 10


@dataclass(frozen=True)
class Goal:
    """How far to run: one argument of `Simulation.run`."""

    name: str
    value: float
    given: bool = True

    @property
    def text(self) -> str:
        """What the table says about it."""
        if self.given:
            write = report.decimal if self.name == "until" else report.count
            return f"--{self.name} {write(self.value)}"
        return f"{DEFAULT_SECONDS} s at its pace (default)"


def goal(pace: float, **options: float | None) -> Goal:
    """Pick the one goal given, or a default.

    Raises
    ------
    InputError
        If there is more than one.
    """
    given = {name: value for name, value in options.items() if value is not None}
    if len(given) > 1:
        msg = f"give only one of {', '.join('--' + name for name in given)}: a run has one end"
        raise InputError(msg)
    for name, value in given.items():
        if value < 0:
            msg = f"--{name} is {value:g}; it must be at least 0"
            raise InputError(msg)
        return Goal(name, value)
    return Goal("until", DEFAULT_SECONDS * pace, given=False)


@dataclass(frozen=True)
class Outcome:
    """How a run went.

    Attributes
    ----------
    seconds : float
        That it took.
    complete : bool
        Whether Ctrl-C did not cut it short.
    before : int
        Collisions that an earlier run had counted.
    """

    seconds: float
    complete: bool
    before: int


def execute(
    sim: Simulation, aim: Goal, *, quiet: bool, label: str, observe: Sequence[Observable] = ()
) -> Outcome:
    """Run with a progress bar on standard error, if somebody looks at it."""
    with report.bar(quiet=quiet) as progress:
        task = progress.add_task(label, total=aim.value, note="")
        begin = time.perf_counter()
        before = sim.collisions
        start = 0.0 if aim.name == "until" else _done(sim, aim.name)

        def show(now: Simulation) -> None:
            speed = (now.collisions - before) / max(time.perf_counter() - begin, 1e-9)
            hits = f"{report.count(now.collisions)} collisions, {report.rate(speed)}/s"
            progress.update(task, completed=_done(now, aim.name) - start, note=hits)

        try:
            sim.run(duration=0)  # builds the engine, so that the clock measures collisions only
            begin = time.perf_counter()
            sim.run(**{aim.name: aim.value}, progress=show, observe=observe)
        except KeyboardInterrupt:
            return Outcome(time.perf_counter() - begin, False, before)
        return Outcome(time.perf_counter() - begin, True, before)


def _done(sim: Simulation, name: str) -> float:
    done: dict[str, Callable[[], float]] = {
        "until": lambda: sim.time,
        "collisions": lambda: sim.collisions,
        "events": lambda: sim.collisions + sim.wall_collisions,
    }
    return done[name]()


def as_data(sim: Simulation, source: Source, outcome: Outcome) -> dict[str, Any]:
    """Everything about a run, for ``--json``."""
    return {
        **report.numbers(sim, outcome.seconds, outcome.before),
        "seconds": outcome.seconds,
        "complete": outcome.complete,
        "scene": source.name,
        "options": source.options,
        "seed": source.scene.seed,
        "method": sim.method,
        "tick": sim.tick if sim.method == "tick" else None,
        "version": carom.__version__,
    }


def summary(sim: Simulation, source: Source, aim: Goal, outcome: Outcome) -> Group:
    """The table at the end of a run, and a line on what it means."""
    found = report.numbers(sim, outcome.seconds, outcome.before)
    method = f"ticks of {report.decimal(sim.tick)}" if sim.method == "tick" else str(sim.method)
    facts = [f"{report.count(len(sim))} spheres", method]
    if source.scene.seed is not None:
        facts.append(f"seed {source.scene.seed}")
    sheet = report.table(report.heading(source.scene.title or source.name, *facts), "", "", "")
    sheet.show_header = False
    sheet.columns[1].style, sheet.columns[1].no_wrap = "bold", True
    sheet.columns[2].justify, sheet.columns[2].style = "left", "dim"
    sheet.add_row("simulated time", report.decimal(sim.time), aim.text)
    walls = f"and {report.count(sim.wall_collisions)} with walls" if sim.wall_collisions else ""
    sheet.add_row("collisions", report.count(sim.collisions), walls)
    rate = report.rate(found["collisions_per_second"])
    sheet.add_row("collisions per second", rate, f"in {report.seconds(outcome.seconds)}")
    sheet.add_row("energy drift", report.error(sim.energy_drift), _drift_note(sim))
    sheet.add_row("momentum", report.vector(sim.momentum), "")
    sheet.add_row("deepest overlap", report.error(sim.max_overlap), "of the contact distance")
    if outcome.complete:
        return Group(sheet)
    stopped = Text("Stopped by Ctrl-C; the numbers are those of this moment.", style="yellow")
    return Group(sheet, stopped)


def _drift_note(sim: Simulation) -> str:
    if sim.dissipated:
        return f"the rules took {report.decimal(sim.dissipated)}"
    return "rounding only" if abs(sim.energy_drift) < 1e-12 else ""
