"""One row of the benchmark: built, warmed up, timed, asserted, profiled."""

import time
from typing import Any

import numpy as np

from carom import mechanics
from carom.bench import answers, machine
from carom.bench.cases import Case
from carom.engine import NO_LIMIT, FastEngine
from carom.errors import RunError
from carom.state import State
from carom.world import World

#: The engine shall not come back before it is done.
NEVER = 1e9


class Run:
    """A case, warmed up and ready to be timed again and again.

    Parameters
    ----------
    case : Case
    """

    def __init__(self, case: Case) -> None:
        self._case = case
        self._seconds: list[float] = []
        self._events = self._collisions = 0
        self._span = 0.0
        self._begin()
        self._answer = (0, 0.0)
        if case.warm_up:
            self._engine.advance(np.inf, max_collisions=case.warm_up)
            self._answer = (self._engine.collisions, self._engine.time)

    def _begin(self) -> None:
        state, self._world = self._case.start()
        self._energy = mechanics.energy(state, self._world)
        begin = time.process_time()
        self._engine = engine(state, self._world)
        self._building = time.process_time() - begin

    def measure(self) -> float:
        """Time one repetition; returns nanoseconds of process time per collision."""
        case, fresh = self._case, not self._case.warm_up
        if fresh and self._seconds:
            self._begin()
        events, collisions, start = self._counts()
        begin = time.process_time()
        self._engine.advance(case.until, max_collisions=case.collisions or NO_LIMIT)
        took = time.process_time() - begin
        now, met, end = self._counts()
        if fresh:
            self._answer = (self._engine.collisions, self._engine.time)
        self._seconds.append(took / (now - events))
        self._events = now - events
        self._collisions += met - collisions
        self._span += end - start
        return 1e9 * self._seconds[-1]

    def _counts(self) -> tuple[int, int, float]:
        """Collisions with walls, without, and the time."""
        met = self._engine.collisions
        return met + self._engine.wall_collisions, met, self._engine.time

    def row(self) -> dict[str, Any]:
        """Assert the answers; return what goes into the results, with what is wrong of them."""
        case, peak = self._case, machine.peak_memory()  # the checks take memory of their own
        state = self._engine.state()
        gone = mechanics.energy(state, self._world) + self._engine.dissipated
        drift = gone / self._energy - 1
        overlap = self._engine.max_overlap()
        rate, wrong = None, ""
        try:
            answers.assert_kept(case, drift, overlap, self._engine.collisions)
            answers.assert_known(case, *self._answer)
            answers.assert_clustered(case, state, self._world)
            rate = answers.rate(case, state, case.warm_up, self._collisions, self._span)
        except RunError as error:  # the other cases are still worth their time
            wrong = str(error)
        return {
            "name": case.name,
            "n": case.n,
            "packing_fraction": case.packing_fraction,
            "collisions": self._events,
            "nanoseconds": [round(1e9 * each, 2) for each in self._seconds],
            "engine_bytes": self._engine.memory,
            "peak_bytes": peak,
            "building_seconds": round(self._building, 4),
            "answer": list(self._answer),
            "energy_drift": drift,
            "max_overlap": overlap,
            "rate": rate and rate._asdict(),
            "wrong": wrong,
        }

    def profile(self) -> dict[str, Any]:
        """Where the time goes: one more repetition, in an engine that looks at itself.

        Returns
        -------
        dict
            With entries ``shares`` of the time (they add up to 1), and ``work``: counts per
            collision.
        """
        case = self._case
        state = self._engine.state() if case.warm_up else case.start()[0]
        begun = state.collisions + state.wall_collisions
        self._engine = engine(state, self._world, profile=True)
        self._engine.advance(case.until, max_collisions=case.collisions or NO_LIMIT)
        seconds, work = self._engine.profile(), self._engine.work()
        total = sum(seconds.values())
        events = self._counts()[0] - begun
        return {
            "shares": {name: each / total for name, each in seconds.items()},
            "work": {name: each / events for name, each in work.items()},
        }


def engine(state: State, world: World, *, profile: bool = False) -> FastEngine:
    """The engine, which keeps no records and runs through."""
    return FastEngine(state, world, log=False, slice_seconds=NEVER, profile=profile)
