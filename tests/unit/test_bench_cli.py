"""``carom bench``, as a user types it, and the page made from its results."""

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest

from carom.bench import cases, suite
from carom.cli import main

ROOT = Path(__file__).parents[2]


@pytest.fixture
def cli(capsys, monkeypatch, tmp_path):
    """Run one command line outside a checkout; returns exit status, stdout, stderr."""
    monkeypatch.chdir(tmp_path)

    def call(line):
        with pytest.raises(SystemExit) as end:
            main(line.split())
        captured = capsys.readouterr()
        return end.value.code, captured.out, captured.err

    return call


def fake_row(case, factor=1.0):
    """A row as a worker would send it."""
    return {
        "name": case.name, "n": case.n, "packing_fraction": case.packing_fraction,
        "collisions": 100, "nanoseconds": [2000 * factor, 1000 * factor],
        "engine_bytes": 250 * case.n, "peak_bytes": 10**8, "building_seconds": 0.1,
        "answer": [100, 0.5], "energy_drift": 0.0, "max_overlap": 0.0,
        "rate": {"measured": 1.001, "expected": 1.0, "error": 0.001, "allowed": 0.01},
    }  # fmt: skip


@pytest.fixture
def fake(monkeypatch):
    """No measuring: every case takes a microsecond, but for those named; asks are kept."""
    asked, slow = [], {}

    def measured(chosen, repetitions, *, profile, progress):
        asked.append(([case.name for case in chosen], repetitions, profile))
        rows = [fake_row(case, slow.get(case.name, 1.0)) for case in chosen]
        for row in rows:
            if profile:
                row["profile"] = {
                    "shares": {"predict": 0.5, "rebuild": 0.3, "queue": 0.1, "collide": 0.1},
                    "work": {"predictions": 2.0, "shells": 0.25},
                }
        progress("timed", chosen[0].name, 1.0)
        return suite.with_bounds(chosen, rows)

    monkeypatch.setattr(suite, "measured", measured)
    return asked, slow


class TestForReal:
    def test_table_and_json(self, cli, monkeypatch):
        monkeypatch.setattr(cases, "QUICK_SIZES", (128,))
        status, out, err = cli("bench --phi .25 --repetitions 2 -o result.json")
        assert (status, err) == (0, "")
        for words in ("carom bench", "million/s", "best", "bytes", "128", "0.25", "result.json"):
            assert words in out
        assert max(len(line) for line in out.splitlines()) <= 80
        status, out, err = cli("bench -n 128 --phi .25 --repetitions 1 --json")
        assert (status, err) == (0, "")
        now, kept = json.loads(out), json.loads(Path("result.json").read_text())
        assert now["rows"][0]["answer"] == kept["rows"][0]["answer"]
        assert len(kept["rows"][0]["nanoseconds"]) == 2
        assert kept["machine"] == now["machine"]

    @pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT")
    def test_ctrl_c_leaves_no_process_behind(self, tmp_path):
        command = [sys.executable, "-m", "carom", "bench", "-n", "300000", "--phi", ".05"]
        with subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)},
            start_new_session=True,
        ) as process:  # fmt: skip
            time.sleep(2)
            os.killpg(process.pid, signal.SIGINT)  # as a terminal does
            out, err = process.communicate(timeout=10)
            assert (process.returncode, out, err) == (130, b"", b"")
            with pytest.raises(ProcessLookupError):
                os.killpg(process.pid, 0)

    def test_a_wrong_answer_is_told(self, cli):
        status, out, err = cli("bench -n 10 --phi .25")
        assert (status, out) == (1, "")
        assert err == (
            "carom: n = 10 cannot be placed on face-centred sites at packing fraction 0.25; "
            "the nearest number that can is 11\n"
        )


class TestChoice:
    def test_the_default_is_the_quick_grid_five_times(self, cli, fake):
        assert cli("bench")[0] == 0
        names, repetitions, profile = fake[0].pop()
        assert len(names) == 6
        assert "fluid-32000-0.49" in names
        assert (repetitions, profile) == (5, False)

    def test_full_is_everything_that_fits(self, cli, fake, monkeypatch):
        monkeypatch.setattr("carom.bench.machine.memory", lambda: 4 * 10**9)
        status, out, _ = cli("bench --full")
        names = fake[0].pop()[0]
        assert status == 0
        assert {case.name for case in cases.CLIFFS} < set(names)
        assert "fluid-10000000-0.25" not in names
        assert "Left out, for want of memory: fluid-10000000-0.25" in " ".join(out.split())

    def test_only(self, cli, fake):
        cli("bench --only clusters,fluid-4*-0.25")
        assert fake[0].pop()[0] == ["fluid-4000-0.25", "clusters", "fluid-32000-0.1"]

    def test_sizes_and_packing_fractions(self, cli, fake):
        cli("bench -n 1e3,50 --phi 0.1,.3 --repetitions 7")
        names, repetitions, _ = fake[0].pop()
        assert names == ["fluid-50-0.1", "fluid-50-0.3", "fluid-1000-0.1", "fluid-1000-0.3"]
        assert repetitions == 7
        cli("bench -n 1e3")
        assert len(fake[0].pop()[0]) == 3

    @pytest.mark.parametrize(
        ("line", "words"),
        [
            ("-n 1", "--n is 1; it must be at least 2"),
            ("-n many", "--n must be a number, not 'many'"),
            ("-n 4000,", "--n must be a number, not ''"),
            ("--phi 0.9", "--phi is 0.9; it must be at least 1e-06 and at most 0.494"),
            ("--phi nan", "--phi is nan; give a finite number"),
            ("--repetitions 0", "--repetitions is 0; it must be at least 1"),
            ("--repetitions 2.5", "--repetitions must be a whole number, not 2.5"),
            ("--full -n 100", "give either --full or --n and --phi"),
            ("--only gaint", "there is no case 'gaint'; did you mean 'giant'?"),
            ("--compare no.toml", "cannot read no.toml"),
            ("-o no/file.json", "there is no folder no"),
            ("-o .", "it is a folder"),
        ],
    )
    def test_bad_input_is_one_sentence_before_any_work(self, cli, fake, line, words):
        status, out, err = cli(f"bench {line}")
        assert status in (1, 2)
        assert out == ""
        assert words in err
        assert err.count("\n") == 1
        assert not fake[0]

    def test_another_file_is_no_result(self, cli, fake):
        Path("scene.json").write_text('{"rows": []}')
        status, _, err = cli("bench --compare scene.json")
        assert status == 2
        assert "scene.json is no result of carom bench; give a file" in err


class TestOutput:
    def test_bounds_and_what_breaks_them(self, cli, fake):
        status, out, err = cli("bench --only giant")
        assert (status, err) == (0, "")
        for words in ("Cost per collision", "times", "bound", "fluid-1000000-0.1"):
            assert words in out
        fake[1]["giant"] = 4.0
        status, out, err = cli("bench --only giant")
        assert status == 1
        assert "carom: giant costs 4.00 times what fluid-1000000-0.1 costs; its bound is" in err

    def test_profile(self, cli, fake):
        out = cli("bench --profile")[1]
        assert fake[0].pop()[2] is True
        for words in ("Where the time goes", "predict", "50", "Work per collision", "0.25"):
            assert words in out
        assert max(len(line) for line in out.splitlines()) <= 80

    def test_compare(self, cli, fake):
        cli("bench -o old.json")
        fake[1].update({"fluid-4000-0.05": 0.5, "fluid-32000-0.49": 2.0})
        status, out, err = cli("bench --compare old.json")
        assert (status, err) == (0, "")
        assert "fluid-4000-0.05  │       2.00 │     2.00" in out
        assert "fluid-32000-0.49 │       0.50 │     0.50" in out
        assert "geometric mean   │       1.00 │     1.00" in out
        compared = json.loads(cli("bench --compare old.json --json")[1])["compared"]
        assert compared["median"] == pytest.approx(1)
        assert compared["rows"][0] == {
            "name": "fluid-4000-0.05", "median": 2.0, "best": 2.0, "same_answer": True
        }  # fmt: skip
        assert compared["differences"] == []

    def test_compare_warns_of_other_machines_and_answers(self, cli, fake):
        cli("bench -o old.json")
        old = json.loads(Path("old.json").read_text())
        old["machine"]["cpu"] = "Abacus"
        old["rows"][0]["answer"] = [100, 0.25]
        Path("old.json").write_text(json.dumps(old))
        status, _, err = cli("bench --compare old.json")
        assert status == 0
        assert "the answers differ in fluid-4000-0.05: these are other computations" in err
        assert "the machines differ: cpu Abacus before" in err

    def test_nothing_to_compare_is_said_first(self, cli, fake):
        cli("bench -n 500 --phi .1 -o old.json")
        fake[0].clear()
        status, _, err = cli("bench --compare old.json")
        assert status == 2
        assert "old.json has none of the cases to be run, but fluid-500-0.1" in err
        assert not fake[0]

    def test_where_results_go(self, cli, fake, tmp_path):
        assert "Nothing is written; keep the result with -o" in " ".join(cli("bench")[1].split())
        assert list(tmp_path.iterdir()) == []
        results = tmp_path / "benchmarks" / "results"
        results.mkdir(parents=True)
        (tmp_path / "src" / "carom").mkdir(parents=True)
        assert "benchmarks/results/quick.json" in cli("bench")[1]
        cli("bench --full --only giant")
        cli("bench --n 100")
        assert [path.name for path in results.iterdir()] == ["quick.json"]
        cli("bench --full")
        assert (results / "speed.json").exists()
        assert "Written" not in cli("bench --quiet")[1]


class TestPage:
    @pytest.fixture
    def page(self):
        spec = spec_from_file_location("performance", ROOT / "docs" / "performance.py")
        module = module_from_spec(spec)
        spec.loader.exec_module(module)
        return module

    def test_it_says_what_the_kept_results_say(self, page):
        text = page.PAGE.read_text("utf-8")
        assert set(page.TABLES) == {block[1] for block in page.BLOCK.findall(text)}
        assert page.page(text, json.loads(page.RESULTS.read_text("utf-8"))) == text

    def test_every_table_of_full_results(self, page, cli, fake):
        cli("bench --full --profile -o all.json")
        data = json.loads(Path("all.json").read_text())
        for name, table in page.TABLES.items():
            made = table(data)
            assert made
            columns = {line.count("|") for line in made.splitlines()}
            assert len(columns) == 1, name
        assert "| 10 000 000 |" in page.scaling(data)
        assert "`giant`" in page.cliffs(data)
        assert "50 %" in page.profile(data)
        data["machine"].update(clock_ghz=None, caches={}, compiler=None)
        assert page.machine(data)
        assert "cycles" not in page.scaling(data)

    def test_pictures(self, page, cli, fake, monkeypatch, tmp_path):
        pytest.importorskip("matplotlib", reason="the docs extra")
        cli("bench --full -o all.json")
        monkeypatch.setattr(page, "IMAGES", tmp_path)
        monkeypatch.setattr(page, "RESULTS", tmp_path / "all.json")
        monkeypatch.setattr(page, "PAGE", tmp_path / "performance.md")
        shutil.copy(ROOT / "docs" / "performance.md", tmp_path)
        page.main()
        drawn = {path.name: path.read_bytes() for path in tmp_path.glob("*.svg")}
        assert set(drawn) == {f"performance-{k}.svg" for k in ("speed", "scaling", "memory")}
        page.main()
        assert drawn == {path.name: path.read_bytes() for path in tmp_path.glob("*.svg")}
