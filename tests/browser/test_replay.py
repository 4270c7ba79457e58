"""Replays in a real browser: from the disk, under their own policy, alone."""

import base64
import re
import time
import zlib

import numpy as np
import pytest

import carom
from carom import scenes
from carom.view import write_replay

from .conftest import Shown
from .png import pixels
from .test_page import still_life, where


@pytest.fixture
def play(chromium, tmp_path):
    """Open a file in a new page. When all is done, checks what the page did meanwhile."""
    complaints, calls, contexts = [], [], []

    def open_file(path, width=1280, height=720, **options):
        context = chromium.new_context(
            viewport={"width": width, "height": height},
            **{"color_scheme": "dark", "reduced_motion": "reduce", **options},
        )
        contexts.append(context)
        page = context.new_page()
        page.on("console", lambda message: complaints.append(message.text))
        page.on("pageerror", lambda error: complaints.append(str(error)))
        context.on("request", lambda request: calls.append(request.url))
        page.goto(path.as_uri())
        shown = Shown(None, None, page)
        shown.wait("!!globalThis.carom?.timeline.keyframes.length")
        return shown

    yield open_file
    for context in contexts:
        context.close()
    assert complaints == []
    assert calls
    assert all(call.startswith("file://") for call in calls), calls


def film(path, sim, frames=90, **options):
    write_replay(sim, path, np.arange(frames) / 30 * sim.pace, **options)
    return path


def picture(shown):
    """When what stands now is drawn."""
    shown.wait("carom.timeline.playing || carom.drawn.t === carom.timeline.t")
    time.sleep(0.1)
    return pixels(shown.page.screenshot(clip={"x": 100, "y": 80, "width": 400, "height": 300}))


def test_it_plays_stops_and_is_scrubbed(play, tmp_path):
    sim = carom.Simulation(scenes.build("bounce"))
    shown = play(film(tmp_path / "a.html", sim, 300, speed=0.2), 800, 500)
    assert shown.page.title() == "Bouncing balls · carom"
    shown.wait("carom.timeline.t > 0.2")
    first = picture(shown)
    time.sleep(0.3)
    assert np.any(picture(shown) != first)
    shown.page.keyboard.press(" ")
    shown.wait("!carom.timeline.playing")
    still = picture(shown)
    time.sleep(0.3)
    assert np.array_equal(picture(shown), still)
    scrub = shown.page.get_by_role("slider", name="Place in the film")
    scrub.focus()
    shown.page.keyboard.press("Home")
    assert shown.js("carom.timeline.t") == 0
    shown.page.keyboard.press("ArrowRight")
    assert shown.js("carom.timeline.t === carom.timeline.keyframes[1].t")
    shown.page.keyboard.press("End")
    assert shown.js("carom.timeline.t === carom.timeline.end")
    assert scrub.get_attribute("aria-valuetext").startswith("9.97 of 9.97")
    assert np.any(picture(shown) != still)
    shown.page.keyboard.press("q")  # one frame back
    assert shown.js("carom.timeline.t === carom.timeline.keyframes[298].t")
    # From anywhere it begins anew; backwards it ends where it began.
    shown.page.keyboard.press("r")
    shown.wait("carom.timeline.t > 0.3 && carom.timeline.playing")
    shown.page.keyboard.press("v")
    shown.wait("carom.timeline.t === 0 && !carom.timeline.playing")


def test_balls_are_where_they_are_and_can_be_picked(play, tmp_path):
    sim = still_life()
    sim.velocity = [(0.5, 0, 0), (0, 0, 0), (0, 0, 0)]
    shown = play(film(tmp_path / "a.html", sim, title="Three"))
    shown.page.keyboard.press(" ")
    shown.page.get_by_role("slider", name="Place in the film").focus()
    shown.page.keyboard.press("End")
    shown.wait("carom.drawn.t === carom.timeline.end")
    x, y, _ = where(shown, (-3 + 0.5 * 89 / 30, 0, 0))
    shown.page.mouse.click(x, y)
    shown.wait("carom.hands.selected === 0")
    shown.wait("document.getElementById('inspector').innerText.includes('0.5000')")
    assert not shown.page.get_by_role("button", name="Delete this sphere").is_visible()
    # Nothing can be changed: no tool adds, no key deletes.
    shown.page.keyboard.press("Delete")
    shown.page.keyboard.press("a")
    assert shown.js("[carom.scene.n, carom.hands.mode]") == [3, "turn"]


def test_it_stops_at_collisions(play, tmp_path):
    sim = carom.Simulation(scenes.build("two-balls"))
    twin = carom.Simulation(scenes.build("two-balls"))
    twin.run(collisions=1)
    shown = play(film(tmp_path / "a.html", sim, frames=300))
    shown.page.keyboard.press("n")
    shown.wait("!carom.timeline.playing")
    assert shown.js("carom.timeline.t") == pytest.approx(twin.time, abs=1e-3)
    shown.wait("carom.hands.flash.strength > 0")
    shown.page.keyboard.press("b")
    assert shown.js("carom.timeline.t") == 0


def test_it_has_what_it_can_do_and_nothing_else(play, tmp_path):
    shown = play(film(tmp_path / "a.html", carom.Simulation(scenes.build("phase-4"))))
    visible = set(
        shown.js(
            """[...document.querySelectorAll("button, input, summary")].filter((e) =>
            e.checkVisibility()).map((e) => e.id).filter((id) => id)"""
        )
    )
    assert {"play", "scrub", "speed", "earlier", "later", "theme", "fullscreen"} <= visible
    assert not visible & {"add", "gallery-button", "compare"}
    assert not shown.js("document.getElementById('section-settings').checkVisibility()")
    unnamed = """[...document.querySelectorAll("button, input")].filter((e) => e.checkVisibility()
        && !e.getAttribute("aria-label") && !e.labels?.length && !e.innerText.trim()).length"""
    assert shown.js(unnamed) == 0
    shown.page.keyboard.press("?")
    sheet = shown.page.locator("#help").inner_text()
    assert "On to the next frame" in sheet
    assert "Choose a scene" not in sheet
    shown.page.keyboard.press("Escape")
    shown.page.keyboard.press("l")
    assert shown.page.locator("#share").is_visible()
    assert not shown.js("!!document.getElementById('keep')")
    assert not shown.page.get_by_role("textbox").count()


def test_a_program_that_the_policy_does_not_name_is_not_run(chromium, tmp_path):
    path = film(tmp_path / "a.html", carom.Simulation(scenes.build("two-balls")))
    text = path.read_text("utf-8")
    packed = re.search(r'id="program">([^<]+)<', text)[1]
    other = base64.b64encode(zlib.compress(b"globalThis.carom = 'another'")).decode()
    path.write_text(text.replace(packed, other), "utf-8")
    page = chromium.new_context().new_page()
    with page.expect_console_message(lambda message: "script-src" in message.text):
        page.goto(path.as_uri())
    assert page.evaluate("globalThis.carom") is None
    page.context.close()


def test_a_browser_that_is_too_old_is_told(chromium, tmp_path):
    path = film(tmp_path / "a.html", carom.Simulation(scenes.build("two-balls")))
    page = chromium.new_context().new_page()
    page.add_init_script("delete globalThis.DecompressionStream")
    page.goto(path.as_uri())
    page.get_by_text("This page needs a browser of 2023 or later").wait_for(timeout=5000)
    page.context.close()


def test_it_fits_a_phone(play, tmp_path):
    path = film(tmp_path / "a.html", carom.Simulation(scenes.build("two-balls")))
    for width, height in ((390, 844), (844, 390), (320, 600), (501, 240), (641, 400)):
        shown = play(path, width, height, has_touch=True)
        for name in ("film", "bar"):
            box = shown.page.locator(f"#{name}").bounding_box()
            assert box["x"] >= 0
            assert box["x"] + box["width"] <= width
            assert box["y"] + box["height"] <= height
        film_box, bar = (shown.page.locator(f"#{n}").bounding_box() for n in ("film", "bar"))
        assert film_box["y"] + film_box["height"] <= bar["y"] + 1
        for name in ("earlier", "later", "play"):
            assert shown.page.locator(f"#{name}").bounding_box()["height"] >= 38


def test_the_live_page_saves_what_it_has_shown(show, play, tmp_path):
    sim = carom.Simulation(scenes.build("gas", {"n": 40}))
    shown = show(sim)
    shown.wait("carom.recorder.keyframes.length > 5")
    shown.settle()
    kept = shown.js("carom.recorder.keyframes.map((k) => k.t)")
    last = shown.js("[...carom.recorder.keyframes.at(-1).position]")
    shown.page.keyboard.press("l")
    button = shown.page.get_by_role("button", name="Save last minute (replay)")
    assert button.get_attribute("title") == "Save the last minute as a replay (Y)"
    with shown.page.expect_download() as download:
        button.click()
    assert download.value.suggested_filename == "gas-in-a-box.html"
    path = tmp_path / "saved.html"
    download.value.save_as(path)
    replayed = play(path)
    assert replayed.js("carom.timeline.keyframes.map((k) => k.t)") == kept
    assert replayed.js("[...carom.timeline.keyframes.at(-1).position]") == pytest.approx(
        last, abs=1e-5 * 10
    )
    replayed.wait("carom.timeline.t > carom.timeline.start + 0.1")


def test_a_watching_page_saves_too_and_restarts_begin_anew(show, play, tmp_path):
    sim = carom.Simulation(scenes.build("two-balls"))
    shown = show(sim)
    shown.wait("carom.recorder.keyframes.length > 5")
    before = shown.js("carom.timeline.newest.t")
    shown.page.keyboard.press("r")
    shown.wait(f"carom.timeline.newest?.t < {before}")
    times = shown.js("carom.recorder.keyframes.map((k) => k.t)")
    assert times == sorted(set(times))
    shown.page.goto(shown.view.watch_url)
    shown.page.reload()  # another hash alone is no other page
    shown.wait("!!globalThis.carom?.timeline.newest")
    shown.wait("document.body.dataset.role === 'watch' && carom.recorder.keyframes.length > 5")
    with shown.page.expect_download() as download:
        shown.page.keyboard.press("y")
    download.value.save_as(tmp_path / "saved.html")
    assert play(tmp_path / "saved.html").js("carom.scene.n") == 2


def test_what_is_kept_is_bounded(show):
    shown = show(carom.Simulation(scenes.build("two-balls")), wait=True)
    bounds = shown.js(
        """[2, 1000, 10000, 100000].map((n) => {
          const recorder = new carom.recorder.constructor();
          const [radius, bytes] = [new Float32Array(n), { length: 16 * n }];
          recorder.setScene({ n, about: { key: 0 }, radius, bytes });
          for (let k = 0; k < 4000; k++) recorder.push({ t: k, clock: k / 60, playing: true });
          const { keyframes: kept } = recorder;
          return [kept.length * n * 28, kept.at(-1).clock - kept[0].clock];
        })"""
    )
    assert all(size <= 64 * 2**20 for size, _ in bounds)
    seconds = [duration for _, duration in bounds]
    assert seconds[0] == pytest.approx(60, abs=1)
    assert seconds[1] > 30
    assert seconds[3] > 1
