"""Exact against ticks, side by side."""

import time

import numpy as np

import carom
from carom import scenes

from .png import pixels
from .test_page import GREEN, RED


def dense():
    """Fast balls, close together: ticks miss much."""
    return carom.Simulation(scenes.gas(n=60, packing_fraction=0.2, seed=2))


def number(text):
    return float(text.replace("\u202f", "").replace("–", "nan"))


def test_ticks_miss_collisions_and_the_page_counts_them(show):
    shown = show(dense())
    page = shown.page
    page.keyboard.press("x")
    page.locator("#comparison .side").last.wait_for(state="visible")
    shown.wait("carom.twin.newest?.missed > 3", 20)
    time.sleep(0.4)
    exact, ticks = page.locator("#comparison .side").all()
    assert "Exact" in exact.inner_text()
    assert "Ticks of 0.0" in ticks.inner_text()
    missed = [side.locator("dt:text('missed') + dd").inner_text() for side in (exact, ticks)]
    assert number(missed[0]) == 0
    assert number(missed[1]) > 3
    assert exact.locator("dt:text('deepest overlap') + dd").inner_text() == "none"
    assert number(ticks.locator("dt:text('deepest overlap') + dd").inner_text()) > 0
    assert shown.js("carom.timeline.newest?.missed") == 0
    page.keyboard.press("Escape")
    page.locator("#comparison .side").last.wait_for(state="hidden")
    assert shown.js("carom.viewports.length") == 1


def test_both_sides_are_drawn_at_the_same_moment(show):
    """Where nothing collides, ticks are as good: the halves are the same picture."""
    flight = carom.Scene(
        carom.Spheres.of(
            [(-2, 0, 0), (2, 1, 1)], [(1, 0, 0.5), (-1, 0, 0)], 0.5, color=[RED, GREEN]
        ),
        pace=0.5,
        color="own",
    )
    shown = show(carom.Simulation(flight))
    shown.page.keyboard.press("x")
    shown.wait("carom.twin.newest?.t > 0.5")
    shown.settle()
    assert shown.js("carom.camera.size.width === carom.viewports[1].width")
    first, second = halves(shown)
    assert first.max() > 120  # balls are there
    assert np.abs(first - second).mean() < 0.5


def test_the_sides_part_when_ticks_miss_a_collision(show):
    shown = show(dense())
    shown.page.keyboard.press("x")
    shown.wait("carom.twin.newest?.missed > 5", 20)
    shown.settle()
    first, second = halves(shown)
    assert np.abs(first - second).mean() > 3.0


def halves(shown):
    """Pixels of both viewports, without what lies over them."""
    picture = pixels(shown.page.screenshot()).astype(float)
    parts = []
    for view in shown.js("carom.viewports"):
        rows = slice(170, 630)
        parts.append(picture[rows, view["x"] + 4 : view["x"] + view["width"] - 4])
    return parts


def test_on_a_phone_the_halves_stand_above_one_another(show):
    shown = show(dense(), 390, 844, has_touch=True)
    shown.page.get_by_role("button", name="Numbers and settings").tap()
    shown.page.get_by_role("button", name="Exact against ticks").tap()
    shown.wait("carom.viewports.length === 2")
    shown.page.get_by_role("button", name="Numbers and settings").tap()
    shown.wait("!!carom.twin.newest")
    first, second = shown.js("carom.viewports")
    assert first["x"] == second["x"] == 0
    assert first["y"] + first["height"] == second["y"]
    assert second["y"] + second["height"] <= shown.page.locator("#bar").bounding_box()["y"]
    for side in shown.page.locator("#comparison .side").all():
        box = side.bounding_box()
        assert box["x"] + box["width"] <= 390
