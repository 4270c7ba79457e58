"""Buttons, keys and sliders of the page: what they do to the engine and to the picture."""

import time

import numpy as np
import pytest

import carom
from carom import scenes

from .test_page import RED, around, hue, rgb, still_life, where


def head_on(**more):
    """Two balls that meet at time 1.5 and fly apart, in open space."""
    return carom.Simulation(
        carom.Scene(
            carom.Spheres.of([(-2, 0, 0), (2, 0, 0)], [(1, 0, 0), (-1, 0, 0)], 0.5, color=RED),
            pace=0.5,
            color="own",
            **more,
        )
    )


def paused(shown):
    shown.wait("carom.timeline.newest?.playing === false")
    shown.wait("carom.timeline.t === carom.timeline.newest?.t")


def open_section(shown, name):
    shown.js(f"document.getElementById('section-{name}').open = true")


def slide(shown, name, share):
    """Move the slider of this name to a share of its way, by mouse."""
    slider = shown.page.get_by_role("slider", name=name, exact=True)
    slider.scroll_into_view_if_needed()
    box = slider.bounding_box()
    y = box["y"] + box["height"] / 2
    shown.page.mouse.move(box["x"] + 0.5 * box["width"], y)
    shown.page.mouse.down()
    shown.page.mouse.move(box["x"] + share * box["width"], y, steps=4)
    shown.page.mouse.up()
    return float(slider.get_attribute("aria-valuetext"))


def eventually(condition, seconds=8.0):
    end = time.perf_counter() + seconds
    while not condition():
        assert time.perf_counter() < end, "never true"
        time.sleep(0.02)


def test_step_and_back_stop_at_the_collision(show):
    shown = show(head_on())
    page = shown.page
    shown.settle()
    page.get_by_role("button", name="On to the next collision").click()
    shown.wait("carom.timeline.newest?.collisions === 1")
    paused(shown)
    assert shown.sim.time == pytest.approx(1.5)
    assert np.linalg.norm(np.diff(shown.sim.position, axis=0)) == pytest.approx(1.0)
    page.keyboard.press("b")
    shown.wait("carom.timeline.newest?.collisions === 0")
    page.keyboard.press("n")
    shown.wait("carom.timeline.newest?.collisions === 1")
    assert shown.sim.time == pytest.approx(1.5)
    page.get_by_role("button", name="Restart").click()
    shown.wait("carom.timeline.newest?.t < 1 && carom.timeline.newest?.collisions === 0")


def test_time_runs_backwards_and_the_page_says_so(show):
    shown = show(carom.Simulation(scenes.phase_3()))
    page = shown.page
    shown.wait("carom.timeline.t > 5")
    shown.settle()
    before = shown.sim.velocity.copy()
    assert page.locator("#reversed").is_hidden()
    page.get_by_role("button", name="Reverse time").click()
    page.locator("#reversed").wait_for(state="visible")
    assert np.array_equal(shown.sim.velocity, -before)
    assert page.locator("#lost-note").is_hidden()  # nothing is lost here
    assert "backwards" in shown.text("state")
    page.keyboard.press("v")
    page.locator("#reversed").wait_for(state="hidden")
    assert np.array_equal(shown.sim.velocity, before)


def test_lost_energy_does_not_come_back(show):
    shown = show(carom.Simulation(scenes.bounce()))
    shown.wait("document.body.dataset.loses === 'true'")
    shown.page.keyboard.press("v")
    shown.page.locator("#lost-note").wait_for(state="visible")


def test_speed_keys(show):
    shown = show(carom.Simulation(scenes.phase_3()))
    shown.page.keyboard.press(",")
    shown.wait("carom.timeline.newest?.speed < 0.7")
    shown.page.keyboard.press(".")
    shown.page.keyboard.press(".")
    shown.wait("carom.timeline.newest?.speed > 1.3")
    shown.page.keyboard.press("1")
    shown.wait("carom.timeline.newest?.speed === 1")


def test_keys_pressed_faster_than_the_server_answers_all_count(show):
    shown = show(carom.Simulation(scenes.phase_3()))
    shown.js("for (let k = 0; k < 5; k++) carom.actions.faster()")
    shown.wait("carom.timeline.newest?.speed > 9.99")
    # Frames with the speed from before may still have come; what was asked for stays.
    assert shown.text("speed-value") == "10×"
    slider = shown.page.get_by_role("slider", name="Speed")
    slider.focus()
    shown.js("carom.connection.send(JSON.stringify({op: 'speed', value: 0.1}))")
    shown.page.locator("#speed-value").get_by_text("0.1×").wait_for()
    assert float(slider.input_value()) == -50


def test_space_means_pause_after_a_click_on_another_button(show):
    shown = show(carom.Simulation(scenes.phase_3()))
    page = shown.page
    page.get_by_role("button", name="Reverse time").click()
    shown.wait("carom.timeline.newest?.reversed")
    page.keyboard.press("Space")
    shown.wait("carom.timeline.newest?.playing === false")
    assert shown.js("carom.timeline.newest?.reversed")
    # By keyboard the button is its own: space presses it.
    page.locator("#back").focus()
    page.keyboard.press("Tab")
    page.keyboard.press("Space")
    shown.wait("carom.timeline.newest?.playing")


def test_restitution_reaches_the_engine_and_is_not_fought(show):
    shown = show(carom.Simulation(scenes.phase_3()))
    open_section(shown, "settings")
    value = slide(shown, "Restitution of spheres", 0.25)
    assert 0.2 < value < 0.3
    eventually(lambda: shown.sim.rule.restitution == value)
    # What comes from outside shows once nobody holds the slider.
    time.sleep(1.0)
    field = shown.page.get_by_role("spinbutton", name="Restitution of spheres")
    assert float(field.input_value()) == value
    field.fill("0.999")
    field.press("Enter")
    eventually(lambda: shown.sim.rule.restitution == 0.999)
    shown.wait("document.body.dataset.loses === 'true'")


def test_the_slider_stays_under_the_finger(show):
    """While it is held, settings that come back do not move it."""
    shown = show(carom.Simulation(scenes.phase_3()))
    open_section(shown, "settings")
    slider = shown.page.get_by_role("slider", name="Restitution of spheres")
    slider.scroll_into_view_if_needed()
    box = slider.bounding_box()
    mouse = shown.page.mouse
    mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    mouse.down()
    shown.js("carom.laws.show({ ...carom.settings, restitution: 0.125 })")
    assert 0.4 < float(slider.get_attribute("aria-valuetext")) < 0.6
    mouse.up()
    time.sleep(1.0)
    shown.js("carom.laws.show({ ...carom.settings, restitution: 0.125 })")
    assert slider.get_attribute("aria-valuetext") == "0.125"


def test_gravity_has_a_strength_and_a_direction(show):
    shown = show(still_life())
    open_section(shown, "settings")
    page = shown.page
    page.get_by_role("button", name="Gravity left").click()
    eventually(lambda: shown.sim.gravity[0] < 0)
    assert shown.sim.gravity[1:] == pytest.approx([0, 0])
    strength = slide(shown, "Gravity", 0.9)
    eventually(lambda: np.linalg.norm(shown.sim.gravity) == pytest.approx(strength))
    assert shown.sim.gravity[0] == pytest.approx(-strength)
    page.get_by_role("button", name="Gravity down").click()
    eventually(lambda: shown.sim.gravity[2] == pytest.approx(-strength))
    needle = shown.js("document.querySelector('.compass path').getAttribute('d')")
    slide(shown, "Tilt from down, °", 0.5)
    eventually(lambda: shown.sim.gravity[0] > 0.9 * strength)
    assert shown.js("document.querySelector('.compass path').getAttribute('d')") != needle
    # The balls fall to the right in the picture too.
    shown.wait("carom.timeline.newest?.kinetic > 0")


def test_no_gravity_where_everything_is_periodic(show):
    shown = show(carom.Simulation(scenes.fluid(n=60)))
    open_section(shown, "settings")
    assert shown.page.get_by_text("No gravity.").is_visible()
    assert shown.page.get_by_role("button", name="Gravity down").is_hidden()


def test_a_wish_outlives_the_scene_that_comes_before_it_is_said(show):
    shown = show(carom.Simulation(scenes.gas(n=20)))
    shown.wait("carom.parameters.rows.length > 0")
    field = shown.page.get_by_role("spinbutton", name="Number of spheres")
    field.fill("31")
    field.press("Enter")
    shown.js("carom.parameters.setOrigin(carom.scene.about.origin)")
    shown.wait("carom.scene.n === 31")
    # But it is not meant for another scene.
    field.fill("45")
    field.press("Enter")
    shown.js("carom.parameters.setOrigin({name: 'bounce', options: {}})")
    time.sleep(0.6)
    assert shown.js("carom.scene.n") == 31


def test_the_scenes_own_parameters(show):
    shown = show(carom.Simulation(scenes.gas(n=40)))
    page = shown.page
    shown.wait("carom.parameters.rows.length > 0")
    shown.js("carom.look.setColor('own')")
    field = page.get_by_role("spinbutton", name="Number of spheres")
    assert field.input_value() == "40"
    field.fill("25")
    field.press("Enter")
    shown.wait("carom.scene.n === 25")
    eventually(lambda: len(shown.sim) == 25)
    assert page.get_by_role("radio", name="Own").is_checked()  # what people chose stays
    first = shown.sim.position.copy()
    page.get_by_role("button", name="Another seed").click()
    shown.wait("carom.scene.about.origin.options.seed !== 1")
    assert shown.js("carom.scene.about.origin.options.n") == 25
    eventually(lambda: not np.array_equal(shown.sim.scene.spheres.position, first))
    value = slide(shown, "Packing fraction", 0.3)
    shown.wait(f"carom.scene.about.origin.options.packing_fraction === {value}")


def test_what_is_refused_is_told_and_taken_back(show):
    shown = show(carom.Simulation(scenes.gas(n=40)))
    shown.wait("carom.parameters.rows.length > 0")
    field = shown.page.get_by_role("spinbutton", name="Packing fraction")
    field.fill("5")
    field.press("Enter")
    toast = shown.page.locator(".toast").first
    toast.wait_for(state="visible")
    assert "acking_fraction is 5" in toast.inner_text()
    assert field.input_value() == "0.05"
    assert len(shown.sim) == 40
    toast.get_by_role("button", name="Close").click()
    assert shown.page.locator(".toast").count() == 0


def test_colours_by_collisions_grow_with_them(show):
    shown = show(carom.Simulation(scenes.phase_3()))
    page = shown.page
    page.get_by_role("radio", name="Collisions").check(force=True)
    assert shown.js("carom.look.full") == 5
    shown.page.keyboard.press(".")
    shown.wait("carom.look.full >= 10", 20)
    full = shown.js("carom.look.full")
    assert full / 10 ** int(np.log10(full)) in (1, 2, 5)
    assert f"{full}" in shown.text("legend").replace("\u202f", "")
    page.keyboard.press("c")
    assert page.get_by_role("radio", name="Own").is_checked()


def test_sections_stay_as_they_were_left(show):
    shown = show(still_life())
    page = shown.page
    page.locator("#section-look summary").click()
    page.locator("#section-settings summary").click()
    shown.wait("localStorage.length >= 2")
    page.reload()
    shown.wait("!!globalThis.carom?.timeline.newest")
    assert page.get_by_role("radio", name="Wire").is_hidden()
    assert page.get_by_role("slider", name="Restitution of spheres").is_visible()


def test_dark_light_and_as_the_system_is(show):
    shown = show(still_life())
    page = shown.page
    shown.settle()
    dark = around(shown, 640, 690).mean()
    page.get_by_role("button", name="Dark or light").click()
    assert shown.js("document.documentElement.dataset.theme") == "light"
    time.sleep(0.3)
    assert around(shown, 640, 690).mean() > dark + 100
    x, y, _ = where(shown, (-3, 0, 0))
    assert hue(around(shown, x, y).mean(axis=0)) == pytest.approx(hue(rgb(RED)), abs=0.3)
    page.reload()
    shown.wait("!!globalThis.carom?.timeline.newest")
    assert shown.js("document.documentElement.dataset.theme") == "light"
    page.keyboard.press("k")
    page.keyboard.press("k")
    assert shown.js("[carom.theme.choice, carom.theme.name]") == ["auto", "dark"]
    page.emulate_media(color_scheme="light")
    shown.wait("document.documentElement.dataset.theme === 'light'")


def test_help_lists_every_key_and_traps_the_focus(show):
    shown = show(still_life())
    page = shown.page
    page.keyboard.press("?")
    dialog = page.get_by_role("dialog", name="Keys, mouse and touch")
    assert dialog.is_visible()
    assert dialog.locator("kbd").count() >= 28
    moment = shown.js("carom.look.wire")
    page.keyboard.press("w")  # keys rest while a dialog is open
    assert shown.js("carom.look.wire") is moment
    for _ in range(8):
        page.keyboard.press("Tab")
        assert shown.js("document.activeElement === document.body") or shown.js(
            "document.getElementById('help').contains(document.activeElement)"
        )
    page.keyboard.press("Escape")
    assert dialog.is_hidden()
    page.keyboard.press("w")
    assert shown.js("carom.look.wire") is not moment


def test_every_button_says_what_it_does_and_quotes_its_key(show):
    shown = show(still_life())
    buttons = shown.js(
        """[...document.querySelectorAll("#bar button, #actions button")].map((button) =>
             [button.title, button.getAttribute("aria-label")])"""
    )
    assert len(buttons) >= 18
    for title, label in buttons:
        assert title.startswith(label)
        assert title.endswith(")"), title
