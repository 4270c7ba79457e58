"""What measuring costs: a run with each observable, and the same run without, in turn.

The file has the entries ``format`` ("carom bench observables"), ``format_version``, ``date``,
``machine``, ``n``, ``packing_fraction``, ``collisions`` (of a repetition), ``bound``, ``rows``.
A row has

==============  =================================================================================
name            of the observable, as ``carom run --observe`` calls it
start           what was run: "fluid", "two kinds" or "box"
slower          median of the repetitions' ratios, observed over bare process time, less 1
ratios          of the repetitions
samples         moments at which it looked, in all repetitions together
over            whether `slower` is above the bound
==============  =================================================================================
"""

import datetime
import statistics
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from carom.bench import machine, run, starts
from carom.bench.starts import Start
from carom.engine import FastEngine
from carom.errors import InputError
from carom.kept import Surroundings
from carom.motion import Motion
from carom.observe import OBSERVABLES, Observable
from carom.observe.feed import Feed
from carom.place import cube_edge
from carom.rules import Smooth
from carom.state import State
from carom.walls import Box, Periodic, Wall
from carom.world import World

FORMAT, VERSION = "carom bench observables", 1
N, PACKING_FRACTION = 4_000, 0.25
COLLISIONS = 1_000_000  #: in a repetition
WARM_UP = 100  #: collisions of each sphere before the first
BOUND = 0.20  #: measuring shall slow a run down by no more

Progress = Callable[[str, str, float], None]


class Pair:
    """A motion with an observable and its twin without, which go on in turn."""

    def __init__(self, name: str, n: int = N) -> None:
        self.name = name
        self.observable: Observable = OBSERVABLES[name]()
        self.ratios: list[float] = []
        self.start, start, wall = _fitting(self.observable, n)
        state, world = start
        engine = run.engine(state, world)
        engine.advance(np.inf, max_collisions=WARM_UP * n)
        around = Surroundings((wall,), Smooth(), (0.0, 0.0, 0.0), True)
        self._bare, self._observed = (
            Motion(engine.state(), around, _engine, keep_events=0) for _ in range(2)
        )

    def measure(self, collisions: int = COLLISIONS) -> None:
        """Time both once; whose turn is first changes each time.

        Both engines are built anew, as where they happen to lie in memory is worth a tenth.
        """
        took = {}
        for motion in (self._bare, self._observed):
            motion.change(motion.state)
        turns = [(self._bare, False), (self._observed, True)]
        for motion, watched in turns if len(self.ratios) % 2 else turns[::-1]:
            begin = time.process_time()
            feed = Feed(self.observable, motion) if watched else None
            motion.advance(collisions=collisions, feed=feed)
            took[watched] = time.process_time() - begin
        self.ratios.append(took[True] / took[False])

    def row(self) -> dict[str, Any]:
        """What goes into the results."""
        slower = statistics.median(self.ratios) - 1
        return {
            "name": self.name,
            "start": self.start,
            "slower": round(slower, 4),
            "ratios": [round(ratio, 4) for ratio in self.ratios],
            "samples": self.observable.samples,
            "over": slower > BOUND,
        }


def _engine(state: State, world: World, log: bool) -> FastEngine:
    return FastEngine(state, world, log=log)


def _fitting(observable: Observable, n: int) -> tuple[str, Start, Wall]:
    """The first start that an observable does not refuse."""
    side = cube_edge(n, PACKING_FRACTION)
    state, world = starts.fluid(n, PACKING_FRACTION)
    periodic = Periodic(side, side, side)
    heavy = replace(state, mass=np.where(np.arange(n) % 2, 2.0, 1.0))
    wide = side + 1.0  # the centres have the room of the periodic box
    box = Box(wide, wide, wide)
    around = Surroundings((box,), Smooth(), (0.0, 0.0, 0.0), True)
    fits: list[tuple[str, Start, Wall]] = [
        ("fluid", (state, world), periodic),
        ("two kinds", (heavy, world), periodic),
        ("box", (state, around.world()), box),
    ]
    for name, start, wall in fits:
        motion = Motion(
            start[0], Surroundings((wall,), Smooth(), (0.0, 0.0, 0.0), True), _engine, 0
        )
        try:
            type(observable)().begin(motion)
        except InputError as error:
            refusal = error
        else:
            return name, start, wall
    raise refusal


def measured(
    names: list[str], repetitions: int, progress: Progress, n: int = N, collisions: int = COLLISIONS
) -> list[dict[str, Any]]:
    """Measure observables, all of them in each round, so that a busy minute meets all alike.

    Parameters
    ----------
    names : list of str
        Of `OBSERVABLES`.
    repetitions : int
    progress : callable
        Told of each step: what is done, whose, its share of the whole.
    n, collisions : int
        Number of spheres, and of collisions in a repetition.

    Returns
    -------
    list of dict
        One row for each, the cheapest first.
    """
    share = 1 / (len(names) * (repetitions + 1))
    pairs = []
    for name in names:
        pairs.append(Pair(name, n))
        progress("warmed up", name, share)
    for k in range(repetitions):
        for pair in pairs:
            pair.measure(collisions)
            progress(f"timed {k + 1} of {repetitions}", pair.name, share)
    return sorted((pair.row() for pair in pairs), key=lambda row: row["slower"])


def result(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """All there is to keep."""
    return {
        "format": FORMAT,
        "format_version": VERSION,
        "date": datetime.datetime.now(datetime.UTC).date().isoformat(),
        "machine": machine.description(),
        "n": N,
        "packing_fraction": PACKING_FRACTION,
        "collisions": COLLISIONS,
        "bound": BOUND,
        "rows": rows,
    }
