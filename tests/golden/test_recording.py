"""A recording of every format there was must open for ever."""

from pathlib import Path

import numpy as np
import pytest

import carom
from carom.record.file import File
from carom.record.recording import Recording

DATA = Path(__file__).parent / "data"


def golden(path):
    """What recording-1.gsd was made by, with carom 0.1.0: falling, bouncing, changed on the way."""
    with carom.Simulation(carom.scenes.gas(n=12, seed=1)) as sim:
        sim.record(path, every=0.5, checkpoint_every=2)
        sim.run(until=3.2)
        sim.gravity, sim.rule = (0, 0, -1), carom.Smooth(0.9)
        sim.run(until=6)
    return sim


@pytest.mark.parametrize("path", sorted(DATA.glob("recording-*.gsd")), ids=lambda p: p.stem)
def test_it_opens(path):
    run = carom.load(path)
    assert run.manifest["format"] == int(path.stem.split("-")[1])
    assert run.manifest["seed"] == 1
    assert run.scene == carom.scenes.gas(n=12, seed=1)
    assert run.times.tolist() == [0, 0.5, 1, 1.5, 2, 2.5, 3, 3.2, 3.2, 3.5, 4, 4.5, 5, 5.5, 6]
    assert run[8].gravity.tolist() == [0, 0, -1]
    assert run[8].rule == carom.Smooth(0.9)
    # Physics ties what is read together: energy, and events that lead from frame to frame.
    for frame in run:
        assert abs(frame.energy_drift) < 1e-14
    start, end = run[8], run[-1]
    given = end.kinetic_energy + end.potential_energy + end.dissipated
    assert given == pytest.approx(start.kinetic_energy + start.potential_energy, rel=1e-13)
    pairs = (run.events()["j"] >= 0).sum()
    assert pairs == end.collisions > 3
    for k in range(1, len(run)):
        if run.times[k] > run.times[k - 1]:
            before = np.nextafter(run.times[k], 0)
            assert np.abs(run.at(before).position - run[k].position).max() < 1e-12


def test_the_newest_format_is_what_is_written_now(tmp_path):
    sim = golden(tmp_path / "run.gsd")
    newest = max(DATA.glob("recording-*.gsd"))
    old, new = Recording(newest), carom.load(tmp_path / "run.gsd")
    assert sorted(old.file.names(0)) == sorted(new.file.names(0))
    assert (old[-1].position == sim.position).all()
    assert (old.events() == new.events()).all()


def test_it_goes_on(tmp_path):
    copy = tmp_path / "run.gsd"
    copy.write_bytes((DATA / "recording-1.gsd").read_bytes())
    sim = carom.Simulation.resume(copy)
    plain = golden(tmp_path / "other.gsd")
    for each in (sim, plain):
        each.run(until=7)
    sim.close()
    assert (sim.position == plain.position).all()
    assert len(File(copy)) > len(File(DATA / "recording-1.gsd"))
