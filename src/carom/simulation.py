"""`Simulation`: spheres, walls and rules, and the button that lets time run."""

import math
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import partial
from types import TracebackType
from typing import Literal, Self, TypeAlias

import numpy as np

from carom import mechanics
from carom.checks import nearest, number
from carom.engine import FastEngine, Stop
from carom.errors import CollapseError, InputError, RunError, UnknownNameError
from carom.motion import MakeEngine, Motion, Saved, Surroundings
from carom.placing import Placing
from carom.reference.exact import ExactEngine
from carom.reference.tick import TickEngine
from carom.rules import Smooth
from carom.scene import Scene, Spheres
from carom.state import State
from carom.walls import Open, Wall, wall_names

Method: TypeAlias = Literal["exact", "tick", "reference"] | MakeEngine
METHODS = ("exact", "tick", "reference")
LARGEST_COUNT = 2**53  # beyond it a float that stands for a count is no longer exact


@dataclass(frozen=True, eq=False)
class Bookmark:
    """A moment of a simulation, see `Simulation.bookmark`.

    Attributes
    ----------
    time : float
    collisions, wall_collisions : int
    nbytes : int
        Memory it holds at most; bookmarks between two changes share a part of it.
    """

    time: float
    collisions: int
    wall_collisions: int
    nbytes: int
    scene: Scene | None = field(repr=False)
    saved: Saved = field(repr=False)


class Simulation(Placing):
    """Spheres that move and collide.

    Parameters
    ----------
    scene : Scene, optional
        Where to start. Without one, space is empty and `add` brings spheres.
    walls : wall or walls, optional
        Replaces the walls of the scene; open space if neither is given.
    rule : Smooth, optional
        What happens when two spheres meet; elastic if neither is given.
    gravity : (3,) floats, optional
        Acceleration of every sphere that is not fixed.
    collide : bool, optional
        False makes an ideal gas: spheres pass through one another.
    method : {"exact", "tick", "reference"} or callable
        "exact" solves every contact time. "tick" is the teaching method that moves in
        steps of `tick`. "reference" is exact too, in plain Python, slow and easy to read.
        A callable ``(state, world) -> Engine`` is an engine of your own.
    tick : float
        Length of one step of ``method="tick"``.
    keep_events : int
        How many of the newest events of a run `events` holds, 40 bytes each.

    Raises
    ------
    InputError
        If a value cannot be used or the spheres do not fit their world.

    Examples
    --------
    >>> import carom
    >>> sim = carom.Simulation()
    >>> red = sim.add(position=(-2, 0, 0), velocity=(1, 0, 0), color="red")
    >>> blue = sim.add(position=(2, 0, 0), mass=1, color="blue")
    >>> sim.run(until=6)
    >>> sim.collisions, red.velocity.tolist(), blue.velocity.tolist()
    (1, [0.0, 0.0, 0.0], [1.0, 0.0, 0.0])
    """

    def __init__(
        self,
        scene: Scene | None = None,
        *,
        walls: Wall | Iterable[Wall] | None = None,
        rule: Smooth | None = None,
        gravity: Iterable[float] | None = None,
        collide: bool | None = None,
        method: Method = "exact",
        tick: float = 1.0,
        keep_events: int = 1_000_000,
    ) -> None:
        changes = {"walls": walls, "rule": rule, "gravity": gravity, "collide": collide}
        changes = {name: value for name, value in changes.items() if value is not None}
        if scene is not None:
            _refuse_other_than_scene(scene)
        empty = Scene(Spheres.of(np.zeros((0, 3))), (Open(),))
        described = replace(empty if scene is None else scene, **changes)  # type: ignore[arg-type]
        self._scene = None if scene is None else described
        self._method = method
        self._tick = number("tick", tick, above=0)
        state = State.empty() if scene is None else described.build()[0]
        limit = _count("keep_events", keep_events)
        make = _engine_maker(method, self._tick, log=limit > 0)
        self._motion = Motion(
            state, Surroundings.of(described), make, limit, strict=method != "tick"
        )

    @property
    def scene(self) -> Scene | None:
        """What the simulation started from, if it started from a scene."""
        return self._scene

    @property
    def method(self) -> Method:
        """How contacts are found; fixed when the simulation is made."""
        return self._method

    @property
    def tick(self) -> float:
        """Length of a step where the method is "tick"."""
        return self._tick

    @property
    def pace(self) -> float:
        """Simulated time per second at which the scene looks best."""
        return 1.0 if self._scene is None else self._scene.pace

    # Letting time run.

    def run(
        self,
        *,
        until: float | None = None,
        duration: float | None = None,
        collisions: float | None = None,
        events: float | None = None,
        progress: Callable[[Self], object] | None = None,
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

        Raises
        ------
        InputError
            If not exactly one goal is given, or it cannot be reached.
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
        if name in ("until", "duration"):
            stop = self._motion.advance(until=self._end(name, value), progress=turn)
        else:
            stop = self._run_count(name, _count(name, value), turn)
        if stop is Stop.COLLAPSE:
            raise CollapseError(self._collapse_message())

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

    def _run_count(self, name: str, wanted: int, turn: Callable[[], object] | None) -> Stop:
        before = self.collisions, self.wall_collisions
        # Spheres that cannot meet may bounce between walls for ever without one collision.
        alone = len(self) < 2 or not self._motion.world.collide
        stop = Stop.IDLE
        if not (name == "collisions" and alone and wanted > 0):
            stop = self._motion.advance(**{name: wanted}, progress=turn)
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
        short = 1e-3 * mechanics.crossing_time(self._motion.start, self.world)
        short = float(f"{short:.0e}")  # one digit: it is a scale, not a result
        cure = f"Smooth(restitution={self.rule.restitution:g}, contact_time={short:g})"
        return (
            f"{who} collapse at time {time:.9g}, colliding infinitely often; let collisions in "
            f"quick succession be elastic with rule={cure}, or take a larger restitution"
        )

    def reset(self, scene: Scene | None = None) -> None:
        """Go back to where the first run began: time, spheres, walls, rule and gravity.

        Parameters
        ----------
        scene : Scene, optional
            Go to the start of this scene instead, by the same method. Nothing of the old one
            stays, so each `Ball` of it is gone.

        Raises
        ------
        InputError
            If it is no scene or cannot be run. Then nothing changes.
        """
        if scene is None:
            self._motion.restart()
            return
        _refuse_other_than_scene(scene)
        state = scene.build()[0]
        self._motion.begin(state, Surroundings.of(scene))
        self._scene = scene

    def bookmark(self) -> Bookmark:
        """Remember this moment, so that `return_to` can come back to it.

        Cost: about 100 bytes and 0.2 microseconds a sphere; coming back takes some five times as long.
        """
        saved = self._motion.saved()
        return Bookmark(
            self.time, self.collisions, self.wall_collisions, saved.nbytes, self._scene, saved
        )

    def return_to(self, bookmark: Bookmark) -> None:
        """Go back to a moment as if the simulation had never left it.

        Spheres, walls, rule, gravity and all counters are as they were, whatever was changed
        since, and a run goes on with the same bits. `events` is empty until then. An engine
        of your own needs `checkpoint` and `restore` for the same bits; without them it is
        built anew from the state.

        Parameters
        ----------
        bookmark : Bookmark
            Of this simulation; it may serve again and again.

        Raises
        ------
        InputError
            If it is of another simulation.

        Examples
        --------
        >>> import carom
        >>> sim = carom.Simulation(carom.scenes.two_balls())
        >>> sim.run(until=1)
        >>> before = sim.bookmark()
        >>> sim.run(collisions=1)
        >>> sim.return_to(before)
        >>> sim.time, sim.collisions
        (1.0, 0)
        """
        if not isinstance(bookmark, Bookmark):
            msg = f"a Bookmark is what bookmark() returns, not {bookmark!r:.60}"
            raise InputError(msg)
        self._motion.return_to(bookmark.saved)
        self._scene = bookmark.scene

    def show(self, *, port: int = 0, open_browser: bool = True) -> None:
        """Show it live in the browser until Ctrl-C.

        Parameters
        ----------
        port : int
            Of the address on this machine; 0 takes a free one.
        open_browser : bool
            False only writes the address on standard error.

        Raises
        ------
        FileError
            If the port is in use.
        """
        from carom.view import serve

        def announce(address: str) -> None:
            sys.stderr.write(f"carom is at {address} (Ctrl-C ends it)\n")

        serve(self, port=port, open_browser=open_browser, on_ready=announce)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        return None

    def __repr__(self) -> str:
        method = self.method if isinstance(self.method, str) else "its own"
        return (
            f"<Simulation: {len(self)} spheres, time {self.time:.6g}, "
            f"{self.collisions} collisions, method {method}>"
        )


def _refuse_other_than_scene(scene: object) -> None:
    if not isinstance(scene, Scene):
        msg = f"scene must be a Scene such as carom.scenes.gas(), not {scene!r:.60}"
        raise InputError(msg)


def _engine_maker(method: Method, tick: float, log: bool) -> MakeEngine:
    """What builds the engine that a method's name stands for."""
    if callable(method):
        return method
    if method == "tick":
        return lambda state, world: TickEngine(state, world, tick=tick)
    if method == "reference":
        return ExactEngine
    if method == "exact":
        return lambda state, world: FastEngine(state, world, log=log)
    msg = f"there is no method {method!r}{nearest(str(method), METHODS)}"
    raise UnknownNameError(msg)


def _count(name: str, value: float) -> int:
    """A whole number, 0 or more; 1e6 is one too."""
    wanted = number(name, value, at_least=0, at_most=LARGEST_COUNT)
    if wanted != math.floor(wanted):
        msg = f"{name} is {wanted:g}; give a whole number"
        raise InputError(msg)
    return int(wanted)
