"""When a recording has frames and checkpoints."""

import numpy as np
import pytest

import carom
from carom import scenes
from carom.errors import InputError
from carom.record import layout, recorder


@pytest.fixture
def path(tmp_path):
    return tmp_path / "run.gsd"


def test_of_a_long_run_only_frames_that_are_worth_it_are_kept(path):
    scene = scenes.gas(n=120, seed=1)
    with carom.Simulation(scene, record=path) as sim:
        sim.run(until=60 * scene.pace)  # 1800 frames, were they all kept
    with carom.Simulation.resume(path) as sim:
        sim.run(until=120 * scene.pace)
    run = carom.load(path)
    step = scene.pace / recorder.FRAMES_PER_SECOND
    film = recorder.FILM_FRAMES
    assert run.times[:film] == pytest.approx(step * np.arange(film))
    later = np.array([k for k in range(film + 1, len(run) - 1) if run.times[k] < 60 * scene.pace])
    happened = np.array([len(run.told(k - 1)) for k in later])
    assert (happened >= len(scene.spheres)).all()
    assert (happened < 2 * len(scene.spheres)).all()
    events = len(run.events())
    assert len(run) - film - 3 <= events / len(scene.spheres)
    assert len(later) > 10
    steps = run.times / step
    assert np.abs(steps - steps.round()).max() < 1e-6
    have = [run.file.has(k, layout.CHECKPOINT) for k in later]
    assert sum(have) == pytest.approx(len(later) / recorder.CHECKPOINT_FRAMES, abs=1)
    plain = carom.Simulation(scene)
    plain.run(until=77.7 * scene.pace)
    frame = run.at(plain.time)
    assert frame.position == pytest.approx(plain.position, abs=1e-12)
    assert frame.collisions == plain.collisions


def test_who_says_how_often_gets_every_frame(path):
    scene = scenes.gas(n=20, seed=1)
    with carom.Simulation(scene) as sim:
        sim.record(path, checkpoint_every=scene.pace)
        sim.run(until=20 * scene.pace)
    assert len(carom.load(path)) == 601
    with carom.Simulation(scene) as sim:
        sim.record(path, every=0.01, overwrite=True)
        sim.run(until=5)
    assert len(carom.load(path)) == 501


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"every": 0}, "every is 0; it must be more than 0"),
        ({"every": 1e-9}, "spheres do not move a millionth of their radius; take at least"),
        ({"every": 0.1, "checkpoint_every": 0.25}, "give a multiple of that"),
        ({"every": 0.1, "checkpoint_every": 0.01}, "give a multiple of that"),
    ],
)
def test_wrong_times(path, options, message):
    sim = carom.Simulation(scenes.two_balls())
    with pytest.raises(InputError, match=message):
        sim.record(path, **options)
    assert not path.exists()


def test_checkpoints_come_as_asked(path):
    with carom.Simulation(scenes.two_balls()) as sim:
        sim.record(path, every=0.1, checkpoint_every=0.4)
        sim.run(until=1.3)
    run = carom.load(path)
    have = [h["time"] for k, h in enumerate(run.heads) if run.file.has(k, layout.CHECKPOINT)]
    assert have == pytest.approx([0, 0.4, 0.8, 1.2, 1.3])


def test_units_of_a_world_at_rest_are_anybodys(path):
    sim = carom.Simulation(carom.Scene(carom.Spheres.of([[0, 0, 0]])))
    with sim:
        sim.record(path, every=1e-12)
        sim.run(until=3e-12)
    assert len(carom.load(path)) == 4
