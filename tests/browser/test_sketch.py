"""A sketch's page in a real browser: pixels where Processing's camera puts them, and controls."""

import math
import threading
import time
from contextlib import ExitStack

import numpy as np
import pytest

from carom.sketch.program import Program
from carom.sketch.serving import SketchView

from .png import pixels

WIDTH, HEIGHT = 800, 600
HEAD = f"""
from carom.sketch import *
def setup():
    size({WIDTH}, {HEIGHT})
def draw():
    background(240)
"""


def sketch(*lines):
    return HEAD + "".join(f"    {line}\n" for line in lines)


class Shown:
    """A page that shows a sketch, which runs in a thread of this process."""

    def __init__(self, program, page):
        self.program, self.page = program, page

    def js(self, expression):
        return self.page.evaluate(expression)

    def wait(self, expression, seconds=10.0):
        end = time.perf_counter() + seconds
        while not (value := self.js(expression)):
            assert time.perf_counter() < end, f"never true: {expression}"
            time.sleep(0.02)
        return value

    def button(self, name):
        return self.page.get_by_role("button", name=name, exact=True)

    def picture(self):
        """The canvas, (height, width, 3), once it shows the newest frame."""
        self.wait("carom.drawn !== null && carom.drawn.frame > 0")
        time.sleep(0.1)
        return pixels(self.page.locator("#sheet").screenshot()).astype(float)


def place(picture, x, y, z=0.0):
    """Column and row of a point: by similar triangles from Processing's eye, not by matrices."""
    away = HEIGHT / 2 / math.tan(math.radians(30))
    scale = away / (away - z)
    per_pixel = picture.shape[0] / HEIGHT
    return (
        (WIDTH / 2 + (x - WIDTH / 2) * scale) * per_pixel,
        (HEIGHT / 2 + (y - HEIGHT / 2) * scale) * per_pixel,
        scale * per_pixel,
    )


def at(picture, column, row, half=1):
    part = picture[
        round(row) - half : round(row) + half + 1, round(column) - half : round(column) + half + 1
    ]
    return part.reshape(-1, 3).mean(axis=0)


def is_back(color):
    return np.abs(color - 240).max() < 6


@pytest.fixture
def show(chromium, tmp_path):
    complaints, calls = [], []
    with ExitStack() as stack:

        def open_page(text, width=660, height=620, wait=True):
            path = tmp_path / "my_ball.py"
            path.write_text(text, encoding="utf-8")
            program = Program(path)
            program.load()
            view = stack.enter_context(SketchView(program))
            thread = threading.Thread(target=view.run)
            thread.start()
            stack.callback(thread.join, 10)
            stack.callback(view.stop)
            context = chromium.new_context(
                viewport={"width": width, "height": height}, color_scheme="dark"
            )
            stack.callback(context.close)
            page = context.new_page()
            page.on("console", lambda message: complaints.append(message.text))
            page.on("pageerror", lambda error: complaints.append(str(error)))
            context.on("request", lambda request: calls.append(request.url))
            page.goto(view.url)
            shown = Shown(program, page)
            if wait:
                shown.wait("globalThis.carom?.sheet?.frame > 0")
            return shown

        yield open_page
    assert complaints == []
    assert calls
    assert all(url.split("/")[2].startswith("127.0.0.1:") for url in calls), calls


@pytest.mark.parametrize(("x", "y", "z"), [(400, 300, 0), (200, 150, -200), (500, 450, 120)])
def test_a_filled_sphere_is_where_processings_camera_sees_it(show, x, y, z):
    shown = show(
        sketch("no_stroke()", "fill(220, 20, 20)", f"translate({x}, {y}, {z})", "sphere(60)")
    )
    picture = shown.picture()
    column, row, scale = place(picture, x, y, z)
    red, green, blue = at(picture, column, row)
    assert red > 130
    assert max(green, blue) < red / 3
    for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        # A sphere off the axis is seen a little drawn out, so the tests keep a distance.
        inside = at(picture, column + 0.85 * 60 * scale * dx, row + 0.85 * 60 * scale * dy)
        beyond = at(picture, column + 1.3 * 60 * scale * dx, row + 1.3 * 60 * scale * dy)
        assert inside[0] > 2 * inside[1]
        assert is_back(beyond)


def test_wire_lines_are_seen_through_crisp_and_in_their_colour(show):
    shown = show(sketch("no_fill()", "stroke(0, 120, 60)", "translate(400, 300)", "sphere(150)"))
    picture = shown.picture()
    column, row, scale = place(picture, 400, 300)
    # The equator passes the middle, and a meridian: 24 of them, one in front.
    for dx in (-60, -20, 33, 77):
        line = picture[round(row) - 2 : round(row) + 3, round(column + dx * scale)]
        assert line[:, 0].min() < 70
        assert line[line[:, 0].argmin(), 1] > 90
    # Between the lines the background shows through, darker towards the rim.
    angle = math.radians(7.5)
    between = at(
        picture, column + 150 * scale * math.sin(angle), row + 150 * scale * math.sin(angle)
    )
    assert between.min() > 180
    inside = picture[
        round(row - 100 * scale) : round(row + 100 * scale),
        round(column - 100 * scale) : round(column + 100 * scale),
        0,
    ]
    assert 0.05 < np.mean(inside < 150) < 0.4  # lines, not a surface
    assert is_back(at(picture, column + 1.05 * 150 * scale, row - 1.05 * 150 * scale))


def test_boxes_lines_widths_and_points(show):
    shown = show(
        sketch(
            "stroke(0)", "stroke_weight(8)", "line(100, 100, 300, 100)", "point(100, 500)",
            "stroke_weight(2)", "fill(250, 200, 40)", "translate(500, 300)", "box(200)",
        )
    )  # fmt: skip
    picture = shown.picture()
    column, row, scale = place(picture, 200, 100)
    # What its darkness adds up to across a line is its width.
    across = picture[round(row) - 12 : round(row) + 13, round(column), 0]
    assert np.sum(1 - across / 240) == pytest.approx(8 * scale, abs=0.6)
    column, row, _ = place(picture, 100, 500)
    dot = picture[round(row) - 12 : round(row) + 13, round(column) - 12 : round(column) + 13, 0]
    assert np.sum(1 - dot / 240) == pytest.approx(math.pi * (4 * scale) ** 2, rel=0.12)
    column, row, _ = place(picture, 500, 300, 100)
    middle = at(picture, column, row)
    assert middle[0] > 180
    assert middle[2] < 80
    for dx, dy in ((100, 0), (-100, 0), (0, 100), (0, -100)):
        column, row, _ = place(picture, 500 + dx, 300 + dy, 100)
        near = picture[round(row) - 2 : round(row) + 3, round(column) - 2 : round(column) + 3, 0]
        assert near.min() < 60  # its edge


def test_nearer_things_hide_farther_ones_whatever_the_order(show):
    shown = show(
        sketch(
            "no_stroke()", "translate(400, 300, 60)", "fill(0, 0, 255)", "sphere(30)",
            "translate(0, 0, -200)", "fill(255, 0, 0)", "sphere(100)",
            "translate(-200, 0, 0)", "fill(0, 255, 0, 128)", "sphere(60)",
        )
    )  # fmt: skip
    picture = shown.picture()
    column, row, _ = place(picture, 400, 300)
    assert at(picture, column, row)[2] > 2 * at(picture, column, row)[0]
    column, row, _ = place(picture, 200, 300, -140)
    through = at(picture, column, row)
    assert through[1] > 180  # half green over the light sheet
    assert 80 < through[0] < 160


def test_ellipsoids_mirrors_and_the_inside_of_a_sphere(show):
    shown = show(
        sketch(
            "no_stroke()", "fill(220, 20, 20)", "push_matrix()", "translate(200, 300)",
            "rotate_z(HALF_PI)", "scale(-2, 0.5, 1)", "sphere(50)", "pop_matrix()",
            "no_fill()", "stroke(0, 0, 200)", "translate(400, 300, 300)", "sphere(700)",
        )
    )  # fmt: skip
    picture = shown.picture()
    column, row, scale = place(picture, 200, 300)
    for dx, dy, inside in (
        (0, 85, True),
        (0, -85, True),
        (20, 0, True),
        (40, 0, False),
        (0, 115, False),
    ):
        color = at(picture, column + dx * scale, row + dy * scale)
        assert (color[0] > 2 * color[1] + 40) == inside
    # The eye is inside of the large sphere: its far half is seen.
    blue = (picture[..., 2] - picture[..., 0] > 40).mean()
    assert 0.005 < blue < 0.2


def test_pause_single_frame_play_and_keys(show):
    shown = show(sketch("sphere(10)"))
    shown.button("Pause").click()
    shown.wait("carom.sheet.playing === false")
    at_frame = shown.program.recorder.frame
    shown.button("Single frame").click()
    shown.wait(f"carom.sheet.frame === {at_frame + 1}")
    shown.page.keyboard.press("n")
    shown.wait(f"carom.sheet.frame === {at_frame + 2}")
    assert shown.page.locator("#frame").inner_text() == str(at_frame + 2)
    assert shown.program.recorder.frame == at_frame + 2
    shown.button("Play").click()
    shown.wait(f"carom.sheet.frame > {at_frame + 5}")
    shown.page.locator("#sheet").focus()
    shown.page.keyboard.press(" ")
    shown.wait("carom.sheet.playing === false")
    shown.page.keyboard.press(" ")
    shown.wait("carom.sheet.playing === true")


def test_restart_runs_setup_again(show):
    shown = show(HEAD.replace("size(", "print('set up'); size(") + "    sphere(frame_count())\n")
    shown.wait("carom.sheet.frame > 150")
    shown.button("Restart").click()
    shown.wait("carom.sheet.epoch === 1 && carom.sheet.frame > 0")
    assert shown.js("carom.sheet.frame") < 120  # a slow machine looks late
    assert shown.page.locator("#printed").inner_text().strip() == "set up"
    shown.page.keyboard.press("r")
    shown.wait("carom.sheet.epoch === 2")


def test_an_error_is_shown_and_goes_when_the_file_is_mended(show):
    shown = show(sketch("if frame_count() > 3: spher(10)"))
    shown.wait("!document.getElementById('failure').hidden")
    said = shown.page.locator("#failure").inner_text()
    assert said.startswith("my_ball.py, line 7: NameError: name 'spher' is not defined")
    assert said.endswith("did you mean 'sphere'?")
    assert shown.button("Play").is_disabled()
    shown.program.path.write_text(sketch("sphere(10)"), encoding="utf-8")
    shown.button("Restart").click()
    shown.wait("document.getElementById('failure').hidden && carom.sheet.playing")


def test_what_it_prints_is_read_on_the_page(show):
    shown = show(sketch("if frame_count() < 200: print('line', frame_count(), '<b>')"))
    shown.wait("document.getElementById('printed').textContent.includes('line 199 <b>\\n')")
    assert shown.page.locator("#console").is_visible()
    # The end is in sight.
    assert shown.js("(p => p.scrollHeight - p.scrollTop - p.clientHeight)(printed)") < 30


def test_the_mouse_turns_and_one_key_comes_back(show):
    shown = show(sketch("no_stroke()", "fill('red')", "translate(400, 300, -100)", "box(200)",
                        "translate(250, 0, 0)", "fill('blue')", "sphere(50)"))  # fmt: skip
    shown.button("Pause").click()
    before = shown.picture()
    assert shown.button("View from the front").is_disabled()
    box = shown.page.locator("#sheet").bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    shown.page.mouse.move(x, y)
    shown.page.mouse.down()
    shown.page.mouse.move(x + 200, y)
    shown.page.mouse.up()
    turned = shown.picture()
    column, row, _ = place(before, 400, 300, -100)
    assert at(turned, column, row)[0] > 100  # around the middle of the largest thing
    right = place(before, 650, 300, -100)[:2]
    assert at(before, *right)[2] > 100
    assert is_back(at(turned, *right))
    shown.page.keyboard.press("f")
    shown.wait("carom.camera.isFront")
    same = np.abs(shown.picture() - before)[4:-4, 4:-4]  # the border may have the focus
    assert same.max() == 0
    shown.page.locator("#sheet").focus()
    for key in ("ArrowLeft", "ArrowUp", "+"):
        shown.page.keyboard.press(key)
    assert shown.js(
        "carom.camera.azimuth < 0 && carom.camera.height !== 0 && carom.camera.zoom > 1"
    )


def test_the_picture_can_be_saved(show, tmp_path):
    shown = show(sketch("no_stroke()", "fill('red')", "translate(400, 300)", "sphere(100)"))
    shown.button("Pause").click()
    shown.wait("carom.sheet.playing === false")
    with shown.page.expect_download() as download:
        shown.button("Save the picture").click()
    file = tmp_path / "saved.png"
    download.value.save_as(file)
    assert download.value.suggested_filename == f"my_ball-{shown.js('carom.sheet.frame')}.png"
    assert at(pixels(file.read_bytes()), *place(shown.picture(), 400, 300)[:2])[0] > 150


def test_it_fits_a_phone_and_every_control_is_named(show):
    shown = show(sketch("print(frame_count())", "sphere(50)"), width=390, height=844)
    shown.wait("!document.getElementById('console').hidden")
    size = shown.js("[document.documentElement.scrollWidth, document.documentElement.scrollHeight]")
    assert size == [390, 844]
    sheet = shown.page.locator("#sheet").bounding_box()
    assert sheet["width"] / sheet["height"] == pytest.approx(WIDTH / HEIGHT, rel=0.01)
    assert sheet["width"] > 350
    for button in shown.page.locator("button").all():
        box = button.bounding_box()
        assert min(box["width"], box["height"]) >= 44
        assert 0 <= box["x"] <= 390 - box["width"]
        assert button.get_attribute("aria-label")


def test_a_reload_and_a_second_page_see_the_same_sketch(show):
    shown = show(sketch("print('hello')", "sphere(50)", "no_loop()"))
    shown.page.reload()
    shown.wait("globalThis.carom?.sheet?.frame === 1")
    shown.wait("document.getElementById('printed').textContent === 'hello\\n'")
    assert shown.page.title() == "my_ball.py · carom"
