"""What a page is told about a scene."""

import json

import numpy as np
import pytest

import carom
from carom import scenes
from carom.view.portrait import portrait


def told(sim):
    return json.loads(json.dumps(portrait(sim, sim.state, 7, (20.0, 5.0)), allow_nan=False))


def test_the_papers_phases_keep_the_papers_look():
    for phase in (scenes.phase_0, scenes.phase_1, scenes.phase_2, scenes.phase_3, scenes.phase_4):
        about = told(carom.Simulation(phase()))
        assert about["wire"] is True
        assert about["color"] == "energy"
        assert about["pace"] == 60


def test_walls_as_the_engine_counts_them():
    about = told(carom.Simulation(scenes.phase_1()))
    assert [wall["offset"] for wall in about["walls"]] == [-250] * 6
    assert np.array(about["walls"][1]["normal"]) == pytest.approx([-1, 0, 0])
    assert told(carom.Simulation(scenes.phase_0()))["walls"] == [
        {"kind": 1, "normal": [0, 0, 0], "offset": 500, "restitution": 1, "name": "Sphere"}
    ]
    assert about["walls"][1]["name"] == "x+ wall of the Box"
    bounce = told(carom.Simulation(scenes.bounce(restitution=0.7)))
    assert [bounce["restitution"], bounce["walls"][0]["restitution"]] == [0.7, 0.7]


def test_where_it_comes_from():
    about = told(carom.Simulation(scenes.phase_3(n=5)))
    assert about["origin"] == {"name": "phase-3", "options": {"n": 5, "width": 500, "seed": 1}}
    assert (about["key"], about["method"]) == (7, "exact")
    own = told(carom.Simulation(carom.Scene(carom.Spheres.of((0, 0, 0)))))
    assert own["origin"] is None


def test_axes_along_which_momentum_is_conserved():
    assert told(carom.Simulation(scenes.fluid(n=32)))["free_axes"] == 3
    assert told(carom.Simulation(scenes.gas(n=5)))["free_axes"] == 0


def test_a_scene_of_ones_own():
    sim = carom.Simulation()
    sim.add((0, 0, 0), velocity=(3, 0, 0), mass=2)
    sim.add((4, 0, 0), fixed=True)
    about = told(sim)
    assert about["full_energy"] == 20
    assert about["full_speed"] == 5
    assert about["full_gravity"] == 5  # 2.5 times 9 over 4
    assert about["color"] == "own"
    assert (about["low"], about["high"]) == ([-0.5, -0.5, -0.5], [4.5, 0.5, 0.5])


def test_camera_of_the_scene():
    camera = carom.scene.Camera((1, 2, 3), (0, 0, 1))
    scene = carom.Scene(carom.Spheres.of((0, 0, 0)), camera=camera, title="t")
    about = told(carom.Simulation(scene))
    assert about["camera"] == {"position": [1, 2, 3], "target": [0, 0, 1]}
    assert about["title"] == "t"
