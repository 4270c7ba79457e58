"""Scenes by name: lists, options, values as typed, and names that do not exist."""

from dataclasses import replace
from typing import Annotated

import pytest

from carom import scenes
from carom.errors import InputError, UnknownNameError
from carom.scene import Origin, Scene, Spheres
from carom.scene_file import dump, parse
from carom.scenes import Option, Slider, registry

ALL = [
    "bounce",
    "break-shot",
    "fluid",
    "galperin",
    "gas",
    "giant",
    "newton-cradle",
    "phase-0",
    "phase-1",
    "phase-2",
    "phase-3",
    "phase-4",
    "two-balls",
]


def test_all_scenes_are_there():
    assert set(ALL) <= set(scenes.names())
    assert scenes.names() == sorted(scenes.names())


@pytest.mark.parametrize("name", ALL)
def test_every_scene_describes_itself_and_its_options(name):
    line = scenes.describe(name)
    assert 10 < len(line) < 90
    assert "\n" not in line
    assert not line.endswith(".")
    for option in scenes.options(name):
        assert len(option.help) > 5, option
        assert type(option.default) is option.type
    assert scenes.find(name) is getattr(scenes, name.replace("-", "_"))


@pytest.mark.parametrize("name", ALL)
def test_every_scene_builds_with_no_options(name):
    scene = scenes.build(name)
    state, world = scene.build()
    assert len(state) >= 2
    assert scene.title
    assert scene.collide == world.collide
    # Something happens within a few seconds of looking at it.
    assert (state.velocity != 0).any() or world.gravity.any()


@pytest.mark.parametrize("name", ALL)
def test_scenes_depend_on_their_seed_alone(name):
    make = scenes.find(name)
    assert make() == make()
    if any(o.name == "seed" for o in scenes.options(name)):
        assert make(seed=2).seed == 2
        assert make(seed=2).spheres != make(seed=3).spheres
        with pytest.raises(InputError, match="seed is -1"):
            make(seed=-1)


def test_options_come_from_the_signature():
    n, phi, temperature, seed = scenes.options("fluid")
    assert (n.name, n.type, n.default) == ("n", int, 4000)
    assert (phi.name, phi.type) == ("packing_fraction", float)
    assert temperature.default == 1
    assert seed.help == "Of the empty sites and the velocities."


def test_counts_may_be_floats():
    assert len(scenes.fluid(n=1e2).spheres) == 100
    assert len(scenes.build("gas", {"n": 20.0, "packing-fraction": 0.01}).spheres) == 20


@pytest.mark.parametrize(
    ("text", "type_", "value"),
    [
        ("1e6", int, 1_000_000),
        ("12", int, 12),
        ("123456789012345678901", int, 123456789012345678901),
        ("0.25", float, 0.25),
        ("3", float, 3.0),
        ("yes", bool, True),
        ("False", bool, False),
        ("1e6", str, "1e6"),
    ],
)
def test_options_read_text(text, type_, value):
    read = Option("x", type_, type_(), "").parse(text)
    assert read == value
    assert type(read) is type_


@pytest.mark.parametrize(
    ("text", "type_", "message"),
    [
        ("ten", int, "x must be a whole number, not 'ten'"),
        ("1.5", int, "x must be a whole number, not 1.5"),
        ("inf", int, "x is inf; give a finite number"),
        ("nan", float, "x is nan; give a finite number"),
        ("a", float, "x must be a number, not 'a'"),
        ("maybe", bool, "x must be true or false, not 'maybe'"),
    ],
)
def test_options_refuse_other_text(text, type_, message):
    with pytest.raises(InputError) as error:
        Option("x", type_, type_(), "").parse(text)
    assert str(error.value) == message


@pytest.mark.parametrize(
    ("option", "value"),
    [("n", 1.5), ("n", "10"), ("n", True), ("packing_fraction", "x"), ("packing_fraction", None)],
)
def test_bad_values_are_refused(option, value):
    with pytest.raises(InputError, match=f"{option} must be"):
        scenes.build("fluid", {option: value})


def test_unknown_names_get_a_suggestion():
    with pytest.raises(UnknownNameError, match="no scene 'phase_4'; did you mean 'phase-4'"):
        scenes.find("phase_4")
    with pytest.raises(UnknownNameError, match="no scene 'zzz'; there are bounce, break-shot"):
        scenes.build("zzz")
    with pytest.raises(UnknownNameError, match="no option 'sed'; did you mean 'seed'"):
        scenes.build("gas", {"sed": 1})
    with pytest.raises(UnknownNameError):
        scenes.describe("zzz")
    with pytest.raises(UnknownNameError):
        scenes.options("zzz")


def test_a_scene_of_ones_own(monkeypatch):
    monkeypatch.setattr(registry, "_SCENES", dict(registry._SCENES))

    @scenes.scene
    def lonely_ball(speed: float = 1.0) -> Scene:
        """One sphere in open space.

        Parameters
        ----------
        speed : float
            Of the sphere,
            in any direction.
        """
        return Scene(Spheres.of((0, 0, 0), velocity=(speed, 0, 0)))

    assert scenes.describe("lonely-ball") == "One sphere in open space"
    assert scenes.options("lonely-ball") == (
        Option("speed", float, 1.0, "Of the sphere, in any direction."),
    )
    assert scenes.build("lonely-ball", {"speed": 3}).spheres.velocity[0, 0] == 3


def test_a_scene_needs_types_and_defaults():
    with pytest.raises(InputError, match="option 'n' of a scene needs a type"):

        @scenes.scene
        def nothing(n: int) -> Scene:
            raise AssertionError

    with pytest.raises(InputError, match="option 'n' of a scene needs a type"):

        @scenes.scene
        def untyped(n=3) -> Scene:
            raise AssertionError


@pytest.mark.parametrize("name", ALL)
def test_sliders_hold_the_default_and_their_ends_make_scenes(name):
    for option in scenes.options(name):
        if option.name == "seed" or option.type is bool:
            assert (option.low, option.high, option.log) == (None, None, False)
            continue
        assert option.low <= option.default <= option.high
        for end in (option.low, option.high):
            assert type(end) is option.type
            scenes.build(name, {option.name: end}).build()


def test_an_option_with_a_slider(monkeypatch):
    monkeypatch.setattr(registry, "_SCENES", dict(registry._SCENES))

    @scenes.scene
    def slid(
        n: Annotated[int, "a remark", Slider(1, 1e3, log=True)] = 10,
        size: Annotated[float, Slider(-1, 2)] = 1.0,
        plain: Annotated[float, "no slider"] = 1.0,
    ) -> Scene:
        """Balls in a row."""
        return Scene(Spheres.of([(2 * i, 0, 0) for i in range(n)], radius=size))

    n, size, plain = scenes.options("slid")
    assert n == Option("n", int, 10, "", 1, 1000, True)
    assert type(n.high) is int
    assert (size.type, size.low, size.high, size.log) == (float, -1.0, 2.0, False)
    assert (plain.type, plain.low, plain.high) == (float, None, None)
    assert len(slid(n=2000).spheres) == 2000  # a slider forbids nothing


@pytest.mark.parametrize(
    ("ends", "message"),
    [
        ((2, 1), "cannot go from 2 to 1$"),
        ((1, 1), "cannot go from 1 to 1$"),
        ((0, 1, True), "from 0 to 1; with log it must start above 0"),
        ((0, float("inf")), "high of the Slider is inf"),
    ],
)
def test_sliders_that_cannot_be(ends, message):
    with pytest.raises(InputError, match=message):
        Slider(*ends)


def test_only_numbers_have_sliders():
    with pytest.raises(InputError, match="option 'box' of a scene is no number"):

        @scenes.scene
        def switched(box: Annotated[bool, Slider(0, 1)] = True) -> Scene:
            raise AssertionError

    with pytest.raises(InputError, match=r"n must be a whole number, not 0\.5"):

        @scenes.scene
        def halved(n: Annotated[int, Slider(0.5, 1)] = 1) -> Scene:
            raise AssertionError


@pytest.mark.parametrize("name", ALL)
def test_a_scene_knows_where_it_came_from(name):
    defaults = {option.name: option.default for option in scenes.options(name)}
    assert scenes.build(name).origin == Origin(name, defaults)
    first = scenes.options(name)[0]
    made = scenes.find(name)(first.low)
    assert made.origin == Origin(name, {**defaults, first.name: first.low})
    assert scenes.build(made.origin.name, made.origin.options) == made


def test_the_origin_is_a_remark():
    made = scenes.gas(n=20.0, seed=3)
    assert made.origin.options == {"n": 20, "packing_fraction": 0.05, "speed": 1.0, "seed": 3}
    assert type(made.origin.options["n"]) is int
    assert replace(made, origin=None) == made
    assert replace(made, pace=9.0).origin is made.origin
    assert "origin" not in dump(made)
    assert parse(dump(made)).origin is None
    assert parse("scene = 'gas'\n[options]\nn = 20\nseed = 3").origin == made.origin
    with pytest.raises(InputError, match="origin must be of type Origin"):
        replace(made, origin="gas")
