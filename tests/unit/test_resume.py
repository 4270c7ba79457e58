"""A run that was interrupted, at any instant and in any way, comes to the same end."""

import os
import random
import re
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import gsd.fl
import pytest

import carom
from carom import scenes
from carom.errors import FileError, InputError
from carom.record import again
from carom.record.check import check
from carom.record.container import ENTRY, begin_of, read_index

from .test_recording import WORLDS, same_bits

ENDLESS = """
import sys, carom
sim = carom.Simulation(carom.scenes.gas(n=int(sys.argv[2]), seed=1))
sim.record(sys.argv[1], every=0.01)
print("go", flush=True)
sim.run(until=1e9, progress=lambda sim: print(sim.time, flush=True))
"""


@pytest.fixture
def path(tmp_path):
    return tmp_path / "run.gsd"


@pytest.mark.parametrize("world", WORLDS)
def test_a_run_in_pieces_ends_with_the_same_bits(world, path):
    scene = WORLDS[world]()
    ends = [0.0, 0.77 * scene.pace, 1.1 * scene.pace, 3.0 * scene.pace]
    plain = carom.Simulation(scene, record=path)
    plain.close()
    for end in ends:
        plain.run(until=end)
        with carom.Simulation.resume(path) as sim:
            sim.run(until=end)
        same_bits(sim, plain)
        assert sim.withheld == plain.withheld
        assert sim.max_overlap == plain.max_overlap
    assert check(path).good
    run = carom.load(path)
    assert run.scene == scene
    assert len(run.events()) >= sim.collisions + sim.wall_collisions


def test_changes_between_the_pieces_too(path):
    def change(sim, k):
        if k == 1:
            sim.gravity, sim.rule = (0, 0, -1), carom.Smooth(0.9)
        elif k == 2:
            sim.remove(5)
            sim.velocity = -sim.velocity
        elif k == 3:
            sim.walls = carom.Open()
            sim.add(position=(0, 0, 50), color="red")

    scene = scenes.gas(n=50, seed=6)
    plain = carom.Simulation(scene)
    with carom.Simulation(scene, record=path):
        pass
    for k in range(4):
        sim = carom.Simulation.resume(path)
        for each in (plain, sim):
            change(each, k)
            each.run(until=1.3 * (k + 1))
        sim.close()
        same_bits(sim, plain)
    assert check(path).good
    with carom.Simulation.resume(path) as sim:
        sim.reset()  # to where the first run began, in another program
        assert (sim.position == carom.Simulation(scene).position).all()
        sim.run(until=0.5)
    assert carom.load(path).end == 0.5


def test_an_end_amid_simultaneous_collisions(path):
    scene = scenes.newton_cradle()
    plain = carom.Simulation(scene)
    with carom.Simulation(scene, record=path) as sim:
        sim.run(collisions=2)
    plain.run(collisions=2)
    for _ in range(5):
        plain.run(collisions=1)
        with carom.Simulation.resume(path) as sim:
            sim.run(collisions=1)
        same_bits(sim, plain)
    assert check(path).good


def test_what_it_was_and_where_it_goes_on(path):
    scene = scenes.gas(n=30, seed=6)
    with carom.Simulation(scene) as sim:
        sim.record(path, every=0.25, checkpoint_every=0.5)
        sim.run(until=1.1)
    with carom.Simulation.resume(path) as sim:
        assert (sim.time, sim.collisions, sim.scene) == (
            1.1,
            carom.load(path)[-1].collisions,
            scene,
        )
        sim.run(until=1.9)
    assert carom.load(path).times.tolist() == [0, 0.25, 0.5, 0.75, 1, 1.1, 1.25, 1.5, 1.75, 1.9]


def test_after_a_collapse_it_is_still_collapsed(path):
    scene = carom.Scene(
        carom.Spheres.of(
            [(-1.0, 0, 0), (0.5, 0, 0), (3.0, 0, 0)], [(1.0, 0, 0), (0, 0, 0), (-1.0, 0, 0)]
        ),
        rule=carom.Smooth(0.05),
    )
    with pytest.raises(carom.CollapseError), carom.Simulation(scene, record=path) as sim:
        sim.run(until=10)
    with carom.Simulation.resume(path) as again:
        same_bits(again, sim)
        with pytest.raises(carom.CollapseError):
            again.run(until=10)


def killed(path, n, wait):
    program = [sys.executable, "-c", ENDLESS, str(path), str(n)]
    with subprocess.Popen(program, stdout=subprocess.PIPE) as child:
        child.stdout.readline()
        time.sleep(wait)
        child.send_signal(signal.SIGKILL)


def killed_at_random(path, times, seed):
    rng = random.Random(seed)
    frames = []
    for _ in range(times):
        path.unlink(missing_ok=True)
        n = rng.choice([5, 100, 400])
        killed(path, n, 0.8 * rng.random() ** 2)
        with gsd.fl.open(str(path), "r") as file:
            empty = file.nframes == 0  # killed before it could write one
        if empty:
            with pytest.raises(FileError, match="without a frame"):
                carom.load(path)
            continue
        frames.append(len(carom.load(path)))
        assert check(path).good
        sim = carom.Simulation.resume(path)
        sim.run(duration=0.1)
        sim.close()
        plain = carom.Simulation(scenes.gas(n=n, seed=1))
        plain.run(until=sim.time)
        same_bits(sim, plain)
        assert check(path).good
    assert len(frames) > times / 2
    assert max(frames) > 3


def test_killed_at_any_instant_it_can_be_read_and_goes_on(path):
    killed_at_random(path, times=5, seed=1)


def test_a_kill_loses_no_more_than_a_moment(path):
    program = [sys.executable, "-c", ENDLESS, str(path), "5"]  # thousands of frames a second
    with subprocess.Popen(program, stdout=subprocess.PIPE, text=True) as child:
        child.stdout.readline()
        for _ in range(10):
            then = float(child.stdout.readline())
        time.sleep(0.5)
        child.send_signal(signal.SIGKILL)
    assert carom.load(path).end > then


@pytest.mark.validate
def test_killed_at_a_hundred_instants(path):
    killed_at_random(path, times=100, seed=2)


def cut_off(path, entries):
    """Take the last entries out of the index, as a kill may; how many the last frame has."""
    head, index = read_index(path)
    of_last = len(index) - begin_of(index, int(index["frame"][-1]))
    place = int(head["index_place"]) + (len(index) - entries) * ENTRY.itemsize
    data = bytearray(path.read_bytes())
    data[place : place + entries * ENTRY.itemsize] = bytes(entries * ENTRY.itemsize)
    path.write_bytes(data)
    return of_last


def test_a_frame_that_a_kill_has_cut_off_is_not_there_and_comes_again(path):
    scene = scenes.gas(n=100, seed=1)
    with carom.Simulation(scene) as plain:
        plain.record(path, every=0.1)
        plain.run(until=2.05)
    good, frames = path.read_bytes(), len(carom.load(path))
    chunks = cut_off(path, 1)
    for entries in (1, chunks // 2, chunks - 1, chunks):
        path.write_bytes(good)
        cut_off(path, entries)
        assert carom.load(path).end == pytest.approx(2)
        assert check(path).good
        with carom.Simulation.resume(path) as sim:
            sim.run(until=2.05)
        same_bits(sim, plain)
        assert check(path).good
        assert len(carom.load(path)) == frames


FULL = """
import resource, sys, carom
sim = carom.Simulation(carom.scenes.gas(n=100, seed=1))
sim.record(sys.argv[1], every=0.01)
sim.run(until=0.2)
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[2]), -1))
try:
    sim.run(until=100)
except carom.FileError as error:
    print(error)
try:
    sim.close()
except carom.FileError as error:
    print(error)
print(sim.time < 100)
sim.run(duration=1)  # nothing is lost of the simulation itself
"""


def filled(path, size):
    """Record until the file may not grow any more."""
    path.unlink(missing_ok=True)
    program = [sys.executable, "-c", FULL, str(path), str(size)]
    done = subprocess.run(program, capture_output=True, text=True, check=True)
    first, second, early = done.stdout.splitlines()
    assert first.startswith(f"cannot write {path}: ")
    assert second == first
    assert early == "True"
    assert check(path).good
    safe = float(re.search(r"what was recorded until time (\S+) is safe", first)[1])
    run = carom.load(path)
    assert run.end == pytest.approx(safe)
    # Nothing but the frame under way has gone, and what was written of it.
    a_frame = 2 * path.stat().st_size / len(run)
    index = ENTRY.itemsize * int(read_index(path)[0]["index_size"])
    assert size - a_frame - 2 * index < path.stat().st_size <= size
    return run


# From 950 kB to 1 MB the frames fit, but no index twice as large as before.
@pytest.mark.parametrize("size", [600_000, 975_000])
def test_a_full_disk_ends_the_run_with_a_sentence_and_what_was_written_is_good(path, size):
    frames = len(filled(path, size))
    assert frames > 20
    with carom.Simulation.resume(path) as sim:
        sim.run(duration=0.1)
    plain = carom.Simulation(scenes.gas(n=100, seed=1))
    plain.run(until=sim.time)
    same_bits(sim, plain)
    assert len(carom.load(path)) > frames


@pytest.mark.validate
def test_a_disk_that_is_full_at_any_size(path):
    for size in range(300_000, 1_500_000, 30_000):
        filled(path, size)


def test_a_file_without_permission_to_write():
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "run.gsd"
        with carom.Simulation(scenes.two_balls(), record=path) as sim:
            sim.run(until=1)
        path.chmod(0o444)
        path.parent.chmod(0o755)
        user = os.geteuid()
        if user == 0:  # who may write everything, so somebody else tries
            os.seteuid(65534)
        try:
            with pytest.raises(FileError, match=r"cannot write .*run.gsd: Permission denied"):
                carom.Simulation.resume(path)
        finally:
            os.seteuid(user)


def test_another_version_cannot_go_on_but_read(path, monkeypatch):
    with carom.Simulation(scenes.gas(n=20), record=path) as sim:
        sim.run(until=1)

    def refuse(self, checkpoint):
        raise ValueError

    monkeypatch.setattr(again.FastEngine, "restore", refuse)
    with pytest.raises(InputError, match="cannot go on from its checkpoints; use the version"):
        carom.Simulation.resume(path)
    assert not check(path).good
    same_bits(carom.load(path)[-1], sim)


def test_other_bits_on_another_machine_are_noticed(path, monkeypatch):
    with carom.Simulation(scenes.gas(n=20)) as sim:
        sim.record(path, every=0.25)
        sim.run(until=1.5)
    monkeypatch.setattr(again, "difference", lambda *args: "position")
    with pytest.raises(InputError, match="comes to another position than carom"):
        carom.Simulation.resume(path)
    with pytest.raises(InputError, match="comes to another position"):
        carom.Simulation.resume(path)  # and nobody holds the file


def test_what_cannot_be_resumed(path):
    path.write_text("spheres")
    with pytest.raises(InputError, match="is no recording"):
        carom.Simulation.resume(path)
