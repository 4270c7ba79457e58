"""`check` finds whatever in a recording is not what was written, or not what happened."""

import random

import gsd.fl
import numpy as np
import pytest

import carom
from carom import scenes
from carom.errors import CaromError, FileError
from carom.record import layout
from carom.record.check import check


def recorded(path):
    with carom.Simulation(scenes.gas(n=20, seed=1)) as sim:
        sim.record(path, every=0.5)
        sim.run(until=4)
        sim.gravity, sim.rule = (0, 0, -1), carom.Smooth(0.9)
        sim.run(until=6)
        mark = sim.bookmark()
        sim.run(until=7.2)
        sim.return_to(mark)
        sim.run(until=8.1)
    return sim


def content(path):
    """Everything that can be read of a recording."""
    with carom.load(path) as run:
        chunks = [
            (k, name, run.file.read(k, name).tobytes())
            for k in range(len(run.file))
            for name in run.file.sums(k)
        ]
        return run.heads, run.times.tolist(), run.manifest, chunks


@pytest.fixture
def path(tmp_path):
    return tmp_path / "run.gsd"


def test_a_good_one(path):
    sim = recorded(path)
    seen = []
    verdict = check(path, lambda done, total: seen.append((done, total)))
    assert verdict.good
    assert (verdict.damage, verdict.differences) == ([], [])
    assert verdict.events >= sim.collisions + sim.wall_collisions
    with carom.load(path) as run:
        assert seen == [(k + 1, len(run.heads)) for k in range(len(run.heads))]


def flipped(path, times, seed):
    recorded(path)
    good, whole = path.read_bytes(), content(path)
    rng, found = random.Random(seed), 0
    for _ in range(times):
        # The index and the names, at the beginning, are a small part of the file.
        at = rng.randrange(len(good) if rng.random() < 0.7 else 20_000)
        bad = bytearray(good)
        bad[at] ^= 1 << rng.randrange(8)
        path.write_bytes(bad)
        try:
            fine = check(path).good
        except CaromError:
            fine = False
        found += not fine
        if fine:  # the file's format keeps some space for later; nothing that is read was there
            assert content(path) == whole, at
    return found


def test_a_flipped_bit_is_found_wherever_it_changes_anything(path):
    assert flipped(path, times=60, seed=1) > 30


@pytest.mark.validate
def test_a_flipped_bit_is_found_at_thousands_of_places(path):
    assert flipped(path, times=3000, seed=2) > 2000


def test_damage_is_one_sentence_for_each_frame_and_stops_reading(path):
    recorded(path)
    data = bytearray(path.read_bytes())
    with carom.load(path) as run:
        for k in (2, 5):
            data[data.find(run.file.read(k, "carom/velocity").tobytes())] ^= 1
    path.write_bytes(data)
    verdict = check(path)
    assert not verdict.good
    assert len(verdict.damage) == 2
    assert (
        "of frame 2 carom/velocity is not what was written; take another copy" in verdict.damage[0]
    )
    run = carom.load(path)
    with pytest.raises(FileError, match="of frame 5 carom/velocity is not what was written"):
        run[5]
    assert len(run[4]) == 20


@pytest.mark.parametrize("what", ["position", "events", "checkpoint", "collisions", "dissipated"])
def test_a_forged_frame_with_the_right_checksums_is_found(path, what):
    recorded(path)
    forge(path, what)
    verdict = check(path)
    assert verdict.damage == []
    sentence = verdict.differences[0]
    # A checkpoint is seen by what it leads to.
    assert what == "checkpoint" or f"{what} as recorded by carom" in sentence


def forge(path, what):
    """Write a recording anew with one bit, or one number, of a frame in its middle changed."""
    copy = path.with_suffix(".copy")
    options = {"application": "carom", "schema": "hoomd", "schema_version": (1, 4)}
    done = False
    with carom.load(path) as run, gsd.fl.open(str(copy), "w", **options) as file:
        for k in range(len(run.file)):
            sums = dict(run.file.sums(k))
            for name in sums:
                data = run.file.read(k, name)
                here = k > 12 and not done
                if here and name == f"carom/{what}" and data.size:
                    data = data.copy()
                    data.reshape(-1).view(np.uint8)[data.nbytes // 2] ^= 1
                elif here and name == layout.HEAD and what in run.heads[k]:
                    data = layout.as_json(run.heads[k] | {what: run.heads[k][what] + 1})
                done = done or layout.checksum(name, data) != sums[name]
                sums[name] = layout.checksum(name, data)
                file.write_chunk(name, data)
            file.write_chunk(layout.CHECKSUMS, layout.as_json(sums))
            file.end_frame()
    assert done
    copy.replace(path)


def test_frames_are_counted_as_everywhere(path):
    with carom.Simulation(scenes.gas(n=20, seed=1)) as sim:
        sim.record(path, every=0.25)
        sim.run(until=2)  # its last frame comes again, with a checkpoint
    with carom.load(path) as run:
        assert len(run) < len(run.heads)
        assert check(path).frames == len(run)
