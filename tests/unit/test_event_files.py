"""Every event of a run, in a file and back: the same bits, and enough to go on from."""

import gc
import json
import math
import subprocess
import sys
from dataclasses import fields

import numpy as np
import pandas
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

import carom
from carom.event_file import layout, recorder
from carom.event_file.layout import KINDS
from carom.event_file.source import ENDINGS
from carom.state import CAME_TO_REST, EVENT, WOKE

from .gases import each_method, gas

each_ending = pytest.mark.parametrize("ending", ENDINGS)


@pytest.fixture
def small_groups(monkeypatch):
    """Groups of 100 events, so that a short run has several."""
    monkeypatch.setattr(recorder, "GROUP", 100)


def same(a, b):
    for field in fields(a):
        one, other = np.asarray(getattr(a, field.name)), np.asarray(getattr(b, field.name))
        assert one.dtype == other.dtype
        assert one.tobytes() == other.tobytes(), field.name


def drops(**options):
    """Balls that fall, bounce, come to rest and are hit again."""
    sim = carom.Simulation(
        walls=carom.Box(6, 6, 30, restitution=0.5), gravity=(0, 0, -1), rule=carom.Smooth(0.6)
    )
    sim.add_many([(0.1 * k, 0, 4 * k - 10) for k in range(5)], velocity=(0.05, 0, 0), radius=0.5)
    return sim


@each_ending
def test_every_event_of_every_run_comes_back_to_the_bit(ending, tmp_path, small_groups):
    sim, path = gas(), tmp_path / f"events{ending}"
    sim.run(events=50)
    told = []
    with sim.record_events(path) as recorded:
        for n in (130, 0, 1, 419):
            sim.run(events=n)
            told.append(sim.events)
        assert len(recorded) == 550
        assert recorded.path == path
    sim.run(events=10)  # the file is closed: these are not in it
    wanted = np.concatenate(told)
    events = carom.load_events(path)
    assert len(events) == 550
    assert events.between().tobytes() == wanted.tobytes()
    assert np.concatenate(list(events.batches())).tobytes() == wanted.tobytes()
    assert [len(batch) for batch in events.batches()] == [100] * 5 + [50]
    for name in ("time", "i", "j", "impulse"):
        assert np.array_equal(getattr(events, name), wanted[name])
        assert getattr(events, name).dtype == wanted[name].dtype
    assert events.end == wanted["time"][-1]


@each_ending
def test_the_start_is_where_the_first_run_begins(ending, tmp_path):
    path = tmp_path / f"events{ending}"
    with carom.Simulation(walls=carom.Box(9, 9, 9, restitution=0.9), gravity=(0, 0, -1)) as sim:
        sim.record_events(path)
        sim.add_many([(0, 0, 0), (2, 0, 1)], velocity=(1, 0.3, 0), radius=[0.5, 0.7], mass=[1, 3])
        sim.add((0, 3, 0), fixed=True, color="red", species=4)
        start, world = sim.state, sim.world
        sim.run(until=7)
    events = carom.load_events(path)
    same(events.start, start)
    same(events.world, world)
    assert "changed" not in events.about
    assert (events.about["n"], events.about["method"], events.about["seed"]) == (3, "exact", None)
    assert len(events.about["walls"]) == 6
    assert events.end == 7


@each_method
@pytest.mark.parametrize("keep", [0, 1000])
def test_recording_changes_no_bit(method, keep, tmp_path):
    alone, recorded = (gas(method, keep_events=keep) for _ in range(2))
    for sim in (alone, recorded):
        sim.run(events=20)
    with recorded.record_events(tmp_path / "events.npz"):
        for sim in (alone, recorded):
            sim.run(events=200)
            sim.run(duration=0.3)
    same(alone.state, recorded.state)
    assert (alone.events == recorded.events).all()


def test_slices_in_time_read_no_more_than_they_need(tmp_path, small_groups, monkeypatch):
    sim = gas()
    with sim.record_events(tmp_path / "events.npz"):
        sim.run(events=1000)
    events = carom.load_events(tmp_path / "events.npz")
    time = sim.events["time"]
    a, b = time[250], time[270]
    read = []
    whole = type(events._source).read
    monkeypatch.setattr(
        type(events._source), "read", lambda *args: read.append(args[1]) or whole(*args)
    )
    assert events.between(a, b).tobytes() == sim.events[250:270].tobytes()  # b itself is not in it
    assert read == [2]
    assert len(events.between(until=a)) == 250
    assert len(events.between(b)) == 1000 - 270
    assert len(events.between(a, a)) == 0
    frame = events.to_pandas(a, b)
    assert frame["time"].tolist() == time[250:270].tolist()


def test_an_npz_can_be_read_by_numpy_alone(tmp_path, small_groups):
    sim = drops()
    with sim.record_events(tmp_path / "events.npz"):
        sim.run(until=120)
    with np.load(tmp_path / "events.npz") as file:
        parts = [file[name] for name in sorted(file.files) if name.startswith("events_")]
        about, mass = json.loads(str(file["about"])), file["start_mass"]
    rows = np.concatenate(parts)
    assert (about["format"], about["kinds"]) == ("carom events", list(KINDS))
    assert set(about["columns"]) == set(rows.dtype.names)
    assert mass.tolist() == [1] * 5
    check_kinds(sim, pandas.DataFrame({name: rows[name] for name in rows.dtype.names}))


def test_a_parquet_can_be_read_by_pandas_alone(tmp_path, small_groups):
    sim = drops()
    with sim.record_events(tmp_path / "events.parquet"):
        sim.run(until=120)
    frame = pandas.read_parquet(tmp_path / "events.parquet")
    assert frame["kind"].cat.categories.tolist() == list(KINDS)
    own = carom.load_events(tmp_path / "events.parquet").to_pandas()
    pandas.testing.assert_frame_equal(own, frame)
    check_kinds(sim, frame.assign(kind=frame["kind"].cat.codes))


def check_kinds(sim, frame):
    """Kinds and walls say what `j` of the event records says."""
    events = sim.events
    assert len(frame) == len(events) > 100
    assert frame["j"].tolist() == events["j"].tolist()
    pair, wall, rest, woke = (frame["kind"] == k for k in range(4))
    assert min(pair.sum(), wall.sum(), rest.sum(), woke.sum()) > 0
    assert (frame["j"][pair] > frame["i"][pair]).all()
    assert (frame["wall"][pair | woke] == -1).all()
    assert (frame["j"][wall] == -1 - frame["wall"][wall]).all()
    assert (frame["j"][rest] == CAME_TO_REST - frame["wall"][rest]).all()
    assert frame["wall"][rest].unique().tolist() == [4]
    assert (frame["j"][woke] == WOKE).all()
    assert (frame.loc[woke, ["impulse_x", "impulse_y", "impulse_z"]] == 0).all(axis=None)


anything = arrays(
    EVENT,
    st.integers(0, 30),
    elements=st.tuples(
        st.floats(width=64),
        st.integers(0, 2**31 - 1),
        st.one_of(
            st.integers(-(2**20), 2**31 - 1),
            st.integers(CAME_TO_REST - 9, CAME_TO_REST),
            st.just(WOKE),
        ),
        st.tuples(*[st.floats(width=64)] * 3),
    ),
)


@given(anything)
def test_rows_keep_every_bit_of_a_record(records):
    rows = layout.rows(records)
    columns = {name: rows[name] for name in layout.COLUMNS}
    assert layout.records(columns).tobytes() == records.tobytes()
    assert ((rows["kind"] == 0) == (records["j"] >= 0)).all()
    assert ((rows["wall"] >= 0) == ((rows["kind"] == 1) | (rows["kind"] == 2))).all()


class TestClosing:
    """However a recording ends, the file is whole."""

    @pytest.fixture(params=ENDINGS)
    def path(self, request, tmp_path):
        return tmp_path / f"events{request.param}"

    def test_by_stop_and_twice(self, path):
        sim = gas()
        recorded = sim.record_events(path)
        sim.run(events=10)
        recorded.stop()
        recorded.stop()
        sim.close()
        assert len(carom.load_events(path)) == 10

    def test_by_closing_the_simulation(self, path):
        sim = gas()
        sim.record_events(path)
        sim.run(events=10)
        sim.close()
        sim.run(events=10)
        assert len(carom.load_events(path)) == 10

    def test_by_forgetting_it(self, path):
        sim = gas()
        sim.record_events(path)
        sim.run(events=10)
        del sim
        gc.collect()
        assert len(carom.load_events(path)) == 10

    def test_by_the_end_of_the_program(self, path):
        program = (
            "import carom\n"
            "sim = carom.Simulation(carom.scenes.gas(n=20))\n"
            f"sim.record_events({str(path)!r})\n"
            "sim.run(events=10)\n"
        )
        subprocess.run([sys.executable, "-c", program], check=True)
        assert len(carom.load_events(path)) == 10

    def test_by_ctrl_c(self, path):
        sim = gas()

        def interrupt(now):
            raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt), sim.record_events(path):
            sim.run(events=10**9, progress=interrupt)
        events = carom.load_events(path)
        assert events.between().tobytes() == sim.events.tobytes()
        assert events.end == sim.time

    def test_before_anything_ran(self, path):
        with gas() as sim:
            sim.record_events(path)
        events = carom.load_events(path)
        assert len(events) == len(events.between()) == len(events.time) == 0
        assert len(events.to_pandas()) == 0
        assert math.isnan(events.end)
        with pytest.raises(carom.InputError, match="closed before anything ran"):
            events.start  # noqa: B018

    def test_a_run_without_events(self, path):
        sim = carom.Simulation()
        sim.add((0, 0, 0), velocity=(1, 0, 0))
        with sim.record_events(path):
            sim.run(until=5)
        events = carom.load_events(path)
        assert (len(events), events.start.time, events.end) == (0, 0, 5)
        assert events.impulse.shape == (0, 3)


def test_changes_from_outside_are_noted_where_they_begin_to_count(tmp_path):
    sim = gas()
    with sim.record_events(tmp_path / "events.npz"):
        sim.run(events=30)
        time = sim.time
        sim.velocity = -sim.velocity
        sim.gravity = (0, 0, -1)
        sim.run(events=5)
        sim.reset()
        sim.run(events=7)
    about = carom.load_events(tmp_path / "events.npz").about
    assert about["changed"]["time"] == time
    assert about["changed"]["events"] == 30
    assert about["end"]["events"] == 42


def test_several_files_at_once(tmp_path):
    with gas() as sim:
        sim.record_events(tmp_path / "a.npz")
        sim.run(events=10)
        sim.record_events(tmp_path / "b.npz")
        with pytest.raises(carom.InputError, match=r"a.npz is being written already"):
            sim.record_events(tmp_path / "a.npz", overwrite=True)
        sim.run(events=10)
    a, b = (carom.load_events(tmp_path / name) for name in ("a.npz", "b.npz"))
    assert (len(a), len(b)) == (20, 10)
    assert b.between().tobytes() == a.between()[10:].tobytes()


class TestBadInput:
    @pytest.mark.parametrize("name", ["events.csv", "events", "events.npz.gz"])
    def test_other_names(self, name, tmp_path):
        with pytest.raises(carom.InputError, match=r"let it end in \.parquet or \.npz"):
            gas().record_events(tmp_path / name)
        with pytest.raises(carom.InputError, match=r"let it end in \.parquet or \.npz"):
            carom.load_events(tmp_path / name)

    @each_ending
    def test_files_that_are_not_there(self, ending, tmp_path):
        with pytest.raises(carom.FileError, match="there is no such file"):
            carom.load_events(tmp_path / f"events{ending}")
        with pytest.raises(carom.FileError, match=r"cannot write .*; check the folder and"):
            gas().record_events(tmp_path / "nowhere" / f"events{ending}")

    @each_ending
    def test_files_that_are_there_already(self, ending, tmp_path):
        path = tmp_path / f"events{ending}"
        path.write_text("my notes")
        with pytest.raises(carom.InputError, match="is there already; give another name"):
            gas().record_events(path)
        assert path.read_text() == "my notes"
        with pytest.raises(carom.InputError, match="it is no "):
            carom.load_events(path)

    @each_ending
    def test_files_cut_short(self, ending, tmp_path):
        path = tmp_path / f"events{ending}"
        with gas() as sim:
            sim.record_events(path)
            sim.run(events=500)
        whole = path.read_bytes()
        for length in (0, 3, 100, len(whole) // 2, len(whole) - 1):
            path.write_bytes(whole[:length])
            with pytest.raises(carom.InputError, match="cut short, or not closed because"):
                carom.load_events(path)

    def test_others_files(self, tmp_path):
        np.savez(tmp_path / "events.npz", x=np.zeros(3))
        pandas.DataFrame({"x": [1.0]}).to_parquet(tmp_path / "events.parquet")
        for name in ("events.npz", "events.parquet"):
            with pytest.raises(carom.InputError, match="was not written by record_events"):
                carom.load_events(tmp_path / name)
        np.savez(tmp_path / "events.npz", about='{"format": "recipes"}', spans=np.zeros((0, 3)))
        with pytest.raises(carom.InputError, match="it holds something else"):
            carom.load_events(tmp_path / "events.npz")

    @each_ending
    def test_files_of_a_later_carom(self, ending, tmp_path, monkeypatch):
        monkeypatch.setattr(recorder, "VERSION", 2)
        with gas() as sim:
            sim.record_events(tmp_path / f"events{ending}")
        with pytest.raises(carom.InputError, match=r"in format 2, and this carom reads up to 1;"):
            carom.load_events(tmp_path / f"events{ending}")

    @pytest.mark.parametrize("call", [gas().record_events, carom.load_events])
    def test_without_pyarrow(self, call, tmp_path, monkeypatch):
        monkeypatch.setitem(sys.modules, "pyarrow", None)
        with pytest.raises(
            carom.InputError, match=r"needs pyarrow: pip install .carom\[analysis\]"
        ):
            call(tmp_path / "events.parquet")

    def test_without_pandas(self, tmp_path, monkeypatch):
        with gas() as sim:
            sim.record_events(tmp_path / "events.npz")
        monkeypatch.setitem(sys.modules, "pandas", None)
        with pytest.raises(carom.InputError, match=r"needs pandas: pip install .carom\[analysis\]"):
            carom.load_events(tmp_path / "events.npz").to_pandas()

    def test_a_disk_that_is_full(self, tmp_path, monkeypatch):
        def full(self, records):
            raise OSError(28, "No space left on device")

        sim = gas()
        monkeypatch.setattr(recorder, "GROUP", 100)
        monkeypatch.setattr(recorder.NpzSink, "write", full)
        sim.record_events(tmp_path / "events.npz")
        with pytest.raises(carom.FileError, match=r"events\.npz: No space left on device"):
            sim.run(events=1000)
        sim.run(events=100)  # the simulation goes on, the file does not
        sim.close()


def test_a_replayed_state_is_a_copy(tmp_path):
    with gas() as sim:
        sim.record_events(tmp_path / "events.npz")
        sim.run(events=10)
    events = carom.load_events(tmp_path / "events.npz")
    events.start.time = 7.0
    assert events.start.time == 0
