"""Scene files: every scene comes back to the bit, and every mistake gets one sentence."""

import math
import tomllib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from carom import scenes
from carom.errors import FileError, InputError, UnknownNameError
from carom.rules import Smooth
from carom.scene import Camera, Scene, Spheres
from carom.scene_file import dump, load, parse, save
from carom.walls import Box, Cylinder, Open, Periodic, Plane, Sphere

ONE = "[[spheres]]\nposition = [0, 0, 0]\n"
BOX = "[[walls]]\nkind = 'box'\nlx = 3\nly = 3\nlz = 3\n"

number = st.floats(-1e30, 1e30)
positive = st.floats(1e-30, 1e30)
fraction = st.floats(0, 1)
triple = st.tuples(number, number, number)
reflection = st.sampled_from(["specular", "bounce-back"])
walls = st.one_of(
    st.builds(Box, positive, positive, positive, fraction, reflection),
    st.builds(Periodic, positive, st.none() | positive, st.none() | positive),
    st.builds(Sphere, positive, fraction, reflection),
    st.builds(Cylinder, positive, positive, fraction, reflection),
    st.builds(Plane, triple.filter(any), number, fraction, reflection),
    st.builds(Open),
)


@st.composite
def spheres(draw):
    n = draw(st.integers(0, 5))
    many = {
        "velocity": triple,
        "radius": positive,
        "mass": positive,
        "color": st.integers(0, 0xFFFFFF),
        "species": st.integers(0, 2**32 - 1),
        "fixed": st.booleans(),
    }
    one_for_all = draw(st.sets(st.sampled_from(sorted(many))))
    values = {
        name: draw(one if name in one_for_all else st.lists(one, min_size=n, max_size=n))
        for name, one in many.items()
    }
    if n == 0:
        values = {}
    position = draw(st.lists(triple, min_size=n, max_size=n))
    return Spheres.of(np.array(position).reshape(n, 3), **values)


scene_of_any_kind = st.builds(
    Scene,
    spheres=spheres(),
    walls=st.lists(walls, min_size=1, max_size=4).map(tuple),
    rule=st.builds(Smooth, fraction, st.none() | positive),
    gravity=triple,
    collide=st.booleans(),
    seed=st.none() | st.integers(0, 2**60),
    pace=positive,
    camera=st.none() | st.builds(Camera, triple, st.just((1e31, 0.0, 0.0))),
    color=st.sampled_from(["energy", "own", "speed", "species"]),
    title=st.text(st.characters(exclude_categories=["Cs"]), max_size=30),
    wire=st.booleans(),
)


@settings(max_examples=200, deadline=None)
@given(scene_of_any_kind)
def test_a_scene_comes_back_to_the_bit(scene):
    back = parse(dump(scene))
    assert back == scene
    assert dump(back) == dump(scene)


@settings(max_examples=100, deadline=None)
@given(st.text(max_size=200) | st.binary(max_size=200).map(lambda b: b.decode("latin-1")))
def test_any_text_is_a_scene_or_a_sentence(text):
    try:
        outcome = parse(text)
    except InputError as error:
        outcome = str(error)
    assert isinstance(outcome, Scene) or outcome.startswith("scene")


@pytest.mark.parametrize("name", scenes.names())
def test_every_scene_survives_a_file(name, tmp_path):
    scene = scenes.build(name)
    save(scene, tmp_path / "scene.toml")
    assert load(tmp_path / "scene.toml") == scene


def test_what_is_default_is_left_out():
    data = tomllib.loads(dump(Scene(Spheres.of([(0, 0, 0), (2, 0, 0)], mass=[1, 3]))))
    assert data == {
        "spheres": [{"position": [[0, 0, 0], [2, 0, 0]], "mass": [1, 3], "color": "#4c9be8"}]
    }


def test_a_file_written_by_hand():
    scene = parse("""
        title = "Two in a tube"
        gravity = [0, 0, -1]
        collide = true
        seed = 4
        pace = 2
        color = "own"
        wire = true
        [camera]
        position = [9, 9, 9]
        [rule]
        restitution = 0.9
        contact_time = 1e-4
        [[walls]]
        kind = "cylinder"
        radius = 3
        length = 10
        reflection = "bounce-back"
        [[walls]]
        kind = "plane"
        normal = [0, 0, 1]
        offset = -2
        restitution = 0.5
        [[spheres]]
        position = [0, 0, 1]
        color = "red"
        [[spheres]]
        position = [[1, 0, 3], [-1, 0, 3]]
        radius = [0.25, 0.5]
        fixed = [false, true]
        species = 2
        """)
    assert scene == Scene(
        Spheres.of((0, 0, 1), color="red")
        + Spheres.of([(1, 0, 3), (-1, 0, 3)], radius=[0.25, 0.5], fixed=[False, True], species=2),
        walls=(
            Cylinder(3, 10, reflection="bounce-back"),
            Plane((0, 0, 1), -2, restitution=0.5),
        ),
        rule=Smooth(0.9, contact_time=1e-4),
        gravity=(0, 0, -1),
        seed=4,
        pace=2,
        camera=Camera((9, 9, 9)),
        color="own",
        title="Two in a tube",
        wire=True,
    )


def test_a_file_may_name_a_scene():
    scene = parse("scene = 'fluid'\n[options]\nn = 100\npacking_fraction = 0.2\n")
    assert scene == scenes.fluid(n=100, packing_fraction=0.2)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        # keys
        ("titel = 'x'\n" + ONE, "there is no key 'titel'; did you mean 'title'?"),
        (ONE + "colour = 'red'", "there is no key 'colour' in spheres[0]; did you mean 'color'?"),
        (
            ONE + BOX + "restitusion = 1",
            "there is no key 'restitusion' in walls[0]; did you mean 'restitution'?",
        ),
        (
            ONE + "[camera]\npositon = [1, 2, 3]",
            "there is no key 'positon' in camera; did you mean 'position'?",
        ),
        (
            ONE + "[rule]\ncontact-time = 1",
            "there is no key 'contact-time' in rule; did you mean 'contact_time'?",
        ),
        ("scene = 'gas'\npace = 2", "there is no key 'pace'; there are scene, options"),
        # missing
        ("", "spheres is missing; give [[spheres]] tables"),
        ("[[spheres]]\nradius = 1", "spheres[0].position is missing; give three numbers"),
        (ONE + "[[walls]]\nlx = 3", "walls[0].kind is missing; give one of box, periodic"),
        (ONE + "[[walls]]\nkind = 'sphere'", "walls[0].radius is missing; give a number"),
        # types
        ("title = 3\n" + ONE, "title is 3; expected text in quotes"),
        ("pace = 'fast'\n" + ONE, "pace is 'fast'; expected a number"),
        ("pace = true\n" + ONE, "pace is True; expected a number"),
        ("collide = 1\n" + ONE, "collide is 1; expected true or false"),
        ("seed = 1.5\n" + ONE, "seed is 1.5; expected a whole number"),
        ("gravity = 9.81\n" + ONE, "gravity is 9.81; expected three numbers [x, y, z]"),
        ("spheres = 3", "spheres is 3; expected [[spheres]] tables"),
        ("spheres = [3]", "spheres[0] is 3; expected [[spheres]] tables"),
        ("walls = 'box'\n" + ONE, "walls is 'box'; expected [[walls]] tables"),
        ("camera = 3\n" + ONE, "camera is 3; expected a [camera] table"),
        (ONE + "[rule]\nrestitution = '1'", "rule.restitution is '1'; expected a number"),
        (ONE + BOX.replace("3", "'3'"), "walls[0].lx is '3'; expected a number"),
        (ONE + "radius = 'big'", "spheres[0]: radius must be numbers, not 'big'"),
        (ONE + ONE + "radius = [1, 2]", "spheres[1]: radius has shape (2,)"),
        ("[[spheres]]\nposition = [[0, 0, 0], [1]]", "spheres[0]: position has rows"),
        # values
        (ONE + "color = 'rde'", "spheres[0]: there is no color 'rde'; did you mean 'red'?"),
        (ONE + "[[walls]]\nkind = 'bxo'", "walls[0].kind is 'bxo'; expected one of box, periodic"),
        (ONE + BOX + "restitution = 1.5", "walls[0]: restitution of the Box is 1.5; it must be"),
        (ONE + BOX + "reflection = 'no'", "walls[0]: Box: reflection must be 'specular'"),
        (ONE + "[rule]\nrestitution = 2", "rule: restitution is 2; it must be at least 0"),
        ("pace = nan\n" + ONE, "pace is nan; give a finite number"),
        ("gravity = [0, 0]\n" + ONE, "gravity must be three numbers (x, y, z), not [0, 0]"),
        ("color = 'speeed'\n" + ONE, "there is no coloring 'speeed'; did you mean 'speed'?"),
        ("scene = 'fluidd'", "there is no scene 'fluidd'; did you mean 'fluid'?"),
        (
            "scene = 'fluid'\n[options]\npaking_fraction = 0.3",
            "the scene 'fluid' has no option 'paking_fraction'; did you mean 'packing_fraction'?",
        ),
        ("scene = 'fluid'\n[options]\nn = 'x'", "n must be a number, not 'x'"),
    ],
)
def test_every_mistake_gets_one_sentence(text, sentence, tmp_path):
    path = tmp_path / "my.toml"
    path.write_text(text)
    with pytest.raises(InputError) as error:
        load(path)
    message = str(error.value)
    assert message.startswith(f"{path}: {sentence}")
    assert "\n" not in message


def test_broken_toml_names_the_line(tmp_path):
    path = tmp_path / "my.toml"
    path.write_text("title = 'x'\npace = = 3\n")
    with pytest.raises(InputError, match=r"my\.toml is not valid TOML: .*line 2"):
        load(path)
    with pytest.raises(InputError, match="nested too deeply"):
        parse("a = " + "[" * 10_000)


def test_misspelt_names_are_unknown_names():
    for text in ("titel = 3\n" + ONE, "scene = 'fluidd'", ONE + "color = 'rde'"):
        with pytest.raises(UnknownNameError):
            parse(text)


def test_files_that_cannot_be_used(tmp_path):
    with pytest.raises(FileError, match=r"cannot read .*none\.toml: No such file"):
        load(tmp_path / "none.toml")
    with pytest.raises(FileError, match="cannot read"):
        load(tmp_path)
    with pytest.raises(FileError, match="cannot write"):
        save(scenes.two_balls(), tmp_path / "no" / "folder.toml")
    (tmp_path / "bits").write_bytes(b"\x00\xff\xfe")
    with pytest.raises(InputError, match="not a text file in UTF-8"):
        load(tmp_path / "bits")


def test_fixed_spheres_come_back_fixed():
    scene = Scene(Spheres.of([(0, 0, 0), (3, 0, 0)], mass=[2, 3], fixed=[True, False]))
    back = parse(dump(scene))
    assert back.spheres.mass.tolist() == [math.inf, 3]
    assert back.spheres.fixed.tolist() == [True, False]
