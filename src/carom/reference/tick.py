"""The paper's method: move every ball by one tick, then see what overlaps.

From T. J. Liggett, *Three-Dimensional Collisions in Java* (2017). It is kept as it is, flaws
included, so that it can be watched beside exact motion: contacts are noticed up to a tick late,
fast balls tunnel, a ball outside a wall by more than one tick's motion flips every tick.
"""

import math
import pickle
from collections.abc import Iterator
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.engine import NO_LIMIT, FastEngine, Stop
from carom.errors import InputError
from carom.reference.body import Wall, vector, walls_of
from carom.reference.periodic import wrapped
from carom.state import EVENT, State
from carom.vector import Vector
from carom.world import CYLINDER, PLANE, World

Pair = tuple[int, int]

SLICE_SECONDS = 0.05


class Ball:
    """One ball: where it is and how it moves.

    Attributes
    ----------
    location, velocity : Vector
    radius, mass : float
    inverse_mass : float
        0 for a ball that nothing moves.
    image : tuple of int
        Whole boxes travelled along each periodic axis.
    """

    __slots__ = ("image", "inverse_mass", "location", "mass", "radius", "velocity")

    def __init__(self, state: State, i: int) -> None:
        self.location = Vector(*state.position[i].tolist())
        self.velocity = Vector(*state.velocity[i].tolist())
        self.radius = float(state.radius[i])
        self.mass = float(state.mass[i])
        self.inverse_mass = 0.0 if state.fixed[i] else 1.0 / self.mass
        x, y, z = state.image[i].tolist()
        self.image = (x, y, z)

    def move(self, tick: float, gravity: Vector) -> None:
        """Fall for one tick, then go where the velocity leads in it."""
        self.velocity = self.velocity.add(gravity.mult(tick))
        self.location = self.location.add(self.velocity.mult(tick))

    def push(self, impulse: Vector) -> None:
        """Change the velocity by an impulse."""
        self.velocity = self.velocity.add(impulse.mult(self.inverse_mass))

    def normal_outside(self, wall: Wall) -> Vector | None:
        """Unit normal of a wall, into the gas, if the ball reaches beyond the wall."""
        if wall.kind == PLANE:
            normal = Vector(*wall.normal)
            outside = normal.dot(self.location) - self.radius < wall.offset
            return normal if outside else None
        across = Vector(*self.location) if wall.kind != CYLINDER else _flat(self.location)
        outside = across.mag() + self.radius > wall.offset
        return across.normalize().mult(-1.0) if outside else None


class TickEngine:
    """Ball motion in ticks, as in the paper, with the contract of every engine.

    Parameters
    ----------
    state : State
        Pairs that overlap in it count as contacts already resolved.
    world : World
        A contact time has no meaning here: ticks cannot collapse. Nothing comes to rest.
    tick : float
        Length of a tick. The one before `advance`'s end is shortened to stop exactly there.
    count_missed : bool
        Also fly each tick exactly and count what the ticks do not see, in `missed`.

    Attributes
    ----------
    missed : int
        Pairs that exact flight from this run's own states makes collide within a tick and that the
        tick does not register, once per tick; 0 unless `count_missed`.

    Notes
    -----
    All pairs are tested every tick, O(N^2). In a periodic world only nearest images are.

    Examples
    --------
    The contact at t = 1.5 is noticed at the end of the second tick, a fifth of a diameter too deep.

    >>> state = State.empty(2)
    >>> state.position[:, 0] = [-2.0, 2.0]
    >>> state.velocity[:, 0] = [1.0, -1.0]
    >>> engine = TickEngine(state, World(), tick=0.8)
    >>> engine.advance(until=4.0)
    <Stop.TIME: 0>
    >>> engine.take_events()["time"], round(engine.max_overlap(), 3)
    (array([1.6]), 0.2)
    """

    def __init__(
        self, state: State, world: World, tick: float = 1.0, *, count_missed: bool = False
    ) -> None:
        if not 0.0 < tick < math.inf:
            msg = f"a tick of {tick} is no time step; give a finite tick above 0"
            raise InputError(msg)
        self.missed = 0
        self._tick, self._count_missed = float(tick), count_missed
        self._given, self._world = state.copy(), world
        self._given.resting[:] = False
        self._balls = [Ball(state, i) for i in range(len(state))]
        self._walls = walls_of(world)
        self._gravity = Vector(*vector(world.gravity))
        self._time = float(state.time)
        self._collisions = int(state.collisions)
        self._wall_collisions = int(state.wall_collisions)
        self._dissipated = 0.0
        self._deepest = 0.0
        self._log: list[tuple[float, int, int, tuple[float, ...]]] = []
        self._active: set[Pair] = set(self._overlapping())

    @property
    def time(self) -> float:
        """Simulated time now."""
        return self._time

    @property
    def collisions(self) -> int:
        """Sphere-sphere contacts registered since the scene began."""
        return self._collisions

    @property
    def wall_collisions(self) -> int:
        """Reversals at walls since the scene began."""
        return self._wall_collisions

    @property
    def dissipated(self) -> float:
        """Energy the rules have taken; the method's own errors are not in it."""
        return self._dissipated

    @property
    def withheld(self) -> float:
        """Always 0: there is no contact-time cure in ticks."""
        return 0.0

    @property
    def collapse(self) -> tuple[float, int, int] | None:
        """Always None: ticks cannot collapse."""
        return None

    def advance(
        self, until: float, max_collisions: int = NO_LIMIT, max_events: int = NO_LIMIT
    ) -> Stop:
        """Run to `until`, or to the end of the tick in which the counts are reached.

        Raises
        ------
        InputError
            `until` lies in the past.
        """
        if not until >= self._time:
            msg = (
                f"cannot advance to {until}: the time is {self._time} already; ask for a later one"
            )
            raise InputError(msg)
        deadline = perf_counter() + SLICE_SECONDS
        pairs, walls = self._collisions, self._wall_collisions
        while True:
            collisions = self._collisions - pairs
            if collisions >= max_collisions:
                return Stop.COUNT
            if collisions + self._wall_collisions - walls >= max_events:
                return Stop.COUNT
            if self._time >= until:
                return Stop.TIME
            if until == math.inf and self._still():
                return Stop.IDLE
            # A last tick longer by rounding, not another one of no length.
            last = until - self._time <= self._tick * (1.0 + 1e-9)
            self._one_tick(float(until) if last else self._time + self._tick)
            if perf_counter() > deadline:
                return Stop.SLICE

    def take_events(self) -> NDArray[Any]:
        """Records (dtype `EVENT`, absolute times) of all events since the last call.

        Their time is the end of the tick that noticed them.
        """
        events = np.array(self._log, dtype=EVENT)
        self._log.clear()
        return events

    def state(self) -> State:
        """A copy of the state at `time`."""
        state = self._given.copy()
        for i, ball in enumerate(self._balls):
            state.position[i] = tuple(ball.location)
            state.velocity[i] = tuple(ball.velocity)
            state.image[i] = ball.image
        state.time = self._time
        state.collisions = self._collisions
        state.wall_collisions = self._wall_collisions
        return state

    def max_overlap(self) -> float:
        """Largest (sigma - r) / sigma at the end of any tick; 0 if nothing ever overlapped."""
        return self._deepest

    def checkpoint(self) -> bytes:
        """Everything the engine knows: `restore` then continues with the same bits."""
        return pickle.dumps(vars(self))

    def restore(self, checkpoint: bytes) -> None:
        """Continue from a checkpoint of an engine built from the same state and world."""
        vars(self).update(pickle.loads(checkpoint))

    def _still(self) -> bool:
        """Whether nothing moves and nothing pulls."""
        return self._gravity.mag() == 0.0 and all(b.velocity.mag() == 0.0 for b in self._balls)

    def _one_tick(self, end: float) -> None:
        """Move, reverse at walls, then look at all pairs."""
        exact = self._exact_collisions(end) if self._count_missed else set[Pair]()
        tick, self._time = end - self._time, end
        for i, ball in enumerate(self._balls):
            if ball.inverse_mass > 0.0:
                ball.move(tick, self._gravity)
                self._wrap(ball)
                self._meet_walls(i, ball)
        overlapping = set(self._overlapping())
        started = sorted(overlapping - self._active)
        for i, j in started:
            self._meet(i, j)
        # A pair stays in the set until it has parted, so no contact counts twice.
        self._active = overlapping
        self.missed += len(exact.difference(started))

    def _wrap(self, ball: Ball) -> None:
        """Bring a ball back into the periodic box."""
        period = vector(self._world.period)
        location, ball.image = wrapped(_tuple(ball.location), ball.image, period)
        ball.location = Vector(*location)

    def _meet_walls(self, i: int, ball: Ball) -> None:
        """Reverse the velocity, or its normal part, of a ball outside a wall: inbound or not."""
        for k, wall in enumerate(self._walls):
            normal = ball.normal_outside(wall)
            if normal is None:
                continue
            e = wall.restitution
            reversed_part = normal.mult(ball.velocity.dot(normal))
            if wall.bounce_back:
                reversed_part = ball.velocity
            ball.velocity = ball.velocity.sub(reversed_part.mult(1.0 + e))
            self._dissipated += 0.5 * ball.mass * (1.0 - e * e) * reversed_part.mag() ** 2
            self._given.collision_count[i] += 1
            self._wall_collisions += 1
            impulse = reversed_part.mult(-(1.0 + e) * ball.mass)
            self._log.append((self._time, i, -1 - k, tuple(impulse)))

    def _meet(self, i: int, j: int) -> None:
        """The paper's impulse along the line of centres, approaching or not.

        J = (1 + e) (v_a - v_b).n / (1/m_a + 1/m_b); v_a -= (J/m_a) n; v_b += (J/m_b) n.
        """
        a, b = self._balls[i], self._balls[j]
        v = a.velocity.sub(b.velocity)
        line = self._nearest(a.location.sub(b.location))
        if line.mag() == 0.0:  # one exactly on the other: they came along v
            line = v if v.mag() > 0.0 else Vector(1.0, 0.0, 0.0)
        n = line.normalize()
        psi = v.dot(n)
        e, mu = self._world.restitution, 1.0 / (a.inverse_mass + b.inverse_mass)
        impulse = n.mult(-(1.0 + e) * psi * mu)
        a.push(impulse)
        b.push(impulse.mult(-1.0))
        self._dissipated += 0.5 * mu * (1.0 - e * e) * psi * psi
        self._given.collision_count[[i, j]] += 1
        self._collisions += 1
        self._log.append((self._time, i, j, tuple(impulse)))

    def _nearest(self, line: Vector) -> Vector:
        """The line of centres to the nearest image."""
        nearest, _ = wrapped(_tuple(line), (0, 0, 0), vector(self._world.period))
        return Vector(*nearest)

    def _overlapping(self) -> Iterator[Pair]:
        """All pairs nearer than touching; remembers how deep they are."""
        if not self._world.collide or not self._balls:
            return
        x = np.array([tuple(ball.location) for ball in self._balls])
        radius, free = self._given.radius, ~self._given.fixed
        period = np.where(self._world.period > 0.0, self._world.period, np.inf)
        boxes = np.where(self._world.period > 0.0, self._world.period, 0.0)
        for i in range(len(x) - 1):
            r = x[i] - x[i + 1 :]
            r -= boxes * np.rint(r / period)
            sigma = radius[i] + radius[i + 1 :]
            depth = (sigma - np.sqrt((r * r).sum(axis=1))) / sigma
            hits = np.flatnonzero((depth > 0.0) & (free[i] | free[i + 1 :]))
            for k in hits.tolist():
                self._deepest = max(self._deepest, float(depth[k]))
                yield i, i + 1 + k

    def _exact_collisions(self, end: float) -> set[Pair]:
        """The pairs that exact flight from here makes collide before `end`."""
        engine = FastEngine(self.state(), self._world)
        while engine.advance(end) is Stop.SLICE:
            pass
        events = engine.take_events()
        # A touch exactly at the end is no overlap yet: it belongs to the next tick.
        events = events[(events["j"] >= 0) & (events["time"] < end)]
        return set(zip(events["i"].tolist(), events["j"].tolist(), strict=True))


def _flat(location: Vector) -> Vector:
    """The part of a location across the z axis."""
    return Vector(location.x, location.y)


def _tuple(v: Vector) -> tuple[float, float, float]:
    return (v.x, v.y, v.z)
