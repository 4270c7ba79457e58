"""Scenes: spheres as arrays, and every state that no engine can run refused by `build`."""

import math
from dataclasses import replace

import numpy as np
import pytest

from carom import fit
from carom.color import SPECIES, hsb, packed, packed_many
from carom.errors import InputError, OverlapError, UnknownNameError
from carom.scene import Camera, Scene, Spheres
from carom.walls import Box, Cylinder, Open, Periodic, Plane, Sphere

ONE = Spheres.of((0, 0, 0), velocity=(1, 0, 0))


def refusal(spheres: Spheres, **parts: object) -> str:
    """The sentence with which a scene is refused."""
    with pytest.raises(InputError) as error:
        Scene(spheres, **parts).build()
    assert "\n" not in str(error.value)
    return str(error.value)


# --- Spheres ---------------------------------------------------------------------------


def test_scalars_are_for_all() -> None:
    s = Spheres.of([(0, 0, 0), (2, 0, 0)], velocity=(0, 0, 1), radius=[0.5, 1], mass=3)
    assert s.velocity.tolist() == [[0, 0, 1], [0, 0, 1]]
    assert s.radius.tolist() == [0.5, 1]
    assert s.mass.tolist() == [3, 3]
    assert s.position.dtype == s.velocity.dtype == s.radius.dtype == np.float64
    assert s.color.dtype == s.species.dtype == np.uint32


def test_fixed_spheres_have_infinite_mass() -> None:
    s = Spheres.of([(0, 0, 0), (2, 0, 0)], mass=5, fixed=[False, True])
    assert s.mass.tolist() == [5, math.inf]


def test_spheres_join_and_compare() -> None:
    both = ONE + Spheres.of((3, 0, 0), radius=2)
    assert len(both) == 2
    assert both == Spheres.of([(0, 0, 0), (3, 0, 0)], [(1, 0, 0), (0, 0, 0)], radius=[0.5, 2])
    assert both != ONE
    assert ONE != "spheres"


def test_arrays_cannot_be_changed_and_share_nothing() -> None:
    x = np.zeros((1, 3))
    s = Spheres.of(x)
    x[0, 0] = 7
    assert s.position[0, 0] == 0
    with pytest.raises(ValueError, match="read-only"):
        s.position[0, 0] = 1
    state, _ = Scene(s).build()
    state.position[0, 0] = 1
    assert s.position[0, 0] == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"position": (1, 2)}, r"position has shape \(1, 2\)"),
        ({"position": [[(0, 0, 0)]]}, "position has shape"),
        ({"position": "origin"}, "position must be numbers, not 'origin'"),
        ({"position": [(0, 0, 0), (1, 1)]}, "rows of different length"),
        ({"position": (0, 0, 0), "radius": [1, 2]}, "radius has shape .* does not fit 1 spheres"),
        ({"position": (0, 0, 0), "velocity": (1, 2)}, "velocity has shape"),
        ({"position": (0, 0, 0), "mass": None}, "mass must be numbers"),
        ({"position": (0, 0, 0), "mass": True}, "mass must be numbers"),
        ({"position": (0, 0, 0), "species": 1.5}, "species must be whole numbers"),
        ({"position": (0, 0, 0), "species": -1}, "species"),
        ({"position": (0, 0, 0), "fixed": 1}, "fixed must be True or False"),
        ({"position": (0, 0, 0), "color": ["red", "blue"]}, "color has shape"),
        ({"position": (0, 0, 0), "color": 1.5}, "not a color"),
    ],
)
def test_what_does_not_fit_is_refused(arguments, message) -> None:
    with pytest.raises(InputError, match=message):
        Spheres.of(**arguments)


# --- colours ---------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("color", "number"),
    [("red", 0xFF0000), ("Teal", 0x008080), ("#4c9BE8", 0x4C9BE8), (0x123456, 0x123456), (0, 0)],
)
def test_colors_are_packed(color: str | int, number: int) -> None:
    assert packed(color) == number
    assert Spheres.of((0, 0, 0), color=color).color.tolist() == [number]


def test_many_colors() -> None:
    assert packed_many(["red", "#000001"], 2).tolist() == [0xFF0000, 1]
    assert packed_many(np.array([1, 2], np.int64), 2).tolist() == [1, 2]
    assert packed_many("red", 2).tolist() == [0xFF0000] * 2


@pytest.mark.parametrize("color", ["#12345", "#12345g", "#+12345", 2**24, -1, 1.5, True, None])
def test_bad_colors_are_refused(color) -> None:
    with pytest.raises(InputError, match="color"):
        packed(color)


def test_bad_color_arrays_are_refused() -> None:
    with pytest.raises(InputError, match="color 16777216 is outside"):
        packed_many(np.array([1, 2**24]), 2)


def test_a_misspelt_color_gets_a_suggestion() -> None:
    with pytest.raises(UnknownNameError, match="no color 'ornage'; did you mean 'orange'"):
        packed("ornage")


def test_default_colors_follow_the_species() -> None:
    colors = Spheres.of([(k, 0, 0) for k in range(9)], species=range(9)).color
    assert colors[:7].tolist() == SPECIES.tolist()
    assert colors[7] == colors[0]


@pytest.mark.parametrize(
    ("h", "s", "b", "rgb"),
    [
        (0, 100, 100, 0xFF0000),
        (60, 100, 100, 0xFFFF00),
        (120, 100, 100, 0x00FF00),
        (180, 100, 100, 0x00FFFF),
        (240, 100, 100, 0x0000FF),
        (300, 100, 100, 0xFF00FF),
        (360, 100, 100, 0xFF0000),
        (77, 0, 100, 0xFFFFFF),
        (77, 50, 0, 0),
        (210, 50, 80, 0x6699CC),
    ],
)
def test_hsb(h: float, s: float, b: float, rgb: int) -> None:
    assert int(hsb(h, s, b)) == rgb


# --- Scene -----------------------------------------------------------------------------


def test_a_scene_builds_a_state_and_a_world() -> None:
    scene = Scene(ONE, walls=Box(5, 5, 5), gravity=[0, 0, -1])
    assert scene.walls == (Box(5, 5, 5),)
    state, world = scene.build()
    assert len(state) == 1
    assert (state.time, state.collisions, state.collision_count.tolist()) == (0, 0, [0])
    assert len(world.walls) == 6
    assert world.gravity.tolist() == [0, 0, -1]


def test_scenes_are_frozen() -> None:
    with pytest.raises(AttributeError):
        Scene(ONE).pace = 2.0
    assert replace(Scene(ONE), pace=2).pace == 2


@pytest.mark.parametrize(
    ("parts", "message"),
    [
        ({"pace": 0}, "pace is 0"),
        ({"pace": math.nan}, "pace is nan"),
        ({"color": "sped"}, "no coloring 'sped'; did you mean 'speed'"),
        ({"gravity": (0, 0)}, "gravity"),
        ({"rule": 0.9}, "rule must be of type Smooth"),
        ({"seed": 1.5}, "seed must be of type int"),
        ({"collide": 1}, "collide must be of type bool"),
        ({"title": 3}, "title must be of type str"),
        ({"camera": (1, 2, 3)}, "camera must be of type Camera"),
        ({"walls": "box"}, "not a wall"),
        ({"spheres": [(0, 0, 0)]}, "spheres must be of type Spheres"),
    ],
)
def test_bad_parts_are_refused(parts, message) -> None:
    with pytest.raises(InputError, match=message):
        Scene(**{"spheres": ONE, **parts})


def test_cameras() -> None:
    assert Camera((1, 2, 3)).target == (0, 0, 0)
    with pytest.raises(InputError, match="its own target"):
        Camera((1, 1, 1), (1, 1, 1))
    with pytest.raises(InputError, match="camera position"):
        Camera((1, 1, math.inf))


def test_no_spheres() -> None:
    assert "no spheres" in refusal(Spheres.of(np.zeros((0, 3))))


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 1e80])
@pytest.mark.parametrize("name", ["position", "velocity", "radius", "mass"])
def test_numbers_must_be_finite(name: str, value: float) -> None:
    parts = {"position": np.zeros((2, 3)), "velocity": 0.0, "radius": 0.1, "mass": 1.0}
    parts["position"][1] = 2
    array = np.broadcast_to(parts[name], (2, 3) if name in ("position", "velocity") else 2).copy()
    array[1] = value
    assert f"sphere 1 has {name}" in refusal(Spheres.of(**{**parts, name: array}))


@pytest.mark.parametrize("value", [0, -1, 1e-80])
@pytest.mark.parametrize("name", ["radius", "mass"])
def test_radius_and_mass_are_positive(name: str, value: float) -> None:
    message = refusal(Spheres.of((0, 0, 0), **{name: value}))
    assert f"sphere 0 has {name} {value:g}; it must be" in message


def test_infinite_mass_only_through_fixed() -> None:
    assert "fixed=True" in refusal(Spheres.of((0, 0, 0), mass=math.inf))
    Scene(Spheres.of((0, 0, 0), fixed=True)).build()


def test_fixed_spheres_do_not_move() -> None:
    assert "fixed but has velocity (1, 0, 0)" in refusal(
        Spheres.of((0, 0, 0), velocity=(1, 0, 0), fixed=True)
    )


# --- places ----------------------------------------------------------------------------


def test_an_overlap_names_pair_and_depth() -> None:
    s = Spheres.of([(-5, 0, 0), (0, 0, 0), (0.75, 0, 0)])
    with pytest.raises(OverlapError, match=r"spheres 1 and 2 overlap by 0\.25; move one"):
        Scene(s).build()
    Scene(s, collide=False).build()


def test_overlap_across_a_periodic_border() -> None:
    s = Spheres.of([(-4.7, 0, 0), (4.8, 0, 0)])
    Scene(s).build()
    assert "spheres 0 and 1 overlap by 0.5" in refusal(s, walls=Periodic(10, None, None))


def test_fixed_spheres_may_overlap_each_other_but_no_other() -> None:
    x = [(0, 0, 0), (0.5, 0, 0)]
    Scene(Spheres.of(x, fixed=True)).build()
    assert "overlap" in refusal(Spheres.of(x, fixed=[True, False]))


@pytest.mark.parametrize("gap", [0, 1e-13, -1e-13])
def test_touching_is_welcome(gap: float) -> None:
    Scene(Spheres.of([(0, 0, 0), (1 + gap, 0, 0)])).build()
    Scene(Spheres.of((0, 0, -0.5 + gap)), walls=Plane((0, 0, 1), -1)).build()
    Scene(Spheres.of((1.5 + gap, 0, 0)), walls=Sphere(2)).build()


def test_an_overlap_beyond_rounding_is_none() -> None:
    assert "overlap" in refusal(Spheres.of([(0, 0, 0), (1 - 1e-11, 0, 0)]))
    assert "through" in refusal(Spheres.of((0, 0, 0.5 - 1e-11)), walls=Plane((0, 0, 1), 0))


@pytest.mark.parametrize(
    ("wall", "position", "name"),
    [
        (Box(4, 4, 4), (1.75, 0, 0), "the x+ wall of the Box"),
        (Box(4, 4, 4), (0, 0, -1.75), "the z- wall of the Box"),
        (Plane((0, 0, 1), 0), (0, 0, 0.25), "the Plane"),
        (Plane((0, 0, 1), 0), (0, 0, -0.25), "the Plane"),
        (Sphere(3), (0, 2.75, 0), "the Sphere"),
        (Cylinder(3, 10), (0, 2.75, 0), "the side of the Cylinder"),
        (Cylinder(3, 10), (0, 0, 4.75), "the top of the Cylinder"),
    ],
)
def test_a_sphere_outside_its_wall(wall, position, name) -> None:
    depth = 0.75 if position[2] == -0.25 else 0.25
    inside = Spheres.of((0, 0, 1))
    message = refusal(inside + Spheres.of(position, velocity=(0.1, 0.2, 0.3)), walls=wall)
    assert f"sphere 1 reaches {depth:g} through {name}" in message
    Scene(Spheres.of(position, fixed=True), walls=wall).build()


@pytest.mark.parametrize(
    "wall",
    [
        Box(1.5, 9, 9),
        Box(9, 9, 2),
        Sphere(1),
        Sphere(0.5),
        Cylinder(1, 9),
        Cylinder(9, 2),
        [Plane((0, 1, 1), -1), Plane((0, -1, -1), -1)],
    ],
)
def test_a_world_smaller_than_a_sphere(wall) -> None:
    message = refusal(Spheres.of((0, 0, 0), radius=1), walls=wall)
    assert "sphere 0 of radius 1 has no room" in message


def test_a_periodic_box_thinner_than_a_diameter() -> None:
    s = Spheres.of((0, 0, 0), radius=1)
    message = refusal(s, walls=Periodic(9, 1.9, None))
    assert "periodic axis y is 1.9 long" in message
    assert "diameter 2" in message
    Scene(s, walls=(Periodic(9, 2, None),)).build()
    Scene(s, walls=(Periodic(9, 1.9, None),), collide=False).build()


@pytest.mark.parametrize(
    ("wall", "position", "velocity"),
    [
        (Sphere(2), (1.5, 0, 0), (0, 1, 0)),
        (Sphere(2), (0, 0.9, 1.2), (1, 0, 0)),
        (Cylinder(2, 9), (0, 1.5, 0), (1, 0, 5)),
    ],
)
def test_sliding_along_a_round_wall_is_refused(wall, position, velocity) -> None:
    assert "moves exactly along it" in refusal(Spheres.of(position, velocity), walls=wall)
    inward = -0.01 * np.array(position)
    Scene(Spheres.of(position, velocity + inward), walls=wall).build()
    Scene(Spheres.of(position), walls=wall).build()


def test_moving_along_the_axis_of_a_cylinder_is_fine() -> None:
    Scene(Spheres.of((0, 1.5, 0), (0, 0, 1)), walls=(Cylinder(2, 9),)).build()


# --- periodic places -------------------------------------------------------------------


def test_positions_are_wrapped_and_boxes_counted() -> None:
    scene = Scene(Spheres.of([(7, 0, 12), (5, 0, 0)], radius=0.1), walls=(Periodic(10, None, 10),))
    state, _ = scene.build()
    assert state.position.tolist() == [[-3, 0, 2], [-5, 0, 0]]
    assert state.image.tolist() == [[1, 0, 1], [1, 0, 0]]


def test_wrapping_stays_inside_and_loses_nothing() -> None:
    length = 9.7
    edges = [length / 2, -length / 2, np.nextafter(length / 2, 0), np.nextafter(-length / 2, -9)]
    x = np.array([[e + k * length, 0, 0] for e in edges for k in range(-3, 4)])
    period = np.array([length, 0, 0])
    wrapped, image = fit.wrap(x, period)
    assert (wrapped[:, 0] >= -length / 2).all()
    assert (wrapped[:, 0] < length / 2).all()
    np.testing.assert_allclose(wrapped + image * period, x, rtol=0, atol=1e-14)
    inside = np.array([[np.nextafter(length / 2, 0), 0, 0], [-length / 2, 3, 4]])
    assert (fit.wrap(inside, period)[0] == inside).all()


def test_far_away_in_a_periodic_box_is_refused() -> None:
    assert "1e9 boxes" in refusal(Spheres.of((1e12, 0, 0)), walls=Periodic(10, None, None))
    Scene(Spheres.of((1e12, 0, 0)), walls=(Open(),)).build()
