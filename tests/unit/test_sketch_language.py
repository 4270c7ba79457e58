"""The words of a sketch: what they record, and what they refuse."""

import math
from contextlib import contextmanager

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import carom
from carom import sketch
from carom.color import hsb
from carom.errors import InputError
from carom.random_numbers import Random
from carom.sketch import language
from carom.sketch.paint import Color
from carom.sketch.recorder import BOX, CURRENT, LINE, MOST_SHAPES, SHAPE, SPHERE, Recorder


@contextmanager
def running(seed=1):
    recorder = Recorder(seed)
    token = CURRENT.set(recorder)
    try:
        yield recorder
    finally:
        CURRENT.reset(token)


@pytest.fixture
def recorder():
    with running() as found:
        yield found


def shapes(recorder):
    """Kind, axes and origin, fill, stroke, weight, detail of each shape."""
    found = []
    for *m, fill, stroke, weight, kind, detail in SHAPE.iter_unpack(recorder.picture().shapes):
        found.append((kind, np.reshape(m, (4, 3)), fill, stroke, weight, detail))
    return found


def test_the_star_brings_every_word_and_vector():
    names = {}
    exec("from carom.sketch import *", names)
    words = {
        name
        for name, value in vars(language).items()
        if callable(value) and value.__module__ == language.__name__ and name[0] != "_"
    }
    assert words <= set(sketch.__all__) <= set(names)
    assert names["Vector"] is carom.Vector
    assert names["TWO_PI"] == 2 * math.pi


def test_a_sphere_under_the_matrix(recorder):
    sketch.translate(10, 20, 30)
    sketch.scale(2, 1, 1)
    sketch.sphere(5)
    ((kind, m, fill, stroke, weight, detail),) = shapes(recorder)
    assert kind == SPHERE
    assert m.tolist() == [[10, 0, 0], [0, 5, 0], [0, 0, 5], [10, 20, 30]]
    # Processing begins with white, black lines one pixel wide.
    assert (fill, stroke, weight, detail) == (0xFFFFFFFF, 0xFF000000, 1.0, 24)


def test_boxes_lines_and_points(recorder):
    sketch.box(2)
    sketch.box(1, 2, 3)
    sketch.line(1, 2, 11, 22)
    sketch.line(1, 2, 3, 4, 5, 6)
    sketch.translate(0, 0, 7)
    sketch.point(1, 2)
    cube, brick, flat, deep, dot = shapes(recorder)
    assert [shape[0] for shape in (cube, brick, flat, deep, dot)] == [BOX, BOX, LINE, LINE, LINE]
    assert cube[1][:3].tolist() == np.diag([2.0, 2, 2]).tolist()
    assert brick[1][:3].tolist() == np.diag([1.0, 2, 3]).tolist()
    assert flat[1][[0, 3]].tolist() == [[10, 20, 0], [1, 2, 0]]
    assert deep[1][[0, 3]].tolist() == [[3, 3, 3], [1, 2, 3]]
    assert dot[1][[0, 3]].tolist() == [[0, 0, 0], [1, 2, 7]]
    assert flat[2] == 0  # lines have no fill


def test_what_cannot_be_seen_is_not_recorded(recorder):
    sketch.no_stroke()
    sketch.line(0, 0, 1, 1)
    sketch.no_fill()
    sketch.sphere(5)
    sketch.fill(255)
    sketch.sphere(0)
    assert shapes(recorder) == []


def test_style_lasts_and_the_matrix_starts_afresh(recorder):
    recorder.begin()
    sketch.fill("red")
    sketch.stroke_weight(3)
    sketch.translate(5, 5)
    recorder.begin()
    sketch.sphere(1)
    ((_, m, fill, _, weight, _),) = shapes(recorder)
    assert m[3].tolist() == [0, 0, 0]
    assert (fill, weight) == (0xFF0000FF, 3.0)
    assert sketch.frame_count() == 2


def test_the_sheet(recorder):
    assert (sketch.width(), sketch.height()) == (100, 100)
    sketch.size(800, 600)
    assert (sketch.width(), sketch.height()) == (800, 600)
    sketch.background(0, 0, 255)
    assert recorder.picture().background == Color(0, 0, 255)
    sketch.frame_rate(30)
    assert recorder.rate == 30
    sketch.lights()


@pytest.mark.parametrize(
    ("values", "color"),
    [
        ((0,), Color(0, 0, 0)),
        ((255,), Color(255, 255, 255)),
        ((128, 51), Color(128, 128, 128, 51)),
        ((1, 2, 3), Color(1, 2, 3)),
        ((1, 2, 3, 4), Color(1, 2, 3, 4)),
        ((300, -5, 127.6), Color(255, 0, 128)),
        (("orange",), Color(255, 165, 0)),
        (("#4c9be8", 128), Color(0x4C, 0x9B, 0xE8, 128)),
        ((Color(9, 8, 7),), Color(9, 8, 7)),
        ((Color(9, 8, 7), 0), Color(9, 8, 7, 0)),
    ],
)
def test_colours(recorder, values, color):
    assert sketch.color(*values) == color


@given(st.floats(0, 360), st.floats(0, 100), st.floats(0, 100))
def test_hsb_is_the_papers(h, s, b):
    with running():
        sketch.color_mode("hsb", 360, 100, 100)
        found = sketch.color(h, s, b)
    code = int(hsb(h, s, b))
    # The same formula in another order of roundings: at most one step of 255 apart.
    assert found.red == pytest.approx(code >> 16, abs=1)
    assert found.green == pytest.approx(code >> 8 & 255, abs=1)
    assert found.blue == pytest.approx(code & 255, abs=1)


def test_hsb_wraps_clips_and_greys(recorder):
    sketch.color_mode("HSB", 360, 100, 100)
    assert sketch.color(480, 100, 100) == sketch.color(120, 100, 100) == Color(0, 255, 0)
    assert sketch.color(120, 250, 100) == Color(0, 255, 0)  # KE/5 beyond 100 percent
    assert sketch.color(100) == Color(255, 255, 255)  # by brightness
    assert sketch.color(0, 0, 100, 51).alpha == 51
    sketch.color_mode("rgb", 1)
    assert sketch.color(1, 0.5, 0, 0.2) == Color(255, 128, 0, 51)


def test_random_is_the_projects_stream(recorder):
    drawn = [sketch.random(-10, 10) for _ in range(600)]
    assert drawn[:256] == Random(1).uniform(256, low=-10, high=10).tolist()
    # Drawn in batches of 256, one stream all the same.
    assert drawn == Random(1).uniform(600, low=-10, high=10).tolist()
    sketch.random_seed(1)
    assert sketch.random(-10, 10) == drawn[0]
    sketch.random_seed(7)
    assert sketch.random(360) == Random(7).uniform(1, high=360)[0]
    sketch.random_seed(7)
    assert sketch.random() == Random(7).uniform(1)[0]


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: sketch.translate(math.nan, 0), "x is nan; give a finite number"),
        (lambda: sketch.sphere(math.inf), "radius is inf; give a finite number"),
        (lambda: sketch.sphere(10**400), "radius is inf; give a finite number"),
        (lambda: sketch.sphere(-1), "radius is -1; it must be at least 0"),
        (lambda: sketch.sphere("5"), "radius is '5'; give a number"),
        (lambda: sketch.translate(sketch.width, 0), r"function width; write width\(\)"),
        (lambda: sketch.size(0, 5), "whole number from 1 to 4096"),
        (lambda: sketch.size(10.5, 5), "whole number"),
        (lambda: sketch.scale(1, 0), "take a small number"),
        (lambda: sketch.line(1, 2, 3), "has 3 numbers"),
        (lambda: sketch.fill(), "has 0 values"),
        (lambda: sketch.fill("rde"), "there is no color 'rde'; did you mean 'red'"),
        (lambda: sketch.stroke(1, "a", 3), "green is 'a'"),
        (lambda: sketch.color_mode("cmyk"), "it is 'rgb' or 'hsb'"),
        (lambda: sketch.color_mode("rgb", 0), "larger than 0"),
        (lambda: sketch.color_mode("rgb", 1, 2), "2 limits"),
        (lambda: sketch.stroke_weight(0), "above 0"),
        (lambda: sketch.frame_rate(0), "above 0"),
        (lambda: sketch.sphere_detail(3), "from 6 to 120"),
        (lambda: sketch.random_seed(-1), "zero or more"),
        (lambda: sketch.pop_matrix(), "without push_matrix"),
        (lambda: sketch.random(1, math.nan), "high is nan"),
    ],
)
def test_what_is_refused(recorder, call, sentence):
    with pytest.raises(InputError, match=sentence):
        call()


def test_too_many_and_too_far(recorder):
    for _ in range(MOST_SHAPES):
        sketch.point(0, 0)
    with pytest.raises(InputError, match="more than 20,000 shapes in one frame"):
        sketch.point(0, 0)
    recorder.begin()
    sketch.scale(1e8)
    with pytest.raises(InputError, match="beyond 1e\\+09 pixels"):
        sketch.sphere(50)
    sketch.scale(1e300)
    with pytest.raises(InputError, match="beyond"):
        sketch.sphere(50)


def test_outside_of_a_sketch_it_says_how_to_run_one():
    with pytest.raises(InputError, match=r"size\(\) works only while a sketch runs.*carom sketch"):
        sketch.size(100, 100)


def test_detail_is_rounded_to_what_is_drawn(recorder):
    for asked, drawn in ((6, 6), (24, 24), (26, 24), (27, 30), (120, 120)):
        sketch.sphere_detail(asked)
        assert recorder.detail == drawn
