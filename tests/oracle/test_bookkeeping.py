"""Random scenes of every kind, with random bookkeeping: the same bits, and no collision missed."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from carom import _core, engine
from carom.engine import FastEngine

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


bookkeeping = st.fixed_dictionaries(
    {
        "simd": st.sampled_from(_core.simd_levels()),
        "grid": st.sampled_from([0, 1]),
        "sort": st.booleans(),
        "margin": st.just(0.0) | st.floats(0.01, 3.0),
        "cell": st.just(0.0) | st.floats(0.5, 8.0),
        "slice_seconds": st.sampled_from([0.05, 1e-6]),
    }
)


def told(recipe: Recipe, options: dict[str, Any], events: int) -> tuple[bytes, ...]:
    """All that a run shows, as bytes: in pieces, so that structures are checked in between."""
    state, world = recipe.build()
    fast = FastEngine(state, world, **options)
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
    assert told(recipe, options, 120) == told(recipe, {}, 120)


@EXAMPLES
@given(
    recipes(
        surroundings="open",
        periodic=(True, True, True),
        gravity=0.0,
        fixed=0,
        restitution=1.0,
        collide=True,
        size_ratio=1.0,
    ).map(lambda recipe: larger(recipe, 60)),
    bookkeeping,
)
def test_gases_large_enough_for_a_grid(recipe, options):
    assert told(recipe, options | {"grid": 1}, 600) == told(recipe, {"grid": 0}, 600)


@EXAMPLES
@given(
    recipes(surroundings="box", gravity=0.0, collide=True).map(lambda recipe: larger(recipe, 60)),
    bookkeeping,
)
def test_gases_in_a_box(recipe, options):
    assert told(recipe, options | {"grid": 1}, 600) == told(recipe, {"grid": 0}, 600)


def larger(recipe: Recipe, spheres: int) -> Recipe:
    """The same with so many spheres, and room for them."""
    fields = {**vars(recipe), "spheres": spheres}
    fields["roominess"] = max(1.3, recipe.roominess) * math.sqrt(recipe.roominess)
    return Recipe(**fields)
