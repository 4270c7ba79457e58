"""Recordings on the command line: run -o, run --resume, info, check, convert."""

import json

import numpy as np
import pytest

import carom
from carom import scenes
from carom.cli import main


@pytest.fixture
def cli(capsys, tmp_path, monkeypatch):
    """Run one command line in a folder of its own; exit status, output, errors."""
    monkeypatch.chdir(tmp_path)

    def call(line):
        with pytest.raises(SystemExit) as end:
            main(line.split())
        captured = capsys.readouterr()
        return end.value.code, captured.out, captured.err

    return call


def test_a_run_is_recorded_and_goes_on_with_the_same_bits(cli):
    status, out, err = cli("run phase-4 --until 50 -o run.gsd --every 5 --checkpoint-every 20")
    assert (status, err) == (0, "")
    assert "Recorded in run.gsd: 11 frames, " in out
    status, out, err = cli("run --resume run.gsd --until 90 --json")
    assert (status, err) == (0, "")
    data = json.loads(out)
    sim = carom.Simulation(scenes.phase_4())
    sim.run(until=90)
    assert data["recording"]["frames"] == 19
    assert (data["collisions"], data["time"], data["seed"]) == (sim.collisions, 90, 1)
    assert (carom.load("run.gsd")[-1].position == sim.position).all()
    status, out, _ = cli("run --resume run.gsd --collisions 3 --quiet")
    assert status == 0
    assert "Recorded" not in out
    assert carom.load("run.gsd")[-1].collisions == sim.collisions + 3


def test_the_rate_of_a_resumed_run_is_its_own(cli):
    cli("run fluid --n 500 --collisions 3000 -o run.gsd --every 1")
    data = json.loads(cli("run --resume run.gsd --collisions 10 --json")[1])
    assert data["collisions"] == 3010
    assert data["collisions_per_second"] == pytest.approx(10 / data["seconds"])


def test_a_long_run_of_few_events_makes_a_small_file(cli):
    status, out, _ = cli("run gas --n 100 --collisions 5000 -o run.gsd")
    assert status == 0
    assert "Recorded in run.gsd: " in out
    facts = json.loads(cli("info run.gsd --json")[1])
    assert 300 < facts["frames"] < 400
    assert facts["bytes"] < 10e6
    assert "one every 0.0666667 or more" in " ".join(cli("info run.gsd")[1].split())
    cli("run gas --n 100 --until 4 -o short.gsd")
    assert "or more" not in cli("info short.gsd")[1]


def test_info(cli):
    cli("run gas --n 30 --seed 5 --until 2 -o run.gsd --every 0.5")
    status, out, err = cli("info run.gsd")
    assert (status, err) == (0, "")
    for word in (
        "Gas in a box · seed 5", "spheres", "30", "frames", "one every 0.5", "0 to 2", "collisions",
        "checkpoints", "the last at 2", "kB a frame", f"carom {carom.__version__}",
    ):  # fmt: skip
        assert word in out
    data = json.loads(cli("info run.gsd --json")[1])
    assert (data["n"], data["frames"], data["start"], data["end"]) == (30, 5, 0, 2)
    assert (data["scene"], data["seed"], data["changes"]) == ("gas", 5, 0)
    assert data["bytes"] > 1000
    assert data["options"]["n"] == 30


def test_check_says_what_is_wrong_and_fails(cli, tmp_path):
    cli("run gas --n 20 --until 2 -o run.gsd")
    status, out, err = cli("check run.gsd")
    assert (status, err) == (0, "")
    assert "as they were written, and run again they come out the same to the bit" in out
    assert json.loads(cli("check run.gsd --json")[1])["good"] is True
    with carom.load("run.gsd") as run:
        place = (
            (tmp_path / "run.gsd").read_bytes().find(run.file.read(3, "carom/position").tobytes())
        )
    data = bytearray((tmp_path / "run.gsd").read_bytes())
    data[place + 5] ^= 1
    (tmp_path / "run.gsd").write_bytes(data)
    status, out, err = cli("check run.gsd")
    assert status == 1
    assert "1 damaged" in out
    assert err.startswith("carom: run.gsd is damaged: of frame 3 carom/position is not what was")
    assert err.count("\n") == 1
    status, out, err = cli("check run.gsd --json")
    assert (status, err) == (1, "")
    assert json.loads(out)["good"] is False


def test_convert(cli, tmp_path):
    cli("run gas --n 20 --until 1 -o run.gsd --every 0.5")
    status, out, _ = cli("convert run.gsd run.xyz")
    assert status == 0
    assert "3 frames" in out
    assert (tmp_path / "run.xyz").read_text().startswith("20\nLattice=")
    assert cli("convert run.gsd run.xyz")[::2] == (
        2,
        "carom: run.xyz is there already; give another name, or --force to replace it\n",
    )
    assert json.loads(cli("convert run.gsd run.xyz --force --json")[1])["frames"] == 3
    events = len(carom.load("run.gsd").events())
    assert cli("convert run.gsd run.npz")[1].startswith(f"{events} events, ")
    assert json.loads(cli("convert run.gsd run.npz --force --json")[1])["events"] == events


def test_a_recording_is_not_lost_by_a_second_run(cli):
    cli("run gas --n 20 --until 1 -o run.gsd")
    status, _, err = cli("run gas --n 30 --until 1 -o run.gsd")
    assert status == 2
    assert "run.gsd is there already; give another name, --force to replace it, or --resume" in err
    assert len(carom.load("run.gsd")[0]) == 20
    assert cli("run gas --n 30 --until 1 -o run.gsd --force")[0] == 0
    assert len(carom.load("run.gsd")[0]) == 30


@pytest.mark.parametrize(
    ("line", "status", "words"),
    [
        ("run gas --every 1", 2, "name the file too, as in -o run.gsd"),
        ("run gas --force", 2, "name the file too, as in -o run.gsd"),
        ("run gas -o x.gsd --every 0", 2, "every is 0; it must be more than 0"),
        ("run gas -o x.gsd --every 1 --checkpoint-every 1.5", 2, "give a multiple of that"),
        ("run gas -o x.gsd --every 1e-300", 2, "spheres do not move a millionth of their radius"),
        ("run gas -o x.txt", 2, "a recording is a .gsd file; name it x.txt.gsd"),
        ("run gas --tick 0.1", 2, "--tick is 0.1, but method exact has no ticks"),
        ("run gas -o no/x.gsd", 1, "cannot write no/x.gsd"),
        ("run gas --method tick -o x.gsd", 2, "method 'tick' cannot be recorded"),
        ("run --resume run.gsd", 2, "say how far run.gsd shall go on"),
        ("run gas --resume run.gsd --until 9", 2, "leave a scene and its options"),
        ("run --resume run.gsd --until 9 -o x.gsd", 2, "leave a scene and its options"),
        ("run --resume run.gsd --until 0.5", 2, "but run.gsd ends at 1; give a later time"),
        ("run --resume no.gsd --until 1", 1, "cannot read no.gsd: No such file"),
        ("info text", 2, "text is no recording"),
        ("check text", 2, "text is no recording"),
        ("convert run.gsd run.foo", 2, "run.foo has no known ending"),
    ],
)
def test_mistakes_are_one_sentence(cli, tmp_path, line, status, words):
    with carom.Simulation(scenes.two_balls(), record=tmp_path / "run.gsd") as sim:
        sim.run(until=1)
    (tmp_path / "text").write_text("spheres")
    got, out, err = cli(line)
    assert (got, out) == (status, "")
    assert words in err
    assert err.count("\n") == 1
    assert not (tmp_path / "x.gsd").exists()


def test_a_collapse_leaves_a_recording_until_then(cli, tmp_path):
    (tmp_path / "collapse.toml").write_text(
        """
        rule = { restitution = 0.05 }
        [[spheres]]
        position = [[-1, 0, 0], [0.5, 0, 0], [3, 0, 0]]
        velocity = [[1, 0, 0], [0, 0, 0], [-1, 0, 0]]
        """
    )
    status, _, err = cli("run collapse.toml --until 10 -o run.gsd")
    assert status == 1
    assert "collapse at time" in err
    run = carom.load("run.gsd")
    assert 0 < run.end < 10
    assert np.isfinite(run[-1].position).all()
