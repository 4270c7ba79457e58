"""The fast engine does what the readable one does, event by event, in scenes of every kind."""

import numpy as np
from hypothesis import given, settings

from .comparison import agreement
from .strategies import SURROUNDINGS, Recipe, recipes

EXAMPLES = settings(max_examples=150, derandomize=True, deadline=None)


def check(recipe: Recipe) -> tuple[int, int]:
    state, world = recipe.build()
    return agreement(state, world)


@EXAMPLES
@given(recipes())
def test_any_scene(recipe):
    check(recipe)


@EXAMPLES
@given(recipes(surroundings="open", periodic=(True, True, True), gravity=0.0))
def test_periodic_boxes(recipe):
    check(recipe)


@EXAMPLES
@given(recipes(roominess=0.2, spheres=2, surroundings="box", fixed=0))
def test_two_spheres_that_meet_in_several_images(recipe):
    check(recipe)


@EXAMPLES
@given(recipes(surroundings="sphere"))
def test_spherical_containers(recipe):
    check(recipe)


@EXAMPLES
@given(recipes(surroundings="cylinder"))
def test_cylinders(recipe):
    check(recipe)


@EXAMPLES
@given(recipes(surroundings="planes", gravity=5.0, straight_down=False))
def test_tilted_planes_under_gravity(recipe):
    check(recipe)


@EXAMPLES
@given(recipes(surroundings="box", gravity=5.0, straight_down=True, wall_restitution=0.3))
def test_coming_to_rest(recipe):
    check(recipe)


@EXAMPLES
@given(recipes(fixed=2, gravity=1.0, collide=True))
def test_gravity_and_fixed_spheres(recipe):
    check(recipe)


@EXAMPLES
@given(recipes(contact_time=0.3, restitution=0.7, wall_restitution=0.9, collide=True))
def test_contact_time(recipe):
    check(recipe)


def test_most_events_are_compared():
    """The comparison stops at chaos; it must not stop too early to mean anything."""
    rng = np.random.default_rng(3)
    compared, total = 0, 0
    for surroundings in SURROUNDINGS:
        for seed in range(10):
            recipe = Recipe(
                seed=seed,
                spheres=8,
                surroundings=surroundings,
                periodic=tuple(rng.random(3) < 0.5),
                roominess=1.2,
                restitution=rng.choice([1.0, 0.9]),
                wall_restitution=rng.choice([1.0, 0.9]),
                bounce_back=bool(rng.random() < 0.3),
                contact_time=0.0,
                gravity=rng.choice([0.0, 1.0]),
                straight_down=True,
                fixed=0,
                size_ratio=2.0,
                collide=True,
            )
            followed, happened = check(recipe)
            compared, total = compared + followed, total + happened
    assert total > 1000
    assert compared > 0.8 * total
