"""When frames come to the disk, and how many may wait for it."""

import threading
import time

import gsd.fl
import numpy as np
import pytest

from carom.errors import FileError
from carom.record import writer
from carom.record.container import Container
from carom.record.writer import FRAMES_WAITING, WAITING, Writer

A_LONG_TIME = 1e9  #: s
PATIENCE = 20.0  #: s


@pytest.fixture
def path(tmp_path):
    return tmp_path / "run.gsd"


def frames_of(path):
    with gsd.fl.open(str(path), "r") as file:
        return file.nframes


def soon(question):
    """Whether it becomes true before patience ends."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        if question():
            return True
        time.sleep(0.01)
    return False


def put(file, moment):
    file.chunk("value", np.full(3, moment))
    file.end_frame(moment)


def test_frames_come_to_the_disk_soon_though_nothing_follows(path):
    file = Writer(path, "x")
    put(file, 0.0)
    assert soon(lambda: frames_of(path) == 1)
    for k in range(1, 8):
        put(file, float(k))
    assert soon(lambda: frames_of(path) == 8)
    file.close()


def test_they_gather_and_those_that_have_are_not_lost_at_the_end(path, monkeypatch):
    monkeypatch.setattr(writer, "GATHERING", A_LONG_TIME)
    commits = []
    commit = Container.commit
    monkeypatch.setattr(Container, "commit", lambda file: commits.append(file) or commit(file))
    file = Writer(path, "x")
    put(file, 0.0)
    assert soon(lambda: commits)  # the first one at once
    for k in range(1, 8):
        put(file, float(k))
    assert soon(lambda: file._queue.empty())
    assert frames_of(path) == 1
    file.close()
    assert frames_of(path) == 8
    assert len(commits) == 2


@pytest.mark.parametrize(
    ("size", "frames"), [(3, FRAMES_WAITING), (2**20, WAITING // 2**23)], ids=["small", "large"]
)
def test_no_more_may_wait_than_is_said(path, monkeypatch, size, frames):
    slow, chunk = threading.Event(), Container.chunk

    def wait(file, name, data):
        slow.wait(PATIENCE)
        chunk(file, name, data)

    monkeypatch.setattr(Container, "chunk", wait)
    file, done = Writer(path, "x"), []

    def work():
        for k in range(2 * frames):
            file.chunk("value", np.zeros(size))
            file.end_frame(float(k))
            done.append(k)

    engine = threading.Thread(target=work)
    engine.start()
    assert soon(lambda: file._waiting > WAITING)
    time.sleep(0.1)
    assert 0.8 * frames < len(done) <= frames
    slow.set()
    engine.join()
    file.close()
    assert frames_of(path) == 2 * frames


def test_an_error_is_told_by_whoever_comes_next_and_frames_before_it_are_kept(path, monkeypatch):
    monkeypatch.setattr(writer, "GATHERING", A_LONG_TIME)
    file = Writer(path, "x")
    for k in range(3):
        put(file, float(k))
    file.chunk("value", np.array(["no", "chunk"]))  # any error at all
    assert soon(lambda: file._error)
    with pytest.raises(FileError, match=r"run.gsd: .*; what was recorded until time 2 is safe"):
        put(file, 3.0)
    with pytest.raises(FileError, match="until time 2 is safe"):
        file.close()
    assert frames_of(path) == 3
