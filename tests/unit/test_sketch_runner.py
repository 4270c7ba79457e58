"""The sketch's runner: its pace, its orders, what it hands out."""

import json
import struct
import threading
import time

import pytest

from carom.sketch import runner as module
from carom.sketch.message import SHEET, encode
from carom.sketch.program import Program
from carom.sketch.recorder import BLACK, Picture
from carom.sketch.runner import Runner
from carom.view import wire
from carom.view.protocol import Command


class Stage:
    """A runner in a thread of its own, with a page that can be switched on and off."""

    def __init__(self, path, text):
        self.path = path / "my_ball.py"
        self.path.write_text(text, encoding="utf-8")
        self.program = Program(self.path)
        self.program.load()
        self.watched, self.hungry = True, True
        self.snapshots, self.errors, self.replies = [], [], []
        self.runner = Runner(
            self.program,
            self.snapshots.append,
            lambda: self.watched and self.hungry,
            lambda: self.watched,
            self.errors.append,
        )
        self.thread = threading.Thread(target=self.runner.run)

    def order(self, op):
        self.runner.order(Command(op), self.replies.append)

    @property
    def frame(self):
        return self.program.recorder.frame

    def newest(self):
        """The header of the newest frame by name, and its notes."""
        snapshot = self.snapshots[-1]
        (data,) = snapshot.frames
        names = [name for name, _ in wire.HEADER]
        head = dict(zip(names, wire.SCENE_HEADER.unpack_from(data), strict=True))
        sheet = SHEET.unpack_from(data, wire.SCENE_HEADER.size)
        notes = {key: json.loads(text)[key] for key, (_, text) in snapshot.notes.items()}
        return {**head, "frame": sheet[3]}, notes

    def until(self, condition, seconds=5.0):
        end = time.perf_counter() + seconds
        while not condition():
            assert time.perf_counter() < end
            time.sleep(0.005)


@pytest.fixture
def stage(tmp_path):
    stages = []

    def open_stage(text, **settings):
        opened = Stage(tmp_path, text)
        for name, value in settings.items():
            setattr(opened, name, value)
        stages.append(opened)
        opened.thread.start()
        return opened

    yield open_stage
    for each in stages:
        each.runner.stop()
        each.thread.join(timeout=10)
        assert not each.thread.is_alive()


COUNTING = "from carom.sketch import *\ndef draw():\n    sphere(5)\n"


def test_the_message():
    picture = Picture(800, 600, BLACK, 7, 1, bytes(range(64)))
    data = encode(picture, epoch=3, playing=True, failed=False, rate=60, reached=59.5)
    assert len(data) == 48 + 64
    assert data[:24] == struct.pack("<4sHHIIII", b"CARO", wire.VERSION, 3, 1, 3, 1, 0)
    assert data[24:48] == struct.pack("<IIIIff", 800, 600, 0xFF000000, 7, 60, 59.5)
    assert data[48:] == picture.shapes


def test_it_keeps_its_frame_rate(stage):
    shown = stage(COUNTING.replace("def draw", "def setup(): frame_rate(50)\ndef draw"))
    shown.until(lambda: shown.frame >= 1)
    begin, first = time.perf_counter(), shown.frame
    shown.until(lambda: shown.frame >= first + 50)
    assert time.perf_counter() - begin == pytest.approx(1.0, abs=0.25)


def test_it_waits_while_nobody_watches(stage):
    shown = stage(COUNTING, watched=False)
    time.sleep(0.3)
    assert shown.frame == 0
    assert shown.snapshots == []
    shown.watched = True
    shown.runner.poke()
    shown.until(lambda: shown.frame > 3)


def test_a_slow_page_gets_the_newest_and_does_not_slow_the_program(stage):
    shown = stage(COUNTING, hungry=False)
    shown.until(lambda: shown.frame >= 20)
    assert shown.snapshots == []
    before = shown.frame
    shown.hungry = True
    shown.runner.poke()
    shown.until(lambda: shown.snapshots)
    head, _ = shown.newest()
    assert head["frame"] >= before


def test_pause_single_frames_and_play(stage):
    shown = stage(COUNTING)
    shown.until(lambda: shown.frame >= 2)
    shown.order("pause")
    shown.until(lambda: not shown.newest()[0]["flags"] & wire.PLAYING)
    at = shown.frame
    shown.order("step")
    shown.until(lambda: shown.newest()[0]["frame"] == at + 1)
    time.sleep(0.1)
    assert shown.frame == at + 1
    shown.order("play")
    shown.until(lambda: shown.newest()[0]["frame"] > at + 5)
    assert shown.newest()[0]["flags"] & wire.PLAYING


def test_restart_reads_the_file_again(stage):
    shown = stage(COUNTING)
    shown.until(lambda: shown.frame >= 3)
    shown.path.write_text(COUNTING + "    print('new')\n", encoding="utf-8")
    shown.order("restart")
    shown.until(lambda: shown.newest()[0]["epoch"] == 1 and "new" in shown.newest()[1]["printed"])
    assert shown.newest()[1]["title"] == "my_ball.py"


def test_an_error_stops_it_and_a_restart_of_the_mended_file_goes_on(stage):
    shown = stage(COUNTING + "    if frame_count() == 3: 1 / 0\n")
    shown.until(lambda: shown.errors)
    sentence = "my_ball.py, line 4: ZeroDivisionError: division by zero"
    assert str(shown.errors[0]) == sentence
    shown.until(lambda: shown.newest()[1]["failure"] == sentence)
    head, _ = shown.newest()
    # The last whole picture stays; time does not go on, whatever a page orders.
    assert (head["frame"], head["flags"]) == (2, wire.FAILED)
    shown.order("play")
    shown.order("step")
    time.sleep(0.1)
    assert shown.runner.failed
    shown.path.write_text("def draw(:\n", encoding="utf-8")
    shown.order("restart")
    shown.until(lambda: "is no Python" in shown.newest()[1]["failure"])
    shown.path.write_text(COUNTING, encoding="utf-8")
    shown.order("restart")
    shown.until(lambda: shown.newest()[1]["failure"] == "" and shown.newest()[0]["frame"] > 3)
    assert len(shown.errors) == 2


def test_an_error_in_setup_is_told(stage):
    shown = stage("def setup(): oops\ndef draw(): pass\n", watched=False)
    shown.until(lambda: shown.errors)
    assert "NameError" in str(shown.errors[0])


def test_no_loop_draws_once_and_redraw_once_more(stage):
    text = (
        "from carom.sketch import *\ndef setup(): no_loop()\n" + "def draw(): print(frame_count())"
    )
    shown = stage(text)
    shown.until(lambda: shown.frame == 1)
    time.sleep(0.1)
    assert shown.frame == 1
    shown.program.recorder.owed = 1
    shown.runner.poke()
    shown.until(lambda: shown.frame == 2)
    time.sleep(0.1)
    assert shown.frame == 2
    assert shown.program.printed.tail == "1\n2\n"


def test_what_it_has_no_control_for_is_refused(stage):
    shown = stage(COUNTING)
    shown.order("reverse")
    assert json.loads(shown.replies[0]) == {"refused": "A sketch has no such control."}


def test_a_frame_without_an_end_is_talked_about(stage, monkeypatch):
    monkeypatch.setattr(module, "PATIENCE", 0.1)
    text = "import time\nimport threading\nend = threading.Event()\ndef draw(): end.wait(10)\n"
    shown = stage(text)
    shown.until(lambda: shown.snapshots and "has been busy" in shown.newest()[1]["failure"])
    numbers = [snapshot.notes["failure"][0] for snapshot in shown.snapshots]
    assert numbers == sorted(numbers)  # a page that was sent a note is sent only newer ones
    shown.program.names["end"].set()
    shown.until(lambda: shown.newest()[1]["failure"] == "")
    assert shown.errors == []
