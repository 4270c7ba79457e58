"""Film files in detail: colours, quality, order, and what a full disk leaves."""

import errno
from types import SimpleNamespace

import av
import numpy as np
import pytest
from PIL import Image

import carom
from carom.errors import FileError
from carom.pictures.film import Film
from carom.view import replay

SIZE = (160, 90)
#: Four colours, each a quarter of the picture.
COLORS = np.array([[200, 40, 40], [40, 180, 60], [50, 60, 210], [230, 230, 120]], np.uint8)
PIXELS = COLORS[np.arange(SIZE[0]) * 4 // SIZE[0]][None].repeat(SIZE[1], axis=0)


def film(path, *, fps=25.0, quality="good"):
    return Film(path, SIZE, fps, quality, lambda: PIXELS)


def written(path, pictures=3, **options):
    with film(path, **options) as roll:
        for _ in range(pictures):
            roll.add(PIXELS)
    return path


def test_an_mp4_says_how_its_colors_are_meant(tmp_path):
    with av.open(str(written(tmp_path / "a.mp4"))) as file:
        context = file.streams.video[0].codec_context
        said = context.colorspace, context.color_primaries, context.color_trc
        frame = next(file.decode(video=0))
        shown = frame.reformat(format="rgb24", src_colorspace="ITU709").to_ndarray()
    assert said == (1, 1, 1)
    for k, color in enumerate(COLORS):
        assert np.abs(shown[45, 20 + 40 * k].astype(int) - color).max() < 8


def test_a_gif_has_opaque_colors(tmp_path):
    with Image.open(written(tmp_path / "a.gif")) as shown:
        assert "transparency" not in shown.info
        for k in range(shown.n_frames):
            shown.seek(k)
            pixels = np.asarray(shown.convert("RGBA"))
            assert (pixels[..., 3] == 255).all()
            assert np.abs(pixels[..., :3].astype(int) - PIXELS).max() < 8


def test_an_mp4_begins_with_its_index(tmp_path):
    # So that a browser can show it before it has all of it.
    data = written(tmp_path / "a.mp4").read_bytes()
    assert 0 < data.index(b"moov") < data.index(b"mdat")


@pytest.mark.parametrize("codec", ["libx264", "mpeg4"])
def test_a_draft_is_smaller(tmp_path, monkeypatch, codec):
    monkeypatch.setattr(av.codec, "codecs_available", {codec})
    noise = np.random.default_rng(1).integers(0, 256, (12, *PIXELS.shape), np.uint8)
    sizes = []
    for quality in ("draft", "good"):
        with film(tmp_path / f"{quality}.mp4", quality=quality) as roll:
            for picture in noise:
                roll.add(picture)
        sizes.append((tmp_path / f"{quality}.mp4").stat().st_size)
    assert sizes[0] < 0.8 * sizes[1]


def test_a_rate_need_not_be_whole(tmp_path):
    with av.open(str(written(tmp_path / "a.mp4", fps=29.97))) as file:
        assert float(file.streams.video[0].average_rate) == pytest.approx(29.97, abs=1e-3)


def full(times):
    """What a disk says that is full a number of times."""

    def refuse(use):
        def refusing(*words):
            nonlocal times
            times -= 1
            if times >= 0:
                raise OSError(errno.ENOSPC, "No space left on device")
            return use(*words)

        return refusing

    return refuse


@pytest.mark.parametrize("when", ["mux", "close"])
def test_a_full_disk_leaves_the_old_film(tmp_path, when):
    path = tmp_path / "a.mp4"
    path.write_bytes(b"old")

    def write():
        with film(path) as roll:
            file, refuse = roll._file, full(1)
            uses = {"mux": file.mux, "close": file.close}
            uses[when] = refuse(uses[when])
            roll._file = SimpleNamespace(**uses)
            for _ in range(60):
                roll.add(PIXELS)

    with pytest.raises(FileError, match=r"cannot write .*a.mp4: No space left on device"):
        write()
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_a_folder_in_the_way_is_noticed_first(tmp_path):
    (tmp_path / "a.mp4").mkdir()
    sim = carom.Simulation(carom.scenes.gas(n=20))
    with pytest.raises(FileError, match=r"a.mp4 is a folder; write elsewhere"):
        carom.render(sim, tmp_path / "a.mp4", until=1, size=SIZE)
    assert sim.time == 0


def test_a_replay_is_told_times_color_and_speed(tmp_path, monkeypatch):
    given = {}

    def write_replay(source, path, times, **options):
        given.update(options, times=times, path=path)

    monkeypatch.setattr(replay, "write_replay", write_replay)
    sim = carom.Simulation(carom.scenes.gas(n=20))
    carom.render(sim, tmp_path / "a.html", until=1.0, fps=10, speed=0.5, color="species")
    step = 0.5 * sim.pace / 10
    assert given["times"][:2] == pytest.approx([0, step])
    # One more than a film has: a replay shows time up to its last moment.
    assert len(given["times"]) == round(1.0 / step) + 1
    assert (given["color"], given["speed"]) == ("species", 0.5)
