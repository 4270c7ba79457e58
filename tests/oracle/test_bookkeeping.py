"""Random scenes of every kind, with random bookkeeping: the same bits, and no collision missed."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from carom import _core, engine
from carom.engine import FastEngine
from carom.state import State
from carom.world import World

from .comparison import run
from .strategies import Recipe, recipes

EXAMPLES = settings(
    max_examples=100,
    derandomize=True,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)


@pytest.fixture(autouse=True)
def _structures_are_checked(monkeypatch):
    monkeypatch.setattr(engine, "_CHECK", True)


FEWER = settings(EXAMPLES, max_examples=25)
Scene = tuple[State, World]

bookkeeping = st.fixed_dictionaries(
    {
        "simd": st.sampled_from(_core.simd_levels()),
        "grid": st.sampled_from([0, 1]),
        "ahead": st.sampled_from([0, 1]),
        "sort": st.booleans(),
        "margin": st.just(0.0) | st.floats(0.01, 3.0),
        "cell": st.just(0.0) | st.floats(0.5, 8.0),
        "slice_seconds": st.sampled_from([0.05, 1e-6]),
    }
)


def told(scene: Scene, options: dict[str, Any], events: int) -> tuple[bytes, ...]:
    """All that a run shows, as bytes: in pieces, so that structures are checked in between."""
    fast = FastEngine(*scene, **options)
    start = fast.collisions + fast.wall_collisions
    for part in (1, 2, 3, 4):
        left = events * part // 4 - (fast.collisions + fast.wall_collisions - start)
        if left > 0:
            run(fast, 50.0, left)
    end, records = fast.state(), fast.take_events()
    seen = (end.position, end.velocity, end.image, end.collision_count, end.resting)
    log = (records["i"], records["j"], records["impulse"])
    sums = np.array([end.time, fast.dissipated, fast.withheld])
    return tuple(np.ascontiguousarray(a).tobytes() for a in (*seen, *log, sums))


@EXAMPLES
@given(recipes(), bookkeeping)
def test_any_scene(recipe, options):
    scene = recipe.build()
    assert told(scene, options, 120) == told(scene, {}, 120)


@FEWER
@given(
    st.sampled_from([(True, True, True), (True, False, True), (False, False, False)]).flatmap(
        lambda periodic: recipes(
            surroundings="box",
            periodic=periodic,
            gravity=0.0,
            collide=True,
            size_ratio=1.0,
            spheres=250,
        )
    ),
    st.floats(1.5, 3.0),
    bookkeeping,
)
def test_gases_large_enough_for_a_grid(recipe, roominess, options):
    scene = replace(recipe, roominess=roominess).build()
    assert told(scene, options | {"grid": 1}, 1000) == told(scene, {"grid": 0}, 1000)


@pytest.mark.parametrize(
    ("options", "did"),
    [([{"grid": 0}, {"grid": 1}], "predictions"), ([{"ahead": 0}, {"ahead": 1}], "stale")],
    ids=["grid", "ahead"],
)
def test_something_else_was_done(options, did):
    scene = Recipe(
        seed=1,
        spheres=250,
        surroundings="box",
        periodic=(True, True, False),
        roominess=1.5,
        restitution=1.0,
        wall_restitution=1.0,
        bounce_back=False,
        contact_time=0.0,
        gravity=0.0,
        straight_down=False,
        fixed=1,
        size_ratio=1.0,
        collide=True,
    ).build()
    engines = [FastEngine(*scene, **({"grid": 1} | option)) for option in options]
    for fast in engines:
        run(fast, 50.0, 500)
    first, second = (fast.work() for fast in engines)
    assert abs(first[did] - second[did]) > 0.1 * first[did]
