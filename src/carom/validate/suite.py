"""Checks worked through by two processes; what is done is handed over at once."""

import multiprocessing
import os
import signal
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from typing import Any

from carom.errors import CaromError, RunError
from carom.validate import catalogue
from carom.validate.row import Check

PROCESSES = 2
QUICK, FULL = "quick", "full"


def work(check: Check, mode: str) -> dict[str, Any]:
    """Run one check.

    Returns
    -------
    dict
        With entries ``check``, ``family``, ``mode``, ``seconds`` (process time), ``rows``,
        ``panels``, and ``failure``: why it has no rows, or "".
    """
    begun = time.process_time()
    failure, rows, panels = "", [], []
    try:
        for found in check.run(check.full if mode == FULL else 1.0):
            rows += [row.as_data() for row in found.rows]
            panels += [panel.as_data() for panel in found.panels]
    except Exception as error:  # from a wrong engine anything may follow; others go on
        told = isinstance(error, CaromError)
        failure = str(error) if told else f"{type(error).__name__}: {error}"
        rows, panels = [], []
    return {
        "check": check.name,
        "family": check.family,
        "mode": mode,
        "seconds": round(time.process_time() - begun, 2),
        "rows": rows,
        "panels": panels,
        "failure": failure,
    }


def seconds(check: Check, mode: str) -> float:
    """About how long it takes."""
    return check.seconds * (check.full if mode == FULL else 1.0)


def results(checks: Sequence[Check], mode: str) -> Iterator[dict[str, Any]]:
    """What `work` returns, of each as it is done; the longest begin first.

    Raises
    ------
    RunError
        If a process was ended from outside.
    """
    longest = sorted(checks, key=lambda check: -seconds(check, mode))
    processes = min(PROCESSES, os.cpu_count() or 1, len(longest))
    pool = ProcessPoolExecutor(
        processes, multiprocessing.get_context("spawn"), initializer=_leave_interrupts
    )
    try:
        waiting = [pool.submit(_by_name, check.name, mode) for check in longest]
        for done in as_completed(waiting):
            yield done.result()
    except BrokenProcessPool as error:
        msg = "a process of the report was ended from outside, perhaps for want of memory"
        raise RunError(msg) from error
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
        for process in multiprocessing.active_children():  # idle, or not wanted any more
            process.terminate()
            process.join()


def _by_name(name: str, mode: str) -> dict[str, Any]:
    return work(catalogue.named(name), mode)


def _leave_interrupts() -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the parent, which ends this
