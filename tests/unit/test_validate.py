"""``carom validate``: its rows, its files, its command."""

import json
import math
import os
import signal
import subprocess
import sys
import time
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest
from tests.physics.plants import PLANTS

from carom.cli import main
from carom.errors import FileError, InputError, RunError, UnknownNameError
from carom.observe import Estimate
from carom.validate import catalogue, figures, references, results, suite
from carom.validate.row import Check, Found, Panel, Row

ROOT = Path(__file__).parents[2]


def row(**changes):
    values = {
        "name": "a", "quantity": "Z", "state": "gas", "n": 10, "collisions": 100,
        "measured": 1.2, "error": 0.03, "reference": 1.0, "reference_error": 0.04,
        "source": "a book",
    }  # fmt: skip
    return Row(**{**values, **changes})


class TestRow:
    def test_statistical(self):
        assert row().deviation == pytest.approx(4.0)
        assert row(measured=1.19).passed
        assert not row(measured=1.21).passed
        assert not row(measured=0.79).passed

    @pytest.mark.parametrize("error", [math.nan, math.inf])
    def test_a_number_without_an_error_does_not_pass(self, error):
        assert row(error=math.nan).passed is False
        assert row(error=math.nan).as_data()["error"] is None
        assert row(measured=math.nan, error=error).passed is False

    def test_exact(self):
        exact = {"kind": "exact", "error": 0.0, "reference_error": 0.0, "tolerance": 0.2}
        assert row(**exact, measured=1.1).deviation == pytest.approx(0.5)
        assert row(**exact, measured=1.19).passed
        assert not row(**exact, measured=1.21).passed
        assert not row(**exact, measured=math.nan).passed

    def test_rejected_must_differ(self):
        assert not row(kind="rejected").passed
        assert row(kind="rejected", measured=1.3).passed
        assert not row(kind="rejected", error=math.nan).passed

    def test_no_error_at_all(self):
        sharp = {"error": 0.0, "reference_error": 0.0}
        assert row(**sharp).deviation == math.inf
        assert row(**sharp).as_data()["deviation"] is None
        assert row(**sharp, measured=1.0).passed


def test_names_are_unique_and_families_known():
    names = [check.name for check in catalogue.checks()]
    assert len(set(names)) == len(names)
    assert {check.family for check in catalogue.checks()} == set(catalogue.FAMILIES)
    assert len(references.table("two_body")) == 64


def measured(value, error):
    def run(size):
        found = Found("a gas", 10, int(1e5 * size))
        found.against(f"z{value}", "Z", Estimate(value, error, 9), 1.0, "a book", 0.01, "roughly")
        found.exact(f"n{value}", "count", 3, 3, 0.5, "a proof")
        found.unlike(f"u{value}", "Z", Estimate(value, error, 9), 5.0, "a wrong law")
        found.panels.append(Panel("Z", "φ", "Z", [value], [value], [error], [0, 1], [0, 1]))
        return [found]

    return run


def test_a_check_that_fails_in_any_way_is_red_and_others_go_on():
    def wrong(size):
        return [][1]

    done = suite.work(Check("wrong", "fluid", wrong, 1.0), "quick")
    assert done["failure"] == "IndexError: list index out of range"


def broken(size):
    msg = "it does not run"
    raise RunError(msg)


CHECKS = [
    Check("good", "fluid", measured(1.001, 0.01), 1.0, 4),
    Check("bad", "fluid", measured(2.0, 0.01), 2.0),
    Check("broken", "walls", broken, 1.0),
]


@pytest.fixture
def checks(monkeypatch):
    """Three checks instead of all, run here."""
    monkeypatch.setattr(catalogue, "checks", lambda: CHECKS)
    monkeypatch.setattr(results, "checks", lambda: CHECKS)
    monkeypatch.setattr(
        suite, "results", lambda some, mode: (suite.work(check, mode) for check in some)
    )


@pytest.fixture
def cli(capsys, monkeypatch, tmp_path):
    """Run one command line; returns exit status, stdout, stderr."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "100")

    def call(line):
        with pytest.raises(SystemExit) as end:
            main(line.split())
        captured = capsys.readouterr()
        return end.value.code, captured.out, captured.err

    return call


@pytest.mark.usefixtures("checks")
class TestCommand:
    def test_all_is_well(self, cli):
        status, out, err = cli("validate --quick --only good")
        assert (status, err) == (0, "")
        for word in ("The fluid", "a gas, N = 10, 1.0e5 collisions", "1.001(10)", "1.000(10)",
                     "+0.1 σ", "ok", "differs", "All 3 rows are as they should be"):  # fmt: skip
            assert word in out
        assert max(map(len, out.splitlines())) <= 100
        assert not list(Path().iterdir())

    def test_full_is_larger(self, cli):
        assert "4.0e5 collisions" in cli("validate --only good")[1]

    def test_red_rows_end_with_status_1(self, cli):
        status, out, err = cli("validate --quick")
        assert status == 1
        assert "carom: broken: it does not run" in err
        assert "2 of 6 rows are red: broken, z2.0" in " ".join(out.split())
        assert out.count("RED") == 2

    def test_ctrl_c_before_anything_is_done(self, cli, monkeypatch):
        def stopped(some, mode):
            raise KeyboardInterrupt
            yield

        monkeypatch.setattr(suite, "results", stopped)
        status, out, err = cli("validate --quick -o report")
        assert (status, out) == (130, "")
        assert err == "carom: stopped after 0 of 3 checks; what is done is kept\n"

    def test_json(self, cli):
        status, out, err = cli("validate --quick --json")
        assert (status, err) == (1, "")
        data = json.loads(out)
        assert [check["check"] for check in data["checks"]] == ["good", "bad", "broken"]
        first = data["checks"][0]["rows"][0]
        assert first["deviation"] == pytest.approx(0.001 / math.hypot(0.01, 0.01))
        assert (first["passed"], first["source"], first["note"]) == (True, "a book", "roughly")
        assert data["checks"][0]["mode"] == "quick"

    def test_files_and_merging(self, cli):
        assert cli("validate --quick --only good -o report")[0] == 0
        folder = Path("report")
        assert sorted(p.name for p in folder.iterdir()) == [
            "fluid.svg", "validation.json", "validation.md"
        ]  # fmt: skip
        status, out, _ = cli("validate --only bad,walls -o report")
        assert status == 1
        assert "Written to report." in out
        kept = results.read(folder / "validation.json")["checks"]
        assert [(c["check"], c["mode"]) for c in kept] == [
            ("good", "quick"), ("bad", "full"), ("broken", "full")
        ]  # fmt: skip
        page = (folder / "validation.md").read_text("utf-8")
        assert (
            "| a gas | Z | 10 | 100 000 | 1.001(10) | 1.000(10) | +0.1 σ | ok | a book (roughly)"
            in page
        )
        assert "Red: broken, z2.0." in page
        assert "| `broken` | it does not run |" in page
        assert (folder / "walls.svg").read_text("utf-8").startswith("<?xml")

    def test_pictures_are_the_same_bytes(self, cli, tmp_path):
        cli("validate --quick --only good -o one")
        cli("validate --quick --only good -o two")
        assert Path("one/fluid.svg").read_bytes() == Path("two/fluid.svg").read_bytes()
        data = results.read(Path("one/validation.json"))
        assert [p.name for p in figures.draw(tmp_path, data, {"fluid"}, "png")] == ["fluid.png"]

    def test_without_matplotlib_the_numbers_are_kept(self, cli, monkeypatch):
        monkeypatch.setitem(sys.modules, "matplotlib", None)
        status, _, err = cli("validate --quick --only good -o report")
        assert status == 0
        assert "carom: the pictures need matplotlib: python -m pip install 'carom[plot]'" in err
        assert Path("report/validation.md").exists()

    @pytest.mark.parametrize(
        ("line", "status", "words"),
        [
            ("--only fluit", 2, "there is no family or check 'fluit'; did you mean 'fluid'?"),
            ("-o no/where", 1, "cannot make the folder no/where"),
            ("-o file", 1, "cannot make the folder file"),
            ("-o other", 2, "is no report of this carom validate"),
        ],
    )
    def test_bad_input_is_one_sentence_before_any_work(self, cli, monkeypatch, line, status, words):
        monkeypatch.setattr(suite, "results", None)
        Path("file").write_text("")
        Path("other").mkdir()
        Path("other/validation.json").write_text("{}")
        found, out, err = cli(f"validate {line}")
        assert (found, out) == (status, "")
        assert words in err
        assert err.count("\n") == 1


def test_a_report_that_cannot_be_read_or_written(tmp_path):
    with pytest.raises(FileError, match="cannot read"):
        results.read(tmp_path / "nothing.json")
    (tmp_path / "old.json").write_text('{"format": "carom validate", "format_version": 0}')
    with pytest.raises(InputError, match="is no report of this carom validate"):
        results.read(tmp_path / "old.json")
    with pytest.raises(FileError, match="cannot write to"):
        results.write(tmp_path / "missing", results.report([]))


def test_the_page_shows_the_stored_report():
    spec = spec_from_file_location("validation_page", ROOT / "docs" / "validation.py")
    page = module_from_spec(spec)
    spec.loader.exec_module(page)
    data, text = results.read(page.RESULTS), page.PAGE.read_text("utf-8")
    blocks = {match[2]: match[0] for match in page.BLOCK.finditer(text)}
    assert set(blocks) == {"rows", "plants"}
    assert page.rows(data) in blocks["rows"]
    assert not results.red(data)
    for family in results.by_family(data):
        assert (page.IMAGES / f"{family}.svg").exists()
    # Each error that is planted was caught by something.
    planted = [plant for group in PLANTS.values() for plant in group]
    assert blocks["plants"].count("\n| ") == len(planted) + 1
    assert "**none**" not in blocks["plants"]


def test_names_to_choose_from_come_once():
    with pytest.raises(UnknownNameError) as refused:
        catalogue.chosen("zzzz")
    names = str(refused.value).partition("there are ")[2].split(", ")
    assert {"pairs", "transport", "galperin-2"} < set(names)
    assert len(names) == len(set(names))


class TestForReal:
    def test_two_processes_give_what_one_gives(self):
        some = catalogue.chosen("rods,box,galperin-2")
        two = {check["check"]: check for check in suite.results(some, "quick")}
        assert set(two) == {"rods", "box", "galperin-2"}
        for check in some:
            one = suite.work(check, "quick")
            assert two[check.name]["rows"] == one["rows"]

    @pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT")
    def test_ctrl_c_keeps_what_is_done(self, tmp_path):
        # One takes a second, the other a minute.
        names = "galperin-7,flights"
        command = [sys.executable, "-m", "carom", "validate", "--only", names, "-o", "report"]
        file = tmp_path / "report" / "validation.json"
        with subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)},
            start_new_session=True,
        ) as process:  # fmt: skip
            end = time.monotonic() + 500
            while not file.exists() and time.monotonic() < end:
                time.sleep(0.1)
            os.killpg(process.pid, signal.SIGINT)  # as a terminal does
            out, err = process.communicate(timeout=30)
            assert process.returncode == 130
            assert b"stopped after 1 of 2 checks; what is done is kept" in err
            assert b"3141592" in out
            assert gone(process.pid)
        assert [check["check"] for check in results.read(file)["checks"]] == ["galperin-7"]


def gone(group):
    """Whether no process of a group is left, or will be in a moment."""
    for _ in range(100):
        try:
            os.killpg(group, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.1)
    return False
