"""The same scene seen from elsewhere, on the move, renamed, turned, rescaled or run backwards."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from hypothesis import assume, given, settings
from tests.oracle.comparison import CHAOS, aside, differs, run, slow_bounces, strong

from carom.engine import FastEngine
from carom.rules import Smooth
from carom.state import State
from carom.walls import Box, Periodic, Plane
from carom.world import CYLINDER, PLANE, World

from . import gallery

LAW = settings(max_examples=200, derandomize=True, deadline=None)
EACH, UNTIL = 8, 40.0  #: events for each sphere, and time, after which runs end

STRAIGHT = [
    both for both in gallery.WALLS if all(isinstance(w, (Box, Periodic, Plane)) for w in both)
]


class Story(NamedTuple):
    """What an engine told until some time."""

    events: np.ndarray
    time: float
    collapsed: bool


def story(state: State, world: World, until: float | None = None) -> Story:
    """The first events, or all those until a time that another story has reached."""
    engine = FastEngine(state, world)
    run(engine, until or UNTIL, EACH * len(state) * (2 if until else 1) + (100 if until else 0))
    return Story(engine.take_events(), engine.time, engine.collapse is not None)


def burst(events: np.ndarray) -> int:
    """Where eight events happen in one moment, and rounding decides when there are enough.

    That is how three spheres stick to one another (e = 0): collapses within the resolution.
    """
    short = events["time"][7:] - events["time"][:-7] < 1e-9
    return int(np.argmax(short)) if short.any() else len(events)


def same(state: State, world: World, a: Story, b: Story, noise: float = 0.0) -> bool:
    """Whether a and b tell the same collisions, for as long as a twin of a agrees with it.

    The twin starts 1e-12 aside. Of two events at one time either may come first by rounding.
    """
    twin = story(aside(state), world, a.time)
    told, other, beside = (strong(tale.events, world) for tale in (a, b, twin))
    rounding = (1e-9 if not slow_bounces(world) else 1e-7) + noise
    sensitivity = 0.0
    for k, event in enumerate(told[: burst(told)]):
        sensitivity = max(sensitivity, differs(event, beside[k]) if k < len(beside) else np.inf)
        if sensitivity > CHAOS or a.time - event["time"] < 10.0 * rounding:
            return True
        missing = k >= len(other)
        if missing or differs(event, other[k]) > rounding + 10.0 * sensitivity:
            ties = np.sum(np.abs(told["time"] - event["time"]) < rounding) > 1
            return bool(ties) or a.collapsed or b.collapsed or twin.collapsed
    return True


def events_like(events: np.ndarray, **columns: np.ndarray) -> np.ndarray:
    """The records with some columns replaced."""
    result = events.copy()
    for name, values in columns.items():
        result[name] = values
    return result


@LAW
@given(gallery.anything())
def test_names_do_not_matter(setting):
    """Spheres in another order: the same events; ties may change their order."""
    state, world = setting.build()
    n = len(state)
    order = np.random.default_rng(n).permutation(n)
    renamed = State(*(getattr(state, name)[order] for name in State.__slots__[:10]), *(0.0, 0, 0))
    first = story(state, world)
    other = story(renamed, world, first.time)
    told = other.events
    i, pair = order[told["i"]], told["j"] >= 0
    j = np.where(pair, order[np.where(pair, told["j"], 0)], told["j"])
    swapped = pair & (i > j)
    back = events_like(
        told,
        i=np.where(swapped, j, i),
        j=np.where(swapped, i, j),
        impulse=np.where(swapped[:, None], -told["impulse"], told["impulse"]),
    )
    assert same(state, world, first, other._replace(events=back))


@LAW
@given(gallery.anything())
def test_axes_do_not_matter(setting):
    """x, y and z change places; those of a cylinder, x and y."""
    state, world = setting.build()
    axes = [1, 0, 2] if (world.walls["kind"] == CYLINDER).any() else [2, 0, 1]
    turned, hard = state.copy(), world.walls.copy()
    for name in ("position", "velocity", "image"):
        getattr(turned, name)[:] = getattr(state, name)[:, axes]
    hard["normal"] = hard["normal"][:, axes]
    there = replace(world, walls=hard, period=world.period[axes], gravity=world.gravity[axes])
    first = story(state, world)
    other = story(turned, there, first.time)
    back = events_like(other.events, impulse=other.events["impulse"][:, np.argsort(axes)])
    assert same(state, world, first, other._replace(events=back))


@LAW
@given(gallery.settings(STRAIGHT + gallery.FREE))
def test_places_do_not_matter(setting):
    """All spheres and planes are moved, against the origin and the borders of periodic boxes."""
    state, world = setting.build()
    shift = np.array([0.37, -1.9, 4.2])
    moved, hard = state.copy(), world.walls.copy()
    moved.position += shift
    boxes = np.rint(moved.position / np.where(world.period > 0, world.period, np.inf))
    moved.position -= boxes * world.period
    hard["offset"] += hard["normal"] @ shift
    first = story(state, world)
    other = story(moved, replace(world, walls=hard), first.time)
    assert same(state, world, first, other, noise=1e-13)


@LAW
@given(gallery.settings(gallery.FREE, fixed=[0]))
def test_the_observer_may_move(setting):
    """Galileo's principle, in open and periodic space, with gravity too."""
    state, world = setting.build()
    boosted = state.copy()
    boosted.velocity += (3.0, -7.0, 1.5)
    first = story(state, world)
    assert same(state, world, first, story(boosted, world, first.time), noise=1e-11)


def solves_quartics(state: State, world: World) -> bool:
    """Curved walls, or partners of which one does not fall because it is fixed or rests."""
    curved = (world.walls["kind"] != PLANE).any()
    may_rest = (world.walls["restitution"] < 1.0).any()
    return bool(world.gravity.any() and (curved or state.fixed.any() or may_rest))


@LAW
@given(gallery.anything())
def test_units_do_not_matter(setting):
    """Powers of two in time, length and mass change no bit but exponents.

    Where a quartic is solved, its root is the same but for the last bits.
    """
    state, world = setting.build()
    time, length, mass = 0.25, 8.0, 2.0
    speed = length / time
    scaled, hard = state.copy(), world.walls.copy()
    scaled.position *= length
    scaled.radius *= length
    scaled.velocity *= speed
    scaled.mass *= mass
    hard["offset"] *= length
    there = replace(
        world,
        walls=hard,
        period=world.period * length,
        gravity=world.gravity * (speed / time),
        contact_time=world.contact_time * time,
    )
    first = story(state, world)
    other = story(scaled, there, first.time * time * (1 + 1e-12))  # the last event is before
    back = events_like(
        other.events,
        time=other.events["time"] / time,
        impulse=other.events["impulse"] / (mass * speed),
    )
    if solves_quartics(state, world):
        assert same(state, world, first, other._replace(events=back))
    else:
        assert back[: len(first.events)].tobytes() == first.events.tobytes()


@LAW
@given(
    gallery.settings(gallery.ELASTIC, rules=[Smooth()]) | gallery.known(),
)
def test_time_may_run_backwards(setting):
    """Elastic worlds go back to where they came from, as near as their own chaos lets them."""
    state, world = setting.build()
    world = gallery.elastic(world)
    there, twin = FastEngine(state, world), FastEngine(aside(state), world)
    run(there, 100.0, 5 * len(state))
    assume(there.collisions + there.wall_collisions > 0)
    run(there, there.time + 1e-3)
    run(twin, there.time)
    middle = there.state()
    growth = np.abs(middle.position - twin.state().position).max() / 1e-12
    assume(growth < 1e7)
    turned = middle.copy()
    turned.velocity *= -1.0
    back = FastEngine(turned, world)
    run(back, 2.0 * there.time - 1e-9)  # not to what happens in the very moment of the start
    end = back.state()
    assert (end.collision_count - middle.collision_count == middle.collision_count).all()
    run(back, 2.0 * there.time)
    end = back.state()
    moved = end.position + (end.image - state.image) * world.period - state.position
    assert np.abs(moved).max() < 1e-12 * (10.0 + growth) * max(1.0, there.time)
