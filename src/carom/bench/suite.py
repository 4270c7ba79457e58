"""Cases measured in turn."""

import statistics
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from typing import Any

from carom.bench import machine
from carom.bench.cases import Case
from carom.bench.worker import Worker

#: Share of the machine's memory that cases may take together.
SHARE = 0.5
#: Told of each step: what is done, the case, its share of the whole (they add up to 1).
Progress = Callable[[str, str, float], None]


def fitting(cases: list[Case]) -> tuple[list[Case], list[Case]]:
    """Those this machine has the memory for, and those it has not."""
    most = machine.memory() or 2**63
    return (
        [case for case in cases if case.memory <= most],
        [case for case in cases if case.memory > most],
    )


def groups(cases: list[Case]) -> Iterator[list[Case]]:
    """Split cases into runs of neighbours that fit into the memory side by side."""
    most = SHARE * (machine.memory() or 2**63)
    group: list[Case] = []
    for case in cases:
        if group and sum(each.memory for each in [*group, case]) > most:
            yield group
            group = []
        group.append(case)
    if group:
        yield group


def measured(
    cases: list[Case], repetitions: int, *, profile: bool, progress: Progress
) -> list[dict[str, Any]]:
    """Measure all cases, those of a group turn by turn.

    Parameters
    ----------
    cases : list of Case
    repetitions : int
        How often each is timed.
    profile : bool
        Whether to find out where the time goes besides.
    progress : callable

    Returns
    -------
    list of dict
        One row for each, in the same order; see `carom.bench.results`.

    Raises
    ------
    RunError
        If a process has come to an end.
    """
    rows = []
    whole = sum(_work(case, repetitions, profile) for case in cases)
    for group in groups(cases):
        with ExitStack() as stack:
            workers = []
            for case in group:  # one after the other: nothing runs beside what is timed
                worker = stack.enter_context(Worker(case.name))
                worker.ask("ready")
                workers.append((case, worker))
                progress("warmed up", case.name, case.warm_up / whole)
            for k in range(repetitions):
                for case, worker in workers:
                    worker.ask("measure")
                    text = f"timed {k + 1} of {repetitions}"
                    progress(text, case.name, _each(case) / whole)
            for case, worker in workers:
                row = worker.ask("row")
                if profile:
                    row["profile"] = worker.ask("profile")
                    progress("profiled", case.name, _each(case) / whole)
                rows.append(row)
    return with_bounds(cases, rows)


def _each(case: Case) -> int:
    """About how many collisions a repetition is."""
    return case.collisions or 10 * case.n


def _work(case: Case, repetitions: int, profile: bool) -> int:
    return case.warm_up + (repetitions + profile) * _each(case)


def with_bounds(cases: list[Case], rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows with the median and best of their repetitions, and what is held against bounds.

    Ratios are of the best repetitions: those that the machine's other work disturbed least.
    """
    best = {row["name"]: min(row["nanoseconds"]) for row in rows}
    for case, row in zip(cases, rows, strict=True):
        row["median_nanoseconds"] = round(statistics.median(row["nanoseconds"]), 2)
        row["best_nanoseconds"] = best[case.name]
        if case.uniform in best:
            row["uniform"], row["bound"] = case.uniform, case.bound
            row["ratio"] = round(best[case.name] / best[case.uniform], 3)
            row["why"] = case.why
        if case.most_memory < float("inf"):
            row["most_bytes"] = case.most_memory
    return rows


def broken(rows: list[dict[str, Any]]) -> list[str]:
    """A sentence for each answer of a row that is wrong, and each bound that it breaks."""
    said = [row["wrong"] for row in rows if row.get("wrong")]
    for row in rows:
        if row.get("ratio", 0.0) > row.get("bound", 0.0):
            said.append(
                f"{row['name']} costs {row['ratio']:.2f} times what {row['uniform']} costs; "
                f"its bound is {row['bound']:g}"
            )
        if (row["peak_bytes"] or 0) > row.get("most_bytes", float("inf")):
            said.append(
                f"{row['name']} takes {row['peak_bytes'] / 1e9:.2f} GB; "
                f"its bound is {row['most_bytes'] / 1e9:g} GB"
            )
    return said
