"""Event times of the reference engine, checked in exact rational arithmetic."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from carom.reference.periodic import half_a_box, images_met, parted_for_ever, wrapped
from carom.reference.times import NEVER, ZERO, dot, landing, leaving, meeting

EXAMPLES = settings(max_examples=60, derandomize=True, deadline=None)

seeds = st.integers(0, 2**32 - 1)


def overlap(r, v, a, distance, t):
    """|r + v t + a t^2 / 2|^2 - distance^2, without any rounding."""
    t = Fraction(t)
    axes = zip(r, v, a, strict=True)
    place = [Fraction(x) + Fraction(u) * t + Fraction(w) * t * t / 2 for x, u, w in axes]
    return sum(x * x for x in place) - Fraction(distance) ** 2


def draw(seed, scale=1.0):
    rng = np.random.default_rng(seed)
    r, v, a = (tuple((scale * rng.normal(size=3)).tolist()) for _ in range(3))
    return rng, r, v, a


def first_contact_on_a_grid(r, v, a, distance, sign, end):
    """A time at or after which the first contact before `end` begins, by looking; inf if none."""
    t = np.linspace(0.0, end, 20001)
    place = np.array(r) + np.outer(t, v) + 0.5 * np.outer(t * t, a)
    f = sign * (np.linalg.norm(place, axis=1) - distance)
    inside = np.flatnonzero((f[1:] < 0) & (f[:-1] > 0))
    return t[inside[0]] if inside.size else math.inf


@EXAMPLES
@given(seeds)
def test_two_spheres_in_free_flight_meet_when_they_touch(seed):
    rng, r, v, _ = draw(seed, 5.0)
    distance = rng.uniform(0.1, 0.9) * math.sqrt(dot(r, r))
    t = meeting(r, v, ZERO, distance)
    if t == NEVER:
        nearest = max(0.0, -dot(r, v) / dot(v, v))
        assert overlap(r, v, ZERO, distance, nearest) > -1e-12
        return
    # The sign changes within a few units of the last place of a well-conditioned root.
    slack = 1e-14 * (1.0 + t) * (1.0 + dot(r, r) / abs(dot(r, v)))
    assert overlap(r, v, ZERO, distance, t - slack) > 0
    before = -dot(r, v) / dot(v, v)
    assert overlap(r, v, ZERO, distance, min(t + 1e3 * slack, before)) < 1e-12


@pytest.mark.parametrize(
    ("r", "v", "expected"),
    [
        ((3.0, 0.0, 0.0), (-1.0, 0.0, 0.0), 2.0),
        ((3.0, 0.0, 0.0), (1.0, 0.0, 0.0), NEVER),  # parting
        ((3.0, 0.0, 0.0), (0.0, 0.0, 0.0), NEVER),  # standing
        ((3.0, 1.0, 0.0), (-1.0, 0.0, 0.0), NEVER),  # grazing is no contact
        ((3.0, 0.999999, 0.0), (-1.0, 0.0, 0.0), 3.0 - math.sqrt(1.0 - 0.999999**2)),
        ((1.0, 0.0, 0.0), (-1.0, 0.5, 0.0), 0.0),  # touching and approaching
        ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), NEVER),  # touching, moving along
        ((0.5, 0.0, 0.0), (-1.0, 0.0, 0.0), 0.0),  # overlapping and approaching
        ((0.5, 0.0, 0.0), (1.0, 0.0, 0.0), NEVER),  # overlapping and parting
    ],
)
def test_special_cases_of_free_flight(r, v, expected):
    assert meeting(r, v, ZERO, 1.0) == pytest.approx(expected, rel=1e-12)


def test_the_time_stays_good_far_away():
    """300 diameters apart the plain discriminant would be wrong by 4e-11."""
    rng = np.random.default_rng(7)
    worst = 0.0
    for _ in range(200):
        n = rng.normal(size=3)
        n /= np.linalg.norm(n)
        v = rng.normal(size=3)
        v *= -math.copysign(1.0, v @ n)
        r = tuple((n - 300.0 * v).tolist())
        t = meeting(r, tuple(v.tolist()), ZERO, 1.0)
        worst = max(worst, abs(t - 300.0) * abs(v @ n) / np.linalg.norm(v))
    assert worst < 1e-11


def test_spheres_that_have_just_met_do_not_meet_again_unless_something_pulls():
    r, v = (1.0, 0.0, 0.0), (-1e-17, 1.0, 0.0)
    assert meeting(r, v, ZERO, 1.0, just_met=True) == NEVER
    pulled_back = meeting((1.0, 0.0, 0.0), (2.0, 0.0, 0.0), (-1.0, 0.0, 0.0), 1.0, just_met=True)
    assert pulled_back == pytest.approx(4.0, rel=1e-12)
    pulled_apart = meeting(r, (-1e-17, 0.0, 0.0), (1.0, 0.0, 0.0), 1.0, just_met=True)
    assert pulled_apart == NEVER


@EXAMPLES
@given(seeds)
def test_accelerated_spheres_meet_at_their_first_contact(seed):
    rng, r, v, a = draw(seed, 3.0)
    distance = rng.uniform(0.1, 0.9) * math.sqrt(dot(r, r))
    t = meeting(r, v, a, distance)
    end = 50.0 if t == NEVER else t
    seen = first_contact_on_a_grid(r, v, a, distance, 1.0, end * (1.0 - 1e-6))
    assert seen == math.inf
    if t != NEVER:
        slack = 1e-7 * (1.0 + t)
        assert overlap(r, v, a, distance, t - slack) > -1e-9
        assert overlap(r, v, a, distance, t) == pytest.approx(0.0, abs=1e-10 * (1.0 + t) ** 4)


@EXAMPLES
@given(seeds)
def test_a_sphere_reaches_its_container_at_the_first_exit(seed):
    rng, r, v, a = draw(seed)
    distance = math.sqrt(dot(r, r)) * rng.uniform(1.01, 3.0)
    for pull in (ZERO, a):
        t = leaving(r, v, pull, distance)
        assert t < NEVER
        seen = first_contact_on_a_grid(r, v, pull, distance, -1.0, t * (1.0 - 1e-6))
        assert seen == math.inf
        assert overlap(r, v, pull, distance, t) == pytest.approx(0.0, abs=1e-10 * (1.0 + t) ** 4)


def test_special_cases_inside_a_container():
    assert leaving(ZERO, ZERO, ZERO, 2.0) == NEVER
    assert leaving(ZERO, ZERO, (0.0, 0.0, -1.0), 2.0) == pytest.approx(2.0)
    assert leaving((2.0, 0.0, 0.0), (1.0, 0.0, 0.0), ZERO, 2.0) == 0.0
    assert leaving((2.0, 0.0, 0.0), (-1.0, 0.0, 0.0), ZERO, 2.0) == 4.0
    # Rounding has put it outside, moving along the wall: no nan, no waiting.
    assert leaving((2.0 + 4e-16, 0.0, 0.0), (0.0, 1.0, 0.0), ZERO, 2.0) == 0.0


@pytest.mark.parametrize(
    ("gap", "rate", "bend", "expected"),
    [
        (2.0, -1.0, 0.0, 2.0),
        (2.0, 1.0, 0.0, NEVER),
        (2.0, 0.0, 0.0, NEVER),
        (-0.1, -1.0, 0.0, 0.0),
        (2.0, 0.0, -1.0, 2.0),  # dropped
        (0.0, 1.0, -1.0, 2.0),  # thrown up from the floor
        (2.0, -1.5, -1.0, 1.0),  # thrown down
        (0.0, -1.0, -1.0, 0.0),
        (-1e-17, 1e-12, -1.0, 1e-12),  # never out of the floor: at the top of the hop
        (1.5, -2.0, 1.0, 1.0),  # thrown up at a ceiling and reaching it
        (2.5, -2.0, 1.0, NEVER),  # and not reaching it
        (0.0, 1.0, 1.0, NEVER),
    ],
)
def test_planes(gap, rate, bend, expected):
    assert landing(gap, rate, bend) == pytest.approx(expected, rel=1e-4)


@EXAMPLES
@given(seeds)
def test_no_image_is_lost(seed):
    """Every image that comes within reach in a piece of flight is among those looked at."""
    rng, r, v, _ = draw(seed, 3.0)
    period = tuple((rng.uniform(1.0, 4.0, 3) * (rng.random(3) < 0.7)).tolist())
    reach, begin = rng.uniform(0.3, 2.0), rng.uniform(0.0, 5.0)
    end = begin + min(half_a_box(v, period), 5.0)
    looked_at = set(images_met(r, v, period, reach, begin, end))
    around = np.array(list(np.ndindex(9, 9, 9))) - 4
    lengths = np.array(period)
    for t in rng.uniform(begin, end, 20):
        place = np.array(r) + t * np.array(v)
        here = np.rint(np.divide(place, lengths, out=np.zeros(3), where=lengths > 0.0))
        images = around[np.all((around == 0) | (lengths > 0.0), axis=1)] + here.astype(int)
        near = np.linalg.norm(place - images * lengths, axis=1) <= reach
        assert {tuple(m) for m in images[near].tolist()} <= looked_at


def test_how_long_the_images_are_known():
    assert half_a_box((0.5, -2.0, 9.0), (4.0, 4.0, 0.0)) == 1.0
    assert half_a_box((0.0, 0.0, 9.0), (4.0, 4.0, 0.0)) == NEVER


def test_when_an_open_axis_parts_two_spheres_for_ever():
    periodic = (5.0, 5.0, 0.0)
    assert parted_for_ever((0, 0, 3.0), (1.0, 1.0, -1.0), ZERO, periodic, 1.0) == 4.0
    assert parted_for_ever((0, 0, 3.0), (1.0, 1.0, 0.0), ZERO, periodic, 1.0) == -math.inf
    assert parted_for_ever((0, 0, 0.5), (1.0, 1.0, 0.0), ZERO, periodic, 1.0) == NEVER
    assert parted_for_ever((0, 0, 3.0), (1.0, 1.0, 1.0), ZERO, (5.0, 5.0, 5.0), 1.0) == NEVER
    falling = parted_for_ever((0, 0, 3.0), ZERO, (0, 0, -2.0), periodic, 1.0)
    assert falling == pytest.approx(2.0)
    assert parted_for_ever((0, 0, 3.0), ZERO, (0, 0, 2.0), periodic, 1.0) == -math.inf


@pytest.mark.parametrize(
    ("x", "expected", "boxes"),
    [(0.0, 0.0, 0), (2.0, -2.0, 1), (-2.0, -2.0, 0), (7.0, -1.0, 2), (-6.5, 1.5, -2)],
)
def test_wrapping(x, expected, boxes):
    position, image = wrapped((x, 0.0, x), (0, 0, 0), (4.0, 4.0, 0.0))
    assert position == (expected, 0.0, x)
    assert image == (boxes, 0, 0)
