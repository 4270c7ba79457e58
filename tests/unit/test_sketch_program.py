"""Students' programs, right and wrong."""

import io
import sys
from pathlib import Path

import pytest

from carom.errors import FileError, InputError, RunError
from carom.sketch.program import Program

GOOD = """
from carom.sketch import *

def setup():
    global x
    size(300, 200)
    x = random(10)
    print("x is", x)

def draw():
    translate(x, 0)
    sphere(5)
"""


@pytest.fixture
def write(tmp_path):
    def write_program(text, name="my_ball.py"):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return Program(path)

    return write_program


def test_a_program_runs(write):
    program = write(GOOD)
    program.start()
    first, second = program.draw(), program.draw()
    assert (first.width, first.height, first.n) == (300, 200, 1)
    assert (first.frame, second.frame) == (1, 2)
    assert program.printed.tail == f"x is {program.names['x']}\n"


def test_both_ways_to_import_and_no_setup(write):
    program = write("from carom import sketch\ndef draw():\n    sketch.sphere(1)\n")
    program.start()
    picture = program.draw()
    assert (picture.width, picture.height, picture.n) == (100, 100, 1)


def test_starting_again_is_the_same_run_of_the_file_as_it_is_now(write):
    program = write(GOOD)
    program.start()
    x = program.names["x"]
    program.draw()
    program.start()
    assert program.names["x"] == x
    assert program.draw().frame == 1
    write(GOOD.replace("sphere(5)", "sphere(5); sphere(6)"))
    program.start()
    assert program.draw().n == 2
    assert program.printed.tail.count("x is") == 1  # the page of prints starts afresh


def test_the_seed_chooses_the_numbers(tmp_path):
    path = tmp_path / "a.py"
    path.write_text(GOOD)
    xs = []
    for seed in (1, 1, 2):
        program = Program(path, seed)
        program.start()
        xs.append(program.names["x"])
    assert xs[0] == xs[1] != xs[2]


def test_prints_go_to_the_terminal_and_the_last_of_them_to_the_page(tmp_path):
    path, echo = tmp_path / "a.py", io.StringIO()
    path.write_text("def draw():\n    for k in range(2000): print('line', k)\n")
    program = Program(path, echo=echo)
    program.start()
    program.draw()
    assert echo.getvalue().count("\n") == 2000
    tail = program.printed.tail
    assert len(tail) < 4000
    assert tail.startswith("line ")
    assert tail.endswith("line 1999\n")


def test_modules_beside_it_can_be_used_and_are_read_again(write, tmp_path):
    helper = tmp_path / "helper_of_sketch.py"
    helper.write_text("RADIUS = 5\n")
    text = "from helper_of_sketch import RADIUS\ndef draw(): pass\n"
    program = write(text)
    program.start()
    assert program.names["RADIUS"] == 5
    helper.write_text("RADIUS = 66\n")
    program.start()
    assert program.names["RADIUS"] == 66
    sys.path.remove(str(tmp_path))


def test_dataclasses_work(write):
    program = write(
        "from __future__ import annotations\nfrom dataclasses import dataclass\n"
        "@dataclass\nclass Ball:\n    x: float = 3\n"
        "def draw():\n    assert Ball().x == 3\n"
    )
    program.start()
    program.draw()


def test_a_missing_file(tmp_path):
    (tmp_path / "my_ball.py").write_text(GOOD)
    with pytest.raises(FileError, match=r"no file 'my_bal\.py' in .*; did you mean 'my_ball\.py'"):
        Program(tmp_path / "my_bal.py").load()
    with pytest.raises(FileError, match="name a Python file"):
        Program(tmp_path).load()


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("def draw(:\n    pass\n", r"my_ball\.py, line 1 is no Python: "),
        ("x = 'π\n", r"my_ball\.py, line 1 is no Python: "),
        ("def setup(): pass\n", r"my_ball\.py has no draw\(\); write a function draw\(\)"),
        ("draw = 3\n", r"has no draw\(\)"),
        ("x = '\0'\ndef draw(): pass\n", "is no Python"),
    ],
)
def test_what_cannot_be_loaded(write, text, sentence):
    with pytest.raises(InputError, match=sentence):
        write(text).load()


def test_an_error_while_loading(write):
    with pytest.raises(RunError, match=r"^my_ball\.py, line 2: ZeroDivisionError: .*by zero$"):
        write("def draw(): pass\n1 / 0\n").load()


@pytest.mark.parametrize(
    ("body", "sentence"),
    [
        ("spher(5)", r"line 4: NameError: name 'spher' is not defined; did you mean 'sphere'\?"),
        ("Vector().mga()", r"line 4: AttributeError: .*; did you mean 'mag'\?"),
        ("width / 2", r"line 4: TypeError.*missing its brackets, as in width\(\)"),
        ("translate(float('nan'), 0)", r"line 4: translate\(\): x is nan; give a finite number"),
        ("pop_matrix()", r"line 4: pop_matrix\(\) without push_matrix\(\): nothing was kept"),
        ("push_matrix()", r"line 4: push_matrix\(\) has no pop_matrix\(\) by the end of draw\(\)"),
        ("for _ in range(30000): point(0, 0)", r"line 4: draw\(\) draws more than 20,000 shapes"),
        ("Vector(0, 0, 0).normalize()", r"line 4: cannot normalize Vector"),
        ("draw()", r"a function calls itself without end"),
        ("raise ValueError('two\\nlines')", r"line 4: ValueError: two lines$"),
        ("fill('rde')", r"line 4: there is no color 'rde'; did you mean 'red'"),
    ],
)
def test_errors_in_draw_name_file_and_line(write, body, sentence):
    program = write(f"from carom.sketch import *\n\ndef draw():\n    {body}\n")
    program.start()
    with pytest.raises(RunError, match=sentence) as caught:
        program.draw()
    assert str(caught.value).startswith("my_ball.py, line 4: ")
    assert "\n" not in str(caught.value)


def test_an_error_in_a_helper_names_the_helper(write, tmp_path):
    (tmp_path / "helper_that_fails.py").write_text("def half(x):\n    return x / 0\n")
    program = write("import helper_that_fails as h\ndef draw():\n    h.half(1)\n")
    program.start()
    with pytest.raises(RunError, match=r"^helper_that_fails\.py, line 2: ZeroDivisionError"):
        program.draw()
    sys.path.remove(str(tmp_path))


def test_leaving_and_ctrl_c_pass_through(write):
    for body, kind in (("exit()", SystemExit), ("raise KeyboardInterrupt", KeyboardInterrupt)):
        program = write(f"from sys import exit\ndef draw():\n    {body}\n")
        program.start()
        with pytest.raises(kind):
            program.draw()


def test_a_failed_program_leaves_nothing_behind(write):
    before = sys.stdout
    program = write("from carom.sketch import *\ndef draw():\n    push_matrix()\n    1 / 0\n")
    program.start()
    with pytest.raises(RunError):
        program.draw()
    assert sys.stdout is before
    write(Path(program.path).read_text().replace("1 / 0", "pop_matrix()"))
    program.start()
    assert program.draw().n == 0
