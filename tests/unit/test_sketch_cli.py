"""`carom sketch`, as people type it."""

import json
import re
import signal
import subprocess
import sys
import time
from contextlib import contextmanager

import pytest
from websockets.sync.client import connect

from carom.cli import main
from carom.view.wire import VERSION

DRAW = "from carom.sketch import *\ndef draw():\n    sphere(5)\n"


@contextmanager
def carom_sketch(*words):
    """The command in a process of its own, and its page's address."""
    process = subprocess.Popen(
        [sys.executable, "-c", "from carom.cli import main; main()", "sketch", *map(str, words)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        yield process
    finally:
        if process.poll() is None:
            process.kill()
        process.wait()
        process.stdout.close()
        process.stderr.close()


@contextmanager
def page(address):
    base, token = address.split("/#token=")
    with connect(base.replace("http", "ws") + "/live", origin=base, compression=None) as ws:
        ws.send(json.dumps({"op": "hello", "token": token, "version": VERSION}))
        ws.send(json.dumps({"op": "credit", "count": 4}))
        yield ws


def note(ws, key):
    """The next text note of a kind."""
    while True:
        message = ws.recv(timeout=10)
        if isinstance(message, str) and key in json.loads(message):
            return json.loads(message)[key]


def ended(process, number=signal.SIGINT):
    process.send_signal(number)
    out, err = process.communicate(timeout=10)
    return process.returncode, out, err


@pytest.fixture
def write(tmp_path):
    def write_program(text):
        path = tmp_path / "my_ball.py"
        path.write_text(text, encoding="utf-8")
        return path

    return write_program


@pytest.mark.parametrize(
    ("text", "status", "sentence"),
    [
        (None, 1, "there is no file 'my_ball.py'"),
        ("def setup(): pass\n", 2, "my_ball.py has no draw(); write a function draw()"),
        ("def draw(:\n", 2, "my_ball.py, line 1 is no Python: "),
        ("import nowhere_at_all\n", 1, "my_ball.py, line 1: ModuleNotFoundError: "),
    ],
)
def test_what_cannot_start(capsys, write, tmp_path, text, status, sentence):
    path = tmp_path / "my_ball.py" if text is None else write(text)
    with pytest.raises(SystemExit) as end:
        main(["sketch", str(path), "--no-browser"])
    out, err = capsys.readouterr()
    assert end.value.code == status
    assert out == ""
    assert err.startswith(f"carom: {sentence}")
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["--seed", "x"], "--seed must be a number, not 'x'"),
        (["--seed", "-1"], "seed is -1; it must be a whole number, zero or more"),
        (["--port", "99999"], "port is 99999; it must be a whole number from 0"),
    ],
)
def test_wrong_options(capsys, write, words, sentence):
    with pytest.raises(SystemExit) as end:
        main(["sketch", str(write(DRAW)), "--no-browser", *words])
    assert end.value.code == 2
    assert sentence in capsys.readouterr().err


def test_quiet_prints_the_address_alone(write):
    with carom_sketch(write(DRAW), "--no-browser", "--quiet") as process:
        line = process.stdout.readline()
        process.send_signal(signal.SIGINT)
        rest, _ = process.communicate(timeout=10)
    assert re.fullmatch(r"http://127\.0\.0\.1:\d+/#token=\S+\n", line)
    assert rest == ""


def test_help_lists_it(capsys):
    with pytest.raises(SystemExit):
        main(["sketch", "--help"])
    out = capsys.readouterr().out
    assert "setup() and draw()" in out
    assert "--seed" in out


def test_it_runs_prints_and_ends_with_ctrl_c(write):
    path = write(DRAW.replace("sphere(5)", "print('ball', frame_count(), random())"))
    with carom_sketch(path, "--no-browser", "--json", "--seed", 5) as process:
        about = json.loads(process.stdout.readline())
        assert about["file"] == str(path)
        with page(about["address"]) as ws:
            assert note(ws, "title") == "my_ball.py"
            while "ball 1 " not in (text := note(ws, "printed")):
                pass
        status, out, err = ended(process)
    assert status == 0
    assert out == ""  # with --json, standard output is the program's that started it
    assert err.startswith(text[:20])


def test_ctrl_c_ends_a_draw_without_end(write):
    path = write("def draw():\n    print('in')\n    while True: pass\n")
    with (
        carom_sketch(path, "--no-browser", "--json") as process,
        page(json.loads(process.stdout.readline())["address"]),
    ):
        assert process.stderr.readline() == "in\n"
        begin = time.perf_counter()
        status, _, err = ended(process)
    assert (status, err) == (0, "")
    assert time.perf_counter() - begin < 5


@pytest.mark.parametrize("debug", [[], ["--debug"]])
def test_an_error_is_one_line_in_the_terminal_and_on_the_page(write, debug):
    path = write(DRAW.replace("sphere(5)", "pop_matrix()"))
    with (
        carom_sketch(path, "--no-browser", "--json", *debug) as process,
        page(json.loads(process.stdout.readline())["address"]) as ws,
    ):
        while not (sentence := note(ws, "failure")):
            pass
        status, _, err = ended(process)
    assert sentence.startswith("my_ball.py, line 3: pop_matrix() without push_matrix()")
    assert f"carom: {sentence}\n" in err
    assert ("Traceback" in err) == bool(debug)
    assert status == 1


def test_a_program_may_leave_by_itself(write):
    path = write("import sys\ndef draw():\n    sys.exit(0)\n")
    with (
        carom_sketch(path, "--no-browser", "--json") as process,
        page(json.loads(process.stdout.readline())["address"]),
    ):
        assert process.wait(timeout=10) == 0


def test_the_line_for_people(write):
    path = write("print('hello')\n" + DRAW)
    with carom_sketch(path, "--no-browser") as process:
        assert process.stdout.readline() == "hello\n"
        line = process.stdout.readline()
        assert line.startswith("carom runs my_ball.py at http://127.0.0.1:")
        assert ended(process)[0] == 0
