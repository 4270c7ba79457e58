"""Measuring when a run is over gives what observing it would have given, to the bit."""

import csv
import json
import re

import numpy as np
import pytest

import carom
from carom import observe
from carom.cli import main
from carom.observe import OBSERVABLES

from .gases import gas


def fluid(n=108, **options):
    return carom.Simulation(carom.scenes.fluid(n=n, packing_fraction=0.3, seed=2), **options)


def several():
    return [
        observe.Compressibility(),
        observe.FreeTime(),
        observe.MSD(at=[0.1, 0.2, 0.5]),
        observe.RDF(every=0.2),
        observe.Energy(every=0.1),
        observe.MaxOverlap(),
        observe.CollisionsPerSphere(),
    ]


def told(observables):
    return [json.dumps(one.table().as_data()) for one in observables]


@pytest.fixture(params=["events.npz", "events.parquet", "run.gsd"])
def recording(request, tmp_path):
    """A path, and what lets a simulation be recorded there."""
    path = tmp_path / request.param

    def begin(sim):
        if path.suffix == ".gsd":
            return sim.record(path, every=0.7, checkpoint_every=2.1)
        return sim.record_events(path)

    return path, begin


@pytest.mark.parametrize("under_way", [False, True])
def test_the_same_bits_as_observed(recording, under_way):
    path, begin = recording
    seen, measured = several(), several()
    with fluid() as sim:
        if under_way:
            sim.run(events=777)
        begin(sim)
        sim.run(collisions=20_000, observe=seen)
    carom.measure(path, measured)
    assert told(measured) == told(seen)
    assert measured[0].seen.time == sim.time


def test_from_one_time_to_another(recording):
    path, begin = recording
    seen, measured = several(), several()
    with fluid() as sim:
        begin(sim)
        sim.run(until=3)
        sim.run(until=4.3, observe=seen)
        sim.run(until=5)
    times = []
    carom.measure(path, measured, start=3, until=4.3, progress=times.append)
    assert told(measured) == told(seen)
    assert times == sorted(times)
    assert times[-1] == 4.3


def test_an_open_file_serves_again_and_again(tmp_path):
    seen, first, second = several(), several(), several()
    with fluid() as sim:
        sim.record(tmp_path / "run.gsd")
        sim.record_events(tmp_path / "events.npz")
        sim.run(until=3, observe=seen)
    events = carom.load_events(tmp_path / "events.npz")
    with carom.load(tmp_path / "run.gsd") as run:
        for source in (events, run):
            for these in (several(), several()):
                carom.measure(source, these)
                assert told(these) == told(seen)
    carom.measure(str(tmp_path / "run.gsd"), first)
    carom.measure(str(tmp_path / "events.npz"), second)
    assert told(first) == told(second) == told(seen)


@pytest.mark.parametrize("name", OBSERVABLES)
def test_all_that_can_be_observed_can_be_measured(name, tmp_path):
    sim = gas() if name in ("wall-pressure", "density-profile") else fluid(32)
    if name == "mutual-diffusion":
        sim.mass = np.where(np.arange(32) < 16, 1.0, 2.0)
    seen, measured = OBSERVABLES[name](), OBSERVABLES[name]()
    sim.run(events=100)
    with sim:
        sim.record_events(tmp_path / "events.npz")
        sim.run(events=8000, observe=seen)
    carom.measure(tmp_path / "events.npz", measured)
    assert told([measured]) == told([seen])


@pytest.mark.parametrize("method", ["tick", "reference", fluid])
def test_other_methods(method, tmp_path):
    from carom.engine import FastEngine

    make = (lambda state, world: FastEngine(state, world)) if callable(method) else method
    seen, measured = several()[:4], several()[:4]
    with fluid(32, method=make, tick=0.01) as sim:
        sim.record_events(tmp_path / "events.npz")
        sim.run(until=1.5, observe=seen)
    carom.measure(tmp_path / "events.npz", measured)
    assert told(measured) == told(seen)


def test_energy_is_booked_as_it_was(recording):
    """Spheres rest and wake, rules take energy, and some was taken before the recording."""
    path, begin = recording
    walls = carom.Box(6, 6, 30, restitution=0.5)
    sim = carom.Simulation(walls=walls, gravity=(0, 0, -1), rule=carom.Smooth(0.6))
    sim.add_many([(0.1 * k, 0, 4 * k - 10) for k in range(5)], velocity=(0.05, 0, 0), radius=0.5)
    sim.run(until=10)
    sim.velocity = 1.1 * sim.velocity
    sim.run(until=20)
    seen, measured = observe.Energy(every=3), observe.Energy(every=3)
    with sim:
        begin(sim)
        sim.run(until=90, observe=seen)
    carom.measure(path, measured)
    assert told([measured]) == told([seen])
    assert (seen.seen.time, measured.seen.time) == (90, 90)


class TestChanges:
    """What somebody changed does not follow from the start."""

    @pytest.fixture
    def changed(self, recording):
        path, begin = recording
        before, after = observe.Compressibility(), observe.Compressibility()
        with fluid() as sim:
            begin(sim)
            sim.run(until=3, observe=before)
            sim.velocity = -sim.velocity
            sim.run(until=5, observe=after)
        return path, before, after

    def test_up_to_the_first(self, changed):
        path, before, _ = changed
        measured = observe.Compressibility()
        carom.measure(path, measured)
        assert told([measured]) == told([before])
        message = r"until is 4, but .* from 0 to 3, where the simulation was changed"
        with pytest.raises(carom.InputError, match=message):
            carom.measure(path, observe.Compressibility(), until=4)

    def test_after_it_where_there_is_a_recording(self, changed):
        path, _, after = changed
        measured = observe.Compressibility()
        if path.suffix == ".gsd":
            carom.measure(path, measured, start=3)
            assert told([measured]) == told([after])
        else:
            with pytest.raises(carom.InputError, match="start is 4, but"):
                carom.measure(path, measured, start=4)

    def test_what_was_undone_counts_no_more(self, tmp_path):
        seen, measured = observe.Compressibility(), observe.Compressibility()
        with fluid() as sim:
            sim.record(tmp_path / "run.gsd", every=0.5)
            sim.run(until=2, observe=seen)
            back = sim.bookmark()
            sim.run(until=4)
            sim.return_to(back)
            sim.velocity = -sim.velocity
            sim.run(until=5)
        carom.measure(tmp_path / "run.gsd", measured)
        assert told([measured]) == told([seen])


class TestBadInput:
    @pytest.fixture
    def path(self, tmp_path):
        with fluid(32) as sim:
            sim.record_events(tmp_path / "events.npz")
            sim.run(until=2)
        return tmp_path / "events.npz"

    @pytest.mark.parametrize(
        ("times", "message"),
        [
            ({"start": -1}, "start is -1, but .* from 0 to 2, its end; give a time between"),
            ({"until": 3}, "until is 3, but .* from 0 to 2, its end"),
            ({"start": 1.5, "until": 1}, "start is 1.5, after until, which is 1"),
            ({"start": "soon"}, "start must be a number, not 'soon'"),
            ({"until": float("nan")}, "until is nan"),
        ],
    )
    def test_times(self, times, message, path):
        with pytest.raises(carom.InputError, match=message):
            carom.measure(path, observe.MSD(), **times)

    def test_events_that_do_not_follow_from_the_start(self, path):
        with np.load(path) as file:
            arrays = dict(file)
        arrays["events_00000"]["impulse_x"][100] += 1e-15
        np.savez(path, **arrays)
        with pytest.raises(carom.InputError, match=r"differs from what carom .* recorded"):
            carom.measure(path, observe.MSD())

    def test_events_that_will_never_come(self, tmp_path):
        path = tmp_path / "events.npz"
        with carom.Simulation() as sim:
            sim.add_many([(0, 0, 0), (3, 0, 0)], velocity=[(1, 0, 0), (0, 0, 0)])
            sim.record_events(path)
            sim.run(until=5)
        with np.load(path) as file:
            arrays = dict(file)
        about = json.loads(str(arrays["about"]))
        about["end"]["collisions"] += 1
        np.savez(path, **{**arrays, "about": json.dumps(about)})
        with pytest.raises(carom.InputError, match="does not follow from its start"):
            carom.measure(path, observe.CollisionsPerSphere())

    def test_what_is_no_observable_or_has_no_meaning(self, path):
        with pytest.raises(carom.InputError, match="takes observables such as"):
            carom.measure(path, "msd")
        with pytest.raises(carom.InputError, match=r"source must be a file, .* not 42"):
            carom.measure(42, observe.MSD())
        with pytest.raises(carom.InputError, match="WallPressure"):
            carom.measure(path, observe.WallPressure())

    def test_files_without_a_run(self, tmp_path):
        with fluid(32) as sim:
            sim.record_events(tmp_path / "events.npz")
        with pytest.raises(carom.InputError, match="closed before anything ran"):
            carom.measure(tmp_path / "events.npz", observe.MSD())
        (tmp_path / "notes.txt").write_text("no recording")
        with pytest.raises((carom.InputError, carom.FileError), match=r"notes\.txt"):
            carom.measure(tmp_path / "notes.txt", observe.MSD())

    def test_ctrl_c_leaves_what_was_measured(self, path):
        def interrupt(now):
            raise KeyboardInterrupt

        one = observe.CollisionRate()
        with pytest.raises(KeyboardInterrupt):
            carom.measure(path, one, progress=interrupt)
        assert one.duration > 0


class TestCommand:
    """`carom run --record-events` and `carom measure`, as a user types them."""

    @pytest.fixture
    def cli(self, capsys, tmp_path, monkeypatch):
        monkeypatch.chdir(tmp_path)

        def call(line):
            with pytest.raises(SystemExit) as end:
                main(line.split())
            captured = capsys.readouterr()
            return end.value.code, captured.out, captured.err

        return call

    @pytest.fixture
    def recorded(self, cli):
        line = "run fluid --n 108 --packing-fraction 0.3 --collisions 5e3 --seed 2"
        status, out, err = cli(f"{line} --record-events events.parquet --observe msd --json")
        assert (status, err) == (0, "")
        return json.loads(out)

    def test_what_was_recorded_is_said(self, cli, recorded, tmp_path):
        size = (tmp_path / "events.parquet").stat().st_size
        about = {"path": "events.parquet", "events": 5000, "bytes": size}
        assert recorded["events"] == about
        status, out, _ = cli("run two-balls --until 9 --record-events events.npz")
        assert status == 0
        assert "Recorded in events.npz: 3 events," in out

    def test_the_same_as_observed(self, cli, recorded):
        status, out, _ = cli("measure events.parquet msd --json")
        found = json.loads(out)
        assert status == 0
        assert found["observed"] == recorded["observed"]
        assert (found["file"], found["n"], found["start"]) == ("events.parquet", 108, 0)
        assert found["until"] == recorded["time"]

    def test_tables_and_files(self, cli, recorded):
        status, out, err = cli("measure events.parquet compressibility --from 1 -o z.csv")
        assert (status, err) == (0, "")
        assert "events.parquet · 108 spheres · time 1 to" in out
        assert "Written to z.csv." in out
        with open("z.csv", newline="") as file:  # noqa: PTH123
            rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
        one = observe.Compressibility()
        carom.measure("events.parquet", one, start=1)
        assert float(rows[0]["value"]) == one.result().value
        status, out, _ = cli(
            "measure events.parquet collision-rate,msd --until 2 -o out.json --json"
        )
        assert status == 0
        assert json.loads(out)["written"] == ["out-collision-rate.json", "out-msd.json"]
        with open("out-msd.json") as file:  # noqa: PTH123
            assert json.load(file) == json.loads(out)["observed"]["msd"]

    @pytest.mark.parametrize(
        ("line", "sentence"),
        [
            ("measure events.parquet msc", "no observable 'msc'; did you mean 'msd'?"),
            ("measure events.parquet zz", "there is no observable 'zz'; carom measure takes names"),
            ("measure events.parquet msd,", "carom measure takes names with commas between"),
            ("measure events.parquet msd -o out.txt", "out.txt is none of .csv, .json, .npz"),
            ("measure events.parquet msd --from 1e9", "start is 1000000000, but events.parquet"),
            ("measure events.parquet msd --from soon", "--from must be a number, not 'soon'"),
            ("measure events.parquet wall-pressure", "WallPressure"),
            ("run fluid --events events.npz", "--record-events events.npz"),
            ("run fluid --record-events events.parquet", "is there already; give another name"),
            ("run fluid --record-events events.txt", "let it end in .parquet or .npz"),
        ],
    )
    def test_bad_input(self, line, sentence, cli, recorded):
        status, out, err = cli(line)
        assert (status, out) == (2, "")
        assert sentence in err
        assert err.count("\n") == 1

    @pytest.mark.parametrize("line", ["run --observe list", "measure events.parquet list"])
    def test_a_list_of_all(self, line, cli, recorded):
        status, out, err = cli(line)
        assert (status, err) == (0, "")
        for name in OBSERVABLES:
            assert re.search(rf"^{name} +[A-Z]", out, re.MULTILINE)
        assert "Mean square displacement" in out

    def test_a_missing_file(self, cli):
        status, _, err = cli("measure nowhere.npz msd")
        assert (status, err) == (1, "carom: cannot read nowhere.npz: there is no such file\n")
