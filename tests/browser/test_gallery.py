"""The gallery: every scene has a picture and can be loaded."""

import struct
from importlib import resources

import carom
from carom import scenes

from .test_page import still_life

PICTURES = resources.files("carom.view") / "static" / "gallery"


def test_every_scene_has_a_small_picture():
    names = {picture.name.removesuffix(".webp") for picture in PICTURES.iterdir()}
    assert names == set(scenes.names())
    for picture in PICTURES.iterdir():
        data = picture.read_bytes()
        assert data[8:15] == b"WEBPVP8"
        assert len(data) < 25_000
        if data[12:16] == b"VP8 ":  # lossy: its frame header holds the size
            assert struct.unpack_from("<HH", data, 26) == (320, 200)


def test_a_card_loads_its_scene(show):
    shown = show(still_life())
    page = shown.page
    page.keyboard.press("g")
    dialog = page.get_by_role("dialog", name="Choose a scene")
    dialog.wait_for(state="visible")
    shown.wait("document.querySelectorAll('#gallery .cards button').length > 0")
    assert dialog.locator(".cards button").count() == len(scenes.names())
    assert dialog.locator(".cards h3 + button").get_attribute("data-name") == "phase-0"
    # Those that were looked at have come; the others wait until they are scrolled to.
    loaded = "[...document.querySelectorAll('#gallery img')].filter((i) => i.naturalWidth === 320)"
    shown.wait(f"{loaded}.length >= 8")
    card = dialog.locator("button[data-name=newton-cradle]")
    title, line = scenes.describe("newton-cradle").split(": ")
    assert card.inner_text().split("\n")[0] == title
    assert line.lower() in card.inner_text().lower()
    card.focus()
    page.keyboard.press("Enter")
    shown.wait("carom.scene.about.origin?.name === 'newton-cradle'")
    assert dialog.is_hidden()
    assert shown.sim.scene.title == scenes.newton_cradle().title
    assert shown.text("title") == shown.sim.scene.title
    shown.wait("carom.timeline.newest?.t > 0")


def test_the_scene_that_runs_is_marked(show):
    shown = show(carom.Simulation(scenes.phase_2()))
    shown.page.locator("#title-button").click()
    shown.wait("document.querySelector('#gallery [aria-current]')?.dataset.name === 'phase-2'")
    shown.wait("document.activeElement.dataset.name === 'phase-2'")
    shown.page.keyboard.press("Escape")
    assert shown.page.locator("#gallery").is_hidden()


def test_a_scene_of_ones_own_has_an_icon(show):
    shown = show(still_life())
    shown.wait("carom.gallery.entries.length > 0")
    shown.js(
        """carom.gallery.setCatalogue(
             [{ name: "mine", title: "Mine", description: "", options: [] }]);
           carom.actions.gallery()"""
    )
    shown.wait("document.querySelector('#gallery img')?.naturalWidth > 0")
    assert shown.js("document.querySelector('#gallery img').src").endswith("/icon.svg")
