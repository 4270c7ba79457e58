"""Pictures show what is there, where it is, in the colours of the page."""

import io
import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from tests.unit.seen import luminance

import carom
from carom.color import packed
from carom.errors import FileError, InputError, UnknownNameError
from carom.pictures import look
from carom.pictures.eye import lamp
from carom.pictures.eye import look as look_at
from carom.pictures.painter import FLOOR_ONLY_FROM, Painter, Style, _faces
from carom.pictures.png import png
from carom.pictures.room import Room

SIZE = (240, 136)
STATIC = Path(carom.__file__).parent / "view" / "static"


def scene(*positions, walls=(), **options):
    spheres = carom.Spheres.of(np.array(positions), radius=options.pop("radius", 0.5))
    return carom.Scene(spheres, tuple(walls) or (carom.Box(10, 10, 10),), color="own", **options)


def drawn(described, **options):
    options = {"size": SIZE, "caption": False, **options}
    return carom.Simulation(described).picture(**options).pixels


def eye_of(described, size=SIZE, camera=None):
    state, world = described.build()
    return look_at(Room.of(state, world), world.gravity, size, camera)


@pytest.mark.parametrize("place", [(0, 0, 0), (3, -2, 1), (-4, 4, -4)])
@pytest.mark.parametrize("quality", ["good", "draft"])
def test_a_sphere_is_seen_where_projection_by_hand_puts_it(place, quality):
    camera = carom.Camera((20, -30, 12), (1, 0, 0))
    # By hand: axes of a camera with z up, half the picture is tan 17° high at distance 1.
    line = np.array([1.0, 0, 0]) - (20, -30, 12)
    ahead = line / np.linalg.norm(line)
    right = np.cross(ahead, (0, 0, 1))
    right /= np.linalg.norm(right)
    up = np.cross(right, ahead)
    to = np.array(place) - np.array([20, -30, 12])
    scale = SIZE[1] / 2 / np.tan(np.radians(17)) / (to @ ahead)
    expected = SIZE[0] / 2 + to @ right * scale, SIZE[1] / 2 - to @ up * scale
    there = scene(place, walls=[carom.Open()])
    away = scene((0, 0, 900), walls=[carom.Open()])
    shown = drawn(there, camera=camera, quality=quality, theme="light")
    changed = np.abs(shown.astype(int) - drawn(away, camera=camera, theme="light")).max(axis=2) > 20
    y, x = np.nonzero(changed)
    assert (x.mean() + 0.5, y.mean() + 0.5) == pytest.approx(expected, abs=0.6)
    assert np.pi * (0.5 * scale - 1) ** 2 < len(x) < np.pi * (0.5 * scale + 1) ** 2


def test_what_is_nearer_hides_what_is_farther():
    camera = carom.Camera((0, -20, 0))
    for order in ([0, 1], [1, 0]):
        spheres = carom.Spheres.of(
            np.array([(0, -3, 0), (0, 3, 0)])[order],
            color=np.array([0xFF0000, 0x00FF00])[order],
        )
        shown = drawn(carom.Scene(spheres, color="own"), camera=camera)
        red, green, _ = shown[SIZE[1] // 2, SIZE[0] // 2].astype(int)
        assert red > green + 60


def test_shadows_darken_the_floor_and_other_spheres():
    falling = scene((0, 0, -4), (0, 0, 0), gravity=(0, 0, -1), radius=1.0)
    lit, shaded = drawn(falling, shadows=False), drawn(falling)
    darker = luminance(lit) - luminance(shaded)
    assert darker.min() > -2
    x, y = (round(part) for part in eye_of(falling).project(np.array([0.0, 0.0, -5.0])))
    assert darker[y - 3 : y + 4, x - 20 : x + 21].max() > 10
    # A sphere on the way from another to the lamp.
    lit_place = np.array([0, 0, -4.0])
    state, world = falling.build()
    towards = lamp(eye_of(falling), Room.of(state, world))
    pair = scene(lit_place, lit_place + 3 * towards, gravity=(0, 0, -1), radius=1.0)
    x, y = (round(part) for part in eye_of(pair).project(lit_place + towards))
    lit, shaded = (
        luminance(drawn(pair, shadows=on))[y - 1 : y + 2, x - 1 : x + 2] for on in (0, 1)
    )
    assert shaded.mean() < 0.8 * lit.mean()


def test_a_periodic_sphere_is_seen_on_both_sides():
    box = [carom.Periodic(10, 10, 10)]
    camera = carom.Camera((0, -40, 0))
    elsewhere = drawn(scene((0, 0, 3), walls=box), camera=camera)[SIZE[1] // 2].astype(int)

    def parts(x):
        row = drawn(scene((x, 0, 0), walls=box), camera=camera)[SIZE[1] // 2].astype(int)
        columns = np.flatnonzero(np.abs(row - elsewhere).max(axis=1) > 60)
        return np.count_nonzero(np.diff(columns) > SIZE[0] // 8) + 1

    assert (parts(4.0), parts(4.9)) == (1, 2)


def test_the_wires_of_the_paper_are_seen_through():
    wired = scene((0, 0, 0), radius=3.0, wire=True)
    solid = scene((0, 0, 0), radius=3.0)
    middle = np.s_[58:78, 110:130]
    back = luminance(look.parts(look.THEMES["dark"].back) * 255)
    assert np.percentile(luminance(drawn(wired))[middle], 20) < 2 * back
    assert luminance(drawn(solid))[middle].min() > 2 * back


@pytest.mark.parametrize(
    ("walls", "positions"),
    [
        (carom.Sphere(6), [(0, 0, 0)]),
        (carom.Cylinder(4, 10), [(0, 0, 0)]),
        (carom.Periodic(10, 10, 10), [(0, 0, 0)]),
        (carom.Box(10, 10, 10), [(0, 0, 0)]),
        (carom.Plane((0, 0, 1), -3), [(0, 0, 0)]),
    ],
)
@pytest.mark.parametrize("theme", ["dark", "light"])
def test_walls_are_drawn(walls, positions, theme):
    bare, closed = (scene(*positions, walls=[w]) for w in (carom.Open(), walls))
    camera = carom.Camera((20, -30, 12))
    with_, without = (drawn(s, camera=camera, theme=theme).astype(int) for s in (closed, bare))
    changed = np.abs(with_ - without).max(axis=2) > 4
    assert 0.004 < changed.mean() < 0.9
    assert tuple(without[1, 1]) == tuple(look.parts(look.THEMES[theme].back) * 255)


@pytest.mark.parametrize("name", carom.scenes.names())
def test_everything_is_in_sight(name):
    described = carom.scenes.build(name)
    state, world = described.build()
    room = Room.of(state, world)
    for size in ((320, 180), (180, 320)):
        eye = look_at(room, world.gravity, size, None)
        for point in room.points:
            x, y = eye.project(point)
            assert 0 < x < size[0]
            assert 0 < y < size[1]


def test_straight_from_above_left_and_right_keep_their_meaning():
    eye = eye_of(scene((0, 0, 0)), camera=carom.Camera((0, 0, 30)))
    assert np.degrees(np.arccos(-eye.forward @ eye.above)) == pytest.approx(1.76, abs=0.01)
    assert eye.right == pytest.approx([1, 0, 0])
    assert eye.up == pytest.approx([0, 1, 0], abs=0.04)


@pytest.mark.parametrize("x", [0.0, -0.0, 1e-17, -1e-17])
@pytest.mark.parametrize("z", [30, -30])
def test_straight_from_above_or_below_nothing_is_turned_round(x, z):
    for y in (0.0, -0.0, 1e-17, -1e-17):
        eye = eye_of(scene((0, 0, 0)), camera=carom.Camera((x, y, z)))
        assert eye.right == pytest.approx([1, 0, 0])


def test_a_camera_may_stand_very_close_to_its_target():
    camera = carom.Camera((1e-200, 0, 0))
    assert eye_of(scene((0, 0, 0)), camera=camera).forward == pytest.approx([-1, 0, 0])
    assert drawn(scene((0, 0, 0)), camera=camera).shape == (SIZE[1], SIZE[0], 3)


def test_gravity_that_is_nearly_along_an_axis_is_along_it():
    assert eye_of(scene((0, 0, 0), gravity=(1e-12, 0, -2))).above.tolist() == [0, 0, 1]
    assert eye_of(scene((0, 0, 0), gravity=(0.1, 0, -2))).above[0] < -0.04


def test_of_two_spherical_walls_the_inner_one_is_in_sight():
    state, world = scene((0, 0, 0), walls=[carom.Sphere(5), carom.Sphere(3)]).build()
    assert Room.of(state, world).margin == 3


def test_lines_of_large_pictures_are_wider():
    described = scene((0, 0, 0), radius=0.1)
    small, large = (drawn(described, size=(640 * k, 720 * k)) for k in (1, 2))
    shown = [luminance(p)[: 200 * k].std() for k, p in ((1, small), (2, large))]
    assert shown[1] == pytest.approx(shown[0], rel=0.08)


def test_only_small_crowds_have_spots_on_side_walls():
    state, world = scene((0, 0, 0)).build()
    room, style = Room.of(state, world), Style(SIZE)
    eye = look_at(room, world.gravity, SIZE, None)
    for n, spots in ((FLOOR_ONLY_FROM, 3), (FLOOR_ONLY_FROM + 1, 1)):
        assert np.count_nonzero(_faces(room, eye, style, 0.1, n)[:, -1]) == spots


# Colours: the same as the page's.


def numbers(name, text):
    return [int(n, 16) for n in re.findall(r"0x([0-9a-f]{6})", text.split(f"{name} = ")[1][:120])]


def test_scales_and_themes_are_those_of_the_page():
    text = (STATIC / "colors.js").read_text()
    assert numbers("SPEED_SCALE", text)[:5] == list(look.SPEEDS)
    assert numbers("COLLISION_SCALE", text)[:5] == list(look.COLLISIONS)
    themes = text.split("export const THEMES")[1]
    for name in ("dark", "light"):
        part = themes.split(f"  {name}: {{")[1].split("  },")[0]
        palette = look.THEMES[name]
        for key in ("back", "line", "shell", "surface"):
            assert f"{key}: unpack(0x{getattr(palette, key):06x})" in part
        for key in ("floor", "wall", "shade", "contact", "fog"):
            assert f"{key}: {getattr(palette, key)}," in part
        for key in ("key", "sky", "ground"):
            assert f"{key}: /** @type {{Rgb}} */ ({list(getattr(palette, key))})" in part
        assert f"tint: /** @type {{Rgb}} */ ({[palette.tint] * 3})" in part


def test_the_eye_stands_where_the_page_stands():
    camera, stand = ((STATIC / name).read_text() for name in ("camera.js", "standpoint.js"))
    assert "Math.tan((17 * Math.PI) / 180)" in camera
    assert "[AZIMUTH, HEIGHT] = [-0.42, 0.3]" in stand
    eye = eye_of(carom.scenes.gas(), (1280, 720))
    # What camera.eye says in the page, in a window of that size without panels.
    assert eye.place == pytest.approx([-19.6659, -44.0374, 14.919], abs=1e-3)


@pytest.mark.parametrize("color", look.COLORS)
def test_spheres_have_the_colors_of_the_page(color):
    state = carom.State.empty(3)
    state.color[:] = [packed("red"), packed("#4c9be8"), packed("gray")]
    state.velocity[:, 0] = [0, 1, 10]
    state.collision_count[:] = [0, 5, 90]
    state.species[:] = [0, 1, 8]
    shown = [f"{c:06x}" for c in look.colors_of(state, color, 10.0).tolist()]
    expected = {
        "own": ["ff0000", "4c9be8", "808080"],
        "speed": ["4059d6", "456fdc", "ffe65a"],
        "collisions": ["5b2a86", "db4f5f", "fde7a0"],
        "species": ["4c9be8", "e69f00", "e69f00"],
        # Grey has no hue of its own: the page takes red.
        "energy": ["ffffff", "dce2e8", "800000"],
    }
    assert shown == expected[color]


def test_a_sphere_in_the_light_has_its_own_color():
    shown = drawn(scene((0, 0, 0), radius=4.0, walls=[carom.Open()]), theme="light")
    blue = shown[SIZE[1] // 2, SIZE[0] // 2] / look.parts(0x4C9BE8)
    assert blue.max() / blue.min() < 1.25  # the same hue, whatever the light


def test_fixed_spheres_have_no_energy():
    state = carom.State.empty(2)
    state.velocity[:, 0] = 3.0
    state.fixed[:] = [True, False]
    state.color[:] = 0x4C9BE8
    still, moving = look.colors_of(state, "energy", 10.0).tolist()
    assert (still, moving != still) == (0xE8E8E8, True)


@pytest.mark.parametrize(("most", "end"), [(0, 5), (5, 5), (6, 10), (11, 20), (1234, 2000)])
def test_the_scale_of_collisions_ends_at_a_round_number(most, end):
    assert look.full_count(np.array([0, most], np.uint32)) == end


# Files, notebooks, mistakes.


def test_png_files_hold_the_pixels(tmp_path):
    pixels = np.random.default_rng(1).integers(0, 256, (7, 11, 3), dtype=np.uint8)
    assert np.array_equal(np.asarray(Image.open(io.BytesIO(png(pixels)))), pixels)
    picture = carom.Simulation(carom.scenes.gas(n=20)).picture(size=SIZE)
    picture.save(tmp_path / "a.png")
    assert np.array_equal(np.asarray(Image.open(tmp_path / "a.png")), picture.pixels)
    with pytest.raises(InputError, match=r"a picture is a .png file, not .*a.jpg"):
        picture.save(tmp_path / "a.jpg")
    with pytest.raises(FileError, match=r"cannot write .*No such file"):
        picture.save(tmp_path / "none" / "a.png")
    (tmp_path / "b.png").mkdir()
    with pytest.raises(FileError, match=r"cannot write .*b.png: Is a directory"):
        picture.save(tmp_path / "b.png")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.png", "b.png"]


def test_notebooks_show_pictures():
    described = carom.scenes.gas(n=20)
    for shown in (described, carom.Simulation(described), carom.Simulation(described).picture()):
        assert shown._repr_png_()[:8] == b"\x89PNG\r\n\x1a\n"
    assert "data:image/png;base64," in described._repr_html_()
    assert "data:image/png;base64," in carom.Simulation(described)._repr_html_()
    assert carom.Simulation()._repr_png_() is None
    overlapping = carom.Scene(carom.Spheres.of([(0, 0, 0), (0.1, 0, 0)]))
    assert overlapping._repr_png_() is None
    assert "<img" not in overlapping._repr_html_()


@pytest.mark.parametrize("n", [200, FLOOR_ONLY_FROM + 1])
def test_the_same_picture_twice(n):
    # With and without spots under spheres: a picture must not remember the one before.
    state, world = carom.scenes.gas(n=n).build()
    painter = Painter(state, world, Style(SIZE, color="speed"))
    again = Painter(state, world, Style(SIZE, color="speed"))
    first = painter.paint(state)
    assert np.array_equal(first, painter.paint(state))
    assert np.array_equal(first, again.paint(state))


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"size": (8, 100)}, InputError, "width is 8; it must be at least 16 and at most 8192"),
        ({"size": (100, 9000)}, InputError, "height is 9000"),
        ({"size": (100.5, 100)}, InputError, "width is 100.5; give whole pixels"),
        ({"size": 640}, InputError, r"size must be \(width, height\) in pixels, not 640"),
        ({"size": ("a", 3)}, InputError, "width must be a number"),
        ({"color": "sped"}, UnknownNameError, "no coloring 'sped'; did you mean 'speed'"),
        ({"theme": "drak"}, UnknownNameError, "no theme 'drak'; did you mean 'dark'"),
        ({"quality": "best"}, UnknownNameError, "no quality 'best'; there are draft, good"),
        ({"camera": (1, 2, 3)}, InputError, r"camera must be a Camera, not \(1, 2, 3\)"),
    ],
)
def test_mistakes_get_a_sentence(options, error, message):
    with pytest.raises(error, match=message):
        carom.Simulation(carom.scenes.gas(n=20)).picture(**options)


def test_nothing_to_show():
    with pytest.raises(InputError, match="no spheres to show"):
        carom.Simulation().picture()


def test_without_pillow_words_are_refused_and_pictures_are_not(monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "PIL", None)
    sim = carom.Simulation(carom.scenes.gas(n=20))
    with pytest.raises(InputError, match=r"need Pillow: pip install .carom\[video\]"):
        sim.picture(size=SIZE)
    assert sim.picture(size=SIZE, caption=False).pixels.shape == (136, 240, 3)
