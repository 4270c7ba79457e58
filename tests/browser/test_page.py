"""The page in a real browser: pixels, controls, and what reaches the engine."""

import math
import time
from pathlib import Path

import numpy as np
import pytest

import carom
from carom import scenes

from .png import pixels

RED, GREEN, BLUE = 0xE03020, 0x20C040, 0x3060F0


def still_life():
    """Three large balls at rest in a box, each of its own colour."""
    return carom.Simulation(
        carom.Scene(
            carom.Spheres.of(
                [(-3, 0, 0), (0, 2, 2), (2.5, -2, -2)], radius=1, color=[RED, GREEN, BLUE]
            ),
            walls=(carom.Box(10, 10, 10),),
            color="own",
        )
    )


def where(shown, point):
    """Pixel of a place in the world: lines from the eye, cut by the picture's plane.

    By angles, not matrices: how far right and up of the line to the target the place is seen.
    """
    eye, target, size, insets = shown.js(
        "[carom.camera.eye, carom.camera.target, carom.camera.size, carom.camera.insets]"
    )
    eye, point = np.array(eye), np.array(point, float)
    ahead = np.array(target) - eye
    ahead /= np.linalg.norm(ahead)
    right = np.cross(ahead, (0, 0, 1))
    right /= np.linalg.norm(right)
    up = np.cross(right, ahead)
    line = point - eye
    per_tangent = size["height"] / 2 / math.tan(math.radians(17))
    x = size["width"] / 2 + (insets["left"] - insets["right"]) / 2
    y = size["height"] / 2 + (insets["top"] - insets["bottom"]) / 2
    x += per_tangent * (line @ right) / (line @ ahead)
    y -= per_tangent * (line @ up) / (line @ ahead)
    return x, y, per_tangent / (line @ ahead)


def around(shown, x, y, half=3):
    """Pixels around a place on the page."""
    box = {"x": round(x) - half, "y": round(y) - half, "width": 2 * half, "height": 2 * half}
    return pixels(shown.page.screenshot(clip=box)).reshape(-1, 3).astype(float)


def hue(color):
    """Red, green, blue over their largest, so that light and shade do not count."""
    return np.asarray(color, float) / max(1.0, np.max(color))


def rgb(packed):
    return np.array([packed >> 16, packed >> 8 & 255, packed & 255])


def test_balls_are_where_they_are_and_have_their_colours(show):
    shown = show(still_life())
    shown.settle()
    for place, color in zip(shown.sim.position, (RED, GREEN, BLUE), strict=True):
        x, y, scale = where(shown, place)
        middle = around(shown, x, y).mean(axis=0)
        assert hue(middle) == pytest.approx(hue(rgb(color)), abs=0.25)
        # Inside the outline on all four sides, and background beyond it.
        for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            inside = around(shown, x + 0.9 * scale * dx, y + 0.9 * scale * dy, half=1)
            beyond = around(shown, x + 1.12 * scale * dx, y + 1.12 * scale * dy, half=1)
            off = [np.abs(hue(p.mean(axis=0)) - hue(rgb(color))).max() for p in (inside, beyond)]
            assert off[0] < 0.35
            assert off[0] < 0.7 * off[1]


def test_turning_zooming_and_moving_the_camera(show):
    shown = show(still_life())
    shown.settle()
    moves = [
        lambda: drag(shown, 160, 60),
        lambda: shown.page.mouse.wheel(0, -240),
        lambda: drag(shown, 60, -40, key="Shift"),
        lambda: shown.page.keyboard.press("ArrowLeft"),
        lambda: shown.page.keyboard.press("Shift+ArrowUp"),
        lambda: shown.page.keyboard.press("+"),
    ]
    for move in moves:
        before = where(shown, (-3, 0, 0))
        move()
        shown.wait("carom.drawn.camera === carom.camera.version")
        time.sleep(0.1)
        x, y, _ = where(shown, (-3, 0, 0))
        assert math.hypot(x - before[0], y - before[1]) > 4
        middle = around(shown, x, y).mean(axis=0)
        assert hue(middle) == pytest.approx(hue(rgb(RED)), abs=0.25)
    shown.page.keyboard.press("f")
    assert shown.js("carom.camera.moved") is False


def drag(shown, dx, dy, key=None):
    mouse = shown.page.mouse
    if key:
        shown.page.keyboard.down(key)
    mouse.move(400, 300)
    mouse.down()
    mouse.move(400 + dx, 300 + dy, steps=3)
    mouse.up()
    if key:
        shown.page.keyboard.up(key)


def test_nothing_changes_while_paused(show):
    shown = show(carom.Simulation(scenes.phase_3()))
    shown.wait("carom.timeline.t > 5")
    shown.settle()
    first, moment = shown.page.screenshot(), shown.sim.time
    time.sleep(0.4)
    assert shown.page.screenshot() == first
    assert shown.sim.time == moment
    assert shown.js("carom.timeline.t") == moment
    shown.page.keyboard.press("Space")
    shown.wait(f"carom.timeline.t > {moment + 5}")
    assert shown.page.screenshot() != first


def test_the_picture_follows_the_motion(show):
    """A ball in free flight is drawn where its formula says, at moments between keyframes."""
    sim = carom.Simulation(walls=carom.Box(12, 12, 12))
    sim.add((-5, 0, 0), velocity=(0.8, 0, 0), radius=0.5, color=GREEN)
    shown = show(sim)
    for _ in range(3):
        shown.wait(f"carom.timeline.t > {sim.time + 0.3}")
        shown.settle()
        moment = shown.js("carom.drawn.t")
        x, y, _ = where(shown, (-5 + 0.8 * moment, 0, 0))
        assert np.argmax(around(shown, x, y).mean(axis=0)) == 1
        shown.page.keyboard.press("Space")
        shown.wait("carom.timeline.newest?.playing")


def test_speed_restart_and_play_reach_the_engine(show):
    shown = show(carom.Simulation(scenes.phase_4()))
    page = shown.page
    slider = page.get_by_role("slider", name="Speed")
    slider.fill("-100")
    shown.wait("carom.timeline.newest?.speed === 0.01")
    assert shown.text("speed-value") == "0.01×"
    time.sleep(0.2)
    before, clock = shown.sim.time, time.perf_counter()
    time.sleep(0.6)
    rate = (shown.sim.time - before) / (time.perf_counter() - clock)
    assert rate == pytest.approx(0.6, rel=0.5)  # 60 ticks per second, a hundredth of them
    page.locator("#speed-value").click()
    shown.wait("carom.timeline.newest?.speed === 1")
    shown.wait("carom.timeline.newest?.collisions > 3")
    page.get_by_role("button", name="Pause", exact=True).click()
    shown.wait("carom.timeline.newest?.playing === false")
    start = shown.sim.scene.spheres.position
    assert not np.array_equal(shown.sim.position, start)
    page.get_by_role("button", name="Restart").click()
    shown.wait("carom.timeline.newest?.epoch === 1")
    shown.wait("carom.timeline.newest?.playing")


def test_numbers_on_the_page_are_the_engines(show):
    shown = show(carom.Simulation(scenes.bounce()))
    shown.wait("carom.timeline.newest?.collisions > 5")
    shown.settle()
    sim = shown.sim
    assert shown.text("n") == "25"
    assert shown.text("collisions") == str(sim.collisions)
    assert shown.text("wall-collisions") == str(sim.wall_collisions)
    kinetic = float(shown.text("kinetic").replace("\u202f", ""))
    assert kinetic == pytest.approx(sim.kinetic_energy, rel=1e-3)
    assert float(shown.text("clock")) == pytest.approx(sim.time, abs=0.006)
    assert shown.page.locator("#potential").is_visible()
    assert shown.text("drift").startswith("Energy with losses has")
    assert shown.text("title") == "Bouncing balls"


def test_energy_colours_are_the_papers(show):
    """Saturation KE/5 percent: a ball of energy 250 is half as grey as one at rest."""
    speed = math.sqrt(2 * 250)
    scene = carom.Scene(
        carom.Spheres.of(
            [(-100, 0, 0), (100, 0, 0)], [(0, 0, 0), (0, speed, 0)], 60, color=[RED, RED]
        ),
        walls=(carom.Box(500, 5000, 500),),
        collide=False,
        wire=True,
        pace=1e-6,
        camera=carom.scene.Camera((0, -900, 300)),
    )
    shown = show(carom.Simulation(scene))
    shown.settle()
    assert shown.page.get_by_role("radio", name="Energy").is_checked()
    assert shown.page.get_by_role("radio", name="Wire").is_checked()
    assert "500" in shown.text("legend")
    shown.page.get_by_role("radio", name="Solid").check(force=True)
    time.sleep(0.2)
    rest, fast = (
        around(shown, *where(shown, place)[:2]).mean(axis=0) for place in shown.sim.position
    )
    saturation = [1 - color.min() / color.max() for color in (rest, fast)]
    assert saturation[0] < 0.1
    assert 0.35 < saturation[1] < 0.65
    shown.page.get_by_role("radio", name="Own").check(force=True)
    time.sleep(0.2)
    own = around(shown, *where(shown, shown.sim.position[0])[:2]).mean(axis=0)
    assert hue(own) == pytest.approx(hue(rgb(RED)), abs=0.25)
    shown.page.get_by_role("radio", name="Speed").check(force=True)
    assert "speed" in shown.text("legend")


def test_scales_follow_a_gas_that_cools_and_begin_again_with_it(show):
    sim = carom.Simulation(scenes.gas(n=60, packing_fraction=0.2))
    sim.rule = carom.Smooth(0.7, contact_time=1e-4)
    shown = show(sim)
    assert shown.text("legend").split() == ["0", "speed", "2", "+"]
    shown.js("carom.controls.ask(20)")
    shown.wait("carom.look.full < 1")
    shown.settle()
    end = shown.wait("carom.look.full === carom.timeline.newest.fullSpeed && carom.look.full")
    assert shown.text("legend").split() == ["0", "speed", f"{end:g}", "+"]
    shown.js("carom.controls.ask(0.01)")
    shown.page.keyboard.press("r")
    shown.wait("carom.look.full === 2")


def test_wire_spheres_are_seen_through(show):
    shown = show(still_life())
    shown.settle()
    x, y, scale = where(shown, shown.sim.position[0])
    solid = around(shown, x, y, half=int(0.6 * scale))
    shown.page.keyboard.press("w")
    time.sleep(0.2)
    wire = around(shown, x, y, half=int(0.6 * scale))
    assert solid.min(axis=0)[0] > 75  # red all over
    assert wire.min(axis=0)[0] < 55  # the dark behind shows between the lines
    assert wire.max(axis=0)[0] > 150  # and the lines shine


def test_the_shaders_motion_is_the_tested_one(show):
    """`glsl.js` against `interpolation.js`, on the graphics unit, over random keyframes."""
    shown = show(still_life())
    worst = shown.js(Path(__file__).with_name("compare_motion.js").read_text())
    assert worst["cases"] == 4000
    assert worst["place"] < 2e-4
    assert worst["velocity"] < 2e-5
    assert worst["energy"] < 2e-3


@pytest.mark.parametrize(("width", "height"), [(820, 1180), (844, 390), (667, 375), (1024, 768)])
def test_nothing_covers_the_tools_on_any_screen(show, width, height):
    shown = show(still_life(), width, height)
    page = shown.page
    for opened in (False, True):
        shown.js(f"carom.controls.openPanel({str(opened).lower()})")
        bar = page.locator("#bar").bounding_box()
        assert bar["x"] >= 0
        assert bar["x"] + bar["width"] <= width
        for button in page.locator("#bar button, #panel-toggle, #extras button").all():
            if not button.is_visible():
                continue
            box = button.bounding_box()
            assert min(box["width"], box["height"]) >= 40
            x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
            inside = f"e.contains(document.elementFromPoint({x}, {y}))"
            assert button.evaluate(f"(e) => {inside}"), button.get_attribute("id")


def test_tools_of_a_selected_sphere_rest_without_one(show):
    shown = show(still_life())
    trail = shown.page.locator("#trail")
    assert trail.get_attribute("aria-pressed") == "false"
    shown.page.keyboard.press("j")
    shown.wait("document.getElementById('trail').getAttribute('aria-pressed') === 'true'")


def test_phone(show):
    shown = show(
        carom.Simulation(scenes.phase_0()), 390, 844, has_touch=True, device_scale_factor=2
    )
    page = shown.page
    shown.wait("carom.timeline.newest?.wallCollisions > 0")
    assert page.locator("#panel").is_hidden()
    page.get_by_role("button", name="Numbers and settings").tap()
    assert page.locator("#panel").is_visible()
    width = shown.js("document.documentElement.scrollWidth")
    assert width == 390
    for name in ("panel", "bar", "heading"):
        box = page.locator(f"#{name}").bounding_box()
        assert box["x"] >= 0
        assert box["x"] + box["width"] <= 390
        assert box["y"] + box["height"] <= 844
    for button in page.locator("#bar button").all():
        assert button.bounding_box()["width"] >= 40
    page.get_by_role("button", name="Pause", exact=True).tap()
    shown.wait("carom.timeline.newest?.playing === false")


def test_pinch_zooms_and_one_finger_turns(show):
    shown = show(still_life(), 390, 844, has_touch=True)
    touch = shown.page.context.new_cdp_session(shown.page)

    def fingers(kind, *points):
        touch.send(
            "Input.dispatchTouchEvent",
            {"type": kind, "touchPoints": [{"x": x, "y": y} for x, y in points]},
        )

    distance, azimuth = shown.js("[carom.camera.distance, carom.camera.azimuth]")
    fingers("touchStart", (150, 400))
    fingers("touchMove", (200, 400))
    fingers("touchEnd")
    assert shown.js("carom.camera.azimuth") < azimuth - 0.1
    fingers("touchStart", (150, 400), (250, 400))
    fingers("touchMove", (100, 400), (300, 400))
    fingers("touchEnd")
    assert shown.js("carom.camera.distance") == pytest.approx(distance / 2, rel=0.05)


def test_keyboard_reaches_everything_and_all_is_labelled(show):
    shown = show(still_life())
    wanted = {"view", "title-button", "restart", "step", "play", "reverse", "speed", "add", "fit"}
    wanted |= {"gallery-button", "compare", "share-button", "panel-toggle", "own", "solid"}
    names = set()
    for _ in range(40):
        shown.page.keyboard.press("Tab")
        names.add(shown.js("document.activeElement.id || document.activeElement.value"))
    assert names >= wanted
    unnamed = shown.js(
        """[...document.querySelectorAll("button, input, textarea, canvas")].filter((element) =>
             !element.getAttribute("aria-label") && !element.textContent.trim() &&
             ![...(element.labels ?? [])].some((label) => label.textContent.trim())
           ).map((element) => element.outerHTML)"""
    )
    assert unnamed == []


def test_the_token_leaves_the_address_and_survives_a_reload(show):
    shown = show(still_life())
    assert "token" not in shown.page.url
    assert "#" not in shown.page.url
    shown.page.reload()
    shown.wait("!!globalThis.carom?.timeline.newest")


def test_first_picture_comes_soon(show):
    start = time.perf_counter()
    shown = show(carom.Simulation(scenes.phase_4()))
    shown.wait("carom.drawn.t >= 0")
    assert time.perf_counter() - start < 4  # two seconds on a machine that does nothing else


def test_it_calls_again_when_the_line_was_cut(show):
    shown = show(carom.Simulation(scenes.phase_3()))
    page = shown.page
    shown.wait("carom.timeline.t > 3")
    loop = shown.view._server._loop
    for client in shown.view._server._clients:
        loop.call_soon_threadsafe(client.connection.transport.abort)
    page.locator("#connection").wait_for(state="visible")
    assert "Waiting" in shown.text("connection")
    page.locator("#connection").wait_for(state="hidden")
    shown.wait("!!carom.timeline.newest")
    moment = shown.js("carom.timeline.t")
    shown.wait(f"carom.timeline.t > {moment}")


def test_a_failure_is_told_in_words_and_its_cure_lets_time_run_on(show):
    sim = carom.Simulation(rule=carom.Smooth(restitution=0.05))
    for x, v in ((-2, 1), (0, 0), (2, -1)):
        sim.add((x, 0, 0), velocity=(v, 0, 0))
    shown = show(sim, wait=False)
    banner = shown.page.locator("#failure")
    banner.wait_for(state="visible")
    assert "Spheres 1 and 2 collapse at time 1" in banner.inner_text()
    shown.js("carom.connection.send(JSON.stringify({ op: 'rule', restitution: 0.5 }))")
    banner.wait_for(state="hidden")
    shown.page.keyboard.press("Space")
    shown.wait("carom.timeline.t > 1.2")
