"""``carom bench --observables``: what measuring costs."""

import json
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest

from carom.bench import observing
from carom.cli import bench_observables, main
from carom.observe import MSD, OBSERVABLES, WallPressure

ROOT = Path(__file__).parents[2]


@pytest.fixture
def cli(capsys, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)

    def call(line):
        with pytest.raises(SystemExit) as end:
            main(line.split())
        captured = capsys.readouterr()
        return end.value.code, captured.out, captured.err

    return call


@pytest.fixture
def small(monkeypatch):
    """The same, of few spheres and collisions."""
    whole = observing.measured

    def measured(names, repetitions, progress):
        return whole(names, repetitions, progress, n=256, collisions=2000)

    monkeypatch.setattr(observing, "measured", measured)


class TestForReal:
    def test_table_and_json(self, cli, small):
        line = "bench --observables --only msd,wall* --repetitions 3"
        status, out, err = cli(line + " -o costs.json")
        assert (status, err) == (0, "")
        for words in (
            "What measuring costs",
            "N 4,000",
            "bound 20 %",
            "msd",
            "wall-pressure",
        ):
            assert words in out
        assert max(len(line) for line in out.splitlines()) <= 80
        kept = json.loads(Path("costs.json").read_text())
        assert {row["name"]: row["start"] for row in kept["rows"]} == {
            "msd": "fluid", "wall-pressure": "box"
        }  # fmt: skip
        assert all(len(row["ratios"]) == 3 for row in kept["rows"])
        data = json.loads(cli(line + " --json")[1])
        assert data["format"] == "carom bench observables"
        assert data.keys() == kept.keys()

    @pytest.mark.parametrize("name", OBSERVABLES)
    def test_each_has_a_start_in_which_it_has_a_meaning(self, name):
        start, (state, _), _ = observing._fitting(OBSERVABLES[name](), 256)
        assert start in ("fluid", "two kinds", "box")
        assert len(state) == 256

    def test_both_runs_are_the_same_and_go_on(self):
        pair = observing.Pair("msd", 256)
        for _ in range(3):
            pair.measure(1500)
        assert pair._bare.time == pair._observed.time
        assert pair._bare.collisions == 256 * observing.WARM_UP + 4500
        assert pair.row()["samples"] > 10
        assert isinstance(pair.observable, MSD)

    def test_a_slow_observable_is_seen_and_marked(self, cli, small, monkeypatch):
        class Slow(WallPressure):
            def events(self, batch):
                for _ in range(300):
                    super().events(batch)

        monkeypatch.setitem(OBSERVABLES, "slow", Slow)
        out = cli("bench --observables --only slow --repetitions 3")[1]
        assert "% over" in out


@pytest.mark.parametrize(("line", "words"), [
    ("--full", "give either --observables or --full"),
    ("-n 100", "give either --observables or --n"),
    ("--phi .1", "give either --observables or --phi"),
    ("--profile", "give either --observables or --profile"),
    ("--compare a.json", "give either --observables or --compare"),
    ("--only mds", "there is no observable 'mds'; did you mean 'msd'?"),
    ("-o no/file.json", "there is no folder no"),
    ("--repetitions 0", "--repetitions is 0; it must be at least 1"),
])  # fmt: skip
def test_bad_input_is_one_sentence_before_any_work(cli, monkeypatch, line, words):
    monkeypatch.setattr(observing, "measured", None)
    status, out, err = cli(f"bench --observables {line}")
    assert status in (1, 2)
    assert out == ""
    assert words in err
    assert err.count("\n") == 1


def test_the_default_is_every_observable():
    assert bench_observables.named(None) == list(OBSERVABLES)


def test_the_page_says_what_the_kept_result_says():
    spec = spec_from_file_location("costs", ROOT / "docs" / "costs.py")
    costs = module_from_spec(spec)
    spec.loader.exec_module(costs)
    text = costs.PAGE.read_text("utf-8")
    data = json.loads(costs.RESULTS.read_text("utf-8"))
    assert costs.page(text, data) == text
    assert {row["name"] for row in data["rows"]} <= set(OBSERVABLES)
