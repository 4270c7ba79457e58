"""`carom.Vector`: the ten operations (their plain use is in the docstrings' examples)."""

import dataclasses
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import carom
from carom.errors import InputError
from carom.vector import Vector

EXAMPLES = settings(derandomize=True, deadline=None)

coordinates = st.floats(-1e6, 1e6)
vectors = st.builds(Vector, coordinates, coordinates, coordinates)


def test_it_is_the_public_vector():
    assert carom.Vector is Vector


@EXAMPLES
@given(vectors, vectors)
def test_subtracting_undoes_adding(a, b):
    assert a.add(b).sub(b).dist(a) <= 1e-9 * (1.0 + a.mag() + b.mag())


@EXAMPLES
@given(vectors, vectors)
def test_a_cross_product_is_perpendicular_to_both(a, b):
    c = a.cross(b)
    size = a.mag() * b.mag()
    assert abs(c.dot(a)) <= 1e-12 * size * a.mag()
    assert abs(c.dot(b)) <= 1e-12 * size * b.mag()
    # Lagrange: |a x b|^2 + (a . b)^2 = |a|^2 |b|^2
    assert math.hypot(c.mag(), a.dot(b)) == pytest.approx(size, rel=1e-9, abs=1e-300)


@EXAMPLES
@given(vectors.filter(lambda v: v.mag() > 1e-100))
def test_a_normalized_vector_has_length_one_and_the_same_direction(v):
    unit = v.normalize()
    assert unit.mag() == pytest.approx(1.0, rel=1e-12)
    assert unit.dot(v) == pytest.approx(v.mag(), rel=1e-12)


@EXAMPLES
@given(vectors, st.floats(0.0, 1e6))
def test_limit_never_lengthens(v, maximum):
    assert v.limit(maximum).mag() <= min(v.mag(), maximum) * (1.0 + 1e-12) + 1e-300


def test_limit_leaves_a_short_vector_alone():
    v = Vector(3.0, 4.0, 0.0)
    assert v.limit(5.0) is v


def test_a_vector_never_changes():
    v = Vector(1.0, 2.0, 3.0)
    with pytest.raises(dataclasses.FrozenInstanceError):
        v.x = 5.0
    v.add(v)
    assert tuple(v) == (1.0, 2.0, 3.0)


@pytest.mark.parametrize(
    ("use", "words"),
    [
        (lambda: Vector().normalize(), "no direction"),
        (lambda: Vector(1.0, 2.0, 3.0).div(0.0), "divide"),
        (lambda: Vector(1.0, 2.0, 3.0).limit(-1.0), "-1.0"),
        (lambda: Vector(1.0, 2.0, 3.0).limit(math.nan), "nan"),
    ],
)
def test_what_has_no_answer_is_refused_in_one_sentence(use, words):
    with pytest.raises(InputError, match=words):
        use()
