"""Hands in the picture, in a real browser: what is clicked, dragged and typed, and what it does."""

import colorsys
import math
import time

import numpy as np
import pytest

import carom

from .png import pixels
from .test_page import GREEN, RED, around, still_life, where

#: Red, yellow, green, magenta: as far apart as hues can be that are not the background's blue.
COLORS = {0.0: 0xF01818, 1 / 6: 0xE8E818, 1 / 3: 0x18E018, 5 / 6: 0xE818E8}


def crowd(speed=0.0, world=carom.Box):
    """Many balls of four colours, some in front of others."""
    rng = np.random.default_rng(5)
    places = [(x, y, z) for x in (-4, -2, 0, 2, 4) for y in (-4, 0, 4) for z in (-4, -2, 0, 2, 4)]
    n = len(places)
    return carom.Simulation(
        carom.Scene(
            carom.Spheres.of(
                np.array(places) + rng.uniform(-0.4, 0.4, (n, 3)),
                velocity=speed * rng.normal(size=(n, 3)),
                radius=rng.uniform(0.3, 0.55, n),
                color=np.array(list(COLORS.values()))[rng.integers(0, len(COLORS), n)],
            ),
            walls=(world(11, 11, 11),),
            color="own",
            pace=0.2,
        )
    )


def colour_at(picture, x, y, half):
    """The one hue of all pixels around a place; "nothing" on background; None if mixed or grey."""
    found = set()
    for r, g, b in picture[y - half : y + half + 1, x - half : x + half + 1].reshape(-1, 3) / 255.0:
        h, s, v = colorsys.rgb_to_hsv(r, g, b)
        nearest = min(COLORS, key=lambda c: abs((h - c + 0.5) % 1 - 0.5))
        close = abs((h - nearest + 0.5) % 1 - 0.5) < 0.06
        if close and s > 0.5 and v > 0.25:
            found.add(nearest)
        elif v < 0.5 and 0.52 < h < 0.72:
            found.add("nothing")
        else:
            found.add(None)
    return found.pop() if len(found) == 1 else None


def agree(shown, picture, tries=400):
    """Click on pixels of known colour: the selected sphere has that colour. Counts both kinds."""
    rng = np.random.default_rng(3)
    colors = shown.js("[...carom.scene.color]")
    hits, misses, last = 0, 0, (0, 0)
    for _ in range(tries):
        x, y = int(rng.integers(230, 760)), int(rng.integers(80, 600))
        seen = colour_at(picture, x, y, 1)
        if seen == "nothing":
            seen = colour_at(picture, x, y, 8)
        if seen is None or math.hypot(x - last[0], y - last[1]) < 30:
            continue
        if (misses if seen == "nothing" else hits) >= 25:
            continue
        last = x, y
        shown.page.mouse.click(x, y)
        selected = shown.js("carom.hands.selected")
        if seen == "nothing":
            assert selected is None, (x, y)
            misses += 1
        else:
            assert selected is not None, (x, y)
            assert colors[selected] == COLORS[seen], (x, y, selected)
            hits += 1
    return hits, misses


def test_a_click_selects_the_ball_whose_pixel_it_hits(show):
    shown = show(crowd())
    shown.settle()
    hits, misses = agree(shown, pixels(shown.page.screenshot()))
    assert hits >= 20
    assert misses >= 5
    shown.page.keyboard.press("Escape")
    assert shown.js("carom.hands.selected") is None


@pytest.mark.parametrize("world", [carom.Box, carom.Periodic])
def test_it_agrees_at_moments_between_keyframes_too(show, world):
    shown = show(crowd(2.0, world))
    shown.page.get_by_role("slider", name="Speed").fill("30")  # long ways between keyframes
    shown.wait("carom.timeline.newest?.t > 0.6")
    shown.wait(
        """() => {
          const { timeline } = carom;
          const [first, second] = timeline.keyframes.slice(-2);
          if (second === undefined || second.t - first.t < 0.005) return false;
          timeline.t = 0.35 * first.t + 0.65 * second.t;
          timeline.advance = () => [first, second];
          timeline.push = () => undefined;
          return true;
        }"""
    )
    shown.wait("carom.drawn.t === carom.timeline.t")
    time.sleep(0.3)
    hits, _ = agree(shown, pixels(shown.page.screenshot()), tries=250)
    assert hits >= 15


def pause_and_select(shown, i):
    shown.settle()
    shown.js(f"carom.hands.select({i})")
    time.sleep(0.3)


def handle(shown):
    """Middle of the velocity's handle."""
    box = shown.page.locator(".hand-handle").bounding_box()
    return box["x"] + box["width"] / 2, box["y"] + box["height"] / 2


def tip_of(shown, i):
    """Where the arrow of a sphere's velocity ends: it grows out of the surface."""
    sim = shown.sim
    speed = np.linalg.norm(sim.velocity[i])
    ahead = sim.velocity[i] / speed
    return sim.position[i] + ahead * (0.96 * sim.radius[i] + speed * shown.js("carom.hands.time"))


def test_a_drag_turns_and_selects_nothing_and_double_click_shows_everything(show):
    shown = show(still_life())
    shown.settle()
    x, y, _ = where(shown, (-3, 0, 0))
    mouse = shown.page.mouse
    mouse.move(x, y)
    mouse.down()
    mouse.move(x + 60, y, steps=4)
    mouse.up()
    assert shown.js("carom.hands.selected") is None
    assert shown.js("carom.camera.moved") is True
    x, y, _ = where(shown, (-3, 0, 0))
    mouse.click(x, y)
    assert shown.js("carom.hands.selected") == 0
    time.sleep(0.5)
    mouse.dblclick(330, 640)
    assert shown.js("carom.camera.moved") is False
    assert shown.js("carom.hands.selected") is None


def test_a_finger_selects(show):
    shown = show(still_life(), 390, 844, has_touch=True)
    shown.settle()
    x, y, _ = where(shown, (2.5, -2, -2))
    shown.page.touchscreen.tap(x, y)
    assert shown.js("carom.hands.selected") == 2


def test_the_inspector_reads_the_engines_numbers(show):
    scene = carom.Scene(
        carom.Spheres.of(
            [(-3, 0, 0), (3, 0, 0)], [(1, 0.5, -2), (0, 0, 0)], radius=[0.5, 1], mass=[2, 3],
            fixed=[False, True],
        ),
        walls=(carom.Box(12, 12, 12),),
    )  # fmt: skip
    shown = show(carom.Simulation(scene))
    shown.wait("carom.timeline.newest?.wallCollisions > 1")
    shown.settle()
    page = shown.page
    page.keyboard.press("j")
    page.locator("#inspector .vector").first.wait_for(state="visible")
    time.sleep(0.3)
    text = page.locator("#inspector").inner_text().replace("−", "-").replace("\u202f", "")
    words = text.split()
    sim = shown.sim
    assert "Sphere 0" in text
    at = words.index("Position")
    assert [float(w) for w in words[at + 1 : at + 4]] == pytest.approx(sim.position[0], abs=1e-2)
    at = words.index("Velocity")
    assert [float(w) for w in words[at + 1 : at + 4]] == pytest.approx(sim.velocity[0], abs=1e-2)
    assert float(words[words.index("Speed") + 1]) == pytest.approx(math.sqrt(5.25), abs=1e-2)
    assert float(words[words.index("energy") + 1]) == pytest.approx(5.25, rel=1e-3)
    assert float(words[words.index("Mass") + 1]) == 2
    assert int(words[words.index("Collisions") + 1]) == sim.state.collision_count[0]
    page.get_by_role("button", name="Next sphere").press("Enter")
    time.sleep(0.3)
    assert "fixed" in page.locator("#inspector").inner_text()
    page.get_by_role("button", name="Previous sphere").click()
    assert shown.js("carom.hands.selected") == 0
    # It is not read more often than ten times a second.
    changes = shown.js(
        """() => new Promise((done) => {
          let n = 0;
          new MutationObserver((list) => (n += list.length)).observe(
            document.querySelector("#inspector .vector"), { subtree: true, childList: true });
          document.getElementById("play").click();
          setTimeout(() => done(n), 1000);
        })"""
    )
    assert 3 <= changes <= 3 * 11


def test_following_keeps_the_ball_in_the_middle(show):
    sim = carom.Simulation(walls=carom.Box(12, 12, 12))
    sim.add((-4, 0, 0), velocity=(0.8, 0.3, 0.2), radius=0.6, color=GREEN)
    sim.add((4, 4, 4), radius=0.6, color=RED)
    shown = show(sim)
    pause_and_select(shown, 0)
    shown.page.keyboard.press("o")
    shown.page.keyboard.press("Space")
    start = shown.js("carom.timeline.t")
    for k in range(2):
        shown.wait(f"carom.timeline.t > {start + 1 + k}")
        shown.settle()
        shown.js("carom.camera.turn(0.3, 0.1)")
        time.sleep(0.2)
        x, y = shown.js("[carom.camera.middle.x, carom.camera.middle.y]")
        assert np.argmax(around(shown, x, y).mean(axis=0)) == 1
        place = shown.js("carom.camera.center")
        assert place == pytest.approx(shown.sim.position[0], abs=1e-5)
        shown.page.keyboard.press("Space")
        shown.wait("carom.timeline.newest?.playing")
    assert shown.js("carom.hands.following") is True
    shown.page.keyboard.press("f")
    assert shown.js("carom.hands.following") is False


def test_the_trail_lies_behind_the_ball(show):
    sim = carom.Simulation(walls=carom.Box(12, 12, 12))
    sim.add((-4, 0, 0), velocity=(0.8, 0, 0.5), radius=0.6, color=GREEN)
    shown = show(sim)
    shown.wait("!!carom.scene")
    shown.js("carom.hands.select(0)")
    start = shown.js("carom.timeline.t")
    shown.wait(f"carom.timeline.t > {start + 1}")
    shown.settle()
    points = np.reshape(shown.js("[...carom.hands.overlay().trails[0].points]"), (-1, 3))
    assert len(points) >= 4
    assert points[-1] == pytest.approx(shown.sim.position[0], abs=1e-5)
    free = points[(points[:, 0] < 5.4) & (points[:, 2] < 5.4)]
    assert free[:, 2] == pytest.approx(0.5 / 0.8 * (free[:, 0] + 4), abs=1e-5)
    assert np.all(np.diff(free[:, 0]) > 0)
    shown.page.keyboard.press("t")
    assert shown.js("carom.hands.overlay().trails") == []


def test_tools_of_the_selected_sphere_are_pressed_only_with_one(show):
    shown = show(still_life())
    page = shown.page
    bar = page.locator("#bar")

    def pressed(name):
        return bar.get_by_role("button", name=name).get_attribute("aria-pressed")

    inspector = page.locator("#section-inspector")
    inspector.get_by_text("No sphere selected").wait_for(state="visible")
    assert inspector.get_by_text("Click a sphere").is_visible()
    assert (pressed("Trail"), pressed("Follow")) == ("false", "false")
    for key in ("t", "o"):  # nothing to do it with: they say so
        page.keyboard.press(key)
    assert page.locator(".toast").filter(has_text="Select a sphere first").count() == 2
    time.sleep(0.2)
    assert (pressed("Trail"), pressed("Follow")) == ("false", "false")
    inspector.get_by_role("button", name="Next sphere").click()
    page.locator("#bar [data-tool=trail][aria-pressed=true]").wait_for()
    assert pressed("Follow") == "false"
    page.keyboard.press("o")
    own = inspector.get_by_role("button", name="Follow")
    page.locator("#inspector [aria-label^=Follow][aria-pressed=true]").wait_for()
    page.keyboard.press("Shift+ArrowLeft")  # moving the camera lets it go
    page.locator("#inspector [aria-label^=Follow][aria-pressed=false]").wait_for()
    assert own.is_visible()
    assert pressed("Follow") == "false"
    page.keyboard.press("t")
    page.locator("#bar [data-tool=trail][aria-pressed=false]").wait_for()
    page.keyboard.press("Escape")
    page.keyboard.press("j")
    time.sleep(0.3)
    assert pressed("Trail") == "false"  # what people chose stays


def test_on_a_phone_the_selected_sphere_takes_room_only_when_there_is_one(show):
    shown = show(still_life(), 390, 844)
    shown.page.keyboard.press("p")
    inspector = shown.page.locator("#section-inspector")
    inspector.wait_for(state="hidden")
    shown.page.keyboard.press("j")
    inspector.wait_for(state="visible")
