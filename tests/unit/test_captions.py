"""Words in pictures: what they say, where they stand, and which letters they have."""

import numpy as np
import pytest
from PIL import ImageFont
from tests.unit.seen import luminance

import carom
from carom.pictures.caption import Caption, Legend, short
from carom.pictures.letters import Letters, spelled, wide_font
from carom.pictures.look import parts
from carom.pictures.painter import Painter, Style

SMALL = {"size": (160, 90)}


def titled(title):
    spheres = carom.Spheres.of([(0, 0, 0)], radius=0.5)
    return carom.Scene(spheres, (carom.Box(10, 10, 10),), color="own", title=title)


def drawn(described, **options):
    return carom.Simulation(described).picture(**options).pixels


@pytest.fixture
def said(monkeypatch):
    """All words that are drawn."""
    texts = []
    write = Caption._text

    def noted(self, draw, place, text, *rest):
        texts.append(text)
        write(self, draw, place, text, *rest)

    monkeypatch.setattr(Caption, "_text", noted)
    return texts


def test_words_say_what_colors_mean():
    described = carom.scenes.gas(n=30)
    state, _ = described.build()
    for color, bars, dots in (("energy", 1, 0), ("speed", 1, 0), ("species", 0, 1), ("own", 0, 0)):
        legend = Legend.of(state, Style.of(described, color=color))
        assert (len(legend.bars), len(legend.dots)) == (bars, dots)
    phase = carom.scenes.phase_4()
    assert len(Legend.of(phase.build()[0], Style.of(phase)).bars) == 5
    plain, worded = (drawn(described, caption=caption, size=(640, 360)) for caption in (0, 1))
    changed = np.abs(plain.astype(int) - worded).max(axis=2) > 40
    corners = changed[:40, :200], changed[:40, -120:], changed[-60:, :200]
    assert all(corner.sum() > 50 for corner in corners)
    assert not changed[60:280].any()


@pytest.mark.parametrize("size", [(120, 90), (240, 100), (640, 360)])
def test_no_word_covers_another(size, monkeypatch):
    boxes = []
    write = Caption._text

    def noted(self, draw, place, text, name, anchor, ink):
        boxes.append(draw.textbbox(place, text, self._fonts[name], anchor))
        write(self, draw, place, text, name, anchor, ink)

    monkeypatch.setattr(Caption, "_text", noted)
    for title in ("Gas", "A title far too long for any picture, however wide it may be drawn" * 2):
        boxes.clear()
        drawn(titled(title), color="energy", size=size)
        for k, (left, top, right, bottom) in enumerate(boxes):
            for other in boxes[:k]:
                apart = left >= other[2] or right <= other[0] or top >= other[3]
                # The title and the legend are drawn twice, on black and on white.
                assert apart or bottom <= other[1] or (left, top, right, bottom) == other


def test_long_titles_end_in_dots(said):
    drawn(titled("An endless title " * 20), size=(320, 180))
    assert said[0].endswith("...")
    assert 10 < len(said[0]) < 60


@pytest.mark.parametrize("size", [(16, 16), (64, 64), (16, 1000), (1000, 16)])
@pytest.mark.parametrize("color", ["energy", "speed", "collisions", "species"])
def test_words_in_tiny_pictures_do_no_harm(size, color):
    picture = carom.Simulation(carom.scenes.phase_4()).picture(size=size, color=color)
    assert picture.pixels.shape == (size[1], size[0], 3)


@pytest.mark.parametrize("size", [(320, 180), (640, 480), (1920, 1080), (360, 640)])
def test_words_stay_inside(size):
    sim = carom.Simulation(carom.scenes.phase_4())
    plain, worded = (sim.picture(size=size, caption=c).pixels.astype(int) for c in (False, True))
    y, x = np.nonzero(np.abs(plain - worded).max(axis=2))
    assert x.min() > 3
    assert y.min() > 3
    assert x.max() < size[0] - 4
    assert y.max() < size[1] - 4


def test_numbers_are_short():
    assert [short(v) for v in (0, 0.02, 500, 2e6, 3.14159, 1e-5, 1e5)] == [
        "0", "0.02", "500", "2e6", "3.14", "1e-5", "1e5",
    ]  # fmt: skip


TITLE = "Übung φ = λ₀ — é ñ, 粒子"


def test_a_title_has_its_letters_where_matplotlib_has_brought_a_font():
    letters = Letters(TITLE, ImageFont)
    assert letters.text == "Übung φ = λ₀ — é ñ, ??"
    some = letters.sized(20)
    assert bytes(some.getmask("φ")) != bytes(some.getmask("\uffff"))
    # Signs that lose nothing do without it, so that words look as they always do.
    assert Letters("Two × 3 – “π’s”", ImageFont).text == "Two × 3 – “π’s”"
    plain = Letters("Newton’s cradle × 3 – …", ImageFont)
    assert plain.text == "Newton's cradle x 3 - ..."
    assert plain.sized(20).getname() == ImageFont.load_default(20).getname()


def test_without_it_they_are_spelled(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "matplotlib", None)
    assert wide_font() is None
    letters = Letters("Größe × 3: " + TITLE, ImageFont)
    assert letters.text == "Grosse x 3: Ubung phi = lambda0 - e n, ??"
    assert letters.sized(20).getname() == ImageFont.load_default(20).getname()
    assert "".join(map(spelled, "ΔΩς½Å−\n\u0301\x00")) == "DeltaOmegasigma1/2A-"


def test_any_title_can_be_drawn():
    described = titled(TITLE + "\n\t\x00\ud800🎱" + 200 * "x")
    assert drawn(described, **SMALL).shape == (90, 160, 3)


def test_words_over_a_picture_are_as_if_drawn_on_it():
    described = carom.scenes.phase_4()
    state, world = described.build()
    style = Style.of(described, size=(640, 360))
    pixels = Painter(state, world, style).paint(state)
    words = Caption("Words", Legend.of(state, style), style, 0.1)
    first = words.write(pixels, 1.0, 500.0)
    drawn_on_it = words._draw_still(pixels, 500.0).astype(int)
    clock = np.s_[:60, 500:]
    difference = np.abs(first - drawn_on_it)
    difference[clock] = 0
    assert difference.max() <= 2
    assert np.array_equal(first, words.write(pixels, 1.0, 500.0))
    # The clock goes on, and so does the end of a scale.
    later, longer = words.write(pixels, 2.0, 500.0), words.write(pixels, 1.0, 1000.0)
    assert [changed[clock].any() for changed in (later != first, longer != first)] == [True, False]
    assert [changed[300:].any() for changed in (later != first, longer != first)] == [False, True]


def test_a_rim_keeps_words_readable_over_bright_spheres():
    style = Style((640, 360))
    words = Caption("Words", Legend([]), style, 0.1)
    shown = luminance(words.write(np.full((360, 640, 3), 255, np.uint8), 1.0, 1.0))
    back = luminance(parts(style.palette.back) * 255)
    assert np.count_nonzero(shown < back + 15) > 100


def test_a_scale_that_goes_on_says_so(said):
    sim = carom.Simulation(carom.scenes.gas(n=30))
    sim.picture(color="speed", **SMALL)
    assert {"speed", "2 +"} <= set(said)
    said.clear()
    sim.picture(color="collisions", **SMALL)
    assert {"collisions so far", "5"} <= set(said)


def test_the_clock_tells_pictures_apart(tmp_path, said):
    sim = carom.Simulation(carom.scenes.gas(n=30))
    speed = 0.001 * 30 / sim.pace
    carom.render(sim, tmp_path / "a.mp4", until=0.003, speed=speed, **SMALL)
    assert [text for text in said if text.startswith("time")] == [
        "time 0.000", "time 0.001", "time 0.002",
    ]  # fmt: skip
