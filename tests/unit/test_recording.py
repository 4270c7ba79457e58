"""What is read back from a recording is what happened: frames, times in between, events."""

from dataclasses import replace

import numpy as np
import pytest

import carom
from carom import scenes
from carom.errors import FileError, InputError
from carom.record import layout, recorder

ARRAYS = (
    "position", "velocity", "unwrapped_position", "collision_count", "resting", "mass", "radius",
    "color", "species", "fixed",
)  # fmt: skip
NUMBERS = ("time", "collisions", "wall_collisions", "dissipated", "energy_drift", "missed")


def sinking():
    """Balls come to rest on a floor, and others fall on them and wake them; one is fixed."""
    x, y = (a.ravel() for a in np.meshgrid([-3.0, -1.0, 1.0, 3.0], [-3.0, -1.0, 1.0, 3.0]))
    low = np.column_stack([x, y, np.full(16, -3.8)])
    high = low + np.random.default_rng(4).uniform([-0.3, -0.3, 5], [0.3, 0.3, 7], (16, 3))
    spheres = carom.Spheres.of(np.concatenate([low, high]), mass=2, fixed=np.arange(32) == 0)
    return carom.Scene(
        spheres,
        walls=carom.Box(9, 9, 9, restitution=0.5),
        rule=carom.Smooth(0.8),
        gravity=(0, 0, -2),
        seed=4,
        title="Sinking",
    )


WORLDS = {
    "gas": lambda: scenes.gas(n=60, seed=2),
    "fluid": lambda: scenes.fluid(n=108, packing_fraction=0.3, seed=3),
    "giant": lambda: scenes.giant(n=60),
    "sinking": sinking,
    "ideal": lambda: replace(scenes.gas(n=30, seed=2), collide=False),
    "cured": lambda: replace(sinking(), rule=carom.Smooth(0.6, contact_time=1e-3)),
    "paper": scenes.phase_2,
}
every_world = pytest.mark.parametrize("world", WORLDS)


@pytest.fixture
def path(tmp_path):
    return tmp_path / "run.gsd"


def same_bits(frame, sim, names=ARRAYS + NUMBERS):
    for name in names:
        np.testing.assert_array_equal(getattr(frame, name), getattr(sim, name), err_msg=name)


def close(frame, sim):
    """But for rounding."""
    for name in ("time", "collisions", "wall_collisions", "collision_count", "resting"):
        np.testing.assert_array_equal(getattr(frame, name), getattr(sim, name), err_msg=name)
    for name in ("unwrapped_position", "velocity"):
        found, right = getattr(frame, name), getattr(sim, name)
        size = np.abs(right).max()
        assert np.abs(found - right).max() < 1e-12 * size, name
    assert frame.dissipated == pytest.approx(sim.dissipated, rel=1e-12, abs=1e-12)


@every_world
def test_frames_are_what_was_to_the_bit_and_recording_changes_no_bit(world, path):
    scene = WORLDS[world]()
    every, end = scene.pace / 7, 3.3 * scene.pace
    plain = carom.Simulation(scene)
    with carom.Simulation(scene) as sim:
        sim.record(path, every=every)
        sim.run(until=end)
    plain.run(until=end)
    same_bits(sim, plain)
    run = carom.load(path)
    again = carom.Simulation(scene)
    assert run.times.tolist() == [k * every for k in range(24)] + [end]
    for frame, time in zip(run, run.times, strict=True):
        again.run(until=time)
        same_bits(frame, again)
        assert frame.walls == sim.walls
        assert frame.rule == sim.rule
        assert frame.gravity.tolist() == sim.gravity.tolist()
        assert frame.collide == sim.collide
    assert run[-1].max_overlap == sim.max_overlap
    assert run[-1].withheld == sim.withheld
    assert (run.start, run.end, run.pace) == (0.0, end, scene.pace)
    assert run.scene == scene


@every_world
def test_any_time_is_exact_but_for_rounding(world, path):
    scene = WORLDS[world]()
    end = 4 * scene.pace
    with carom.Simulation(scene) as sim:
        sim.record(path, every=end / 3)  # long stretches, of many collisions a sphere
        sim.run(until=end)
    run, again = carom.load(path), carom.Simulation(scene)
    for time in np.sort(np.random.default_rng(1).uniform(0, end, 25)):
        again.run(until=time)
        close(run.at(time), again)
    same_bits(run.at(end), sim)
    times = [0.0, 0.1, 2.5]
    assert [frame.time for frame in run.frames(at=times)] == times
    few = [frame.time for frame in run.frames(every=end / 5)]
    assert few == pytest.approx([k * end / 5 for k in range(6)], rel=1e-15)
    assert [frame.time for frame in run.frames(every=end / 5, until=end / 2)] == few[:3]


def test_something_rests_and_wakes_in_the_worlds_above(path):
    with carom.Simulation(sinking(), record=path) as sim:
        sim.run(until=4)
    run = carom.load(path)
    j = run.events()["j"]
    assert (j == -(2**21)).any()  # woke
    assert ((j <= -(2**20) - 1) & (j > -(2**21))).any()  # came to rest
    assert any(frame.resting.any() for frame in run)


@every_world
def test_events_are_those_of_the_run(world, path):
    scene = WORLDS[world]()
    with carom.Simulation(scene, record=path) as sim:
        sim.run(until=2 * scene.pace)
    run, events = carom.load(path), sim.events
    assert (run.events() == events).all()
    begin, end = 0.31 * scene.pace, 1.27 * scene.pace
    inside = (events["time"] >= begin) & (events["time"] <= end)
    assert (run.events(begin, end) == events[inside]).all()
    if inside.any():
        first = events["time"][inside][0]  # both ends count
        assert first in run.events(first, first)["time"]


def test_changes_from_outside_begin_segments(path):
    def go(sim):
        yield sim.run(until=1.01)
        sim.velocity = -sim.velocity
        yield sim.run(until=1.5)
        sim.gravity = (0, 0, -1)
        sim.rule = carom.Smooth(0.9)
        sim.remove(3)
        yield sim.run(collisions=25)
        sim.walls = carom.Open()
        sim.add(position=(0, 0, 30), species=7, color="red", mass=3)
        yield sim.run(duration=0.7)

    scene = scenes.gas(n=40, seed=5)
    plain, times, frames = carom.Simulation(scene), [], []
    with carom.Simulation(scene) as sim:
        sim.record(path, every=0.3)
        for _ in zip(go(sim), go(plain), strict=True):
            same_bits(sim, plain)
            times.append(sim.time)
            frames.append(sim._motion.frame())
    run = carom.load(path)
    assert run.heads[-1]["segment"] == 3
    assert (np.diff(run.times) >= 0).all()
    for time, frame in zip(times[:3], frames[:3], strict=True):  # before the change, and after it
        first, second = np.flatnonzero(run.times == time)
        same_bits(run[int(first)], frame)
        assert run.at(time).time == run[int(second)].time
    after = run.at(times[0])
    assert (after.velocity == -frames[0].velocity).all()
    same_bits(run[-1], frames[-1])
    assert run[-1].species[-1] == 7
    assert run[-1].walls == (carom.Open(),)
    assert len(run[0]) == len(scene.spheres) == len(run[-1])
    assert len(run.at(times[1])) == 39
    assert (run.events()["j"] >= 0).sum() == sim.collisions
    again = carom.Simulation(scene)
    again.run(until=1.01)
    again.velocity = -again.velocity
    again.run(until=1.44)
    close(run.at(1.44), again)


def test_going_back_in_time_takes_what_came_after_out_of_the_recording(path):
    scene = scenes.gas(n=40, seed=5)
    with carom.Simulation(scene) as sim:
        sim.record(path, every=0.25)
        sim.run(until=2.1)
        mark = sim.bookmark()
        sim.run(until=3)
        sim.return_to(mark)
        sim.velocity = 2 * sim.velocity
        sim.run(until=4)
    run = carom.load(path)
    assert len(run.file) > len(run)
    assert (np.diff(run.times) >= 0).all()
    again = carom.Simulation(scene)
    events = []
    for time in (2.06, 2.1, 3.3):
        again.run(until=time)
        events.append(again.events)
        if time == 2.1:
            again.velocity = 2 * again.velocity
        close(run.at(time), again)
    assert (run.events(0, 3.3) == np.concatenate(events)).all()

    with carom.Simulation(scene) as sim:
        sim.record(path, every=0.25, overwrite=True)
        sim.run(until=2)
        sim.reset()
        sim.run(until=1)
    assert carom.load(path).times.tolist() == [0, 0.25, 0.5, 0.75, 1]
    assert (carom.load(path).events() == sim.events).all()


def test_many_events_go_to_the_file_in_parts(path, monkeypatch):
    monkeypatch.setattr(recorder, "MOST_EVENTS", 50)
    with carom.Simulation(scenes.fluid(n=108, seed=3)) as sim:
        sim.record(path, every=10.0)
        sim.run(until=1)
    run = carom.load(path)
    assert run.file.has(1, layout.events_name(3))
    assert (run.events() == sim.events).all()


def test_a_program_that_does_not_close_it_keeps_what_was_recorded(path):
    sim = carom.Simulation(scenes.gas(n=20, seed=1), record=path)
    sim.run(until=1)
    (follower,) = sim._motion.followers
    follower._writer.close()  # what happens at the end of a program
    run = carom.load(path)
    assert run.end == pytest.approx(1, abs=1 / 30 + 1e-12)


def test_spheres_added_one_by_one_have_no_scene_but_all_else(path):
    with carom.Simulation(record=path) as sim:
        sim.add(position=(-2, 0, 0), velocity=(1, 0, 0))
        sim.add(position=(2, 0, 0))
        sim.run(until=6)
    run = carom.load(path)
    assert run.scene is None
    assert run.pace == 1
    assert run[-1].velocity[:, 0].tolist() == [0, 1]
    assert run.at(3.5).position[0, 0] == pytest.approx(1)


def test_a_recording_says_how_it_came_to_be(path):
    with carom.Simulation(scenes.gas(n=20, seed=9), record=path) as sim:
        sim.run(until=0.1)
    manifest = carom.load(path).manifest
    assert manifest["carom"] == carom.__version__
    assert (manifest["scene"], manifest["seed"], manifest["format"]) == ("gas", 9, 1)
    assert manifest["options"]["n"] == 20
    assert manifest["started"].endswith("+00:00")
    assert manifest["command"]


@pytest.mark.parametrize("method", ["tick", "reference"])
def test_only_the_exact_method_is_recorded(path, method):
    with pytest.raises(InputError, match=f"method '{method}' cannot be recorded"):
        carom.Simulation(scenes.two_balls(), method=method, record=path)


def test_a_file_that_is_there_is_kept(path):
    path.write_text("a diary")
    sim = carom.Simulation(scenes.two_balls())
    with pytest.raises(InputError, match="is there already"):
        sim.record(path)
    assert path.read_text() == "a diary"
    with sim:
        sim.record(path, overwrite=True)
        sim.run(until=1)
    assert carom.load(path).end == 1


def test_two_recordings_into_one_file_are_refused(path):
    with carom.Simulation(scenes.two_balls(), record=path) as sim:
        sim.run(until=1)
        with pytest.raises(FileError, match="another program is writing"):
            carom.Simulation(scenes.two_balls()).record(path, overwrite=True)
        with pytest.raises(FileError, match="another program is writing"):
            carom.Simulation.resume(path)
    assert carom.load(path).end == 1


def test_files_that_cannot_be_written(tmp_path):
    sim = carom.Simulation(scenes.two_balls())
    with pytest.raises(FileError, match=r"cannot write .*No such file"):
        sim.record(tmp_path / "nowhere" / "run.gsd")
    with pytest.raises(FileError, match="cannot write"):
        sim.record(tmp_path, overwrite=True)


def test_what_is_no_recording_is_refused_in_one_sentence(tmp_path, path):
    import gsd.hoomd

    with pytest.raises(FileError, match=r"cannot read .*No such file"):
        carom.load(path)
    path.write_text("spheres")
    with pytest.raises(InputError, match="is no recording"):
        carom.load(path)
    other = tmp_path / "other.gsd"
    with gsd.hoomd.open(other, "w") as file:
        frame = gsd.hoomd.Frame()
        frame.particles.N, frame.particles.position = 1, [[0, 0, 0]]
        file.append(frame)
    with pytest.raises(InputError, match="not recorded by carom"):
        carom.load(other)


def test_recordings_cut_short_or_of_later_versions_are_refused(path, monkeypatch):
    monkeypatch.setattr(layout, "FORMAT", 2)
    with carom.Simulation(scenes.two_balls(), record=path) as sim:
        sim.run(until=1)
    monkeypatch.undo()
    with pytest.raises(InputError, match=r"has format 2, and carom .* reads up to 1; update carom"):
        carom.load(path)
    with carom.Simulation(scenes.gas(n=20)) as sim:
        sim.record(path, overwrite=True)
        sim.run(until=1)
    data = path.read_bytes()
    for part in (0.9, 0.5, 0.1):
        path.write_bytes(data[: int(part * len(data))])
        with pytest.raises(FileError, match="cut short or damaged"):
            carom.load(path)
    path.write_bytes(b"")
    with pytest.raises(InputError, match="is no recording"):
        carom.load(path)


def test_times_outside_are_refused(path):
    with carom.Simulation(scenes.two_balls(), record=path) as sim:
        sim.run(until=1)
    run = carom.load(path)
    with pytest.raises(InputError, match="time 2 is outside the recording, from 0 to 1"):
        run.at(2)
    with pytest.raises(InputError, match="exactly one of them"):
        run.frames()
    with pytest.raises(IndexError):
        run[len(run)]
    assert repr(run).endswith("run.gsd, 21 frames, time 0 to 1>")
    assert [f.time for f in run.frames(at=[0.5, 7.0])] == [0.5]


def test_a_slice_is_a_list_of_frames(path):
    with carom.Simulation(scenes.gas(n=20, seed=1)) as sim:
        sim.record(path, every=0.25)
        sim.run(until=2)
    run = carom.load(path)
    assert [frame.time for frame in run[1::3]] == [0.25, 1.0, 1.75]
    assert [frame.time for frame in run[-2:]] == [1.75, 2.0]
