"""The readable twin of the fast engine: exact collisions, every pair asked, O(N) per event.

It is the oracle that the fast engine is tested against, so it is written for the eye: one
table holds the next event of every pair and of every sphere with every wall; the earliest is
carried out; the entries of the spheres it changed are worked out anew.
"""

import math
import pickle
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.engine import NO_LIMIT, Stop
from carom.errors import InputError
from carom.reference.body import Body, bodies_of, vector, walls_of
from carom.reference.impulse import Outcome, pair_outcome, wall_outcome
from carom.reference.periodic import (
    NO_IMAGE,
    Image,
    half_a_box,
    images_met,
    parted_for_ever,
    shifted,
    wrapped,
)
from carom.reference.times import NEVER, ZERO, Vec, dot, meeting, plus, sub
from carom.state import CAME_TO_REST, EVENT, WOKE, State
from carom.world import World

#: (time, i, j, image). Python's own order of tuples is the order of simultaneous events.
#: A pair whose image is None is not an event: it is only to be looked at again then.
Entry = tuple[float, int, int, Image | None]

SLICE_SECONDS = 0.05


class ExactEngine:
    """Exact event-driven motion in plain Python.

    Parameters
    ----------
    state : State
        Where the spheres are; touching and overlapping spheres are welcome.
    world : World
        Walls, rule, gravity.

    Notes
    -----
    Memory O(N^2). About a thousand events per second with 50 spheres.

    Examples
    --------
    >>> state = State.empty(2)
    >>> state.position[:, 0] = [-2.0, 2.0]
    >>> state.velocity[:, 0] = [1.0, -1.0]
    >>> engine = ExactEngine(state, World())
    >>> engine.advance(until=4.0)
    <Stop.TIME: 0>
    >>> engine.take_events()["time"]
    array([1.5])
    >>> engine.state().velocity[:, 0]
    array([-1.,  1.])
    """

    def __init__(self, state: State, world: World) -> None:
        self._given = state.copy()
        self._period = vector(world.period)
        self._gravity = vector(world.gravity)
        self._restitution = float(world.restitution)
        self._contact_time = float(world.contact_time)
        self._collide = bool(world.collide)
        self._walls = walls_of(world)
        self._bodies = bodies_of(state, world, self._walls)
        self._time = float(state.time)
        self._collisions = int(state.collisions)
        self._wall_collisions = int(state.wall_collisions)
        self._dissipated = 0.0
        self._withheld = 0.0
        self._deepest = 0.0
        self._collapse: tuple[float, int, int] | None = None
        self._log: list[tuple[float, int, int, Vec]] = []
        self._table: dict[tuple[int, int], Entry] = {}
        for i in range(len(self._bodies)):
            self._wrap(i)
            self._predict_walls(i)
            for j in range(i):
                self._predict_pair(j, i, self._time)

    @property
    def time(self) -> float:
        """Simulated time now."""
        return self._time

    @property
    def collisions(self) -> int:
        """Sphere-sphere collisions since the scene began."""
        return self._collisions

    @property
    def wall_collisions(self) -> int:
        """Collisions with walls since the scene began; coming to rest on one counts."""
        return self._wall_collisions

    @property
    def dissipated(self) -> float:
        """Energy the rules have taken since this engine was built (negative: given)."""
        return self._dissipated

    @property
    def withheld(self) -> float:
        """Energy the contact-time cure has kept from being dissipated."""
        return self._withheld

    @property
    def collapse(self) -> tuple[float, int, int] | None:
        """(time, i, j) of an inelastic collapse, j as in event records; None if there is none."""
        return self._collapse

    def advance(
        self, until: float, max_collisions: int = NO_LIMIT, max_events: int = NO_LIMIT
    ) -> Stop:
        """Run to `until`, events at `until` included, or until the counts are reached.

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
            if self._collapse is not None:
                return Stop.COLLAPSE
            if collisions >= max_collisions:
                return Stop.COUNT
            if collisions + self._wall_collisions - walls >= max_events:
                return Stop.COUNT
            entry = min(self._table.values(), default=None)
            if entry is None and until == NEVER:
                return Stop.IDLE
            if entry is None or entry[0] > until:
                self._time = float(until)
                return Stop.TIME
            self._carry_out(entry)
            if perf_counter() > deadline:
                return Stop.SLICE

    def take_events(self) -> NDArray[Any]:
        """Records (dtype `EVENT`, absolute times) of all events since the last call."""
        events = np.array(self._log, dtype=EVENT)
        self._log.clear()
        return events

    def state(self) -> State:
        """A copy of the state at `time`."""
        state = self._given.copy()
        for i, body in enumerate(self._bodies):
            position, velocity = body.at(self._time)
            state.position[i], state.image[i] = wrapped(position, body.image, self._period)
            state.velocity[i] = velocity
            state.collision_count[i] = body.collision_count
            state.resting[i] = body.resting_on is not None
        state.time = self._time
        state.collisions = self._collisions
        state.wall_collisions = self._wall_collisions
        return state

    def max_overlap(self) -> float:
        """Largest (sigma - r) / sigma over executed collisions and pairs now near each other."""
        deepest = self._deepest
        if not self._collide:
            return deepest
        places = [body.at(self._time)[0] for body in self._bodies]
        for j, b in enumerate(self._bodies):
            for i, a in enumerate(self._bodies[:j]):
                if a.fixed and b.fixed:
                    continue
                r, sigma = sub(places[i], places[j]), a.radius + b.radius
                for m in images_met(r, ZERO, self._period, sigma, 0.0, 0.0):
                    deepest = max(deepest, _depth(shifted(r, m, self._period), sigma))
        return deepest

    # What happens next

    def checkpoint(self) -> bytes:
        """Everything the engine knows: `restore` then continues with the same bits."""
        return pickle.dumps(vars(self))

    def restore(self, checkpoint: bytes) -> None:
        """Continue from a checkpoint of an engine built from the same state and world."""
        vars(self).update(pickle.loads(checkpoint))

    def _predict_pair(self, i: int, j: int, now: float) -> None:
        """Put the next meeting of i and j, in whatever image, into the table.

        In a periodic world only the images met until one of them has crossed half the box
        relative to the other are looked at; then the pair is looked at again. The time found
        for an image depends on the two stored states alone, not on when it was looked for.
        """
        self._table.pop((i, j), None)
        a, b = self._bodies[i], self._bodies[j]
        if not self._collide or (a.fixed and b.fixed):
            return
        start = max(a.time, b.time)
        (xa, va), (xb, vb) = a.at(start), b.at(start)
        r, v, g = sub(xa, xb), sub(va, vb), sub(a.acceleration, b.acceleration)
        sigma = a.radius + b.radius
        begin = now - start
        if begin > parted_for_ever(r, v, g, self._period, sigma * (1.0 + 1e-9)):
            return
        end = begin + half_a_box(v, self._period)
        found: list[Entry] = []
        for m in images_met(r, v, self._period, sigma, begin, end):
            just_met = self._just_met(i, j, m)
            t = meeting(shifted(r, m, self._period), v, g, sigma, just_met=just_met)
            if t <= end and t != NEVER:
                found.append((start + t, i, j, m))
        if found:
            self._table[i, j] = min(found)
        elif end != NEVER:
            self._table[i, j] = (start + end, i, j, None)

    def _just_met(self, i: int, j: int, m: Image) -> bool:
        """Whether the last event of both spheres is their own collision in this image."""
        a, b = self._bodies[i], self._bodies[j]
        return a.contact is not None and a.contact == b.contact == (i, j, self._boxes(a, b, m))

    def _predict_walls(self, i: int) -> None:
        """Put the next hit of sphere i on each wall into the table."""
        body = self._bodies[i]
        for k, wall in enumerate(self._walls):
            j = -1 - k
            self._table.pop((i, j), None)
            if body.fixed or body.resting_on == k:
                continue
            t = wall.time(body, just_hit=body.contact == (i, j, NO_IMAGE))
            if t != NEVER:
                self._table[i, j] = (body.time + t, i, j, NO_IMAGE)

    def _carry_out(self, entry: Entry) -> None:
        """Let one entry of the table happen."""
        time, i, j, m = entry
        if m is None:
            self._predict_pair(i, j, time)
            return
        self._time = time
        changed = [i] if j < 0 else [i, j]
        if j < 0:
            self._hit_wall(time, i, -1 - j)
        else:
            self._collide_pair(time, i, j, m)
        for k in changed:
            self._wrap(k)
        for k in changed:
            self._predict_walls(k)
            for other in range(len(self._bodies)):
                if other != k:
                    self._predict_pair(min(k, other), max(k, other), time)

    # What an event does

    def _collide_pair(self, time: float, i: int, j: int, m: Image) -> None:
        """Let spheres i and j collide in image m."""
        a, b = self._bodies[i], self._bodies[j]
        cured = self._in_contact(a, time) or self._in_contact(b, time)
        a.fly_to(time)
        b.fly_to(time)
        r = shifted(sub(a.position, b.position), m, self._period)
        speed = math.dist(a.velocity, b.velocity)
        outcome = pair_outcome(a, b, r, self._restitution, cured=cured)
        a.kick(outcome.impulse)
        b.kick(plus(ZERO, -1.0, outcome.impulse))
        a.contact = b.contact = (i, j, self._boxes(a, b, m))
        self._deepest = max(self._deepest, _depth(r, a.radius + b.radius))
        self._collisions += 1
        self._log.append((time, i, j, outcome.impulse))
        self._account(outcome)
        n = len(self._bodies)
        counted = outcome.inelastic and [x.collapses(time, speed, n) for x in (a, b)]
        if counted and any(counted):
            self._collapse = (time, i, j)
        self._wake(i, outcome.impulse)
        self._wake(j, outcome.impulse)

    def _hit_wall(self, time: float, i: int, k: int) -> None:
        """Let sphere i hit wall k, and perhaps come to rest there."""
        body, wall = self._bodies[i], self._walls[k]
        cured = self._in_contact(body, time)
        body.fly_to(time)
        speed = math.hypot(*body.velocity)
        after, outcome = wall_outcome(body, wall, self._gravity, cured=cured)
        body.kick(outcome.impulse)
        body.velocity = after  # exactly: what rests must not creep
        body.contact = (i, -1 - k, NO_IMAGE)
        self._wall_collisions += 1
        j = CAME_TO_REST - k if outcome.rests else -1 - k
        self._log.append((time, i, j, outcome.impulse))
        self._account(outcome)
        if outcome.inelastic and body.collapses(time, speed, len(self._bodies)):
            self._collapse = (time, i, -1 - k)
        self._wake(i, outcome.impulse)
        if outcome.rests:
            body.resting_on = k
            body.acceleration = ZERO

    def _account(self, outcome: Outcome) -> None:
        self._dissipated += outcome.dissipated
        self._withheld += outcome.withheld

    def _wake(self, i: int, impulse: Vec) -> None:
        """End the rest of sphere i if an impulse has a component along its floor's normal."""
        body = self._bodies[i]
        if body.resting_on is None:
            return
        if dot(impulse, self._walls[body.resting_on].normal) != 0.0:
            body.resting_on = None
            body.acceleration = self._gravity
            self._log.append((self._time, i, WOKE, ZERO))

    def _wrap(self, i: int) -> None:
        """Bring the stored position of sphere i back into the box."""
        body = self._bodies[i]
        body.position, body.image = wrapped(body.position, body.image, self._period)

    def _in_contact(self, body: Body, time: float) -> bool:
        """TC model: whether the sphere's last event is less than the contact time ago."""
        return body.contact is not None and time - body.time < self._contact_time

    def _boxes(self, a: Body, b: Body, m: Image) -> Image:
        """The image of a pair, counted between unwrapped positions: wrapping leaves it alone."""
        return (
            m[0] + a.image[0] - b.image[0],
            m[1] + a.image[1] - b.image[1],
            m[2] + a.image[2] - b.image[2],
        )


def _depth(r: Vec, sigma: float) -> float:
    """Overlap as a fraction of the distance at contact; negative if apart."""
    return (sigma - math.sqrt(dot(r, r))) / sigma
