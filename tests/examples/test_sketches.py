"""The five example sketches: three hundred frames each, and the physics in them."""

import re
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

from carom import sketch
from carom.sketch.program import Program
from carom.sketch.recorder import BOX, SHAPE, SPHERE

HERE = Path(__file__).parents[2] / "examples" / "sketches"
WIDTH = 500


def started(phase):
    program = Program(HERE / f"phase_{phase}.py")
    program.start()
    return program


def balls(program):
    names = program.names
    return names["balls"] if "balls" in names else [names["a"], names["b"]]


def radius(ball, program):
    return ball.radius if hasattr(ball, "radius") else program.names["RADIUS"]


def energy(program):
    return sum(
        getattr(ball, "mass", 1) * ball.velocity.dot(ball.velocity) / 2 for ball in balls(program)
    )


def momentum(program):
    return sum(getattr(ball, "mass", 1) * np.array(tuple(ball.velocity)) for ball in balls(program))


def test_the_first_sketch_of_the_documents_runs(tmp_path):
    text = (HERE.parents[1] / "docs" / "sketches.md").read_text(encoding="utf-8")
    first = re.search(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)[1]
    assert first.count("\n") - first.count("\n\n") <= 15
    (tmp_path / "my_ball.py").write_text(first, encoding="utf-8")
    program = Program(tmp_path / "my_ball.py")
    program.start()
    for _ in range(3):
        picture = program.draw()
    ((*matrix, fill, stroke, _, kind, _),) = SHAPE.iter_unpack(picture.shapes)
    assert (kind, matrix[9:], fill) == (SPHERE, [409, 306, -12], 0)
    assert stroke == 0xFF00A5FF  # orange: bytes red, green, blue, opaque


def test_every_word_is_in_the_documents():
    text = (HERE.parents[1] / "docs" / "sketches.md").read_text(encoding="utf-8")
    missing = [word for word in sketch.__all__ if not re.search(rf"`[^`\n]*\b{word}\b", text)]
    assert missing == []


def test_all_are_here_and_short():
    files = sorted(HERE.glob("*.py"))
    assert [path.stem for path in files] == [f"phase_{k}" for k in range(5)]
    for path in files:
        text = path.read_text(encoding="utf-8")
        assert text.count("\n") <= 60
        for word in ("class Ball:", "def move(self):", "def display(self):", "push_matrix()"):
            assert word in text


@pytest.mark.parametrize("phase", range(5))
def test_it_draws_its_balls_in_their_room(phase):
    program = started(phase)
    for _ in range(300):
        picture = program.draw()
    room, *rest = [shape[-2] for shape in SHAPE.iter_unpack(picture.shapes)]
    assert room == (SPHERE if phase == 0 else BOX)
    assert rest == [SPHERE] * (2 if phase == 2 else 12)
    assert (picture.width, picture.height, picture.frame) == (900, 700, 300)


@pytest.mark.parametrize("phase", range(5))
def test_balls_stay_inside_but_for_a_ticks_motion(phase):
    program = started(phase)
    seen = False
    for _ in range(300):
        before = {id(ball): ball.velocity for ball in balls(program)}
        program.draw()
        for ball in balls(program):
            # A collision may have turned it since; what counts is how fast it came.
            came = max(before[id(ball)].mag(), ball.velocity.mag())
            if phase == 0:
                over = ball.location.mag() + radius(ball, program) - WIDTH
                assert over <= came
            else:
                over = max(map(abs, ball.location)) + radius(ball, program) - WIDTH / 2
                # Outside, a collision may send it on once more, as the paper's ticks do.
                assert over <= (came if phase == 1 else 2 * came)
            seen = seen or over > 0
    assert seen  # they do reach the wall, and a little beyond: these are ticks


@pytest.mark.parametrize("phase", range(5))
def test_energy_is_kept(phase):
    program = started(phase)
    start = energy(program)
    for _ in range(300):
        program.draw()
    # An impulse along any unit vector keeps it; a late tick only has the wrong one.
    assert energy(program) == pytest.approx(start, rel=1e-12)


def test_phase_0_reverses_the_whole_velocity():
    program = started(0)
    for _ in range(300):
        before = [ball.velocity for ball in balls(program)]
        program.draw()
        for was, ball in zip(before, balls(program), strict=True):
            assert ball.velocity in (was, was.mult(-1))


def test_phase_2_prints_what_the_paper_prints():
    program = started(2)
    for _ in range(300):
        program.draw()
    lines = program.printed.tail.splitlines()
    assert program.names["collisions"] >= 2
    assert len(lines) == 5 * program.names["collisions"]
    assert lines[0] == "collision 1"
    assert lines[1] == "|n| = 1.000000"
    assert lines[4] == f"total KE = {energy(program):.6f}"


@pytest.mark.parametrize("phase", [3, 4])
def test_pairs_collide_and_momentum_is_kept_by_collisions(phase):
    program = started(phase)
    hits = 0
    collide = program.names["collide"]

    def counted(a, b):
        nonlocal hits
        hits += 1
        before = momentum(program)
        collide(a, b)
        assert momentum(program) == pytest.approx(before, abs=1e-9)

    program.names["collide"] = counted
    for _ in range(300):
        program.draw()
        touching = {
            frozenset(pair)
            for pair in combinations(balls(program), 2)
            if pair[0].location.dist(pair[1].location)
            <= sum(radius(ball, program) for ball in pair)
        }
        assert {frozenset(pair) for pair in program.names["active"]} == touching
    assert hits >= 10


def test_phase_4_shows_energy_by_saturation():
    program = started(4)
    picture = program.draw()
    strokes = [shape[13] for shape in SHAPE.iter_unpack(picture.shapes)][1:]
    masses = [ball.mass for ball in balls(program)]
    assert 0.5 < np.mean(masses) < 2
    for rgba, ball in zip(strokes, balls(program), strict=True):
        red, green, blue = rgba & 255, rgba >> 8 & 255, rgba >> 16 & 255
        most, least = max(red, green, blue), min(red, green, blue)
        speed2 = ball.velocity.dot(ball.velocity)
        # Frame 1 has no collision yet that would have changed a velocity after it was shown.
        assert (1 - least / most) * 100 == pytest.approx(min(100, ball.mass * speed2 / 10), abs=1)
