"""Pictures of the renderer, pixel by pixel: shadows, arrows, marks, trails, sides, levels."""

import base64
import math
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import carom
from carom.view import LiveView

from .conftest import Shown
from .png import pixels

RED, GREEN, BLUE = 0xE03020, 0x20C040, 0x3060F0
FLOOR = [{"kind": 0, "normal": [0, 0, 1], "offset": -2, "name": "floor"}]
BOX = [
    {"kind": 0, "normal": [s if k == axis else 0 for k in range(3)], "offset": -4, "name": "wall"}
    for axis in range(3)
    for s in (1, -1)
]


@pytest.fixture(scope="module")
def page(chromium):
    """One page for all pictures; each has a renderer and a canvas of its own."""
    complaints = []
    sim = carom.Simulation(walls=carom.Box(4, 4, 4))
    sim.add((0, 0, 0))
    with LiveView(sim) as view:
        made = chromium.new_page()
        made.on("console", lambda message: complaints.append(message.text))
        made.on("pageerror", lambda error: complaints.append(str(error)))
        made.goto(view.url)
        Shown(sim, view, made).wait("!!globalThis.carom")
        yield made
        made.close()
    assert complaints == []


@pytest.fixture
def draw(page):
    """Draw spheres; the picture as (360, 480, 3) floats for ratio 1, and where things are in it."""
    script = Path(__file__).with_name("draw_picture.js").read_text()

    def one(x, radius=1.0, color=RED, second=None, **spec):
        x = np.atleast_2d(np.array(x, float))
        count = len(x)
        frames = [x, x if second is None else np.atleast_2d(np.array(second, float))]
        given = {
            "x": [f.ravel().tolist() for f in frames],
            "radius": np.broadcast_to(radius, count).tolist(),
            "color": np.broadcast_to(color, count).tolist(),
            **spec,
        }
        got = page.evaluate(f"({script})", given)
        assert got["error"] == 0
        picture = pixels(base64.b64decode(got["png"].split(",")[1])).astype(float)
        return SimpleNamespace(picture=picture, blob=got["blob"], view=got)

    return one


def where(drawn, point):
    """Pixel of a place, and pixels per unit of length there, by angles from the line of sight."""
    view = drawn.view
    eye, point = np.array(view["eye"], float), np.array(point, float)
    ahead = np.array(view["target"]) - eye
    ahead /= np.linalg.norm(ahead)
    right = np.cross(ahead, (0, 0, 1))
    right /= np.linalg.norm(right)
    up, line = np.cross(right, ahead), point - eye
    per = view["ratio"] * view["height"] / 2 / math.tan(math.radians(17)) / (line @ ahead)
    middle = np.array([view["width"], view["height"]]) * view["ratio"] / 2
    return middle[0] + per * (line @ right), middle[1] - per * (line @ up), per


def at(drawn, point, half=2):
    """Mean colour around a place."""
    x, y, _ = where(drawn, point)
    x, y = round(x), round(y)
    return drawn.picture[y - half : y + half + 1, x - half : x + half + 1].mean(axis=(0, 1))


def light(color):
    return float(np.asarray(color) @ (0.2126, 0.7152, 0.0722))


def changed(a, b, least=12):
    """Which pixels differ."""
    return np.abs(a.picture - b.picture).max(axis=2) > least


@pytest.mark.parametrize("level", [0, 1, 2, 3])
def test_every_level_draws_the_spheres_in_the_same_places(draw, level):
    places, radii = [(-2, 0, 1), (1.5, 1, -1)], [1.0, 0.5]
    drawn = draw(places, radii, [RED, GREEN], level=level)
    ratio = drawn.view["ratio"]
    for place, radius, channel in zip(places, radii, (0, 1), strict=True):
        others = np.delete(drawn.picture, channel, axis=2).max(axis=2)
        ys, xs = np.nonzero(drawn.picture[:, :, channel] > 1.5 * others + 10)
        x, y, per = where(drawn, place)
        assert np.mean(xs) == pytest.approx(x, abs=1.5)
        assert np.mean(ys) == pytest.approx(y, abs=1.5)
        assert math.sqrt(len(xs) / math.pi) == pytest.approx(per * radius, abs=1.2 * ratio)


@pytest.mark.parametrize("level", [0, 3])
@pytest.mark.parametrize("theme", ["dark", "light"])
def test_a_sphere_on_the_floor_darkens_it(draw, level, theme):
    look = [[0, -16, 5], [0, 0, -1]]
    spec = {"about": {"walls": FLOOR, "gravity": [0, 0, -1]}, "look": look, "theme": theme}
    drawn = draw([(0, 0, -1)], level=level, **spec)
    away = draw([(0, 0, 3)], level=0, **spec)  # too high for a spot on the floor
    for place, least, most in (((0, -0.9, -2), 0, 0.9), ((3.4, -0.9, -2), 0.97, 1.03)):
        ratio = light(at(drawn, place)) / light(at(away, place))
        assert least < ratio < most, place


def test_spheres_cast_shadows_on_one_another(draw):
    """The lamp stands above the left shoulder: a ball there dims the other, if there is a map."""
    spec = {"about": {"walls": BOX}, "look": [[0, -20, 9], [0, 0, 0]]}
    pair, top = [(0, 0, -1.5), (-1.4, -1.1, 2.1)], (0, -0.35, -0.65)
    alone = light(at(draw([pair[0]], level=3, **spec), top))
    assert light(at(draw(pair, level=3, **spec), top)) < 0.8 * alone
    assert light(at(draw(pair, level=0, **spec), top)) > 0.9 * alone


def test_velocity_arrows_point_along_the_velocity(draw):
    spec = {"v": [0, 0, 1, 0, 0, 0], "look": [[0, -20, 0], [0, 0, 0]]}
    places = [(-2, 0, 0), (2, 0, 0)]  # the second is at rest
    without, with_ = draw(places, 0.5, **spec), draw(places, 0.5, swarm=1.25, **spec)
    ys, xs = np.nonzero(changed(without, with_))
    x, y, per = where(with_, places[0])
    assert np.abs(xs - x).max() < 0.5 * per  # none at the second
    assert (y - ys).min() > 0.4 * per  # all above the first one's centre
    assert (y - ys).max() == pytest.approx(per * (0.5 * 0.96 + 1.25), rel=0.1)


def test_a_mark_is_a_ring_outside_the_sphere(draw):
    mark = {"side": 0, "x": [0, 0, 0], "radius": 1, "color": [1, 0.9, 0.2], "strength": 1}
    plain, marked = draw([(0, 0, 0)]), draw([(0, 0, 0)], marks=[mark])
    ys, xs = np.nonzero(changed(plain, marked, least=40))
    x, y, per = where(marked, (0, 0, 0))
    away = np.hypot(xs - x, ys - y) / per
    assert len(xs) > 2 * math.pi * per
    assert away.min() > 0.97
    angles = np.histogram(np.arctan2(ys - y, xs - x), bins=12, range=(-math.pi, math.pi))[0]
    assert angles.min() > 0  # all the way round
    assert not changed(plain, draw([(0, 0, 0)], marks=[{**mark, "strength": 0}])).any()
    assert not changed(plain, draw([(0, 0, 0)], marks=[{**mark, "side": 1}])).any()


def test_a_trail_fades_towards_the_past_and_has_gaps(draw):
    look = [[0, -20, 0], [0, 0, 0]]
    xs = [-3 + 0.5 * k for k in range(13)]
    points = [part for x in xs for part in ([None] * 3 if x == -0.5 else [x, 0, 2])]
    trail = {"side": 0, "points": points, "color": [1, 0.8, 0.1]}
    plain = draw([(0, 0, -2)], look=look)
    drawn = draw([(0, 0, -2)], look=look, trails=[trail])
    old, gap, new = (
        np.abs(at(drawn, p, 1) - at(plain, p, 1)).max()
        for p in ((-2.2, 0, 2), (-0.25, 0, 2), (2.8, 0, 2))
    )
    assert gap == 0
    assert 5 < old < 0.6 * new
    behind = {**trail, "points": [-3, 0, -2, 3, 0, -2]}  # through the sphere: hidden by it
    hidden = draw([(0, 0, -2)], look=look, trails=[behind])
    assert np.abs(at(hidden, (0, 0, -2)) - at(plain, (0, 0, -2))).max() < 2
    assert np.abs(at(hidden, (2.5, 0, -2), 1) - at(plain, (2.5, 0, -2), 1)).max() > 40


def test_a_ghost_is_seen_through(draw):
    ghost = {"side": 0, "x": [0, -2, 0], "radius": 1.5, "color": [0.2, 0.3, 0.95]}
    plain, drawn = draw([(0, 2, 0)], 1.0), draw([(0, 2, 0)], 1.0, ghost=ghost)
    assert changed(plain, drawn).sum() > 1000
    red, mixed = at(plain, (0, 2, 0)), at(drawn, (0, 2, 0))
    assert red[0] > 2 * red[2]
    assert mixed[2] > red[2] + 15  # bluer than without
    assert mixed[0] > 0.4 * red[0]  # and the red still shines through


def test_single_arrows_go_from_place_to_place(draw):
    ends = {"from": [-2, 0, 0], "to": [2, 0, 1]}
    arrow = {"side": 0, **ends, "color": [0.2, 1, 0.4], "strength": 1}
    look = [[0, -20, 0], [0, 0, 0]]
    plain = draw([(0, 0, -2.5)], look=look)
    ys, xs = np.nonzero(changed(plain, draw([(0, 0, -2.5)], look=look, arrows=[arrow])))
    drawn = draw([(0, 0, -2.5)], look=look, arrows=[arrow])
    (x0, y0, _), (x1, y1, _) = where(drawn, arrow["from"]), where(drawn, arrow["to"])
    assert (xs.min(), xs.max()) == pytest.approx((x0, x1), abs=3)
    assert ys[np.argmax(xs)] == pytest.approx(y1, abs=3)
    assert ys[xs < x0 + 2].mean() == pytest.approx(y0, abs=4)
    # Half as strong it is half seen through, as evenly where its parts lie behind one another.
    faint = draw([(0, 0, -2.5)], look=look, arrows=[{**arrow, "strength": 0.5}])
    full = drawn.picture.astype(float) - plain.picture
    part = faint.picture.astype(float) - plain.picture
    seen = np.abs(full).max(axis=2) > 60
    assert seen.sum() > 300
    assert part[seen] == pytest.approx(0.5 * full[seen], abs=8)
    none = draw([(0, 0, -2.5)], look=look, arrows=[{**arrow, "strength": 0}])
    assert not changed(plain, none).any()


def test_a_single_arrow_shines_through_what_hides_it(draw):
    look = [[0, -20, 0], [0, 0, 0]]
    ends = {"from": [-0.6, 3, 0], "to": [0.6, 3, 0]}  # behind the ball, for an eye at y = -20
    arrow = {"side": 0, **ends, "color": [0.2, 1, 0.4], "strength": 1}
    bare = draw([(0, 0, 0)], look=look)
    hidden = draw([(0, 0, 0)], look=look, arrows=[arrow])
    ys, xs = np.nonzero(changed(bare, hidden))
    assert len(xs) > 100
    greener = (hidden.picture - bare.picture)[ys, xs, 1]
    assert np.median(greener) > 10


def test_two_sides_show_two_moments(draw):
    look = [[0, -26, 0], [0, 0, 0]]
    drawn = draw([(-2, 0, 0)], second=[(2, 0, 0)], v=[4, 0, 0], t=[0, 1], look=look)
    half = drawn.picture.shape[1] // 2
    mark = {"side": 1, "x": [2, 0, 0], "radius": 1, "color": [1, 1, 1], "strength": 1}
    for side, x in ((0, -2), (1, 2)):
        picture = drawn.picture[:, side * half : (side + 1) * half]
        _, xs = np.nonzero(picture[:, :, 0] > 1.5 * picture[:, :, 2] + 10)
        assert np.mean(xs) == pytest.approx(where(drawn, (x, 0, 0))[0], abs=1.5)
    both = {"second": [(2, 0, 0)], "v": [4, 0, 0], "t": [0, 1], "look": look}
    differ = changed(drawn, draw([(-2, 0, 0)], marks=[mark], **both))
    assert not differ[:, :half].any()
    assert differ[:, half:].any()


def test_colours_count_collisions(draw):
    places = [(-2.5, 0, 0), (0, 0, 0), (2.5, 0, 0)]
    counts = [0, 5 + 2**31, 40]  # the second rests, which its colour does not show
    drawn = draw(places, counts=counts, full=10, about={"color": "collisions"})
    none, half, more = (at(drawn, place) for place in places)
    assert none[2] > none[1] > 0  # purple
    assert half[0] > 1.5 * half[2]  # red
    assert more[1] > 0.75 * more[0] > more[2]  # pale yellow, full at 10 and beyond
    assert light(none) < light(half) < light(more)


def test_fog_brings_far_spheres_closer_to_the_background(draw):
    look = [[0, -18, 0], [0, 0, 0]]
    for theme in ("dark", "light"):
        drawn = draw([(-1.5, -4, 0), (1.5, 4, 0)], theme=theme, look=look)
        back = drawn.picture[4, 4]
        near, far = (np.linalg.norm(at(drawn, (x, y, 0)) - back) for x, y in ((-1.5, -4), (1.5, 4)))
        assert far < 0.93 * near


def test_a_sphere_across_a_periodic_border_is_seen_on_both_sides(draw):
    about = {"period": [8, 8, 8]}
    look = [[0, -26, 0], [0, 0, 0]]
    for level in (0, 3):
        drawn = draw([(3.8, 0, 3.9)], level=level, about=about, look=look)
        for place in ((3.8, 0, 3.9), (-4.2, 0, 3.9), (3.8, 0, -4.1), (-4.2, 0, -4.1)):
            color = at(drawn, place)
            assert color[0] > 1.5 * color[2], (level, place)
    inside = draw([(2.5, 0, 2.5)], about=about, look=look)
    assert at(inside, (-5.5, 0, 2.5))[0] < 60


def test_wires_are_brighter_in_front_than_behind(draw):
    """A sphere seen along its poles' plane: its front lines cover more than the rest of it."""
    drawn = draw([(0, 0, 0)], 3.0, 0xFFFFFF, about={"wire": True}, look=[[0, -20, 0], [0, 0, 0]])
    x, y, per = where(drawn, (0, 0, 0))
    row = drawn.picture[round(y + 0.4 * per), round(x - 2 * per) : round(x + 2 * per)].max(axis=1)
    back = drawn.picture[4, 4].max()
    assert row.max() > 200
    assert np.median(row) < back + 70
    between = row[(row > back + 25) & (row < 150)]
    assert len(between) > 4  # the lines behind


def test_the_picture_as_a_file(draw):
    drawn = draw([(0, 0, 0)], level=0, blob=True)
    assert drawn.blob["type"] == "image/png"
    head = bytes(drawn.blob["bytes"])
    assert head[:8] == b"\x89PNG\r\n\x1a\n"
    size = int.from_bytes(head[16:20], "big"), int.from_bytes(head[20:24], "big")
    assert size == (960, 720)  # the best quality, whatever the screen shows
