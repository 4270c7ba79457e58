"""Bad input: one clear sentence each, an error of the right kind, the right exit status."""

import math
import socket

import pytest

import carom
from carom import Box, Cylinder, Periodic, Plane, Scene, Simulation, Smooth, Sphere, Spheres, scenes
from carom.cli import main

NAN, INF = math.nan, math.inf


def one(**options):
    return lambda: Simulation().add(**{"position": (0, 0, 0), **options})


def inside(walls, **options):
    return lambda: Simulation(walls=walls).add(**options)


def started(name, value):
    sim = Simulation(scenes.phase_4())
    return lambda: setattr(sim, name, value)


def built(spheres, **options):
    return lambda: Simulation(Scene(spheres, **options))


TWO = Spheres.of([(0, 0, 0), (0.9, 0, 0)])

#: What is wrong, what the error is, what the sentence says: the value, the limit, the remedy.
IN_PYTHON = [
    ("overlapping spheres", built(TWO), carom.OverlapError, "spheres 0 and 1 overlap by 0.1"),
    ("outside the box", inside(Box(4, 4, 4), position=(1.8, 0, 0)), carom.OverlapError, "0.3"),
    ("outside the sphere", inside(Sphere(2), position=(0, 1.6, 0)), carom.OverlapError, "0.1"),
    ("under the floor", inside(Plane((0, 0, 1), 0)), carom.OverlapError, "0.5 through the Plane"),
    ("outside the tube", inside(Cylinder(2, 4), position=(0, 1.6, 0)), carom.OverlapError, "side"),
    ("radius 0", one(radius=0), carom.InputError, "radius 0"),
    ("radius negative", one(radius=-1), carom.InputError, "radius -1"),
    ("radius NaN", one(radius=NAN), carom.InputError, "radius nan"),
    ("radius infinite", one(radius=INF), carom.InputError, "radius inf"),
    ("mass 0", one(mass=0), carom.InputError, "mass 0"),
    ("mass negative", one(mass=-2), carom.InputError, "mass -2"),
    ("mass NaN", one(mass=NAN), carom.InputError, "mass nan"),
    ("mass infinite", one(mass=INF), carom.InputError, "fixed=True"),
    ("position NaN", one(position=(0, NAN, 0)), carom.InputError, "position"),
    ("position infinite", one(position=(INF, 0, 0)), carom.InputError, "position"),
    ("velocity NaN", one(velocity=(0, 0, NAN)), carom.InputError, "velocity"),
    ("velocity infinite", one(velocity=(-INF, 0, 0)), carom.InputError, "velocity"),
    ("position is text", one(position="here"), carom.InputError, "position must be numbers"),
    ("two components", one(position=(1, 2)), carom.InputError, "three numbers"),
    ("unknown color", one(color="rde"), carom.UnknownNameError, "did you mean 'red'?"),
    ("fixed but moving", one(fixed=True, velocity=(1, 0, 0)), carom.InputError, "fixed"),
    ("e above 1", lambda: Smooth(1.1), carom.InputError, "restitution is 1.1"),
    ("e negative", lambda: Smooth(-0.1), carom.InputError, "restitution is -0.1"),
    ("e NaN", lambda: Smooth(NAN), carom.InputError, "restitution is nan"),
    ("contact time 0", lambda: Smooth(0.9, contact_time=0), carom.InputError, "contact_time is 0"),
    ("wall's e above 1", lambda: Box(9, 9, 9, 1.5), carom.InputError, "restitution of the Box"),
    ("box of size 0", lambda: Box(0, 9, 9), carom.InputError, "lx of the Box is 0"),
    ("box of size NaN", lambda: Box(9, NAN, 9), carom.InputError, "ly of the Box is nan"),
    ("normal 0", lambda: Plane((0, 0, 0), 1), carom.InputError, "normal"),
    ("box smaller than a sphere", inside(Box(0.9, 9, 9)), carom.InputError, "x- wall of the Box"),
    ("thin periodic box", inside(Periodic(9, 9, 0.9)), carom.InputError, "periodic axis z is 0.9"),
    ("tight container", inside(Sphere(0.4)), carom.InputError, "radius 0.5"),
    ("gravity NaN", lambda: Simulation(gravity=(0, 0, NAN)), carom.InputError, "gravity"),
    ("gravity of two", lambda: Simulation(gravity=(0, 1)), carom.InputError, "gravity"),
    (
        "gravity along a periodic axis",
        lambda: Simulation(walls=Periodic(9, 9, 9), gravity=(0, 0, -1)),
        carom.InputError,
        "set gravity[2] to 0",
    ),
    (
        "plane across a periodic axis",
        lambda: Simulation(walls=[Periodic(9, 9, 9), Plane((0, 0, 1), -3)]),
        carom.InputError,
        "normal[2]",
    ),
    ("no wall", lambda: Simulation(walls="box"), carom.InputError, "is not a wall"),
    ("no rule", lambda: Simulation(rule=0.9), carom.InputError, "Smooth"),
    ("no scene", lambda: Simulation(scenes.gas), carom.InputError, "must be a Scene"),
    ("N = 0", built(Spheres.of([])), carom.InputError, "no spheres"),
    ("n = 0", lambda: scenes.phase_3(n=0), carom.InputError, "n is 0"),
    ("nothing to run", lambda: Simulation().run(until=1), carom.InputError, "no spheres"),
    ("too full", lambda: scenes.fluid(packing_fraction=0.8), carom.InputError, "packing_fraction"),
    ("unknown scene", lambda: scenes.build("phase-5"), carom.UnknownNameError, "did you mean"),
    (
        "unknown option",
        lambda: scenes.build("fluid", {"fraction": 0.2}),
        carom.UnknownNameError,
        "packing_fraction",
    ),
    ("unknown method", lambda: Simulation(method="tock"), carom.UnknownNameError, "'tick'"),
    ("tick 0", lambda: Simulation(method="tick", tick=0), carom.InputError, "tick is 0"),
    ("kept events negative", lambda: Simulation(keep_events=-1), carom.InputError, "keep_events"),
    ("assigned NaN", started("velocity", NAN), carom.InputError, "sphere 0 has velocity"),
    ("assigned radius", started("radius", 400), carom.InputError, "no room"),
    ("assigned gravity", started("gravity", (0, INF, 0)), carom.InputError, "gravity"),
    ("assigned rule", started("rule", None), carom.InputError, "Smooth"),
    ("assigned walls", started("walls", Box(1, 1, 1)), carom.InputError, "no room"),
]


@pytest.mark.parametrize(
    ("bad", "kind", "words"), [row[1:] for row in IN_PYTHON], ids=[row[0] for row in IN_PYTHON]
)
def test_in_python(bad, kind, words):
    with pytest.raises(carom.CaromError) as caught:
        bad()
    assert type(caught.value) is kind
    sentence = str(caught.value)
    assert words in sentence
    assert "\n" not in sentence
    assert len(sentence) < 250


#: What is typed, the exit status, what the sentence says.
ON_THE_COMMAND_LINE = [
    ("run phase4", 2, "there is no scene 'phase4'; did you mean 'phase-4'?"),
    ("show phse-4", 2, "did you mean 'phase-4'?"),
    ("compare nosuch", 2, "there is no scene 'nosuch'"),
    ("scenes fluids", 2, "did you mean 'fluid'?"),
    ("run", 2, "name a scene or a file first"),
    ("run --n 5 fluid", 2, "name a scene or a file first"),
    ("run fluid --packing 0.2", 2, "did you mean '--packing-fraction'?"),
    ("run fluid --colisions 5", 2, "did you mean '--collisions'?"),
    ("run galperin --xyz 2", 2, "its options are --digits"),
    ("run fluid 5", 2, "'5' is one word too many"),
    ("run fluid --n", 2, "option --n needs a value"),
    ("run fluid --n ten", 2, "n must be a whole number, not 'ten'"),
    ("run fluid --n 1.5", 2, "n must be a whole number, not 1.5"),
    ("run fluid --n 0", 2, "n is 0"),
    ("run fluid --n -4", 2, "n is -4"),
    ("run fluid --packing-fraction 0.9", 2, "packing_fraction is 0.9"),
    ("run fluid --packing-fraction nan", 2, "packing_fraction is nan"),
    ("run fluid --until later", 2, "--until must be a number, not 'later'"),
    ("run fluid --until -1", 2, "--until is -1; it must be at least 0"),
    ("run fluid --until inf", 2, "--until is inf"),
    ("run fluid --until", 2, "--until"),
    ("run fluid --until 1 --collisions 2", 2, "give only one of --until, --collisions"),
    ("run fluid --collisions 1.5", 2, "--collisions must be a whole number"),
    ("run fluid --seed x", 2, "--seed must be a number, not 'x'"),
    ("run fluid --method exat", 2, "did you mean 'exact'?"),
    ("run fluid --method tick --tick 0", 2, "tick is 0"),
    ("compare phase-4 --tick -1", 2, "tick"),
    ("show --port 70000", 2, "port is 70000"),
    ("show --port web", 2, "--port must be a number"),
    ("rnu phase-4", 2, "rnu"),
    ("--verbose", 2, "--verbose"),
    ("run no-such-file.toml", 1, "cannot read no-such-file.toml"),
    ("run ./", 1, "cannot read"),
    ("run two-balls --collisions 50 --width 3 --method x", 2, "'--width'"),
    ("run phase-1 --collisions 5", 1, "only 0 of 5 collisions happened"),
]


@pytest.mark.parametrize(("line", "status", "words"), ON_THE_COMMAND_LINE)
def test_on_the_command_line(capsys, line, status, words):
    assert_refused(capsys, line.split(), status, words)


def assert_refused(capsys, line, status, words):
    with pytest.raises(SystemExit) as end:
        main(line)
    out, err = capsys.readouterr()
    assert end.value.code == status
    assert out == ""
    assert err.startswith("carom: ")
    assert err.count("\n") == 1, "one sentence"
    assert words in err
    assert "Traceback" not in err


FILES = [
    ("x = [", "not valid TOML"),
    ("", "spheres"),
    ("[[spheres]]\nposition = [0, 0]", "position"),
    ("[[spheres]]\nposition = [0, 0, 0]\nradus = 2", "did you mean"),
    ("gravity = 'down'\n[[spheres]]\nposition = [0, 0, 0]", "gravity"),
    ("[[spheres]]\nposition = [0, 0, 0]\nradius = -1", "radius -1"),
    ("[[spheres]]\nposition = [[0, 0, 0], [0.5, 0, 0]]", "overlap by 0.5"),
    ("scene = 'fluid'\n[options]\nn = 0", "n is 0"),
]


@pytest.mark.parametrize(("text", "words"), FILES)
def test_scene_files(capsys, tmp_path, text, words):
    path = tmp_path / "scene.toml"
    path.write_text(text)
    assert_refused(capsys, ["run", str(path)], 2, words)


def test_a_file_has_no_scene_options(capsys, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text("[[spheres]]\nposition = [0, 0, 0]")
    assert_refused(capsys, ["run", str(path), "--n", "4"], 2, "--n is an option of scenes")


def test_nothing_more_happens(capsys, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(
        "[[spheres]]\nposition = [[0, 0, 0], [3, 0, 0]]\nvelocity = [[1, 0, 0], [0, 0, 0]]"
    )
    line = ["run", str(path), "--collisions", "9"]
    assert_refused(capsys, line, 1, "only 1 of 9 collisions happened")


def test_an_unreadable_file(capsys, tmp_path):
    path = tmp_path / "scene.toml"
    path.write_bytes(b"\xff\xfe\x00")
    assert_refused(capsys, ["run", str(path)], 2, "UTF-8")


def test_a_port_in_use(capsys):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        assert_refused(capsys, ["show", "two-balls", "--no-browser", "--port", port], 1, port)


def test_too_many_for_this_machine(capsys, monkeypatch):
    def greedy(*_):
        raise MemoryError

    monkeypatch.setattr(scenes, "build", greedy)
    assert_refused(capsys, ["run", "gas"], 1, "not enough memory")


def test_error_families():
    assert issubclass(carom.InputError, ValueError)
    assert issubclass(carom.OverlapError, carom.InputError)
    assert issubclass(carom.UnknownNameError, LookupError)
    assert issubclass(carom.RunError, RuntimeError)
    assert issubclass(carom.CollapseError, carom.RunError)
    assert issubclass(carom.FileError, OSError)
