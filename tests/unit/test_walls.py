"""Walls: their numbers, their order in events, and everything that is refused."""

import math

import numpy as np
import pytest

from carom.errors import InputError
from carom.rules import Smooth
from carom.walls import (
    KINDS,
    Box,
    Cylinder,
    Open,
    Periodic,
    Plane,
    Sphere,
    as_walls,
    wall_names,
    world,
)
from carom.world import CYLINDER, PLANE, SPHERE


def test_a_box_is_six_planes_in_the_documented_order() -> None:
    w = world(Box(2, 4, 6, restitution=0.5)).walls
    assert (w["kind"] == PLANE).all()
    assert w["normal"].tolist() == [
        [1, 0, 0],
        [-1, 0, 0],
        [0, 1, 0],
        [0, -1, 0],
        [0, 0, 1],
        [0, 0, -1],
    ]
    assert w["offset"].tolist() == [-1, -1, -2, -2, -3, -3]
    assert (w["restitution"] == 0.5).all()
    assert not w["bounce_back"].any()


def test_a_cylinder_is_side_bottom_top() -> None:
    w = world(Cylinder(3, 10, reflection="bounce-back")).walls
    assert w["kind"].tolist() == [CYLINDER, PLANE, PLANE]
    assert w["offset"].tolist() == [3, -5, -5]
    assert w["normal"].tolist() == [[0, 0, 0], [0, 0, 1], [0, 0, -1]]
    assert w["bounce_back"].all()


def test_a_container_has_its_radius_as_offset() -> None:
    (w,) = world(Sphere(7, 0.25)).walls
    assert (w["kind"], w["offset"], w["restitution"]) == (SPHERE, 7, 0.25)


@pytest.mark.parametrize("scale", [1, 3.7, 1e-50, 1e50])
def test_a_plane_has_a_unit_normal_and_its_offset_is_a_distance(scale: float) -> None:
    (w,) = world(Plane((3 * scale, 0, -4 * scale), 2)).walls
    assert w["normal"] == pytest.approx([0.6, 0, -0.8], abs=1e-15)
    assert w["offset"] == 2


def test_unit_normals_along_an_axis_are_exact() -> None:
    assert Plane((0, 0, 1e-7), 0).unit_normal == (0, 0, 1)


def test_several_walls_keep_their_order() -> None:
    w = world([Plane((0, 0, 1), -1), Open(), Periodic(8, None, None), Plane((0, 1, 0), -3)])
    assert w.walls["offset"].tolist() == [-1, -3]
    assert w.period.tolist() == [8, 0, 0]


def test_periods_on_different_axes_combine() -> None:
    assert world([Periodic(8, None, None), Periodic(None, 9, None)]).period.tolist() == [8, 9, 0]


def test_rule_gravity_and_collide_reach_the_world() -> None:
    w = world((), Smooth(0.9, contact_time=1e-4), (0, 0, -1), collide=False)
    assert (w.restitution, w.contact_time, w.collide) == (0.9, 1e-4, False)
    assert w.gravity.tolist() == [0, 0, -1]
    assert len(w.walls) == 0
    assert not w.period.any()


@pytest.mark.parametrize("kind", KINDS)
def test_examples_flatten_and_have_a_name_per_wall(kind: type) -> None:
    for wall in kind.examples():
        assert isinstance(wall, kind)
        assert len(world(wall).walls) == len(wall_names(wall))


def test_names_say_which_wall_it_is() -> None:
    names = wall_names([Box(1, 1, 1), Cylinder(1, 1)])
    assert names[0] == "the x- wall of the Box"
    assert names[5] == "the z+ wall of the Box"
    assert names[6:] == [
        "the side of the Cylinder",
        "the bottom of the Cylinder",
        "the top of the Cylinder",
    ]


def test_one_wall_several_and_none() -> None:
    box = Box(1, 2, 3)
    assert as_walls(box) == (box,)
    assert as_walls([box]) == (box,)
    assert as_walls(()) == (Open(),)


@pytest.mark.parametrize("size", [0, -1, math.nan, math.inf, "3", None, True, 1e70, [1, 2]])
@pytest.mark.parametrize(
    "make",
    [
        lambda s: Box(s, 1, 1),
        lambda s: Box(1, 1, s),
        lambda s: Sphere(s),
        lambda s: Cylinder(s, 1),
        lambda s: Cylinder(1, s),
    ],
)
def test_bad_sizes_are_refused(make, size) -> None:
    with pytest.raises(InputError, match=r"must be|finite|overflows"):
        make(size)


@pytest.mark.parametrize("length", [0, -2, math.nan, math.inf, "3"])
def test_bad_periods_are_refused(length: float) -> None:
    with pytest.raises(InputError, match="lx of Periodic"):
        Periodic(length, 1, 1)


def test_periodic_needs_an_axis() -> None:
    with pytest.raises(InputError, match="no periodic axis"):
        Periodic(None, None, None)


@pytest.mark.parametrize("e", [-0.1, 1.1, math.nan, math.inf, "1"])
@pytest.mark.parametrize(
    "make",
    [
        lambda e: Box(1, 1, 1, e),
        lambda e: Sphere(1, e),
        lambda e: Cylinder(1, 1, e),
        lambda e: Plane((0, 0, 1), 0, e),
    ],
)
def test_restitution_stays_between_0_and_1(make, e) -> None:
    with pytest.raises(InputError, match="restitution of the"):
        make(e)


def test_reflection_is_one_of_two() -> None:
    with pytest.raises(InputError, match="'specular' or 'bounce-back', not 'diffuse'"):
        Sphere(1, reflection="diffuse")


@pytest.mark.parametrize(
    "normal", [(0, 0, 0), (1, 0), (1, 0, math.nan), "xyz", 3, (1, 0, math.inf)]
)
def test_bad_normals_are_refused(normal) -> None:
    with pytest.raises(InputError, match="normal of the Plane"):
        Plane(normal, 0)


def test_bad_offset_is_refused() -> None:
    with pytest.raises(InputError, match="offset of the Plane is nan"):
        Plane((0, 0, 1), math.nan)


@pytest.mark.parametrize(
    ("walls", "gravity", "message"),
    [
        ([Periodic(9, None, None), Plane((1, 1, 0), 0)], (0, 0, 0), "cuts the x axis"),
        ([Periodic(None, None, 9), Cylinder(3, 9)], (0, 0, 0), "Cylinder closes the z axis"),
        ([Periodic(None, 9, None), Cylinder(3, 9)], (0, 0, 0), "Cylinder closes the y axis"),
        ([Sphere(3), Periodic(None, 9, None)], (0, 0, 0), "Sphere closes the y axis"),
        ([Box(3, 3, 3), Periodic(None, 9, None)], (0, 0, 0), "Box closes the y axis"),
        ([Periodic(9, None, None), Periodic(8, 9, None)], (0, 0, 0), "two Periodic walls"),
        ([Periodic(9, 9, None)], (0, 1e-9, -1), "gravity .* along y"),
        ([Open()], (0, 0, math.nan), "gravity"),
        ([Open()], (0, 0), "gravity must be three numbers"),
        ([Open()], -9.81, "gravity must be three numbers"),
    ],
)
def test_contradictions_are_refused(walls, gravity, message) -> None:
    with pytest.raises(InputError, match=message):
        world(walls, gravity=gravity)


def test_what_is_no_wall_or_no_rule_is_refused() -> None:
    with pytest.raises(InputError, match="'box' is not a wall; use one of Box"):
        world(["box"])
    with pytest.raises(InputError, match="3 is not a wall"):
        world(3)
    with pytest.raises(InputError, match=r"Smooth\(...\), not 0.9"):
        world((), rule=0.9)


def test_walls_are_frozen_and_compare() -> None:
    assert Box(1, 2, 3) == Box(1.0, 2.0, 3.0)
    with pytest.raises(AttributeError):
        Box(1, 2, 3).lx = 4
    assert np.float64(2) == Box(np.float64(2), 1, 1).lx
