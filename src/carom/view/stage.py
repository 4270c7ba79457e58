"""The simulation on show, the ticks that may run beside it, and what pages can do to both."""

import math
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from carom import mechanics
from carom.errors import CaromError, CollapseError, InputError, RunError
from carom.state import CAME_TO_REST
from carom.view.builder import Builder
from carom.view.history import History, Mark
from carom.view.pressure import WallPressure
from carom.view.protocol import Command
from carom.view.viewable import Viewable

MOST_SPHERES = 200_000  #: that a page may ask for; more are for the command line
MOST_COMPARED = 500  #: the tick method looks at all pairs, in Python
STRETCH = 20.0  #: seconds at speed 1 over which pressures are averaged
SEARCH = 3.0  #: seconds of the clock in which a step must find the next collision

Look = Callable[[object], None]
Stopping = Callable[[], bool]


class Stage:
    """What is on show. Every action either works or raises a `CaromError` and changes nothing.

    But for `CollapseError`, which leaves a step where the spheres collapse.

    Parameters
    ----------
    sim : Viewable
    stopping : callable
        Whether the view is closing, so that a long search must end.

    Attributes
    ----------
    sim : Viewable
        What was handed in.
    twin : Viewable or None
        The same start in ticks.
    epoch : int
        Counts jumps of the motion, after which pictures must not be joined.
    key : int
        Counts the scenes that were loaded.
    reversed : bool
        Whether time was turned round.
    event : dict or None
        The collision that the last step has led to.
    """

    def __init__(self, sim: Viewable, stopping: Stopping) -> None:
        self.sim = sim
        self.twin: Viewable | None = None
        self.epoch = self.key = 0
        self.reversed = False
        self.event: dict[str, Any] | None = None
        self._stopping = stopping
        self._serial = 0
        self._twin_start = 0.0
        self._at_collision = 0  # how many collisions have led to this moment and none after it
        self._owed = 0.0  # time for which no whole tick has passed yet
        self._contact_time = sim.rule.contact_time
        self._builder = Builder(stopping)
        self._history = History()
        self.pressure = self._gauge()
        self._actions: dict[str, Callable[..., None]] = {
            "restart": self.restart,
            "step": self._step,
            "back": self._back,
            "reverse": self._reverse,
            "rule": self._rule,
            "walls": self._walls,
            "gravity": self._gravity,
            "scene": self._load,
            "add": self._add,
            "remove": self._remove,
            "push": self._push,
            "compare": self._compare,
        }

    @property
    def shown(self) -> tuple[Viewable, ...]:
        """The simulation, and the ticks if they run beside it."""
        return (self.sim,) if self.twin is None else (self.sim, self.twin)

    def act(self, command: Command) -> None:
        """Do what a page asks for.

        Raises
        ------
        CaromError
            If it cannot be done; then nothing has changed.
        """
        self._actions[command.op](**command.values)

    def settings(self) -> dict[str, Any]:
        """What the sliders of a page show."""
        walls = [wall.restitution for wall in self.sim.walls if hasattr(wall, "restitution")]
        return {
            "restitution": self.sim.rule.restitution,
            "wall_restitution": walls[0] if walls else None,
            "contact_time": self.sim.rule.contact_time,
            "gravity": self.sim.world.gravity.tolist(),
            "comparing": self.twin is not None,
            "tick": None if self.twin is None else self.twin.tick,
        }

    # Time goes on.

    def run(self, duration: float, look: Look) -> None:
        """Let time run; ticks go on as far as whole ticks go."""
        if len(self.sim) == 0:
            return
        self._history.note(self._mark)
        if duration > 0:
            self._at_collision = 0
        if self._in_ticks:
            # Whole ticks only: a shorter one would be another method.
            self._owed += duration
            duration = math.floor(self._owed / self.sim.tick + 1e-9) * self.sim.tick
            self._owed = max(0.0, self._owed - duration)
        self._advance(look, self._unless_stopping, duration=duration)

    def _advance(self, look: Look, look_beside: Look, **goal: float) -> None:
        before = self.sim.time
        try:
            self.sim.run(**goal, progress=look)
        finally:
            if self.sim.time > before:
                self.pressure.add(self.sim.events, self.sim.time - before)
            if self.twin is not None:
                ticks = math.floor((self.sim.time - self._twin_start) / self.twin.tick + 1e-9)
                end = self._twin_start + ticks * self.twin.tick
                if end > self.twin.time:
                    self.twin.run(until=end, progress=look_beside)

    @property
    def _in_ticks(self) -> bool:
        return bool(self.sim.method == "tick")

    @property
    def _count(self) -> int:
        """Collisions between spheres, or with walls where spheres pass through one another."""
        return self.sim.collisions if self._collide else self.sim.wall_collisions

    @property
    def _collide(self) -> bool:
        return self.sim.world.collide and len(self.sim) > 1

    @property
    def _goal(self) -> str:
        return "collisions" if self._collide else "events"

    def _mark(self) -> Mark:
        return Mark(self._count, self.reversed, tuple(sim.bookmark() for sim in self.shown))

    def _return_to(self, mark: Mark) -> None:
        for sim, bookmark in zip(self.shown, mark.marks, strict=True):
            sim.return_to(bookmark)
        self.reversed = mark.reversed

    def _unless_stopping(self, _: object) -> None:
        if self._stopping():
            msg = "the view is closing"
            raise RunError(msg)

    # What pages can do.

    def restart(self) -> None:
        """Go back to the start; what was set since (rule, walls, gravity) stays."""
        for sim in self.shown:
            rule, walls, gravity = sim.rule, sim.walls, tuple(sim.gravity)
            sim.reset()
            if sim.rule != rule:
                sim.rule = rule
            if sim.walls != walls:
                sim.walls = walls
            if tuple(sim.gravity) != gravity:
                sim.gravity = gravity
        self.reversed = False
        self._jump(forget=True)

    def _step(self) -> None:
        """Run through the next collision."""
        mark = self._mark()
        end = time.perf_counter() + SEARCH

        def search(_: object) -> None:
            if self._stopping() or time.perf_counter() > end:
                msg = f"no collision came within {SEARCH:g} seconds of looking; let time run on"
                raise RunError(msg)

        try:
            self._advance(search, search, **{self._goal: 1})
        except CollapseError:
            self._history.keep(mark)
            raise
        except CaromError:
            self._return_to(mark)
            self.pressure = self._gauge()
            raise
        self._history.keep(mark)
        self._serial += 1
        self.event = self._last_collision()
        self._arrive()

    def _arrive(self) -> None:
        """Take note that the last run has ended with a collision; a tick can hold several."""
        events = self.sim.events
        if self._in_ticks:
            events = events[events["time"] == self.sim.time]
            self._at_collision = int(np.count_nonzero((events["j"] >= 0) == self._collide))
        else:
            self._at_collision = 1

    def _last_collision(self) -> dict[str, Any] | None:
        """What the last run ended with; coming to rest and waking are no collisions."""
        for event in self.sim.events[::-1]:
            if event["j"] > CAME_TO_REST:
                return {
                    "t": float(event["time"]),
                    "i": int(event["i"]),
                    "j": int(event["j"]),
                    "impulse": event["impulse"].tolist(),
                    "serial": self._serial,
                }
        return None

    def _back(self) -> None:
        """Return to the moment right after the collision before this one, or to the start."""
        now = self.sim.time
        found = self._history.before(self._count - self._at_collision)
        if found is None:
            msg = "there is nothing to step back to yet; let time run first"
            raise RunError(msg)
        mark, collisions = found
        self._return_to(mark)
        self._at_collision = 0
        if collisions > 0:
            look = self._unless_stopping
            self._advance(look, look, **{self._goal: collisions})
            self._arrive()
        if self.sim.time > now:  # an engine of one's own need not repeat itself
            self._return_to(mark)
            self._at_collision = 0
        self._jump()

    def _reverse(self) -> None:
        for sim in self.shown:
            sim.velocity = -sim.velocity
        self.reversed = not self.reversed
        self._change()
        self._jump()

    def _rule(self, restitution: float) -> None:
        """Change the restitution, with the cure of inelastic collapse where there is none."""
        contact = self._contact_time
        if contact is None and restitution < 1:
            short = 1e-3 * mechanics.crossing_time(self.sim.state, self.sim.world)
            contact = float(f"{short:.0e}") if 0 < short < math.inf else None
        for sim in self.shown:
            sim.rule = replace(sim.rule, restitution=restitution, contact_time=contact)
        self._change()

    def _walls(self, restitution: float) -> None:
        for sim in self.shown:
            sim.walls = [
                replace(wall, restitution=restitution) if hasattr(wall, "restitution") else wall
                for wall in sim.walls
            ]
        self._change()

    def _gravity(self, value: tuple[float, float, float]) -> None:
        for sim in self.shown:
            sim.gravity = value
        self._change()

    def _load(self, name: str, options: dict[str, Any]) -> None:
        """Show another scene of the library."""
        n = options.get("n", 0)
        if isinstance(n, int | float) and n > MOST_SPHERES:
            msg = (
                f"n is {n:g}; a page may ask for up to {MOST_SPHERES:,} spheres, for more start "
                f"'carom show {name} --n {n:g}'"
            )
            raise InputError(msg)
        scene = self._builder.build(name, options)
        if self._in_ticks and scene.pace != self.sim.pace:
            msg = (
                f"{name} needs ticks of another length than {self.sim.tick:g}; start "
                f"'carom show {name} --method tick'"
            )
            raise InputError(msg)
        same = scene.origin is not None and self._origin == scene.origin.name
        self.sim.reset(scene)
        self.twin = None
        self.reversed = False
        self.key += not same
        self._contact_time = scene.rule.contact_time
        self._jump(forget=True)

    @property
    def _origin(self) -> str:
        scene = self.sim.scene
        return scene.origin.name if scene is not None and scene.origin is not None else ""

    def _add(self, **ball: Any) -> None:
        self._refuse_beside_ticks()
        count = self._count
        self.sim.add(**ball)
        self._change(count)
        self._jump()

    def _remove(self, index: int) -> None:
        self._refuse_beside_ticks()
        self._refuse_unknown(index)
        if len(self.sim) == 1:
            msg = "this is the last sphere and the scene needs one; add another first"
            raise InputError(msg)
        count = self._count
        self.sim.remove(index)
        self._change(count)
        self._jump()

    def _push(self, index: int, velocity: tuple[float, float, float]) -> None:
        self._refuse_unknown(index)
        for sim in self.shown:
            sim[index].velocity = velocity
        self._change()
        self._jump()

    def _refuse_beside_ticks(self) -> None:
        if self.twin is not None:
            msg = "two runs of one start are being compared; leave the comparison first"
            raise InputError(msg)

    def _refuse_unknown(self, index: int) -> None:
        if index >= len(self.sim):
            msg = f"there is no sphere {index}; there are {len(self.sim)}, counted from 0"
            raise InputError(msg)

    def _compare(self, on: bool) -> None:
        """Begin again with the ticks beside, or leave them."""
        if on and len(self.sim) > MOST_COMPARED:
            msg = (
                f"the scene has {len(self.sim)} spheres; the tick method looks at all pairs and "
                f"can be watched with up to {MOST_COMPARED}: take fewer"
            )
            raise InputError(msg)
        if on and self._in_ticks:
            msg = "it goes in ticks already; start it with the exact method to compare"
            raise InputError(msg)
        if on == (self.twin is not None):
            return
        self.twin = None
        if on:
            self.restart()
            self.twin = self.sim.in_ticks()
            self._twin_start = self.twin.time
        self._jump(forget=True)

    def _gauge(self) -> WallPressure:
        return WallPressure(self.sim.world, self.sim.state, STRETCH * self.sim.pace)

    def catch_up(self) -> None:
        """Take note that somebody else has moved the simulation, or changed it."""
        self.twin, self.reversed = None, False
        self._contact_time = self.sim.rule.contact_time
        self._jump(forget=True)

    def _change(self, count: int | None = None) -> None:
        """Take note that the motion goes another way from now on, after so many collisions."""
        self._history.turn(self._count if count is None else count)
        self.pressure = self._gauge()

    def _jump(self, *, forget: bool = False) -> None:
        """Take note that the motion does not go on from where it was."""
        self.epoch += 1
        self.event = None
        self._owed = 0.0
        if forget:
            self._at_collision = 0
            self._history.clear()
        self.pressure = self._gauge()
