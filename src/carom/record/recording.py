"""`Recording`: what happened, read back."""

import operator
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from carom import mechanics
from carom.checks import number
from carom.errors import InputError
from carom.frame import Frame, moments
from carom.kept import Surroundings
from carom.record import layout
from carom.record.file import File
from carom.record.replay import later
from carom.scene import Scene
from carom.state import EVENT, Floats, State


@dataclass(frozen=True, slots=True)
class Segment:
    """A stretch of a recording without a change from outside.

    Attributes
    ----------
    first : int
        Its first frame in the file.
    built : State
        What its engine was built from.
    surroundings : Surroundings
    """

    first: int
    built: State
    surroundings: Surroundings


class Recording:
    """What a simulation has done, from a file that is read as it is needed.

    ``run[k]`` is frame k, ``len(run)`` their number, and ``for frame in run`` goes through them.
    What came before a `reset` or a return to a bookmark, but later in time, is in the file and
    not in the recording: its frames are in the order of time.

    Parameters
    ----------
    path : str or Path

    Attributes
    ----------
    path : Path
    file : carom.record.file.File
    times : (K,) float64
        Of the frames; the same time comes twice where something was changed from outside.
    manifest : dict
        How it came to be: carom, platform, command, scene, options, seed, started, every ...

    Raises
    ------
    FileError
        If it cannot be read, is cut short or damaged.
    InputError
        If it is no recording, or of a later format.

    Examples
    --------
    >>> import carom
    >>> path = getfixture("tmp_path") / "run.gsd"
    >>> with carom.Simulation(carom.scenes.gas(n=20, seed=1), record=path) as sim:
    ...     sim.run(until=2)
    >>> run = carom.load(path)
    >>> run.start, run.end, len(run), run.scene.seed
    (0.0, 2.0, 31, 1)
    >>> bool((run[-1].position == sim.position).all())
    True
    """

    def __init__(self, path: str | Path) -> None:
        self.path = Path(path)
        self.file = File(path)
        self.heads = [self.file.json(k, layout.HEAD) for k in range(len(self.file))]
        self._places = _in_order(self.heads)
        self.times: Floats = np.array([self.heads[k]["time"] for k in self._places])
        self.times.flags.writeable = False
        self.manifest = self.file.json(0, layout.MANIFEST)
        self._segment: tuple[int, Segment] | None = None

    def __len__(self) -> int:
        return len(self._places)

    @overload
    def __getitem__(self, index: int) -> Frame: ...
    @overload
    def __getitem__(self, index: slice) -> list[Frame]: ...
    def __getitem__(self, index: int | slice) -> Frame | list[Frame]:
        """Frame `index`, as it was to the bit; negative ones count from the end.

        A slice gives a list of frames, all in memory.
        """
        if isinstance(index, slice):
            return [self._frame(place) for place in self._places[index]]
        return self._frame(self._places[operator.index(index)])

    def __iter__(self) -> Iterator[Frame]:
        return (self._frame(place) for place in self._places)

    def __enter__(self) -> "Recording":
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<Recording: {self.path}, {len(self)} frames, time {self.start:g} to {self.end:g}>"

    def view(self, *, color: str | None = None, height: int = 480) -> Any:
        """Play it in a notebook's cell; needs ``pip install "carom[notebook]"``.

        The widget holds a replay, so it plays without a kernel too.

        Parameters
        ----------
        color : str, optional
            "energy", "speed", "collisions", "species" or "own"; as the scene asks for if left out.
        height : int
            Of the view, in pixels.

        Returns
        -------
        anywidget.AnyWidget

        Raises
        ------
        InputError
            If a value cannot be used, or anywidget is not installed.
        """
        from carom.view import notebook

        return notebook.recorded(self, color=color, height=height)

    def close(self) -> None:
        """Let go of the file."""
        self.file.close()

    @property
    def start(self) -> float:
        """Time of the first frame."""
        return float(self.times[0])

    @property
    def end(self) -> float:
        """Time of the last frame."""
        return float(self.times[-1])

    @property
    def pace(self) -> float:
        """Simulated time per second at which the scene looks best."""
        return 1.0 if self.scene is None else self.scene.pace

    @cached_property
    def scene(self) -> Scene | None:
        """What the simulation started from, if it started from a scene.

        Its spheres are those of the start; which scene of the library it was says `manifest`.
        """
        if not self.file.has(0, layout.SCENE):
            return None
        text, spheres = self.file.read(0, layout.SCENE), self.file.read(0, layout.SPHERES)
        return layout.unpacked_scene(text, spheres)

    # Any time.

    def at(self, time: float) -> Frame:
        """The spheres at any time of the recording.

        A frame's own time gives that frame to the bit. In between, the events since the frame
        before are added up: exact but for rounding, some 1e-15 of the sizes involved.
        `withheld`, `max_overlap` and `energy_drift` are those of the frame before.

        Parameters
        ----------
        time : float
            From `start` to `end`.

        Raises
        ------
        InputError
            If it is outside.
        """
        time = number("time", time)
        if not self.start <= time <= self.end:
            msg = f"time {time:.9g} is outside the recording, from {self.start:g} to {self.end:g}"
            raise InputError(msg)
        k = int(np.searchsorted(self.times, time, side="right")) - 1
        before = self[k]
        if before.time == time:
            return before
        events = self.told(k)
        events = events[events["time"] <= time]
        state = later(before.state, before.world, events, time)
        return replace(before, state=state, dissipated=before.dissipated + _taken(before, state))

    def frames(
        self,
        *,
        every: float | None = None,
        at: Iterable[float] | None = None,
        until: float | None = None,
    ) -> Iterator[Frame]:
        """Look at exactly these moments, as `Simulation.frames` does; it ends with the recording.

        Parameters
        ----------
        every : float
            Simulated time between frames; the first is at `start`.
        at : iterable of float
            Rising times instead, none before `start`.
        until : float, optional
            No frame after this time; `end` if left out.

        Raises
        ------
        InputError
            If not exactly one of `every` and `at` is given, or a time cannot be used.
        """
        last = self.end if until is None else min(number("until", until), self.end)
        return map(self.at, moments(self.start, every=every, at=at, until=last))

    def events(self, begin: float | None = None, end: float | None = None) -> NDArray[Any]:
        """What happened from `begin` to `end`, both included; all if they are left out.

        Returns
        -------
        (n,) EVENT
            As `Simulation.events`, with absolute times.
        """
        first = self.start if begin is None else number("begin", begin)
        last = self.end if end is None else number("end", end)
        parts = [np.zeros(0, EVENT)]
        k = max(0, int(np.searchsorted(self.times, first, side="left")) - 1)
        while k < len(self) - 1 and self.times[k] <= last:
            found = self.told(k)
            parts.append(found[(found["time"] >= first) & (found["time"] <= last)])
            k += 1
        return np.concatenate(parts)

    def told(self, k: int) -> NDArray[Any]:
        """What happened between frames k and k + 1, (n,) EVENT."""
        place, follows = self._places[k], self._places[k + 1]
        end = np.inf  # what happened after it was undone by going back in time
        if not self._same_segment(place, follows):
            end = self.heads[follows]["time"]
        parts = [np.zeros(0, EVENT)]
        for between in range(place + 1, follows + 1):
            if not self._same_segment(place, between) or self.heads[between - 1]["time"] > end:
                break
            found = self.file.events(between)
            parts.append(found[found["time"] <= end])
        return np.concatenate(parts)

    def changed(self, k: int) -> bool:
        """Whether something was changed from outside between frames k and k + 1."""
        return not self._same_segment(self._places[k], self._places[k + 1])

    def _same_segment(self, a: int, b: int) -> bool:
        return bool(self.heads[a]["segment"] == self.heads[b]["segment"])

    # What is in the file.

    def place(self, k: int) -> int:
        """Where frame k is among all those in the file."""
        return self._places[k]

    def segment(self, place: int) -> Segment:
        """The segment to which a frame of the file belongs."""
        number = self.heads[place]["segment"]
        if self._segment is None or self._segment[0] != number:
            first = place
            while first > 0 and self._same_segment(first - 1, place):
                first -= 1
            built = layout.unpacked_state(self.file.read(first, layout.BUILT))
            around = layout.unpacked_surroundings(self.file.read(first, layout.SURROUNDINGS))
            self._segment = number, Segment(first, built, around)
        return self._segment[1]

    def _frame(self, place: int) -> Frame:
        segment, head = self.segment(place), self.heads[place]
        arrays: dict[str, Any] = {
            k: self.file.inherited(place, name) for k, name in layout.ARRAYS.items()
        }
        arrays["resting"] = arrays["resting"].view(np.bool_)
        counts: dict[str, Any] = {
            name: head[name] for name in ("time", "collisions", "wall_collisions")
        }
        rest = ("dissipated", "withheld", "max_overlap", "energy_drift", "missed")
        state = replace(segment.built, **arrays, **counts)
        return Frame(state, segment.surroundings, **{name: head[name] for name in rest})


def _in_order(heads: list[dict[str, Any]]) -> list[int]:
    """Places of the frames that count, in the order of time."""
    places: list[int] = []
    for place, head in enumerate(heads):
        goes_on = place > 0 and heads[place - 1]["segment"] == head["segment"]
        if goes_on and heads[place - 1]["time"] == head["time"]:
            places.pop()  # the last frame of a file comes again, with a checkpoint
        if not goes_on and places and head["time"] < heads[places[-1]]["time"]:
            while places and heads[places[-1]]["time"] >= head["time"]:
                places.pop()
        places.append(place)
    return places


def _taken(before: Frame, after: State) -> float:
    """Energy that inelastic collisions have taken between the two."""
    world = before.world
    if world.restitution == 1 and (world.walls["restitution"] == 1).all():
        return 0.0
    return mechanics.energy(before.state, world) - mechanics.energy(after, world)
