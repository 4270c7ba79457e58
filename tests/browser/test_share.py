"""Sharing: the picture, the link, the texts."""

import io
import tomllib
from contextlib import redirect_stdout

import numpy as np

import carom
from carom import scene_file, scenes

from .png import pixels
from .test_page import RED, hue, rgb, still_life, where


def dialog_of(shown):
    shown.page.keyboard.press("l")
    dialog = shown.page.get_by_role("dialog", name="Share")
    dialog.wait_for(state="visible")
    return dialog


def test_the_saved_picture_is_what_is_seen(show):
    shown = show(still_life())
    shown.settle()
    dialog = dialog_of(shown)
    with shown.page.expect_download() as download:
        dialog.get_by_role("button", name="Save picture").click()
    assert download.value.suggested_filename == "carom.png"
    picture = pixels(download.value.path().read_bytes())
    assert picture.shape == (1440, 2560, 3)  # twice as fine, without the panel and the bar
    x, y, _ = where(shown, (-3, 0, 0))
    right, bottom = shown.js("[carom.camera.insets.right, carom.camera.insets.bottom]")
    x, y = round(2 * x + right), round(2 * y + bottom)
    ball = picture[y - 3 : y + 3, x - 3 : x + 3].reshape(-1, 3)
    assert np.allclose(hue(ball.mean(axis=0)), hue(rgb(RED)), atol=0.25)
    shown.wait("carom.share.preview.width === 2560")


def test_the_link_opens_the_scene_in_another_tab(show):
    shown = show(carom.Simulation(scenes.gas(n=30, seed=5)))
    dialog = dialog_of(shown)
    link = dialog.get_by_role("textbox", name="Link").input_value()
    assert "scene=gas" in link
    assert "n=30" in link
    moment = shown.sim.time
    page = shown.page.context.new_page()
    page.goto(link)
    page.locator("#title").get_by_text("Gas in a box").wait_for()
    assert "#" not in page.url
    assert shown.sim.time >= moment  # it runs already: nothing was started anew
    page.close()
    page = shown.page.context.new_page()
    page.goto(link.replace("n=30", "n=12").replace("seed=5", "seed=9"))
    shown.wait("carom.scene.n === 12")
    assert shown.sim.scene.origin.options["seed"] == 9
    page.close()


def test_copying(show):
    shown = show(carom.Simulation(scenes.gas(n=30)))
    shown.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    dialog = dialog_of(shown)
    link = dialog.get_by_role("textbox", name="Link").input_value()
    dialog.get_by_role("button", name="Copy link").click()
    dialog.get_by_text("Copied").wait_for()
    assert shown.js("navigator.clipboard.readText()") == link
    # On a plain http address of the network browsers offer no clipboard.
    command = dialog.get_by_role("textbox", name="Command")
    shown.wait("document.querySelector('[aria-label=Command]').value !== ''")
    shown.js("Object.defineProperty(navigator, 'clipboard', { value: undefined })")
    dialog.get_by_role("button", name="Copy command").click()
    shown.wait("document.querySelectorAll('#share .copy')[1].textContent === 'Copied'")
    assert command.input_value().startswith("carom show gas")


def test_python_and_toml_make_the_same_scene(show):
    shown = show(carom.Simulation(scenes.gas(n=30, seed=5)))
    dialog = dialog_of(shown)
    dialog.get_by_text("Show as Python").click()
    dialog.get_by_text("Show as TOML").click()
    shown.wait("document.querySelector('[aria-label=python]').value !== ''")
    program = dialog.get_by_role("textbox", name="python").input_value()
    text = dialog.get_by_role("textbox", name="toml").input_value()
    assert tomllib.loads(text)
    scene = scene_file.parse(text)
    assert np.array_equal(scene.spheres.position, shown.sim.scene.spheres.position)
    names = {}
    with redirect_stdout(io.StringIO()):
        exec(program.replace(".show()", ""), names)
    made = next(value for value in names.values() if isinstance(value, carom.Simulation))
    assert np.array_equal(made.scene.spheres.position, shown.sim.scene.spheres.position)
