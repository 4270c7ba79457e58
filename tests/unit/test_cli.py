"""The command line: every command and option, as a user types them."""

import json
import os
import re
import signal
import subprocess
import sys
import threading
from types import SimpleNamespace

import pytest

import carom
from carom import scenes
from carom.cli import commands, main

NUMBERS = {
    "time", "collisions", "wall_collisions", "collisions_per_second", "energy_drift",
    "momentum", "max_overlap", "n",
}  # fmt: skip


COMMANDS = (
    "scenes", "show", "run", "compare", "sketch", "bench", "validate", "render", "measure", "info",
    "check", "convert",
)  # fmt: skip


@pytest.fixture
def cli(capsys):
    """Run one command line; returns exit status, standard output, standard error."""

    def call(line):
        with pytest.raises(SystemExit) as end:
            main(line.split())
        captured = capsys.readouterr()
        return end.value.code, captured.out, captured.err

    return call


@pytest.fixture
def data(cli):
    """Run one command line with --json and return what it wrote."""

    def call(line):
        status, out, err = cli(f"{line} --json")
        assert (status, err) == (0, "")
        assert out.count("\n") == 1
        return json.loads(out)

    return call


class TestScenes:
    def test_one_line_each(self, cli):
        status, out, err = cli("scenes")
        assert (status, err) == (0, "")
        for name in scenes.names():
            assert re.search(rf"^{name} +{re.escape(scenes.describe(name))} *$", out, re.MULTILINE)

    def test_the_options_of_one(self, cli):
        status, out, _ = cli("scenes fluid")
        assert status == 0
        assert "--packing-fraction" in out
        assert "4000" in out
        assert "carom run fluid --n 4000" in out
        assert "carom run" not in cli("scenes fluid --quiet")[1]

    def test_json(self, data):
        listed = data("scenes")
        assert [entry["name"] for entry in listed] == scenes.names()
        fluid = data("scenes fluid")
        assert {k: v for k, v in fluid["options"][0].items() if k != "help"} == {
            "name": "n",
            "type": "int",
            "default": 4000,
            "low": 32,
            "high": 50_000,
            "log": True,
        }


class TestRun:
    def test_the_table(self, cli):
        status, out, err = cli("run phase-4 --until 100")
        assert (status, err) == (0, "")
        for words in (
            "Phase 4", "12 spheres", "exact", "simulated time", "100", "collisions",
            "collisions per second", "energy drift", "momentum", "deepest overlap",
        ):  # fmt: skip
            assert words in out
        assert max(len(line) for line in out.splitlines()) <= 80

    def test_json_has_the_numbers_of_the_same_run_in_python(self, data):
        found = data("run fluid --n 108 --packing-fraction=0.2 --seed 5 --collisions 1e3")
        sim = carom.Simulation(scenes.fluid(n=108, packing_fraction=0.2, seed=5))
        sim.run(collisions=1000)
        assert set(found) >= NUMBERS
        assert found["time"] == sim.time
        assert found["momentum"] == sim.momentum.tolist()
        assert found["collisions"] == 1000
        assert found["n"] == 108
        assert found["collisions_per_second"] > 0
        assert abs(found["energy_drift"]) < 1e-13
        assert found["max_overlap"] < 1e-12
        assert found["complete"] is True
        assert found["seed"] == 5
        assert found["options"] == {"n": 108, "packing_fraction": 0.2, "seed": 5}
        assert (found["scene"], found["method"]) == ("fluid", "exact")
        assert found["version"] == carom.__version__

    def test_goals(self, data):
        assert data("run phase-4 --until 12.5")["time"] == 12.5
        assert data("run phase-4 --collisions 7")["collisions"] == 7
        found = data("run phase-4 --events 2e1")
        assert found["collisions"] + found["wall_collisions"] == 20

    def test_without_a_goal_it_runs_ten_seconds_of_its_pace_and_says_so(self, cli, data):
        assert data("run phase-4")["time"] == 10 * scenes.phase_4().pace
        assert "10 s at its pace (default)" in cli("run phase-4")[1]

    def test_methods(self, data):
        exact, reference = (
            data(f"run phase-3 --until 60 --method {m}") for m in ("exact", "reference")
        )
        assert exact["collisions"] == reference["collisions"] > 0
        # Ticks of 1 are the default of the paper's scenes: 60 in a second.
        one, default = data("run phase-3 --method tick --tick 1"), data("run phase-3 --method tick")
        assert default["tick"] == 1
        assert one["collisions"] == default["collisions"]
        assert data("run phase-3 --method tick --tick 9")["collisions"] != one["collisions"]

    def test_seed_changes_the_scene(self, data):
        first, second = data("run phase-3 --seed 1"), data("run phase-3 --seed 2")
        assert first["momentum"] != second["momentum"]

    def test_a_scene_without_randomness_takes_a_seed(self, data):
        assert data("run newton-cradle --seed 3")["seed"] is None

    def test_galperin_counts_pi(self, data):
        found = data("run galperin --digits 4 --until 1e5")
        assert found["collisions"] + found["wall_collisions"] == 3141

    def test_phase_2_prints_what_the_paper_prints(self, cli):
        out = cli("run phase-2 --until 600")[1]
        blocks = re.findall(
            r"collision (\d)\n\|n\| = 1\.000000\npsi = (-\S+)\nKE = (\S+), (\S+)\ntotal KE = (\S+)",
            out,
        )
        assert [block[0] for block in blocks] == ["1", "2", "3"]
        for _, _, first, second, total in blocks:
            assert float(first) + float(second) == pytest.approx(float(total), abs=2e-6)
        assert len({block[4] for block in blocks}) == 1
        assert "... and" in out
        assert "psi" not in cli("run phase-2 --until 600 --quiet")[1]
        assert "psi" not in cli("run phase-2 --until 600 --json")[1]

    def test_the_story_agrees_with_the_simulation(self, cli):
        out = cli("run phase-2 --collisions 1")[1]
        sim = carom.Simulation(scenes.phase_2())
        sim.run(collisions=1)
        energies = ", ".join(f"{sim[i].kinetic_energy:.6f}" for i in range(2))
        assert f"KE = {energies}" in out

    def test_a_file(self, data, tmp_path):
        path = tmp_path / "two.toml"
        path.write_text(
            "[[spheres]]\nposition = [-2, 0, 0]\nvelocity = [1, 0, 0]\n"
            "[[spheres]]\nposition = [2, 0, 0]\n"
        )
        found = data(f"run {path} --until 10 --seed 4")
        assert (found["collisions"], found["n"], found["seed"]) == (1, 2, 4)
        assert found["momentum"] == [1, 0, 0]

    def test_dissipation_is_told(self, cli):
        assert "the rules took" in cli("run bounce --until 5")[1]

    def test_progress_shows_on_a_terminal_only(self, tmp_path):
        script = "import sys; sys.argv[0] = 'carom'; from carom.cli import main; main()"
        line = "run fluid --n 200 --collisions 1e4"
        piped = subprocess.run(
            [sys.executable, "-c", script, *line.split()], capture_output=True, check=True
        )
        assert piped.stderr == b""
        for extra, shows in (("", True), (" --quiet", False), (" --json", False)):
            environment = {**os.environ, "FORCE_COLOR": "1", "TERM": "xterm"}
            forced = subprocess.run(
                [sys.executable, "-c", script, *(line + extra).split()],
                capture_output=True,
                check=True,
                env=environment,
            )
            assert (b"collisions" in forced.stderr) == shows


class TestCompare:
    def test_side_by_side(self, cli):
        status, out, err = cli("compare phase-4")
        assert (status, err) == (0, "")
        for words in ("exact", "ticks of 1", "collisions missed", "energy drift", "Looking once"):
            assert words in out

    def test_json(self, data):
        found = data("compare phase-3 --until 300 --tick 2 --n 6")
        assert (found["until"], found["tick_length"], found["n"]) == (300, 2, 6)
        assert found["exact"]["time"] == found["tick"]["time"] == 300
        assert found["exact"]["missed"] == 0
        assert found["tick"]["missed"] > 0
        assert found["exact"]["max_overlap"] < 1e-12
        assert found["tick"]["max_overlap"] > 0.01
        assert found["exact"]["collisions"] == data("run phase-3 --until 300 --n 6")["collisions"]

    def test_where_nothing_collides(self, cli):
        assert "Nothing collided" in cli("compare phase-3 --until 0")[1]


class TestShow:
    def test_hands_the_scene_to_the_view(self, cli, monkeypatch):
        calls = []

        def serve(sim, *, host, port, open_browser, on_ready):
            calls.append((sim.scene.title, len(sim), sim.method, port, open_browser, host))
            public = host != "127.0.0.1"
            on_ready(
                SimpleNamespace(url="http://h:1/#c", watch_url="http://h:1/#w", is_public=public)
            )

        monkeypatch.setattr("carom.cli.commands.serve", serve)
        status, out, err = cli("show --no-browser --port 1234")
        assert (status, err, calls.pop()[2:]) == (0, "", ("exact", 1234, False, "127.0.0.1"))
        assert "carom shows gas at http://h:1/#c" in out
        cli("show phase-3 --n 5 --method tick")
        assert calls.pop()[:5] == ("Phase 3: many balls", 5, "tick", 0, True)
        cli("show --n 5")
        assert calls.pop()[1] == 5
        assert cli("show --quiet")[1] == "http://h:1/#c\n"
        assert json.loads(cli("show --json")[1]) == {
            "address": "http://h:1/#c", "scene": "gas", "n": 500
        }  # fmt: skip
        status, out, err = cli("show --host 0.0.0.0 --json")
        assert json.loads(out)["watch_address"] == "http://h:1/#w"
        assert "Warning" in err
        assert "nothing is encrypted" in err
        assert "http://h:1/#w" in err

    def test_ctrl_c_ends_it_cleanly(self):
        command = [sys.executable, "-m", "carom", "show", "two-balls", "--no-browser", "--quiet"]
        with subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        ) as process:
            assert process.stdout.readline().startswith("http://127.0.0.1:")
            process.send_signal(signal.SIGINT)
            assert process.wait(timeout=10) == 0
            assert process.stderr.read() == ""


class TestCtrlC:
    def test_prints_the_numbers_so_far(self, cli):
        def after_half_a_second(line):
            threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
            return cli(line)

        status, out, err = after_half_a_second("run fluid --until 1e9")
        assert (status, err) == (130, "")
        assert "Stopped by Ctrl-C" in out
        assert "simulated time" in out
        status, out, err = after_half_a_second("run fluid --until 1e9 --json")
        assert (status, err) == (130, "")
        assert json.loads(out)["complete"] is False
        assert json.loads(out)["collisions"] > 0
        status, out, err = after_half_a_second("compare phase-4 --until 1e9")
        assert (status, out, err.strip()) == (130, "", "")

    def test_elsewhere_nothing_is_said(self, cli, monkeypatch):
        def interrupted(*_, **__):
            raise KeyboardInterrupt

        monkeypatch.setattr(scenes, "names", interrupted)
        status, out, err = cli("scenes")
        assert (status, out, err.strip()) == (130, "", "")
        monkeypatch.setattr(commands, "app", interrupted)  # while it is still being put together
        assert cli("scenes") == (130, "", "")


class TestManners:
    def test_version(self, cli):
        assert cli("--version") == (0, f"carom {carom.__version__}\n", "")

    def test_without_words_it_helps(self, cli):
        status, out, err = cli("")
        assert (status, err) == (0, "")
        for command in COMMANDS:
            assert command in out
        assert "--debug" in out

    def test_help_of_each_command(self, cli):
        for command in COMMANDS:
            status, out, _ = cli(f"{command} --help")
            assert status == 0
            assert "--json" in out

    def test_help_on_a_scene_lists_its_options(self, cli):
        status, out, _ = cli("run galperin --help")
        assert status == 0
        assert "--collisions" in out
        assert "--digits" in out
        assert "--digits" not in cli("run --help")[1]

    def test_as_a_module(self):
        done = subprocess.run(
            [sys.executable, "-m", "carom", "--version"], capture_output=True, check=True, text=True
        )
        assert done.stdout == f"carom {carom.__version__}\n"

    def test_debug_shows_the_traceback(self, cli):
        status, _, err = cli("run nosuch --debug")
        assert status == 2
        assert "Traceback" in err
        assert "carom: there is no scene" in err
        assert "Traceback" not in cli("run nosuch")[2]

    def test_a_bug_is_not_hidden(self, monkeypatch):
        monkeypatch.setattr(scenes, "names", lambda: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            main(["scenes"])
