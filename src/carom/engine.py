"""The contract every engine keeps, and the fast one behind it."""

import os
import threading
from dataclasses import replace
from enum import IntEnum
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from carom._core import Engine as _Core
from carom.errors import InputError
from carom.state import EVENT, State
from carom.world import World

NO_LIMIT = 2**62
#: Arrays of a state that no engine changes: all states of one share them, read-only.
UNCHANGING = ("mass", "radius", "species", "color", "fixed")

# CAROM_CHECK=1 lets the core compare its structures with one another after every slice.
_CHECK = os.environ.get("CAROM_CHECK") == "1"


class Stop(IntEnum):
    """Why `advance` returned."""

    TIME = 0  #: the asked-for time is reached
    COUNT = 1  #: the asked-for number of collisions or events is done
    SLICE = 2  #: the time slice is over or the log is full: call again
    IDLE = 3  #: nothing will ever happen again, and `until` is infinite
    COLLAPSE = 4  #: inelastic collapse, see `Engine.collapse`


class Engine(Protocol):
    """Moves spheres from one collision to the next.

    An engine is built from a state and a world. It never rounds a time to a step: after
    ``advance(until=t)`` that stops with `Stop.TIME` its state is exactly at t.
    """

    def __init__(self, state: State, world: World) -> None: ...

    @property
    def time(self) -> float:
        """Simulated time now."""

    @property
    def collisions(self) -> int:
        """Sphere-sphere collisions since the scene began."""

    @property
    def wall_collisions(self) -> int:
        """Collisions with walls since the scene began."""

    @property
    def dissipated(self) -> float:
        """Energy the rules have taken since this engine was built (negative: given)."""

    @property
    def withheld(self) -> float:
        """Energy the contact-time cure has kept from being dissipated."""

    @property
    def collapse(self) -> tuple[float, int, int] | None:
        """(time, i, j) of an inelastic collapse, j as in event records; None if there is none."""

    def advance(
        self, until: float, max_collisions: int = NO_LIMIT, max_events: int = NO_LIMIT
    ) -> Stop:
        """Run to `until`, or until that many collisions (or events, walls included) happened.

        Returns early with `Stop.SLICE` after about 50 ms of work; counts are per call. A time that
        is past, or nan, is an `InputError`.
        """

    def take_events(self) -> NDArray[Any]:
        """Records (dtype `EVENT`, **absolute** times) of all events since the last call."""

    def state(self) -> State:
        """A copy of the state at `time`."""

    def max_overlap(self) -> float:
        """Largest (sigma - r) / sigma over executed collisions and pairs now near each other.

        0 if nothing was ever closer than touching.
        """


@runtime_checkable
class Resumable(Protocol):
    """What an engine may have besides, so that a run can be taken up again with the same bits."""

    def checkpoint(self) -> bytes:
        """The stored states as they are: `restore` then continues with the same bits."""

    def restore(self, checkpoint: bytes) -> None:
        """Continue from a checkpoint of an engine built from the same state and world."""


def _unchanging(state: State) -> State:
    """What of the state no engine changes, read-only; the other arrays are empty."""
    kept = State.empty()
    for name in UNCHANGING:
        array = getattr(state, name)
        if len(array) and (array == array[0]).all():  # one number for all
            setattr(kept, name, np.broadcast_to(array[:1].copy(), array.shape))
        else:
            setattr(kept, name, array.copy())
            getattr(kept, name).flags.writeable = False
    kept.collisions, kept.wall_collisions = state.collisions, state.wall_collisions
    return kept


class FastEngine:
    """The engine in C++: calendar queue, neighbour lists, exact contact times.

    Cost per collision does not grow with the number of spheres. `log=False` keeps no event
    records. `margin`, `cell`, `slice_seconds`, `simd` (the instruction set), `sort` (neighbours in
    space become neighbours in memory), `grid` (1: neighbours on a grid where that can be, 0: in
    lists, -1: whichever is faster) and `ahead` (1: look ahead at what coming events will touch, and
    solve for their times no sooner, 0: do not, -1: where spheres come from memory) are bookkeeping
    for tests: the trajectory's bits do not depend on them; `profile` asks how long each part takes.
    Any thread may call it: a call waits for the slice in hand.
    """

    def __init__(
        self,
        state: State,
        world: World,
        *,
        log: bool = True,
        margin: float = 0.0,
        cell: float = 0.0,
        slice_seconds: float = 0.05,
        simd: str = "",
        sort: bool = True,
        grid: int = -1,
        ahead: int = -1,
        profile: bool = False,
    ) -> None:
        self._start = _unchanging(state)
        self._lock = threading.Lock()  # the core runs without the GIL
        walls = np.column_stack(
            [
                world.walls["kind"],
                world.walls["bounce_back"],
                world.walls["normal"].reshape(-1, 3),
                world.walls["offset"],
                world.walls["restitution"],
            ]
        )
        try:
            self._core = _Core(
                position=np.ascontiguousarray(state.position, np.float64),
                velocity=np.ascontiguousarray(state.velocity, np.float64),
                mass=np.ascontiguousarray(state.mass, np.float64),
                radius=np.ascontiguousarray(state.radius, np.float64),
                fixed=np.ascontiguousarray(state.fixed, np.bool_),
                resting=np.ascontiguousarray(state.resting, np.bool_),
                image=np.ascontiguousarray(state.image, np.int32),
                count=np.ascontiguousarray(state.collision_count, np.uint32),
                time=state.time,
                period=np.ascontiguousarray(world.period, np.float64),
                walls=np.ascontiguousarray(walls, np.float64),
                restitution=world.restitution,
                contact_time=world.contact_time,
                gravity=np.ascontiguousarray(world.gravity, np.float64),
                collide=world.collide,
                margin=margin,
                cell=cell,
                log=log,
                slice=slice_seconds,
                simd=simd,
                sort=sort,
                grid=grid,
                ahead=ahead,
                profile=profile,
            )
        except ValueError as error:  # such as an instruction set that this machine does not have
            raise InputError(str(error)) from None

    @property
    def time(self) -> float:
        """Simulated time now."""
        return self._core.time

    @property
    def collisions(self) -> int:
        """Sphere-sphere collisions since the scene began."""
        return self._start.collisions + self._core.collisions

    @property
    def wall_collisions(self) -> int:
        """Collisions with walls since the scene began."""
        return self._start.wall_collisions + self._core.wall_collisions

    @property
    def dissipated(self) -> float:
        """Energy the rules have taken since this engine was built (negative: given)."""
        return self._core.dissipated

    @property
    def withheld(self) -> float:
        """Energy the contact-time cure has kept from being dissipated."""
        return self._core.withheld

    @property
    def collapse(self) -> tuple[float, int, int] | None:
        """(time, i, j) of an inelastic collapse, j as in event records; None if there is none."""
        return self._core.collapse

    def profile(self) -> dict[str, float]:
        """Seconds spent so far in each part of the work, if built with `profile=True`.

        `predict` events, `rebuild` lists of neighbours or change cells, `queue`, `collide`: an
        estimate from every 61st event.
        """
        return self._core.profile()

    def work(self) -> dict[str, int]:
        """How often it has done what.

        `predictions`; `shells` remade, or cells crossed; `stale`, those predicted anew because the
        partner was hit by another; `exact`, pairs solved exactly.
        """
        return self._core.work()

    @property
    def memory(self) -> int:
        """Memory the engine holds, in bytes."""
        return self._core.memory

    def advance(
        self, until: float, max_collisions: int = NO_LIMIT, max_events: int = NO_LIMIT
    ) -> Stop:
        """Run to `until` or a count; see `Engine.advance`."""
        if not until >= self.time:
            msg = f"cannot advance to time {until}: it is already {self.time}; give a later time"
            raise InputError(msg)
        with self._lock:
            stop = Stop(self._core.advance(until, max_collisions, max_events))
            if _CHECK:
                self._core.check()
        return stop

    def take_events(self) -> NDArray[Any]:
        """Records (dtype `EVENT`, absolute times) of all events since the last call."""
        with self._lock:
            raw = self._core.take_log()
        events: NDArray[Any] = raw.view(EVENT)
        return events

    def state(self) -> State:
        """A copy of the state at `time`; what never changes in it is read-only."""
        with self._lock:
            position, velocity, image, count, resting = self._core.state()
            time, collisions, wall_collisions = self.time, self.collisions, self.wall_collisions
        return replace(
            self._start,
            position=position,
            velocity=velocity,
            image=image,
            collision_count=count,
            resting=resting.view(np.bool_),
            time=time,
            collisions=collisions,
            wall_collisions=wall_collisions,
        )

    def max_overlap(self) -> float:
        """Largest (sigma - r) / sigma met in a collision or between neighbours now."""
        with self._lock:
            return self._core.max_overlap()

    def checkpoint(self) -> bytes:
        """The stored states as they are: `restore` then continues with the same bits."""
        with self._lock:
            return self._core.checkpoint()

    def restore(self, checkpoint: bytes) -> None:
        """Continue from a checkpoint of an engine built from the same state and world."""
        with self._lock:
            self._core.restore(checkpoint)
