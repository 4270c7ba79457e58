"""Letting time run: how far, what is called meanwhile, and what is said if it cannot go on."""

import math
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import Any, Self

from carom import mechanics
from carom.checks import number
from carom.engine import Stop
from carom.errors import CollapseError, InputError, RunError
from carom.frame import Frame, moments
from carom.observe.feed import Feed
from carom.placing import Placing
from carom.walls import wall_names

LARGEST_COUNT = 2**53  # beyond it a float that stands for a count is no longer exact


class Running(Placing):
    """The part of `carom.Simulation` that lets time run."""

    def run(
        self,
        *,
        until: float | None = None,
        duration: float | None = None,
        collisions: float | None = None,
        events: float | None = None,
        progress: Callable[[Self], object] | None = None,
        observe: Any = None,
    ) -> None:
        """Let time run to exactly a moment, or through exactly so many collisions.

        Give one of the first four. Ctrl-C stops within a fraction of a second, between two
        collisions: the simulation is whole and may go on.

        Parameters
        ----------
        until : float
            Simulated time to stop at, not before now.
        duration : float
            The same, counted from now.
        collisions : int
            Collisions between spheres; stops right after the last one.
        events : int
            Collisions between spheres and with walls together.
        progress : callable, optional
            Called with this simulation about twenty times a second.
        observe : Observable or several, optional
            What to measure on the way, see `carom.observe`. That changes no bit of the motion.

        Raises
        ------
        InputError
            If not exactly one goal is given, or it cannot be reached, or something to observe
            has no meaning here.
        RunError
            If nothing will ever happen again before the count is full.
        CollapseError
            At an inelastic collapse: infinitely many collisions in a finite time.
        """
        goals = {"until": until, "duration": duration, "collisions": collisions, "events": events}
        given = {name: value for name, value in goals.items() if value is not None}
        if len(given) != 1:
            got = " and ".join(f"{name}={value!r}" for name, value in given.items()) or "none"
            msg = f"run() takes exactly one of until, duration, collisions, events; got {got}"
            raise InputError(msg)
        if len(self) == 0:
            msg = "there are no spheres to run; add some with add() or start from a scene"
            raise InputError(msg)
        ((name, value),) = given.items()
        turn = None if progress is None else partial(progress, self)
        goal = self._end(name, value) if name in ("until", "duration") else count(name, value)
        feed = None if observe is None else Feed(observe, self._motion)
        if name in ("until", "duration"):
            stop = self._motion.advance(until=goal, progress=turn, feed=feed)
        else:
            stop = self._run_count(name, int(goal), turn, feed)
        if stop is Stop.COLLAPSE:
            raise CollapseError(self._collapse_message())

    def frames(
        self,
        *,
        every: float | None = None,
        at: Iterable[float] | None = None,
        until: float | None = None,
    ) -> Iterator[Frame]:
        """Let time run and stop at exactly these moments, to look.

        Parameters
        ----------
        every : float
            Simulated time between frames; the first is now.
        at : iterable of float
            Rising times instead, from now on.
        until : float, optional
            No frame after this time; with `every` alone they never end.

        Yields
        ------
        Frame
            It stays as it is when time goes on.

        Raises
        ------
        InputError
            If not exactly one of `every` and `at` is given, or a time cannot be used.
        RunError
            See `run`.
        """
        return self._frames(moments(self.time, every=every, at=at, until=until))

    def _frames(self, times: Iterator[float]) -> Iterator[Frame]:
        for time in times:
            self.run(until=time)
            yield self._motion.frame()

    def _end(self, name: str, value: float) -> float:
        if name == "duration":
            return self.time + number("duration", value, at_least=0)
        end = number("until", value)
        if end < self.time:
            msg = (
                f"until is {end:.15g}, but the time is {self.time:.15g} already; "
                "give a later time, or go back with reset()"
            )
            raise InputError(msg)
        return end

    def _run_count(
        self, name: str, wanted: int, turn: Callable[[], object] | None, feed: Feed | None
    ) -> Stop:
        before = self.collisions, self.wall_collisions
        # Spheres that cannot meet may bounce between walls for ever without one collision.
        alone = len(self) < 2 or not self._motion.world.collide
        stop = Stop.IDLE
        if not (name == "collisions" and alone and wanted > 0):
            stop = self._motion.advance(**{name: wanted}, progress=turn, feed=feed)
        done = self.collisions - before[0]
        done += self.wall_collisions - before[1] if name == "events" else 0
        if stop is Stop.IDLE and done < wanted:
            msg = (
                f"only {done} of {wanted} {name} happened: nothing will ever meet again; "
                "run until a time instead"
            )
            raise RunError(msg)
        return stop

    def _collapse_message(self) -> str:
        assert self._motion.collapse is not None
        time, i, j = self._motion.collapse
        who = f"spheres {i} and {j}"
        if j < 0:
            who = f"sphere {i} and {wall_names(self.walls)[-1 - j]}"
        short = 1e-3 * mechanics.crossing_time(self._motion.start.state, self.world)
        short = float(f"{short:.0e}")  # one digit: it is a scale, not a result
        cure = f"Smooth(restitution={self.rule.restitution:g}, contact_time={short:g})"
        return (
            f"{who} collapse at time {time:.9g}, colliding infinitely often; let collisions in "
            f"quick succession be elastic with rule={cure}, or take a larger restitution"
        )


def count(name: str, value: float) -> int:
    """A whole number, 0 or more; 1e6 is one too."""
    wanted = number(name, value, at_least=0, at_most=LARGEST_COUNT)
    if wanted != math.floor(wanted):
        msg = f"{name} is {wanted:g}; give a whole number"
        raise InputError(msg)
    return int(wanted)
