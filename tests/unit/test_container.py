"""What is in a recording's file stays good, whatever happens while it is written."""

import errno
import os

import gsd.fl
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from carom.record import container, layout
from carom.record.container import PAGE, Container, create, read_index
from carom.record.file import File

FRAMES = 28
NEW_NAMES = 9  # in this frame many come at once, more than the list of names has room for


def made(path, frames=0):
    if not frames:
        create(path, "w", "carom 0", "hoomd", (1, 4), first=layout.CHECKSUMS)
    return Container(path, frames)


def contents(k):
    """What the test writes into frame k."""
    found = {f"value/{j}": np.full((k % 4, 3), 100 * k + j, np.float64) for j in range(4)}
    if k == 0:
        found[layout.MANIFEST] = layout.as_json({"format": 1})
    if k == NEW_NAMES:
        found |= {f"name/{j}/{'x' * 90}": np.array([j], np.uint8) for j in range(40)}
    return found


def write_frame(file, k):
    chunks = contents(k)
    for name, data in chunks.items():
        file.chunk(name, data)
    sums = {name: layout.checksum(name, data) for name, data in chunks.items()}
    file.chunk(layout.CHECKSUMS, layout.as_json(sums))
    file.end_frame()


def good_frames(path):
    """How many there are; each must be what was written."""
    file = File(path)
    for k in range(len(file)):
        chunks = contents(k)
        assert {*file.names(k)} == {*chunks, layout.CHECKSUMS}
        for name, data in chunks.items():
            np.testing.assert_array_equal(file.read(k, name), data)
    frames = len(file)
    file.close()
    return frames


@pytest.fixture
def path(tmp_path):
    return tmp_path / "run.gsd"


@pytest.fixture
def hasty(monkeypatch):
    """Hundreds of files need not reach the disk."""
    monkeypatch.setattr(os, "fsync", lambda number: None)


kinds = st.sampled_from(container.TYPES[1:]).map(np.dtype)
shapes = st.one_of(st.tuples(st.integers(0, 5)), st.tuples(st.integers(0, 5), st.integers(2, 4)))
chunks = st.dictionaries(
    st.text("abc/", min_size=1, max_size=70),
    arrays.arrays(kinds, shapes, elements={"allow_nan": False}),
)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(chunks, st.booleans()), max_size=8), st.integers(0, 8))
def test_package_gsd_reads_what_is_written(tmp_path_factory, frames, cut):
    path = tmp_path_factory.mktemp("gsd") / "file.gsd"
    create(path, "x", "an application", "a schema", (3, 7), first="first")
    file = Container(path, 0)
    for k, (frame, commit) in enumerate(frames):
        if k == cut:  # somebody else goes on
            file.commit()
            file.close()
            file = Container(path, k)
        for name, data in frame.items():
            file.chunk(name, data)
        file.end_frame()
        if commit:
            file.commit()
    file.commit()
    file.close()
    with gsd.fl.open(str(path), "r") as read:
        assert (read.application, read.schema) == ("an application", "a schema")
        assert (read.schema_version, read.gsd_version) == ((3, 7), (2, 1))
        last = max((k for k, (frame, _) in enumerate(frames) if frame), default=-1)
        assert read.nframes == last + 1
        for k, (frame, _) in enumerate(frames[: last + 1]):
            names = read.find_matching_chunk_names("")
            assert {name for name in names if read.chunk_exists(k, name)} == {*frame}
            for name, data in frame.items():
                found = read.read_chunk(k, name)
                assert found.dtype == data.dtype
                np.testing.assert_array_equal(found, data)


def test_many_frames_make_the_index_and_the_names_move(path):
    file = made(path)
    for k in range(FRAMES):
        write_frame(file, k)
    file.commit()
    file.close()
    head, index = read_index(path)
    assert head["index_size"] == 256
    assert len(index) == 5 * FRAMES + 41
    assert head["names_place"] > 2 * PAGE
    assert head["index_place"] % PAGE == 0
    assert good_frames(path) == FRAMES


def test_only_what_was_committed_is_there(path):
    file = made(path)
    for k in range(3):
        write_frame(file, k)
    file.commit()
    size = path.stat().st_size
    write_frame(file, 3)
    file.chunk("value/0", np.ones(100_000))
    assert good_frames(path) == 3
    file.close()
    assert good_frames(path) == 3
    assert size < path.stat().st_size < size + 1000  # the chunk without an end of its frame is gone


class Failing:
    """A file of which one write fails after a part of it, as where a disk is full."""

    def __init__(self, file, calls, part):
        self._file, self._calls, self._part = file, calls, part

    def write(self, data):
        self._calls -= 1
        if self._calls >= 0:
            return self._file.write(data)
        if self._calls == -1 and self._part:
            # Linux stops a write at the border of a page.
            here = self._file.tell()
            border = (here + len(data)) // PAGE * PAGE - here
            if 0 < border < len(data):
                return self._file.write(data[:border])
        raise OSError(errno.ENOSPC, "No space left on device")

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self._file.close()

    def __getattr__(self, name):
        return getattr(self._file, name)


def interrupted(path, calls, part, begin=0):
    """Write until a write fails; the frames that were committed, and those that had ended."""
    file = made(path, begin)
    file._file = Failing(file._file, calls, part)
    committed = ended = begin
    try:
        for k in range(begin, FRAMES):
            write_frame(file, k)
            ended = k + 1
            if k % 3 == 0:
                file.commit()
                committed = ended
    except OSError:
        return file, committed, ended
    return file, FRAMES, FRAMES


@pytest.mark.parametrize("part", [False, True])
def test_a_kill_at_any_write_leaves_good_frames(path, part, hasty):
    calls, seen = 0, set()
    while True:
        file, committed, ended = interrupted(path, calls, part)
        if committed == FRAMES:
            break
        # Killed: nobody closes it. Another program reads it and goes on.
        file._file._file.close()
        frames = good_frames(path) if committed else 0
        assert committed <= frames <= ended
        seen.add(frames - committed)
        if calls % 5 == 0 and frames:
            file, committed, _ = interrupted(path, 10_000, False, begin=frames)
            assert committed == FRAMES
            file.commit()
            file.close()
            assert good_frames(path) == FRAMES
        calls += 1
    file.close()
    assert calls > 5 * FRAMES
    assert (max(seen) > 0) == part


def test_a_full_disk_costs_the_frame_under_way(path, hasty):
    calls = 0
    while True:
        file, committed, ended = interrupted(path, calls, True)
        if committed == FRAMES:
            break
        file._file = file._file._file  # somebody has made room
        if file.ready:
            file.commit()
        file.close()
        if ended:
            assert good_frames(path) == ended, calls
        calls += 1
    file.close()


def test_what_a_failed_fsync_may_have_lost_is_not_committed(path, monkeypatch):
    file = made(path)
    for k in range(2):
        write_frame(file, k)
    file.commit()
    write_frame(file, 2)

    def fail(number):
        monkeypatch.undo()  # Linux says so only once
        raise OSError(errno.EIO, "Input/output error")

    monkeypatch.setattr(os, "fsync", fail)
    with pytest.raises(OSError, match="Input/output"):
        file.commit()
    assert not file.ready
    file.close()
    assert good_frames(path) == 2
