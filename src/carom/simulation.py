"""`Simulation`: spheres, walls and rules, and the button that lets time run."""

import copy
import sys
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Self

import numpy as np

from carom.checks import number
from carom.errors import InputError
from carom.kept import Surroundings
from carom.listing import Listing
from carom.markup import html_picture, html_table
from carom.methods import TICKS_PER_SECOND, Method, engine_maker
from carom.motion import Motion, Saved
from carom.rules import Smooth
from carom.running import count
from carom.scene import Scene, Spheres
from carom.showing import Showing
from carom.state import State
from carom.walls import Open, Wall


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


class Simulation(Showing):
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
    record : str or Path, optional
        A file for everything that happens, see `record`; use the simulation with ``with`` then.

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
        record: str | Path | None = None,
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
        limit = count("keep_events", keep_events)
        self._motion = self._moved(state, Surroundings.of(described), limit)
        if record is not None:
            self.record(record)

    def _moved(self, state: State, around: Surroundings, keep_events: int) -> Motion:
        """What carries spheres on by this simulation's method."""
        make = engine_maker(self._method, self._tick)
        return Motion(state, around, make, keep_events, strict=self._method != "tick")

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

    def in_ticks(self, tick: float | None = None) -> Self:
        """Make the twin that goes from the same start by the teaching method of fixed steps.

        Parameters
        ----------
        tick : float, optional
            Length of a step; if left out, what passes in a sixtieth of a second at `pace`, as
            in the paper.

        Returns
        -------
        Simulation
            At the start, where `reset` goes; `missed` counts the collisions it does not see.

        Raises
        ------
        InputError
            If `tick` is not above 0.

        Examples
        --------
        >>> import carom
        >>> exact = carom.Simulation(carom.scenes.phase_4())
        >>> ticks = exact.in_ticks()
        >>> for sim in (exact, ticks):
        ...     sim.run(until=200)
        >>> exact.collisions, ticks.collisions, ticks.missed
        (65, 61, 9)
        """
        twin = copy.copy(self)
        length = self.pace / TICKS_PER_SECOND if tick is None else tick
        twin._method, twin._tick = "tick", number("tick", length, above=0)
        start = self._motion.start
        twin._motion = twin._moved(start.state, start.surroundings, self._motion.keep_events)
        return twin

    def bookmark(self) -> Bookmark:
        """Remember this moment, so that `return_to` can come back to it.

        Cost: about 200 bytes and 0.3 microseconds a sphere; coming back takes four times as long.
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

    def as_python(self) -> str:
        """Write it as a Python program that starts from here, with the same bits.

        A scene of the library whose spheres were neither added, removed nor assigned to since
        is written by its name, at its start, with the walls, rule and gravity of now. All
        others are written as they are now, at time 0.

        Raises
        ------
        InputError
            If there are more than 2000 spheres to write, or they overlap, as ticks let them.

        Examples
        --------
        >>> import carom
        >>> sim = carom.Simulation(carom.scenes.gas(n=200, seed=3))
        >>> sim.run(until=1)
        >>> sim.gravity = (0, 0, -1)
        >>> print(sim.as_python(), end="")
        import carom
        <BLANKLINE>
        sim = carom.Simulation(carom.scenes.gas(n=200, seed=3), gravity=(0, 0, -1))
        sim.show()
        """
        return self._listing().python()

    def as_toml(self) -> str:
        """Write it as a scene file: the same start as `as_python`, with the same bits.

        Raises
        ------
        InputError
            If there are more than 20000 spheres to write, or they overlap, as ticks let them.
        """
        return self._listing().toml()

    def as_command(self) -> str:
        """Write the command that shows it; a scene file is named where options cannot say it.

        Raises
        ------
        InputError
            If spheres overlap, as ticks let them.
        """
        return self._listing().command()

    def _listing(self) -> Listing:
        return Listing.of(self._scene, self._motion, self._method, self._tick)

    def show(self, *, host: str = "127.0.0.1", port: int = 0, open_browser: bool = True) -> None:
        """Show it live in the browser until Ctrl-C.

        Parameters
        ----------
        host : str
            "127.0.0.1" is this machine only. An address of this machine in a network, or
            "0.0.0.0", lets everybody there see it who has the address of the page.
        port : int
            Of the page's address; 0 takes a free one.
        open_browser : bool
            False only writes the address on standard error.

        Raises
        ------
        FileError
            If the port or the address cannot be used.
        InputError
            If the host is none.
        """
        from carom.view import LiveView, serve

        def announce(view: LiveView) -> None:
            sys.stderr.write(f"carom is at {view.url} (Ctrl-C ends it)\n")
            if view.is_public:
                sys.stderr.write(f"to watch only: {view.watch_url}\n")

        serve(self, host=host, port=port, open_browser=open_browser, on_ready=announce)

    def _repr_html_(self) -> str:
        rows = [
            ("spheres", f"{len(self)}"),
            ("time", f"{self.time:.6g}"),
            ("collisions", f"{self.collisions}, {self.wall_collisions} with walls"),
            ("kinetic energy", f"{self.kinetic_energy:.6g}"),
            ("temperature", f"{self.temperature:.6g}"),
            ("relative change of energy", f"{self.energy_drift:.1e}"),
            ("method", self._method if isinstance(self._method, str) else repr(self._method)),
        ]
        title = "" if self._scene is None else self._scene.title
        return html_table(title or "Simulation", rows) + html_picture(self._repr_png_())

    def view(self, *, color: str | None = None, height: int = 480) -> Any:
        """Show it live in a notebook's cell; needs ``pip install "carom[notebook]"``.

        The page's buttons and sliders act on this simulation. While a cell runs the view waits,
        and afterwards shows what the cell has done.

        Parameters
        ----------
        color : str, optional
            "energy", "speed", "collisions", "species" or "own"; as the scene asks for if left out.
        height : int
            Of the view, in pixels.

        Returns
        -------
        anywidget.AnyWidget
            Any number of them can show one simulation.

        Raises
        ------
        InputError
            If a value cannot be used, or anywidget is not installed.
        """
        from carom.view import notebook

        return notebook.live(self, color=color, height=height)

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
