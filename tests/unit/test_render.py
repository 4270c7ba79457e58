"""Films and pictures in files: what they hold, options, mistakes, Ctrl-C."""

import json
import signal

import av
import numpy as np
import pytest
from PIL import Image
from tests.unit.seen import distance

import carom
from carom.cli.commands import main
from carom.errors import FileError, InputError, RunError
from carom.pictures import film
from carom.pictures.painter import Style
from carom.rendering import _Job

SMALL = {"size": (160, 90)}


def gas(n=30):
    return carom.Simulation(carom.scenes.gas(n=n))


def decoded(path):
    """All pictures of a film, its size, pictures per second, and seconds."""
    with av.open(str(path)) as file:
        stream = file.streams.video[0]
        pictures = [frame.to_ndarray(format="rgb24") for frame in file.decode(video=0)]
        return pictures, (stream.width, stream.height), stream.average_rate, file.duration / 1e6


def command(*words):
    with pytest.raises(SystemExit) as ended:
        main(["render", *words])
    return ended.value.code


# What films hold.


def test_an_mp4_has_its_pictures_size_and_duration(tmp_path):
    sim = gas()
    pace = sim.pace
    told = []
    carom.render(sim, tmp_path / "a.mp4", until=2 * pace, fps=12, progress=told.append, **SMALL)
    pictures, size, rate, seconds = decoded(tmp_path / "a.mp4")
    assert (len(pictures), size, rate, seconds) == (24, (160, 90), 12, pytest.approx(2.0))
    assert [p.done for p in told] == list(range(1, 25))
    assert {p.total for p in told} == {24}
    assert told[6].time == pytest.approx(6 * pace / 12)
    with av.open(str(tmp_path / "a.mp4")) as file:
        assert file.streams.video[0].codec_context.pix_fmt == "yuv420p"
    # Each picture shows its moment.
    again = gas()
    for k, picture in enumerate(pictures):
        if k % 8 == 0:
            if k:
                again.run(until=told[k].time)
            assert distance(picture, again.picture(**SMALL).pixels) < 6
    assert distance(pictures[0], pictures[16]) > 8
    assert list(tmp_path.iterdir()) == [tmp_path / "a.mp4"]


def test_colors_survive_the_film(tmp_path):
    sim = gas()
    still = sim.picture(quality="draft", **SMALL).pixels.astype(float)
    carom.render(sim, tmp_path / "a.mp4", until=0.1, quality="good", **SMALL)
    first = decoded(tmp_path / "a.mp4")[0][0]
    for channel in range(3):
        assert first[..., channel].mean() == pytest.approx(still[..., channel].mean(), abs=2.5)


def test_a_gif_opens_and_lasts_as_long(tmp_path):
    carom.render(gas(), tmp_path / "a.gif", until=gas().pace, **SMALL)
    with Image.open(tmp_path / "a.gif") as shown:
        assert (shown.n_frames, shown.size) == (25, (160, 90))
        durations = []
        for k in range(shown.n_frames):
            shown.seek(k)
            durations.append(shown.info["duration"])
        assert durations == [40] * 25
        shown.seek(0)
        first = np.asarray(shown.convert("RGB"))
    assert distance(first, gas().picture(**SMALL).pixels) < 4


def test_gifs_count_in_hundredths_but_keep_their_pace(tmp_path):
    carom.render(gas(), tmp_path / "a.gif", until=gas().pace, fps=30, **SMALL)
    with Image.open(tmp_path / "a.gif") as shown:
        total = 0
        for k in range(shown.n_frames):
            shown.seek(k)
            total += shown.info["duration"]
        assert shown.n_frames == 30
    assert total == pytest.approx(1000, abs=20)


def test_slow_motion_takes_more_pictures_of_the_same_time(tmp_path):
    carom.render(gas(), tmp_path / "a.mp4", until=0.5, speed=0.25, fps=10, **SMALL)
    assert len(decoded(tmp_path / "a.mp4")[0]) == round(0.5 / (0.25 * gas().pace / 10))


def test_a_film_of_a_simulation_takes_ten_seconds(tmp_path):
    times = _Job(gas(), tmp_path / "a.mp4", Style(), None, None, 2.0, None, True, None).times(30)
    assert len(times) == 300
    assert times[1] - times[0] == pytest.approx(2 * gas().pace / 30)


def test_a_recording_gives_the_same_film(tmp_path):
    with carom.Simulation(carom.scenes.gas(n=30), record=tmp_path / "run.gsd") as sim:
        sim.run(until=2)
    recording = carom.load(tmp_path / "run.gsd")
    carom.render(recording, tmp_path / "a.mp4", fps=4, **SMALL)
    carom.render(gas(), tmp_path / "b.mp4", until=2, fps=4, **SMALL)
    a, b = (decoded(tmp_path / name)[0] for name in ("a.mp4", "b.mp4"))
    assert len(a) == len(b)
    assert all(distance(x, y) < 0.5 for x, y in zip(a, b, strict=True))
    with pytest.raises(InputError, match="be -1, but the recording begins at 0; begin later"):
        carom.render(recording, tmp_path / "a.mp4", begin=-1.0)
    for name in ("c.mp4", "c.png", "c.html"):
        with pytest.raises(InputError, match=r"be 2\.5, but the recording ends at 2; end earlier"):
            carom.render(recording, tmp_path / name, until=2.5, **SMALL)
        with pytest.raises(InputError, match="be 3, but the recording ends at 2; end earlier"):
            carom.render(recording, tmp_path / name, begin=3.0, **SMALL)
        assert not (tmp_path / name).exists()
    carom.render(recording, tmp_path / "c.png", until=2.0, **SMALL)
    carom.render(recording, tmp_path / "a.png", until=1.5, **SMALL)
    sim = gas()
    sim.run(until=1.5)
    shown = np.asarray(Image.open(tmp_path / "a.png"))
    assert distance(shown, sim.picture(**SMALL).pixels) < 0.5


def test_a_replay_is_a_page(tmp_path):
    carom.render(gas(), tmp_path / "a.html", until=1.0)
    assert "<html" in (tmp_path / "a.html").read_text()[:2000].lower()


def test_walls_that_change_on_the_way_are_drawn(tmp_path):
    class Changing:
        scene, pace, time = None, 1.0, 0.0

        def frames(self, *, at):
            for k, _ in enumerate(at):
                walls = carom.Box(10, 10, 10) if k == 0 else carom.Sphere(5)
                sim = carom.Simulation(walls=walls)
                sim.add(position=(0, 0, 0))
                yield next(sim.frames(at=[0.0]))

    carom.render(Changing(), tmp_path / "a.mp4", until=2, fps=1, **SMALL)
    first, second = decoded(tmp_path / "a.mp4")[0]
    assert distance(first, second) > 3


# What is left when it ends early.


def test_ctrl_c_leaves_a_film_of_what_was_drawn(tmp_path):
    def stop(now):
        if now.done == 5:
            signal.raise_signal(signal.SIGINT)

    with pytest.raises(KeyboardInterrupt):
        carom.render(gas(), tmp_path / "a.mp4", until=2, fps=10, progress=stop, **SMALL)
    assert len(decoded(tmp_path / "a.mp4")[0]) == 5
    assert list(tmp_path.iterdir()) == [tmp_path / "a.mp4"]


def test_a_run_that_cannot_go_on_leaves_a_film(tmp_path):
    class Stuck:
        scene, pace, time = None, 1.0, 0.0

        def frames(self, *, at):
            yield from gas().frames(at=at[:3])
            msg = "stuck"
            raise RunError(msg)

    with pytest.raises(RunError, match="stuck"):
        carom.render(Stuck(), tmp_path / "a.mp4", until=2, fps=10, **SMALL)
    assert len(decoded(tmp_path / "a.mp4")[0]) == 3


def test_an_old_film_stays_until_the_new_one_is_whole(tmp_path):
    path = tmp_path / "a.mp4"
    path.write_bytes(b"old")
    carom.render(
        gas(),
        path,
        until=0.2,
        progress=lambda now: now.done > 2 or path.read_bytes() == b"old" or 1 / 0,
        **SMALL,
    )
    assert path.read_bytes() != b"old"


def test_without_h264_there_is_a_film_too(tmp_path, monkeypatch):
    monkeypatch.setattr(av.codec, "codecs_available", {"mpeg4"})
    carom.render(gas(), tmp_path / "a.mp4", until=0.3, **SMALL)
    with av.open(str(tmp_path / "a.mp4")) as file:
        assert file.streams.video[0].codec_context.name == "mpeg4"


# Mistakes.


@pytest.mark.parametrize(
    ("name", "options", "message"),
    [
        ("a.avi", {}, "'a.avi' ends in '.avi'; give one that ends in .mp4, .gif, .png or .html"),
        ("film", {}, "'film' has no ending"),
        ("a.mp4", {"size": (161, 90)}, "cannot have the odd size 161x90; take 162x90"),
        ("a.mp4", {"until": -1.0}, "would begin at 0 and end at -1; give a later end"),
        ("a.mp4", {"speed": 0}, "speed is 0; it must be more than 0"),
        ("a.mp4", {"fps": 0}, "fps is 0; it must be more than 0"),
        ("a.mp4", {"fps": 1000}, "fps is 1000; a film shows 240 pictures per second at most"),
        ("a.gif", {"fps": 1e-5}, "fps is 1e-05; a GIF shows 0.01 pictures per second at least"),
        ("a.mp4", {"begin": -5}, "would be -5, but the simulation is already at 0; begin later"),
        ("a.gif", {"fps": 60}, "fps is 60; a GIF shows 50 pictures per second at most"),
        ("a.mp4", {"speed": 1e-9}, "would have .* pictures, more than 200,000; show less time"),
        ("a.mp4", {"begin": float("nan")}, "begin is nan; give a finite number"),
        ("a.mp4", {"camera": "top"}, "camera must be a Camera"),
        ("a.mp4", {"color": "blue"}, "no coloring 'blue'"),
    ],
)
def test_mistakes_get_a_sentence_and_leave_nothing(tmp_path, name, options, message):
    with pytest.raises(InputError, match=message):
        carom.render(gas(), tmp_path / name, **{"until": 1.0, **SMALL, **options})
    assert not list(tmp_path.iterdir())


def test_files_that_cannot_be_written(tmp_path):
    with pytest.raises(FileError, match=r"there is no folder .*none; make it first"):
        carom.render(gas(), tmp_path / "none" / "a.mp4")
    (tmp_path / "a.mp4.part").mkdir()
    with pytest.raises(FileError, match=r"cannot write .*a.mp4: Is a directory"):
        carom.render(gas(), tmp_path / "a.mp4", until=0.1, **SMALL)


def test_no_spheres(tmp_path):
    for name in ("a.mp4", "a.png"):
        with pytest.raises(InputError, match="there are no spheres"):
            carom.render(carom.Simulation(), tmp_path / name, until=1)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("module", "name"), [("av", "a.mp4"), ("PIL", "a.gif"), ("PIL", "a.mp4")])
def test_missing_libraries_are_named(tmp_path, monkeypatch, module, name):
    monkeypatch.setitem(__import__("sys").modules, module, None)
    with pytest.raises(InputError, match=r"pip install .carom\[video\]"):
        carom.render(gas(), tmp_path / name, until=1, **SMALL)
    assert not list(tmp_path.iterdir())


# The command line.


def test_the_command_writes_each_kind(tmp_path, capsys):
    for name in ("a.png", "a.mp4", "a.gif", "a.html"):
        target = str(tmp_path / name)
        words = ["gas", "--n", "20", "-o", target, "--duration", "0.5", "--size", "160x90"]
        assert command(*words) == 0
        assert capsys.readouterr().out.split() == ["wrote", target]
        assert (tmp_path / name).stat().st_size > 500
    assert len(decoded(tmp_path / "a.mp4")[0]) == round(0.5 / gas().pace * 30)


def test_json_and_quiet(tmp_path, capsys):
    target = str(tmp_path / "a.mp4")
    base = ("gas", "--n", "20", "-o", target, "--until", "1", "--size", "160x90", "--fps", "5")
    assert command(*base, "--json") == 0
    many = round(5 / gas().pace)
    assert json.loads(capsys.readouterr().out) == {
        "file": target, "scene": "gas --n 20", "pictures": many,
    }  # fmt: skip
    assert command(*base, "--quiet") == 0
    assert capsys.readouterr() == ("", "")


def pictured(tmp_path, *words):
    assert command("bounce", "-o", str(tmp_path / "x.png"), "--size", "160x90", *words) == 0
    return np.asarray(Image.open(tmp_path / "x.png"))


@pytest.mark.parametrize(
    "words",
    [
        ["--camera", "30,-10,4"],
        ["--camera", "30,-10,4,0,0,2"],
        ["--theme", "light"],
        ["--color", "energy"],
        ["--no-shadows"],
        ["--no-caption"],
        ["--quality", "draft"],
        ["--until", "1.5"],
        ["--from", "1.5"],
        ["--duration", "1.5"],
        ["--seed", "7"],
    ],
)
def test_each_option_changes_the_picture(tmp_path, words):
    plain, changed = pictured(tmp_path), pictured(tmp_path, *words)
    assert not np.array_equal(plain, changed)


def test_options_do_what_python_does(tmp_path):
    shown = pictured(tmp_path, "--camera", "30,-10,4,0,0,2", "--theme", "light", "--until", "1.5")
    sim = carom.Simulation(carom.scenes.bounce())
    sim.run(until=1.5)
    camera = carom.Camera((30, -10, 4), (0, 0, 2))
    assert np.array_equal(shown, sim.picture(camera=camera, theme="light", **SMALL).pixels)


@pytest.mark.parametrize(
    ("words", "status", "sentence"),
    [
        (["gas"], 2, "say where to write with -o, as in 'carom render gas -o film.mp4'"),
        (["-o", "a.mp4"], 2, "name a scene or a file first"),
        (["gas", "-o", "a.mpg"], 2, "ends in '.mpg'"),
        (["gas", "-o", "none/a.mp4"], 1, "there is no folder none"),
        (["gas", "-o", "a.mp4", "--size", "big"], 2, "--size is 'big'; give width and height"),
        (["gas", "-o", "a.mp4", "--size", "1x1"], 2, "width is 1; it must be at least 16"),
        (["gas", "-o", "a.mp4", "--size", "641x360"], 2, "odd size 641x360; take 642x360"),
        (["gas", "-o", "a.mp4", "--camera", "top"], 2, "--camera is 'top'; give a place"),
        (["gas", "-o", "a.mp4", "--camera", "1,2"], 2, "--camera is '1,2'; give a place"),
        (["gas", "-o", "a.mp4", "--camera", "0,0,0"], 2, "the camera is at its own target"),
        (["gas", "-o", "a.mp4", "--theme", "blue"], 2, "there is no theme 'blue'"),
        (["gas", "-o", "a.mp4", "--until", "1", "--duration", "1"], 2, "give only one of --until"),
        (["gas", "-o", "a.mp4", "--fps", "fast"], 2, "--fps must be a number, not 'fast'"),
        (
            ["gas", "-o", "a.mp4", "--slowmotion", "2"],
            2,
            "has no option '--slowmotion'; did you mean '--slow-motion'",
        ),
        (["gas", "-o", "a.mp4", "--slow-motion", "0"], 2, "--slow-motion is 0; it must be more"),
        (["gas", "-o", "a.mp4", "--slow-motion", "very"], 2, "--slow-motion must be a number"),
        (["none.gsd", "-o", "a.mp4"], 1, "none.gsd"),
        (
            ["none.gsd", "-o", "a.mp4", "--n", "3"],
            2,
            "--n is an option of scenes, not of recordings",
        ),
    ],
)
def test_mistakes_on_the_command_line(tmp_path, monkeypatch, capsys, words, status, sentence):
    monkeypatch.chdir(tmp_path)
    assert command(*words) == status
    said = capsys.readouterr().err
    assert sentence in said
    assert "Traceback" not in said
    assert not list(tmp_path.iterdir())


def test_ctrl_c_on_the_command_line(tmp_path, monkeypatch, capsys):
    add = film.Film.add

    def stop(self, pixels):
        add(self, pixels)
        if self.frames == 4:
            raise KeyboardInterrupt

    monkeypatch.setattr(film.Film, "add", stop)
    target = tmp_path / "a.mp4"
    assert command("gas", "-o", str(target), "--size", "160x90") == 130
    assert "Stopped by Ctrl-C" in capsys.readouterr().err
    assert len(decoded(target)[0]) == 4


def test_ctrl_c_before_the_first_picture_keeps_an_old_film_and_claims_nothing(
    tmp_path, monkeypatch, capsys
):
    def stop(self, pixels):
        raise KeyboardInterrupt

    monkeypatch.setattr(film.Film, "add", stop)
    target = tmp_path / "a.mp4"
    target.write_bytes(b"old")
    assert command("gas", "-o", str(target), "--size", "160x90") == 130
    assert "holds" not in capsys.readouterr().err
    assert target.read_bytes() == b"old"
