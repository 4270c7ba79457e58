"""What other programs read of a recording, and the formats it is converted to."""

import re

import gsd.hoomd
import h5py
import numpy as np
import pytest

import carom
from carom import scenes
from carom.errors import FileError, InputError, UnknownNameError
from carom.record import hoomd
from carom.record.convert import convert


@pytest.fixture
def path(tmp_path):
    return tmp_path / "run.gsd"


def record(path, scene, every=0.5, until=2.0):
    with carom.Simulation(scene) as sim:
        sim.record(path, every=every)
        sim.run(until=until)
    return carom.load(path)


@pytest.mark.parametrize(
    "scene",
    [scenes.fluid(n=108, packing_fraction=0.3, seed=3), scenes.giant(n=40), scenes.phase_4()],
    ids=["fluid", "giant", "phase-4"],
)
def test_the_schema_of_hoomd_tells_the_same_in_single_precision(path, scene):
    run = record(path, scene)
    with gsd.hoomd.open(path) as file:
        assert file.file.schema == "hoomd"
        assert file.file.application == f"carom {carom.__version__}"
        assert len(file) == len(run.file)
        for k, frame in enumerate(run):
            seen = file[k]
            seen.validate()
            particles = seen.particles
            assert len(frame) == particles.N
            assert seen.configuration.step == frame.collisions + frame.wall_collisions
            assert seen.log["time"] == [frame.time]
            pairs = {
                "position": frame.position, "velocity": frame.velocity, "mass": frame.mass,
                "diameter": 2 * frame.radius,
            }  # fmt: skip
            for name, right in pairs.items():
                assert (getattr(particles, name) == right.astype("f4")).all(), name
            assert (particles.image == frame.state.image).all()
            names = [particles.types[kind] for kind in particles.typeid]
            assert names == [str(label) for label in frame.species]
            box = seen.configuration.box
            assert (np.abs(particles.position) <= box[:3] / 2).all()
            period = frame.world.period
            assert (box[:3][period > 0] == period[period > 0].astype("f4")).all()


def test_changed_spheres_are_seen_by_others_too(path):
    with carom.Simulation(scenes.gas(n=10, seed=1)) as sim:
        sim.record(path, every=0.5)
        sim.run(until=1.2)
        sim.remove(0)
        sim.radius, sim.mass, sim.species = 0.1, 7, 3
        sim.run(until=2.5)
        sim.add(position=(0, 0, 0), radius=0.01)
        sim.radius, sim.mass, sim.species = 0.5 * sim.radius, 1, 0
        sim.run(until=3.2)  # no frame comes again with a checkpoint
    run = carom.load(path)
    with gsd.hoomd.open(path) as file:
        for seen, frame in zip(file, run, strict=True):
            assert len(frame) == seen.particles.N
            assert (seen.particles.diameter == (2 * frame.radius).astype("f4")).all()
            assert (seen.particles.mass == frame.mass).all()
            names = [seen.particles.types[kind] for kind in seen.particles.typeid]
            assert names == [str(label) for label in frame.species]


@pytest.mark.parametrize(
    ("walls", "sides"),
    [
        (carom.Box(4, 5, 6), [4, 5, 6]),
        (carom.Periodic(4, 5, 6), [4, 5, 6]),
        (carom.Sphere(5), [10, 10, 10]),
        (carom.Cylinder(5, 7), [10, 10, 7]),
        ([carom.Periodic(4, 5, None), carom.Plane((0, 0, 1), -3)], [4, 5, 8]),
        (carom.Open(), [4, 8, 8]),
    ],
)
def test_a_box_that_holds_the_world(walls, sides):
    sim = carom.Simulation(walls=walls)
    sim.add(position=(1.0, -1.4, 2), radius=0.9)
    assert hoomd.lengths(sim.state, sim.world) == sides


def test_extended_xyz(path, tmp_path):
    run = record(path, scenes.fluid(n=32, seed=1))
    seen = []
    convert(run, tmp_path / "run.xyz", lambda done, total: seen.append((done, total)))
    assert seen == [(k + 1, 5) for k in range(5)]
    lines = (tmp_path / "run.xyz").read_text().splitlines()
    assert len(lines) == 5 * 34
    for k, frame in enumerate(run):
        count, head, *rows = lines[34 * k : 34 * (k + 1)]
        assert count == "32"
        side = frame.world.period[0]
        assert f'Lattice="{side} 0 0 0 {side} 0 0 0 {side}"' in head
        assert f"Time={frame.time}" in head
        assert 'pbc="T T T"' in head
        assert re.search(r"Properties=type:I:1:pos:R:3:velo:R:3:radius:R:1:mass:R:1:id:I:1", head)
        table = np.array([row.split() for row in rows], float)
        assert (table[:, 1:4] == frame.position).all()
        assert (table[:, 4:7] == frame.velocity).all()
        assert (table[:, 7] == frame.radius).all()
        assert (table[:, 8] == frame.mass).all()
        assert table[:, 9].tolist() == list(range(1, 33))


def test_h5md(path, tmp_path):
    run = record(path, scenes.giant(n=20))
    convert(run, tmp_path / "run.h5")
    with h5py.File(tmp_path / "run.h5") as file:
        assert file["h5md"].attrs["version"].tolist() == [1, 1]
        assert file["h5md/creator"].attrs["name"] == b"carom"
        group = file["particles/all"]
        assert group["box"].attrs["boundary"].tolist() == [b"none"] * 3
        assert group["box"].attrs["dimension"] == 3
        for name in ("position", "velocity", "image"):
            assert (group[name]["time"][:] == run.times).all()
            for k, frame in enumerate(run):
                assert (group[name]["value"][k] == getattr(frame.state, name)).all()
        assert group["position/time"] == group["velocity/time"]  # one array, linked
        assert (
            group["box/edges/value"][:, 0] == hoomd.lengths(run[0].state, run[0].world)[0]
        ).all()
        for name in ("mass", "radius", "species"):
            assert (group[name][:] == getattr(run[0], name)).all()


def test_h5md_holds_one_number_of_spheres(path, tmp_path):
    with carom.Simulation(scenes.gas(n=20), record=path) as sim:
        sim.run(until=0.2)
        sim.remove(0)
        sim.run(until=0.4)
    with pytest.raises(InputError, match="changes from 19 to 20; convert it to"):
        convert(carom.load(path), tmp_path / "run.h5")


@pytest.mark.parametrize("ending", ["npz", "parquet"])
@pytest.mark.parametrize("begin", [0.0, 0.7])
def test_event_files_are_those_that_record_events_writes(path, tmp_path, ending, begin):
    right, converted = tmp_path / f"right.{ending}", tmp_path / f"converted.{ending}"
    with carom.Simulation(scenes.gas(n=40, seed=2)) as sim:
        if begin:
            sim.run(until=begin)
        sim.record(path, every=0.5)
        sim.record_events(right)
        sim.run(until=3.3)
        sim.gravity = (0, 0, -1)
        sim.run(until=5)
    convert(carom.load(path), converted)
    old, new = carom.load_events(right), carom.load_events(converted)
    assert new.about == old.about
    for name in ("time", "i", "j", "impulse", "kind", "wall"):
        assert (getattr(new, name) == getattr(old, name)).all(), name
    results = []
    for file in (right, converted):  # replayed from what the file holds of the start
        z = carom.observe.WallPressure()
        carom.measure(file, z)
        results.append(str(z.result()))
    assert results[0] == results[1]


def test_h5py_is_asked_for_where_it_is_missing(path, tmp_path, monkeypatch):
    run = record(path, scenes.two_balls())
    monkeypatch.setitem(__import__("sys").modules, "h5py", None)
    with pytest.raises(InputError, match=r"needs h5py: pip install .carom\[analysis\]"):
        convert(run, tmp_path / "run.h5")


def test_unknown_formats_and_places_that_cannot_be_written(path, tmp_path):
    run = record(path, scenes.two_balls())
    with pytest.raises(UnknownNameError, match=r"run.foo has no known ending"):
        convert(run, tmp_path / "run.foo")
    for name in ("run.xyz", "run.h5", "run.npz"):
        with pytest.raises(FileError, match=rf"cannot write .*nowhere.{name}: "):
            convert(run, tmp_path / "nowhere" / name)


@pytest.mark.parametrize("name", ["run.xyz", "run.h5", "run.npz"])
def test_what_is_stopped_leaves_what_was_there_before(path, tmp_path, name):
    run = record(path, scenes.gas(n=20, seed=1))
    target = tmp_path / name
    target.write_text("before")

    def stop(done, total):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        convert(run, target, stop)
    assert target.read_text() == "before"
    assert {file.name for file in tmp_path.iterdir()} == {path.name, name}
