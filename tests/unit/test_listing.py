"""A simulation written down is run again and compared bit by bit."""

import dataclasses
import shlex
import tomllib

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import carom
from carom.cli.source import source
from carom.reference.exact import ExactEngine
from carom.scene_file import parse
from carom.scenes import registry

from .gases import gas

LOOKS = ("pace", "camera", "color", "title", "wire")


def pasted(text):
    """Run a printed program, all but the showing."""
    assert text.endswith("\nsim.show()\n")
    names = {}
    exec(text.removesuffix("sim.show()\n"), names)
    return names["sim"]


def spheres(sim):
    """All bits that tell the spheres apart."""
    return {f.name: getattr(sim.state, f.name).tobytes() for f in dataclasses.fields(carom.Spheres)}


def around(sim):
    gravity = sim.gravity.tobytes()
    return sim.walls, sim.rule, gravity, sim.collide


def run_on(sim):
    """Two hundred events, or as many as happen."""
    for event in range(200):
        try:
            sim.run(events=1)
        except carom.RunError:
            return event
    return 200


def agree(sim, *others):
    for other in others:
        assert spheres(other) == spheres(sim)
        assert around(other) == around(sim)
    ran = [run_on(each) for each in (sim, *others)]
    assert len(set(ran)) == 1
    for other in others:
        assert spheres(other) == spheres(sim)
        assert other.time == sim.time
    return ran[0]


def same_looks(sim, *others):
    for other in others:
        for name in LOOKS:
            assert getattr(other.scene, name) == getattr(sim.scene, name)


class TestLibrary:
    @pytest.mark.parametrize("name", [n for n in carom.scenes.names() if n != "fluid"])
    def test_every_scene_is_written_by_its_name(self, name):
        sim = carom.Simulation(carom.scenes.build(name))
        plain = name.replace("-", "_")
        program = f"import carom\n\nsim = carom.Simulation(carom.scenes.{plain}())\nsim.show()\n"
        assert sim.as_python() == program
        assert sim.as_toml() == f'scene = "{name}"\n'
        assert sim.as_command() == f"carom show {name}"
        assert agree(sim, pasted(program), carom.Simulation(parse(sim.as_toml()))) > 0

    def test_options_and_surroundings_that_are_not_the_default(self):
        scene = carom.scenes.gas(n=40, packing_fraction=0.1 + 0.2 / 3, seed=3)
        sim = carom.Simulation(scene)
        options = "n=40, packing_fraction=0.16666666666666669, seed=3"
        assert f"carom.scenes.gas({options}))\n" in sim.as_python()
        written = tomllib.loads(sim.as_toml())
        assert written == {"scene": "gas", "options": {**scene.origin.options, "speed": 1.0}} | {
            "options": {"n": 40, "packing_fraction": 0.1 + 0.2 / 3, "seed": 3}
        }
        command = "carom show gas --n 40 --packing-fraction 0.16666666666666669 --seed 3"
        assert sim.as_command() == command
        sim.rule = carom.Smooth(0.9, contact_time=1e-4)
        sim.gravity = (0, -0.1, -1)
        assert sim.as_command().startswith("carom show my-scene.toml   # ")
        text = sim.as_python()
        for line in (
            f"    carom.scenes.gas({options}),",
            "    rule=carom.Smooth(restitution=0.9, contact_time=0.0001),",
            "    gravity=(0, -0.1, -1),",
        ):
            assert line in text.splitlines()
        from_file = carom.Simulation(parse(sim.as_toml()))
        same_looks(sim, pasted(text), from_file)
        assert agree(sim, pasted(text), from_file) == 200

    def test_it_is_the_start_wherever_the_run_is(self):
        sim = carom.Simulation(carom.scenes.two_balls())
        start = sim.as_python()
        sim.run(until=3)
        assert sim.as_python() == start
        sim.walls = carom.Box(20, 10, 10, restitution=0.5, reflection="bounce-back")
        assert "walls=carom.Box(20, 10, 10, restitution=0.5, reflection=" in sim.as_python()
        program, file = pasted(sim.as_python()), carom.Simulation(parse(sim.as_toml()))
        sim.reset()
        sim.walls = carom.Box(20, 10, 10, restitution=0.5, reflection="bounce-back")
        agree(sim, program, file)

    def test_changed_looks(self):
        scene = dataclasses.replace(
            carom.scenes.phase_4(n=5),
            title='A "new" title',
            camera=carom.Camera((900, 0, 0.1)),
            pace=7.5,
        )
        sim = carom.Simulation(scene, collide=False, method="reference")
        text = sim.as_python()
        assert text.startswith("import dataclasses\n\nimport carom\n\nscene = dataclasses.replace(")
        assert '(scene, collide=False, method="reference")' in text
        again, file = pasted(text), carom.Simulation(parse(sim.as_toml()), method="reference")
        assert again.method == "reference"
        same_looks(sim, again, file)
        agree(sim, again, file)

    @pytest.mark.parametrize("option", [{"offset": -0.25, "box": False}, {"mass_ratio": 1e-3}])
    def test_the_command_gives_the_same_scene(self, option):
        sim = carom.Simulation(carom.scenes.two_balls(**option))
        name, *words = shlex.split(sim.as_command())[2:]
        assert source(name, words, None).scene == sim.scene

    def test_the_command_names_the_method(self):
        scene = carom.scenes.phase_4()
        for sim, words in [
            (carom.Simulation(scene, method="reference"), " --method reference"),
            (carom.Simulation(scene).in_ticks(), " --method tick"),
            (carom.Simulation(scene).in_ticks(0.5), " --method tick --tick 0.5"),
        ]:
            assert sim.as_command() == f"carom show phase-4{words}"
        assert 'method="tick", tick=0.5)' in sim.as_python()
        assert agree(sim, pasted(sim.as_python())) == 200

    def test_a_scene_only_this_program_knows_is_written_in_full(self, monkeypatch):
        monkeypatch.setattr(registry, "_SCENES", dict(registry._SCENES))

        @carom.scenes.scene
        def mine(n: int = 2) -> carom.Scene:
            """Balls in a row."""
            return carom.Scene(carom.Spheres.of([(2 * i, 0, 0) for i in range(n)], velocity=1.0))

        sim = carom.Simulation(mine(3))
        assert "mine" not in sim.as_python() + sim.as_toml() + sim.as_command()
        agree(sim, pasted(sim.as_python()))

    def test_spheres_put_in_the_place_of_the_librarys_are_written(self):
        other = carom.Spheres.of((1, 1, 1))
        sim = carom.Simulation(dataclasses.replace(carom.scenes.two_balls(), spheres=other))
        assert "two_balls" not in sim.as_python()
        agree(sim, pasted(sim.as_python()))


EDITS = {
    "add": lambda sim: sim.add(position=(0, 2, 0.1), velocity=(0.3, -0.2, 0.1), color="teal"),
    "remove": lambda sim: sim.remove(1),
    "push": lambda sim: setattr(sim[0], "velocity", (1 / 3, 0, 0)),
    "reverse": lambda sim: setattr(sim, "velocity", -sim.velocity),
    "color": lambda sim: setattr(sim[1], "color", "gold"),
}


class TestEdited:
    @pytest.mark.parametrize("edit", EDITS)
    @pytest.mark.parametrize("before", [0, 1.7])
    def test_the_state_of_now_is_written(self, edit, before):
        sim = carom.Simulation(carom.scenes.two_balls(), gravity=(0, 0, -1))
        sim.run(until=before)
        EDITS[edit](sim)
        text = sim.as_python()
        assert "two_balls(" not in text
        assert sim.as_command().startswith("carom show my-scene.toml   # ")
        program, file = pasted(text), carom.Simulation(parse(sim.as_toml()))
        assert spheres(program) == spheres(sim)
        assert around(program) == around(sim)
        assert program.time == 0
        same_looks(sim, program, file)
        assert agree(program, file) > 0

    def test_reset_undoes_edits_but_those_before_the_first_run(self):
        sim = carom.Simulation(carom.scenes.two_balls())
        sim.run(until=1)
        mark = sim.bookmark()
        sim.remove(0)
        assert "two_balls(" not in sim.as_python()
        sim.return_to(mark)
        assert "two_balls(" in sim.as_python()
        sim.remove(0)
        sim.reset()
        assert "two_balls(" in sim.as_python()
        sim.remove(0)
        sim.run(until=1)
        sim.reset()
        assert "two_balls(" not in sim.as_python()
        sim.reset(carom.scenes.two_balls())
        assert "two_balls(" in sim.as_python()

    def test_the_seed_of_other_spheres_is_not_told(self):
        sim = carom.Simulation(carom.scenes.gas(n=5, seed=7))
        sim.remove(0)
        assert "seed" not in sim.as_python() + sim.as_toml()

    def test_overlaps_that_ticks_leave_are_refused(self):
        sim = carom.Simulation(method="tick", tick=0.3)
        sim.add(position=(-2, 0, 0), velocity=(1, 0, 0))
        sim.add(position=(2, 0, 0), velocity=(-1, 0, 0))
        sim.run(until=1.8)
        for write in (sim.as_python, sim.as_toml, sim.as_command):
            with pytest.raises(carom.OverlapError, match="spheres 0 and 1 overlap by"):
                write()


class TestWithoutScene:
    def test_a_line_for_each_sphere(self):
        sim = carom.Simulation(
            walls=[carom.Periodic(9, None, 8.5), carom.Plane((0, 1, 0), -5, 1, "bounce-back")],
            gravity=(0, -1, 0),
        )
        sim.add()
        sim.add(position=(0.1, 2, -0.0), velocity=(0.1 + 0.2, 0, 0), radius=0.25, mass=1 / 3)
        sim.add(position=(3, 0, 0), color="red", species=2)
        sim.add(position=(0, -2, 0), fixed=True)
        text = sim.as_python()
        assert text == (
            "import carom\n\n"
            "sim = carom.Simulation(\n"
            "    walls=[carom.Periodic(9, None, 8.5),"
            ' carom.Plane((0, 1, 0), -5, reflection="bounce-back")],\n'
            "    gravity=(0, -1, 0),\n)\n"
            "sim.add(position=(0, 0, 0))\n"
            "sim.add(position=(0.1, 2, -0.0), velocity=(0.30000000000000004, 0, 0), radius=0.25,"
            " mass=0.3333333333333333)\n"
            'sim.add(position=(3, 0, 0), species=2, color="#ff0000")\n'
            "sim.add(position=(0, -2, 0), fixed=True)\n"
            "sim.show()\n"
        )
        file = carom.Simulation(parse(sim.as_toml()))
        assert file.scene.color == "own"  # as the view shows spheres without a scene
        assert agree(sim, pasted(text), file) > 0

    @pytest.mark.parametrize("n", [1, 2, 30, 31, 2000])
    def test_more_than_thirty_come_as_arrays(self, n):
        rng = np.random.default_rng(n)
        sim = carom.Simulation(walls=carom.Box(40, 40, 40))
        grid = np.stack(np.meshgrid(*[np.arange(13) * 3.0 - 18] * 3), -1).reshape(-1, 3)[:n]
        sim.add_many(
            grid + rng.uniform(-0.5, 0.5, grid.shape),
            velocity=rng.normal(size=grid.shape),
            radius=rng.uniform(0.2, 0.9, n),
            mass=2,
            species=rng.integers(0, 3, n),
        )
        text = sim.as_python()
        assert (text.count("sim.add(") == n) == (n <= 30)
        assert ("sim.add_many(" in text) == (n > 30)
        assert agree(sim, pasted(text), carom.Simulation(parse(sim.as_toml()))) > 0

    def test_too_many(self):
        sim = carom.Simulation()
        grid = np.stack(np.meshgrid(*[np.arange(28.0)] * 3), -1).reshape(-1, 3)
        sim.add_many(grid[:2001])
        with pytest.raises(carom.InputError, match=r"2001 spheres are too many .* as_toml\(\)"):
            sim.as_python()
        assert len(parse(sim.as_toml()).spheres) == 2001
        sim.add_many(grid[2001:20_001])
        with pytest.raises(carom.InputError, match="20001 spheres are too many for a scene file"):
            sim.as_toml()
        large = carom.Simulation(carom.scenes.fluid(n=32_000))
        assert "fluid(n=32000)" in large.as_python()
        assert "n = 32000" in large.as_toml()

    def test_nothing_at_all(self):
        sim = carom.Simulation()
        assert sim.as_python() == "import carom\n\nsim = carom.Simulation()\nsim.show()\n"
        assert len(parse(sim.as_toml()).spheres) == 0
        assert len(pasted(sim.as_python())) == 0

    def test_an_engine_of_ones_own_is_only_mentioned(self):
        text = gas(ExactEngine).as_python()
        assert "\n# The engine of its own is not written here.\nsim = carom.Simulation(" in text
        assert pasted(text).method == "exact"


number = st.floats(-1e6, 1e6, allow_subnormal=False)
positive = st.floats(1e-3, 1e3)
share = st.floats(0, 1)
turn = st.sampled_from(["specular", "bounce-back"])
triple = st.tuples(number, number, number)
one_wall = st.one_of(
    st.builds(carom.Box, positive, positive, positive, share, turn),
    st.builds(carom.Sphere, positive, share, turn),
    st.builds(carom.Cylinder, positive, positive, share, turn),
    st.builds(carom.Plane, triple.filter(any), number, share, turn),
    st.builds(carom.Periodic, positive, st.none() | positive, st.none() | positive),
    st.builds(carom.Open),
)


@settings(max_examples=150, deadline=None)
@given(
    walls=st.lists(one_wall, max_size=3),
    rule=st.builds(carom.Smooth, share, st.none() | positive),
    camera=st.none() | st.builds(carom.Camera, triple, st.just((1e7, 0.0, 0.0))),
    title=st.text(st.characters(exclude_categories=["Cs"]), max_size=20),
    value=number | st.integers(-(2**60), 2**60) | st.booleans() | st.none(),
)
def test_literals_are_what_they_stand_for(walls, rule, camera, title, value):
    from carom.literals import literal

    for each in (*walls, rule, camera, title, value):
        back = eval(literal(each), {"carom": carom})
        assert back == each
        assert repr(back) == repr(each) or isinstance(each, float)
