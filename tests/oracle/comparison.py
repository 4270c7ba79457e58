"""Following two engines event by event, as far as arithmetic in doubles lets them agree."""

import math

import numpy as np

from carom.engine import Engine, FastEngine, Stop
from carom.reference.exact import ExactEngine
from carom.state import State
from carom.world import World

#: Scenes move with momenta of about 1. A collision this weak is decided by rounding: spheres
#: that stick (e = 0) or rest touch again, or not, in the last bit.
WEAK = 1e-6

#: Farther than this from a twin that starts 1e-12 aside, a flight has forgotten its start.
CHAOS = 1e-6


def run(engine: Engine, until: float, events: int | None = None) -> Stop:
    """Run to `until` or until so many events are done."""
    goal = math.inf
    if events is not None:
        goal = engine.collisions + engine.wall_collisions + events
    while True:
        left = goal - engine.collisions - engine.wall_collisions
        limit = {} if events is None else {"max_events": left}
        stop = engine.advance(until, **limit)
        if stop is not Stop.SLICE:
            return stop


def strong(events: np.ndarray, world: World) -> np.ndarray:
    """The events that are not mere touches.

    In the contact-time model a touch changes what the next collision does: there, the events
    before the first touch.
    """
    weak = np.linalg.norm(events["impulse"], axis=1) < WEAK
    if world.contact_time > 0.0 and weak.any():
        return events[: np.argmax(weak)]
    return events[~weak]


def aside(state: State) -> State:
    """The same scene, its free spheres moved by 1e-12."""
    moved = state.copy()
    shift = 1e-12 * np.random.default_rng(0).normal(size=state.position.shape)
    moved.position[~state.fixed] += shift[~state.fixed]
    return moved


def differs(a: np.void, b: np.void) -> float:
    """How far two records of the same collision are apart; inf if they are not the same one."""
    if (a["i"], a["j"]) != (b["i"], b["j"]):
        return math.inf
    return max(abs(a["time"] - b["time"]), np.abs(a["impulse"] - b["impulse"]).max())


def agreement(
    state: State, world: World, *, until: float = 50.0, events: int | None = None
) -> tuple[int, int]:
    """Run both engines and a twin; assert that they agree while the twin says they should.

    Returns
    -------
    tuple of int
        Events compared, and events there were.
    """
    reference = ExactEngine(state, world)
    events = 8 * len(state) if events is None else events
    stop = run(reference, until, events)
    fast, twin = FastEngine(state, world), ExactEngine(aside(state), world)
    most = 2 * events + 100  # a twin may take a path with endless small bounces
    stops = [stop, run(fast, reference.time, most), run(twin, reference.time, most)]
    records = [engine.take_events() for engine in (reference, fast, twin)]
    story, told, other = (strong(events, world) for events in records)
    # Touches, rests and micro-hops turn a rounding of 1e-16 in a position into 1e-8 in a time.
    rounding = 1e-9 if not slow_bounces(world) else 1e-7
    sensitivity = 0.0
    for k, event in enumerate(story):
        sensitivity = max(sensitivity, differs(event, other[k]) if k < len(other) else math.inf)
        if sensitivity > CHAOS or reference.time - event["time"] < 10.0 * rounding:
            return k, len(story)
        if k == len(told):
            assert world.contact_time > 0.0 or begins_to_collapse(fast, records[0]), event
            return k, len(story)
        if differs(event, told[k]) > rounding + 10.0 * sensitivity:
            # Of two events at one time either may come first by rounding, and then all is lost.
            assert np.sum(np.abs(story["time"] - event["time"]) < rounding) > 1, (event, told[k])
            return k, len(story)
    if Stop.COLLAPSE not in stops and world.contact_time == 0.0:
        # A sticky sphere pinched between another and a sticky wall is pushed to and fro by ever
        # smaller impulses; which of them is the last, rounding decides.
        pinched = world.restitution < 0.5 and np.any(world.walls["restitution"] < 0.5)
        assert same_end(reference, fast, twin, world, 1e-5 if pinched else rounding)
    return len(story), len(story)


def begins_to_collapse(engine: Engine, events: np.ndarray) -> bool:
    """Whether the engine saw a collapse where the other one saw ten collisions at one time.

    With e near 0 a group of three ends its many collisions near the twentieth, which is one
    too many, in the noise.
    """
    if engine.collapse is None:
        return False
    return bool(np.sum(np.abs(events["time"] - engine.collapse[0]) < 1e-7) >= 10)


def slow_bounces(world: World) -> bool:
    """Whether spheres may stick, come to rest, or hop along a wall or along a fixed sphere."""
    damped = world.restitution < 1.0 and np.any(world.gravity)
    return bool(damped or world.restitution < 0.5 or np.any(world.walls["restitution"] < 1.0))


def same_end(reference: Engine, fast: Engine, twin: Engine, world: World, rounding: float) -> bool:
    """Whether both engines are in the same state, as nearly as the twin lets one ask."""
    a, b, c = reference.state(), fast.state(), twin.state()
    x, y, z = (s.position + s.image * world.period for s in (a, b, c))
    allowed = rounding + 10.0 * (np.abs(x - z).max() + np.abs(a.velocity - c.velocity).max())
    energy = [engine.dissipated + engine.withheld for engine in (reference, fast)]
    return bool(
        np.abs(x - y).max() < allowed
        and np.abs(a.velocity - b.velocity).max() < 10.0 * allowed + WEAK
        and abs(energy[0] - energy[1]) < 10.0 * allowed + WEAK
        and abs(reference.max_overlap() - fast.max_overlap()) < 1e-9
    )
