"""The benchmark: its starts, its answers, its rows."""

import io
import json
import math
import sys
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from carom import fit, mechanics
from carom.bench import answers, cases, machine, starts, suite, worker
from carom.bench import run as running
from carom.bench.run import Run
from carom.errors import InputError, RunError, UnknownNameError
from carom.state import State

SMALL = cases.Case(
    "fluid-1100-0.25", 1100, 0.25, partial(starts.fluid, 1100, 0.25), 20_000, warm_up=20_000
)
#: Every cliff, so small that it takes no time.
STARTS = {
    "lattice": partial(starts.lattice, 6),
    "lattice-start": partial(starts.lattice_start, 4, 0.25),
    "giant": partial(starts.giant, 2000, 10, 0.1),
    "two-sizes": partial(starts.two_sizes, 1, 6, 0.25),
    "clusters": partial(starts.cooling, 500, 0.1, 0.6),
    "sediment": partial(starts.sediment, 500, 10.0, 0.3),
    "cloud": partial(starts.cloud, 200, 0.25),
}
ROW = {
    "name": "fluid-1100-0.25", "n": 1100, "packing_fraction": 0.25, "nanoseconds": [200.0, 100.0],
    "answer": [5, 0.5], "rate": None, "peak_bytes": 10**9, "engine_bytes": 300_000,
}  # fmt: skip


class TestStarts:
    @pytest.mark.parametrize("name", STARTS)
    def test_each_is_a_state_that_an_engine_can_start_from(self, name):
        state, world = STARTS[name]()
        fit.check_values(state)
        fit.check_overlap(state, world)
        assert (fit.wrap(state.position, world.period)[0] == state.position).all()
        assert np.abs(mechanics.momentum(state)).max() < 1e-10
        again = STARTS[name]()[0]
        assert (again.position == state.position).all()
        assert (again.velocity == state.velocity).all()

    def test_every_cliff_is_tried(self):
        assert {case.name for case in cases.CLIFFS} == set(STARTS)

    @pytest.mark.parametrize(("n", "phi"), [(2, 0.25), (16, 0.25), (500, 0.05), (1000, 0.49)])
    def test_fluid(self, n, phi):
        state, world = starts.fluid(n, phi)
        fit.check_overlap(state, world)
        assert len(state) == n
        assert mechanics.packing_fraction(state, world) == pytest.approx(phi)
        assert mechanics.temperature(state, world) == pytest.approx(1)

    def test_all_collisions_of_the_lattice_happen_in_one_moment(self):
        engine = running.engine(*starts.lattice(6))
        for k in range(1, 10):
            engine.advance(0.25 * k - 0.125 - 1e-9)
            assert engine.collisions == (k - 1) * 6**3 / 2
            engine.advance(0.25 * k - 0.125)
            assert engine.collisions == k * 6**3 / 2

    def test_sizes_and_densities(self):
        state, world = starts.giant(2000, 10, 0.1)
        small = np.pi / 6 * 2000
        room = mechanics.volume(world) - np.pi / 6 * 10**3
        assert small / room == pytest.approx(0.1)
        assert (state.radius[0], state.mass[0]) == (5, 1000)
        state, world = starts.two_sizes(1, 6, 0.25)
        assert np.sum(state.radius[:4] ** 3) == pytest.approx(np.sum(state.radius[4:] ** 3))
        assert mechanics.packing_fraction(state, world) == pytest.approx(0.25)

    def test_sediment_stays_above_its_floor(self):
        engine = running.engine(*starts.sediment(500, 10.0, 0.3))
        engine.advance(5.0)
        height = engine.state().position[:, 2]
        assert height.min() >= 0.5 - 1e-9
        assert np.count_nonzero(height < 5) > np.count_nonzero(height > 10)

    def test_the_cloud_flies_apart(self):
        engine = running.engine(*starts.cloud(200, 0.25))
        engine.advance(100.0)
        assert np.linalg.norm(engine.state().position, axis=1).mean() > 50


class TestCases:
    def test_names_find_their_cases(self):
        for case in cases.full():
            assert cases.named(case.name).name == case.name
            assert cases.named(case.name).n == case.n
        with pytest.raises(UnknownNameError, match="did you mean 'clusters'"):
            cases.named("cluster")

    def test_every_bound_has_its_uniform_case_and_reason(self):
        bounded = [case for case in cases.full() if case.bound < math.inf]
        assert {case.name for case in cases.CLIFFS} < {case.name for case in bounded}
        for case in bounded:
            assert case.why
            assert cases.named(case.uniform).is_fluid
            assert case.uniform in [other.name for other in cases.with_uniform([case])]

    def test_names_of_the_full_table_are_unique(self):
        names = [case.name for case in cases.full()]
        assert len(set(names)) == len(names)
        assert {case.name for case in cases.quick()} < set(names)

    def test_the_numbers_of_spheres_are_those_of_the_starts(self):
        for case in cases.full():
            if case.n < 40_000:
                assert len(case.start()[0]) == case.n

    @pytest.mark.parametrize(
        ("n", "phi", "words"),
        [(1, 0.25, "--n is 1; it must be at least 2"), (100, 0.9, "--phi is 0.9; it must be"),
         (100, 0.0, "--phi is 0"), (10**12, 0.25, "has room for")],
    )  # fmt: skip
    def test_impossible_fluids(self, n, phi, words):
        with pytest.raises(InputError, match=words):
            cases.fluid(n, phi)


class TestAnswers:
    def test_rate_against_theory(self):
        run = Run(SMALL)
        run.measure()
        rate = run.row()["rate"]
        assert rate["error"] == pytest.approx(1.2 / math.sqrt(20_000))
        assert abs(rate["measured"] / rate["expected"] - 1) < rate["allowed"]

    def test_a_wrong_rate_is_refused(self):
        run = Run(SMALL)
        run.measure()
        state = State.empty(1100)
        state.velocity[:, 0] = 3.0
        with pytest.raises(RunError, match="Enskog and Carnahan-Starling have"):
            answers.rate(SMALL, state, 20_000, 20_000, 1.0)

    def test_there_is_no_theory_of_few_spheres_or_other_cases(self):
        assert answers.rate(cases.fluid(2, 0.25), State.empty(2), 0, 1, 1.0) is None
        assert answers.rate(cases.CLIFFS[0], State.empty(2), 0, 1, 1.0) is None

    def test_energy_and_overlap(self):
        answers.assert_kept(SMALL, 1e-13, 1e-15, 1000)
        with pytest.raises(RunError, match="energy has drifted by 1e-09"):
            answers.assert_kept(SMALL, 1e-9, 0.0, 1000)
        with pytest.raises(RunError, match=r"overlap by 0\.1"):
            answers.assert_kept(SMALL, 0.0, 0.1, 1000)
        with pytest.raises(RunError, match="drifted by nan"):
            answers.assert_kept(SMALL, math.nan, 0.0, 1000)

    def test_the_known_run(self, monkeypatch):
        monkeypatch.setitem(answers.KNOWN, SMALL.name, (7, 0.5))
        answers.assert_known(SMALL, 7, 0.5)
        with pytest.raises(RunError, match="computes something else"):
            answers.assert_known(SMALL, 7, 0.5000001)

    def test_known_runs_are_cases(self):
        assert set(answers.KNOWN) <= {case.name for case in cases.full()}

    def test_clusters(self):
        state, world = starts.cooling(4000, 0.1, 0.6)
        assert answers.clumping(state, world) < 1
        case = replace(SMALL, clustered=True)
        with pytest.raises(RunError, match="more than 2 was to be reached"):
            answers.assert_clustered(case, state, world)
        engine = running.engine(state, world)
        engine.advance(math.inf, max_collisions=200_000)
        answers.assert_clustered(case, engine.state(), world)


class TestRun:
    def test_row(self):
        run = Run(SMALL)
        nanoseconds = [run.measure() for _ in range(3)]
        row = run.row()
        assert row["nanoseconds"] == pytest.approx(nanoseconds, abs=0.01)
        assert (row["name"], row["n"], row["collisions"]) == (SMALL.name, 1100, 20_000)
        assert row["engine_bytes"] > 100_000
        again = Run(SMALL)
        again.measure()
        assert row["answer"] == again.row()["answer"]
        assert row["answer"][0] == 20_000
        assert row["wrong"] == ""
        json.dumps(row, allow_nan=False)

    def test_a_wrong_answer_is_told_and_the_row_is_kept(self, monkeypatch):
        monkeypatch.setitem(answers.KNOWN, SMALL.name, (7, 0.5))
        run = Run(SMALL)
        run.measure()
        row = run.row()
        assert row["nanoseconds"]
        assert "computes something else" in row["wrong"]
        assert suite.broken([{**row, "peak_bytes": None}]) == [row["wrong"]]

    def test_without_warm_up_each_repetition_begins_anew(self):
        case = cases.Case("small-cloud", 200, None, STARTS["cloud"], collisions=0, until=50.0)
        run = Run(case)
        run.measure()
        first = run.row()
        run.measure()
        second = run.row()
        assert first["answer"] == second["answer"]
        assert first["answer"][1] == 50.0
        assert second["collisions"] == first["collisions"] == first["answer"][0]
        assert len(second["nanoseconds"]) == 2

    def test_walls_are_counted(self):
        case = cases.Case("small-sediment", 500, None, STARTS["sediment"], 5000, warm_up=5000)
        run = Run(case)
        run.measure()
        assert run.row()["collisions"] > 5000

    @pytest.mark.parametrize("warm_up", [0, 1000])
    def test_profile(self, monkeypatch, warm_up):
        class Looking(running.FastEngine):
            def __init__(self, *arguments, profile=False, **options):
                super().__init__(*arguments, **options)
                self.looks = profile

            def profile(self):
                assert self.looks
                return dict.fromkeys(("predict", "rebuild", "queue", "collide", "other"), 0.2)

            def work(self):
                return {"predictions": 4000, "shells": 500, "stale": 100, "exact": 0}

        monkeypatch.setattr(running, "FastEngine", Looking)
        found = Run(replace(SMALL, collisions=2000, warm_up=warm_up)).profile()
        assert found["shares"]["rebuild"] == pytest.approx(0.2)
        assert found["work"] == {"predictions": 2, "shells": 0.25, "stale": 0.05, "exact": 0}


class TestWorker:
    def test_does_what_it_is_asked(self):
        out = io.StringIO()
        worker.work("fluid-128-0.25", ["ready\n", "measure\n", "row\n"], out)
        ready, took, row = (json.loads(line) for line in out.getvalue().splitlines())
        assert ready is None
        assert row["nanoseconds"] == [pytest.approx(took, abs=0.01)]

    def test_tells_errors_in_a_sentence(self, monkeypatch):
        out = io.StringIO()
        worker.work("fluid-10-0.25", ["ready"], out)
        assert "the nearest number that can is 11" in json.loads(out.getvalue())["error"]

        def full(_):
            raise MemoryError

        monkeypatch.setattr(worker, "Run", full)
        out = io.StringIO()
        worker.work("fluid-1000-0.25", ["ready"], out)
        assert "not enough memory" in json.loads(out.getvalue())["error"]

    def test_in_a_process_of_its_own(self):
        with worker.Worker("fluid-128-0.25") as one:
            assert one.ask("ready") is None
            assert one.ask("measure") > 0
            row = one.ask("row")
            assert row["n"] == 128
            if sys.platform == "linux":
                assert 10e6 < row["peak_bytes"] < 200e6
        assert one._process.returncode is not None

    def test_an_error_and_an_end_are_run_errors(self):
        with worker.Worker("fluid-10-0.25") as one, pytest.raises(RunError, match="nearest number"):
            one.ask("ready")
        with worker.Worker("fluid-128-0.25") as one:
            one._process.kill()
            with pytest.raises(RunError, match="ended with status"):
                one.ask("ready")


class TestSuite:
    def test_groups_share_the_memory(self, monkeypatch):
        monkeypatch.setattr(machine, "memory", lambda: 8 * 10**9)
        big = replace(SMALL, n=4_000_000)
        sizes = [[case.n for case in group] for group in suite.groups([SMALL, SMALL, big, big])]
        assert sizes == [[1100, 1100, 4_000_000], [4_000_000]]
        huge = replace(SMALL, n=10**8)
        assert suite.fitting([SMALL, huge]) == ([SMALL], [huge])
        monkeypatch.setattr(machine, "memory", lambda: None)
        assert suite.fitting([huge]) == ([huge], [])

    def test_measured(self):
        steps = []
        chosen = cases.grid((128, 200), (0.25,))
        rows = suite.measured(chosen, 2, profile=False, progress=lambda *step: steps.append(step))
        assert [row["name"] for row in rows] == ["fluid-128-0.25", "fluid-200-0.25"]
        assert all(len(row["nanoseconds"]) == 2 for row in rows)
        assert [step[:2] for step in steps][2:4] == [
            ("timed 1 of 2", "fluid-128-0.25"), ("timed 1 of 2", "fluid-200-0.25")
        ]  # fmt: skip
        assert sum(step[2] for step in steps) == pytest.approx(1)

    def test_profiles_are_asked_for(self, monkeypatch):
        asked = []

        class Silent:
            def __init__(self, name):
                self.name = name

            def __enter__(self):
                return self

            def __exit__(self, *_):
                pass

            def ask(self, word):
                asked.append(word)
                return {**ROW, "name": self.name} if word == "row" else {"shares": {}}

        monkeypatch.setattr(suite, "Worker", Silent)
        rows = suite.measured([SMALL], 1, profile=True, progress=lambda *_: None)
        assert asked == ["ready", "measure", "row", "profile"]
        assert rows[0]["profile"] == {"shares": {}}

    def test_bounds(self):
        cliff = replace(SMALL, name="cliff", uniform=SMALL.name, bound=2.0, why="because")
        large = replace(SMALL, name="large", most_memory=5e8)
        rows = [
            dict(ROW),
            {**ROW, "name": "cliff", "nanoseconds": [250.0]},
            {**ROW, "name": "large"},
        ]
        rows = suite.with_bounds([SMALL, cliff, large], rows)
        assert (rows[0]["median_nanoseconds"], rows[0]["best_nanoseconds"]) == (150, 100)
        assert (rows[1]["ratio"], rows[1]["bound"], rows[1]["why"]) == (2.5, 2.0, "because")
        first, second = suite.broken(rows)
        assert first == "cliff costs 2.50 times what fluid-1100-0.25 costs; its bound is 2"
        assert second == "large takes 1.00 GB; its bound is 0.5 GB"
        rows[1]["nanoseconds"], rows[2]["peak_bytes"] = [150.0], None
        assert suite.broken(suite.with_bounds([SMALL, cliff, large], rows)) == []
