"""What hands change: velocities dragged, balls added and deleted, and the flash of a step."""

import time

import numpy as np
import pytest

import carom

from .test_hands import handle, pause_and_select, tip_of
from .test_page import BLUE, GREEN, RED, around, hue, rgb, still_life, where


def test_a_dragged_velocity_reaches_the_engine(show):
    shown = show(still_life())
    pause_and_select(shown, 1)
    x, y = handle(shown)
    ball = where(shown, (0, 2, 2))
    assert (x, y) == pytest.approx(ball[:2], abs=1.5)  # at rest: no arrow yet
    mouse = shown.page.mouse
    mouse.move(x, y)
    mouse.down()
    mouse.move(x + 70, y - 40, steps=5)
    assert "speed" in shown.page.locator(".hand-label").filter(visible=True).inner_text()
    mouse.up()
    time.sleep(0.5)
    velocity = shown.sim.velocity[1]
    assert np.all(shown.sim.velocity[[0, 2]] == 0)
    assert shown.sim.position[1] == pytest.approx((0, 2, 2))
    # The arrow of this velocity ends where the mouse let go.
    tip = tip_of(shown, 1)
    assert where(shown, tip)[:2] == pytest.approx((x + 70, y - 40), abs=1.5)
    # Across the view only: the ball was at rest.
    back = np.array(shown.js("carom.camera.axes.back"))
    assert abs(velocity @ back) < 1e-6 * np.linalg.norm(velocity)
    # Now with a part along the view, which a drag does not show: the tip stays as far away.
    faster = (velocity + 0.4 * np.linalg.norm(velocity) * back).tolist()
    shown.js(f"carom.connection.send(JSON.stringify({{op: 'push', index: 1, velocity: {faster}}}))")
    shown.wait(f"Math.abs(carom.hands.handle.velocity[0] - ({faster[0]!r})) < 1e-5")
    time.sleep(0.2)
    tip = tip_of(shown, 1)
    x, y = handle(shown)
    mouse.move(x, y)
    mouse.down()
    mouse.move(x - 50, y - 30, steps=5)
    mouse.up()
    time.sleep(0.5)
    assert handle(shown) == pytest.approx((x - 50, y - 30), abs=1.5)
    assert tip_of(shown, 1) @ back == pytest.approx(tip @ back, rel=1e-5)
    assert np.linalg.norm(shown.sim.velocity[1] - faster) > 0.1
    shown.page.locator(".hand-handle").press("ArrowUp")
    time.sleep(0.4)
    assert shown.sim.velocity[1] @ np.array(shown.js("carom.camera.axes.up")) > 0
    shown.page.keyboard.press("Space")
    shown.wait("carom.timeline.newest?.playing")
    shown.page.locator(".hand-handle").wait_for(state="hidden")


def start_adding(shown):
    shown.settle()
    shown.page.keyboard.press("a")
    assert shown.js("carom.hands.mode") == "add"


def test_a_ball_is_added_where_it_is_pressed_and_flies_where_it_is_thrown(show):
    shown = show(still_life())
    start_adding(shown)
    radius, mass = shown.js("[carom.hands.next.radius, carom.hands.next.mass]")
    assert (radius, mass) == pytest.approx((1, shown.sim.mass[0]))
    mouse = shown.page.mouse
    x, y = 430, 420
    mouse.move(x, y)
    mouse.down()
    mouse.move(x + 90, y + 30, steps=5)
    ghost = shown.js("carom.hands.overlay().ghost")
    mouse.up()
    shown.wait("carom.scene.n === 4")
    time.sleep(0.3)
    sim = shown.sim
    assert sim.position[3] == pytest.approx(ghost["x"], abs=1e-5)
    assert where(shown, sim.position[3])[:2] == pytest.approx((x, y), abs=1)
    tip = tip_of(shown, 3)
    assert where(shown, tip)[:2] == pytest.approx((x + 90, y + 30), abs=1)
    assert sim.radius[3] == pytest.approx(radius)
    assert sim.mass[3] == pytest.approx(mass)
    assert rgb(sim.color[3]) / 255 == pytest.approx(ghost["color"], abs=0.01)
    assert shown.js("carom.hands.mode") == "add"
    mouse.move(5, 300)
    shown.page.keyboard.press("Escape")
    assert shown.js("carom.hands.mode") == "turn"
    shown.js("carom.hands.next.ghost = null")
    time.sleep(0.3)
    middle = around(shown, x, y).mean(axis=0)
    assert hue(middle) == pytest.approx(hue(rgb(sim.color[3])), abs=0.3)


def test_what_does_not_fit_changes_nothing(show):
    shown = show(still_life())
    start_adding(shown)
    x, y, _ = where(shown, (0, 0, 0))
    shown.js("carom.hands.next.radius = 4.9")  # touches all three
    said = shown.js(
        """() => {
          const { listener } = carom.connection;
          const { note } = listener;
          globalThis.said = [];
          listener.note = (key, value) => {
            if (key === "refused") globalThis.said.push(value);
            note(key, value);
          };
          return globalThis.said;
        }"""
    )
    assert said == []
    shown.page.mouse.click(x, y)
    shown.wait("globalThis.said.length === 1")
    assert len(shown.sim) == 3
    assert shown.js("carom.scene.n") == 3
    assert shown.js("carom.hands.mode") == "add"


def test_adding_by_keys_and_leaving_a_throw(show):
    shown = show(still_life())
    start_adding(shown)
    mouse = shown.page.mouse
    mouse.move(430, 420)
    mouse.down()
    mouse.move(500, 420, steps=3)
    shown.page.keyboard.press("Escape")
    mouse.up()
    time.sleep(0.3)
    assert len(shown.sim) == 3
    assert shown.js("carom.hands.mode") == "add"
    shown.page.locator("#view").press("Enter")
    shown.wait("carom.scene.n === 4")
    assert shown.sim.position[3] == pytest.approx(shown.js("carom.camera.center"), abs=1e-5)
    assert np.all(shown.sim.velocity[3] == 0)


def test_a_finger_adds(show):
    shown = show(still_life(), 390, 844, has_touch=True)
    start_adding(shown)
    x, y, _ = where(shown, (0, -2, 2.5))
    touch = shown.page.context.new_cdp_session(shown.page)

    def finger(kind, *points):
        touch.send(
            "Input.dispatchTouchEvent",
            {"type": kind, "touchPoints": [{"x": x, "y": y} for x, y in points]},
        )

    finger("touchStart", (x, y))
    finger("touchMove", (x + 30, y - 10))
    finger("touchMove", (x + 40, y - 20))
    finger("touchEnd")
    shown.wait("carom.scene.n === 4")
    assert where(shown, shown.sim.position[3])[:2] == pytest.approx((x, y), abs=1)
    tip = tip_of(shown, 3)
    assert where(shown, tip)[:2] == pytest.approx((x + 40, y - 20), abs=1)


def test_deleting_the_selected_ball(show):
    shown = show(still_life())
    pause_and_select(shown, 1)
    shown.page.keyboard.press("Delete")
    shown.wait("carom.scene.n === 2 && carom.hands.sides.length > 0")
    assert [int(c) for c in shown.sim.color] == [RED, BLUE]
    assert shown.js("carom.hands.selected") is None
    shown.page.keyboard.press("Delete")  # nothing selected: nothing happens
    x, y, _ = where(shown, (-3, 0, 0))
    shown.page.mouse.click(x, y)
    assert shown.js("carom.hands.selected") == 0
    shown.page.get_by_role("button", name="Delete this sphere").click()
    shown.wait("carom.scene.n === 1")
    assert [int(c) for c in shown.sim.color] == [BLUE]


def test_a_step_flashes_both_balls_and_shows_the_impulse(show):
    sim = carom.Simulation(walls=carom.Box(12, 12, 12))
    sim.add((-3, 0, 0), velocity=(1, 0, 0), radius=1, color=GREEN)
    sim.add((2, 0, 0), radius=1, color=RED)
    shown = show(sim)
    shown.settle()
    shown.js("carom.connection.send(JSON.stringify({op: 'step'}))")
    shown.wait("carom.hands.overlay().marks.length === 2")
    overlay = shown.js("carom.hands.overlay()")
    centers = sorted(mark["x"][0] for mark in overlay["marks"])
    assert centers == pytest.approx([0, 2], abs=1e-5)
    (arrow,) = overlay["arrows"]
    assert arrow["from"] == pytest.approx([1, 0, 0], abs=1e-5)
    assert abs(arrow["to"][0] - 1) > 1
    shown.page.keyboard.press("Space")
    shown.wait("carom.hands.overlay().marks.length === 0")


def test_beside_ticks_a_click_selects_on_its_side_and_changes_nothing(show):
    shown = show(still_life())
    shown.settle()
    shown.page.keyboard.press("x")
    shown.wait("carom.hands.sides.length === 2")
    x, y = shown.js(
        """(() => {
          const { viewport } = carom.hands.sides[1];
          const place = carom.camera.project([-3, 0, 0]);
          return [place.x + viewport.x, place.y + viewport.y];
        })()"""
    )
    shown.page.mouse.click(x, y)
    assert shown.js("[carom.hands.selected, carom.hands.side]") == [0, 1]
    sides = [mark["side"] for mark in shown.js("carom.hands.overlay().marks")]
    assert sorted(sides) == [0, 1]
    shown.page.locator(".sphere-title").filter(has_text="in ticks").wait_for(state="visible")
    assert shown.page.locator(".hand-handle").is_hidden()
