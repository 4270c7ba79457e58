"""Scenes by name: lists, options, values as typed, and names that do not exist."""

import pytest

from carom import scenes
from carom.errors import InputError, UnknownNameError
from carom.scene import Scene, Spheres
from carom.scenes import Option, registry

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
