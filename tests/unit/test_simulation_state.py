"""Simulation: arrays, balls, additions and the world, read and assigned."""

import math

import numpy as np
import pytest

import carom

from .gases import each_method, gas


class TestArrays:
    @each_method
    def test_they_are_read_only_and_of_their_moment(self, method):
        sim = gas(method)
        before = sim.position
        start = before.copy()
        for name in ("position", "velocity", "mass", "radius", "unwrapped_position", "gravity"):
            with pytest.raises(ValueError, match="read-only"):
                getattr(sim, name)[0] = 7
        sim.run(until=0.3)
        sim.velocity = 0
        assert np.array_equal(before, start)

    @each_method
    def test_velocity_reversed_is_time_reversed(self, method):
        sim = gas(method)
        start = sim.position
        sim.run(until=4)
        assert sim.collisions > 10
        sim.velocity = -sim.velocity
        sim.run(duration=4)
        assert sim.position == pytest.approx(start, abs=1e-9)

    def test_one_value_for_all(self):
        sim = gas()
        sim.velocity = (1, 2, 3)
        assert np.array_equal(sim.velocity, np.tile([1, 2, 3], (len(sim), 1)))
        sim.mass = 2
        assert sim.kinetic_energy == len(sim) * 14
        sim.radius = 0.25
        assert sim.radius.tolist() == [0.25] * len(sim)
        sim.color = "#010203"
        assert set(sim.color.tolist()) == {0x010203}
        sim.species = np.arange(len(sim))
        assert sim.species[3] == 3

    def test_a_refused_assignment_changes_nothing(self):
        sim = gas()
        for name, value, kind in [
            ("radius", 1.5, carom.InputError),
            ("radius", -1, carom.InputError),
            ("mass", math.inf, carom.InputError),
            ("position", np.zeros((len(sim), 3)), carom.OverlapError),
            ("position", np.zeros((2, 3)), carom.InputError),
            ("position", sim.position + 100, carom.OverlapError),
            ("velocity", math.nan, carom.InputError),
            ("velocity", np.zeros((2, 3)), carom.InputError),
            ("color", "rde", carom.UnknownNameError),
        ]:
            before = sim.state
            with pytest.raises(kind):
                setattr(sim, name, value)
            assert np.array_equal(getattr(sim, name), getattr(before, name))

    def test_mass_of_fixed_spheres_stays_infinite(self):
        sim = carom.Simulation()
        rock = sim.add(fixed=True)
        sim.add(position=(2, 0, 0))
        sim.mass = 2 * sim.mass
        assert sim.mass.tolist() == [math.inf, 2]
        sim.mass = 5
        assert sim.mass.tolist() == [math.inf, 5]
        with pytest.raises(carom.InputError, match="sphere 0 is fixed"):
            rock.mass = 3
        with pytest.raises(carom.InputError, match="sphere 0 is fixed but has velocity"):
            sim.velocity = (1, 0, 0)

    @each_method
    def test_unwrapped_position(self, method):
        sim = carom.Simulation(walls=carom.Periodic(10, 10, None), method=method)
        ball = sim.add(velocity=(3, -1, 2))
        sim.run(until=10)
        assert sim.position[0] == pytest.approx([0, 0, 20])
        assert sim.unwrapped_position[0] == pytest.approx([30, -10, 20])
        ball.position = (12, 0, 0)
        assert ball.position.tolist() == [2, 0, 0]
        assert sim.unwrapped_position[0] == pytest.approx([42, -10, 0])

    def test_state_is_a_copy(self):
        sim = gas()
        sim.state.position[0] = 99
        assert sim.position[0, 0] != 99


class TestBall:
    @each_method
    def test_everything_may_be_assigned(self, method):
        sim = gas(method)
        sim.run(until=0.1)
        ball = sim[0]
        ball.position = (-2, -2, -2)
        ball.velocity = (0, 3, 4)
        ball.mass = 2
        ball.radius = 0.4
        ball.color = "blue"
        ball.species = 7
        assert ball.index == 0
        assert ball.speed == 5
        assert ball.kinetic_energy == 25
        assert (ball.mass, ball.radius, ball.color, ball.species) == (2, 0.4, 0xFF, 7)
        assert sim.velocity[0].tolist() == [0, 3, 4]
        assert repr(ball) == "<Ball 0: position (-2, -2, -2), velocity (0, 3, 4)>"
        sim.run(until=0.2)
        assert ball.position[2] != -2

    def test_a_row_is_read_only(self):
        ball = carom.Simulation().add()
        with pytest.raises(ValueError, match="read-only"):
            ball.velocity[0] = 1

    def test_gone_after_reset(self):
        sim = gas()
        sim.run(until=0.1)
        late = sim.add_many([(0.9, 0.9, 0.9)], radius=0.05)
        ball = sim[late.start]
        sim.reset()
        with pytest.raises(carom.InputError, match="ball 27 is gone"):
            ball.velocity  # noqa: B018
        with pytest.raises(carom.InputError, match="ball 27 is gone"):
            ball.velocity = 0

    def test_index(self):
        sim = gas()
        assert sim[-1].index == len(sim) - 1
        with pytest.raises(IndexError):
            sim[len(sim)]


class TestAdding:
    def test_many(self):
        sim = carom.Simulation()
        assert sim.add_many([(0, 0, 0), (2, 0, 0)], mass=[1, 2], color="red") == slice(0, 2)
        assert sim.add_many([(4, 0, 0)], velocity=(1, 0, 0), fixed=[False]) == slice(2, 3)
        assert sim.mass.tolist() == [1, 2, 1]
        with pytest.raises(carom.UnknownNameError, match="did you mean 'mass'"):
            sim.add_many([(6, 0, 0)], mas=1)
        with pytest.raises(carom.InputError, match="use add_many"):
            sim.add(position=[(6, 0, 0), (8, 0, 0)])
        assert len(sim) == 3

    @each_method
    def test_during_a_run_the_clock_goes_on(self, method):
        sim = gas(method)
        sim.run(until=1)
        hits, walls = sim.collisions, sim.wall_collisions
        with pytest.raises(carom.OverlapError, match="spheres 3 and 27 overlap by"):
            sim.add(sim.position[3])
        sim.walls = carom.Box(40, 40, 40)
        sim.add(position=(15, 0, 0))
        assert (sim.time, sim.collisions, sim.wall_collisions) == (1, hits, walls)
        sim.run(until=2)
        assert sim.collisions >= hits
        assert abs(sim.energy_drift) < 1e-13

    def test_touching_is_welcome(self):
        sim = carom.Simulation(walls=carom.Box(1, 1, 10))
        with pytest.raises(carom.InputError, match="no room"):
            sim.add()
        sim = carom.Simulation(walls=carom.Plane((0, 0, 1), 0))
        sim.add(position=(0, 0, 0.5))
        sim.add(position=(1, 0, 0.5))
        with pytest.raises(carom.OverlapError, match=r"spheres 0 and 2 overlap by 0\.1"):
            sim.add(position=(0, 0, 1.4))
        with pytest.raises(carom.OverlapError, match="the Plane"):
            sim.add(position=(5, 0, 0.4))


class TestWorld:
    @each_method
    def test_rule_gravity_and_walls_may_be_assigned(self, method):
        sim = gas(method)
        sim.run(until=0.2)
        energy = sim.kinetic_energy
        sim.rule = carom.Smooth(0.5)
        sim.walls = carom.Box(6, 6, 6, restitution=0.8)
        sim.gravity = (0, 0, -2)
        assert sim.rule.restitution == 0.5
        assert sim.walls == (carom.Box(6, 6, 6, restitution=0.8),)
        assert sim.gravity.tolist() == [0, 0, -2]
        assert sim.kinetic_energy == energy
        sim.run(until=1)
        assert sim.dissipated > 0
        assert abs(sim.energy_drift) < 1e-13

    def test_contradictions_are_refused_and_change_nothing(self):
        sim = gas(walls=carom.Periodic(10, 10, 10))
        for name, value in [
            ("gravity", (0, 0, -1)),
            ("gravity", (0, 0)),
            ("rule", 0.5),
            ("walls", "box"),
            ("walls", [carom.Periodic(10, 10, 10), carom.Plane((0, 0, 1), -5)]),
            ("walls", carom.Box(4, 4, 4)),
        ]:
            with pytest.raises(carom.InputError):
                setattr(sim, name, value)
        assert sim.walls == (carom.Periodic(10, 10, 10),)
        sim.run(until=0.1)

    @each_method
    @pytest.mark.parametrize("change", ["gravity", "walls", "velocity", "position"])
    def test_a_resting_sphere_wakes(self, method, change):
        floor = carom.Plane((0, 0, 1), 0, restitution=0.3)
        sim = carom.Simulation(walls=floor, gravity=(0, 0, -1), method=method)
        ball = sim.add(position=(0, 0, 1))
        still = sim.add(position=(9, 0, 1))
        sim.run(until=20)
        assert sim.state.resting.tolist() == [True, True]
        if change == "gravity":
            sim.gravity = (0, 0, 1)
        elif change == "walls":
            sim.walls = carom.Plane((0, 0, 1), -5, restitution=0.3)
        elif change == "velocity":
            ball.velocity = (0, 0, 1)
        else:
            ball.position = (0, 0, 3)
        assert not sim.state.resting[0]
        sim.run(duration=0.5)
        assert ball.velocity[2] != 0
        assert (still.velocity[2] != 0) == (change in ("gravity", "walls"))

    @each_method
    def test_periodic_to_box_keeps_places(self, method):
        sim = carom.Simulation(walls=carom.Periodic(10, 10, 10), method=method)
        sim.add(velocity=(7, 0, 0))
        sim.run(until=2)
        sim.walls = carom.Box(10, 10, 10)
        assert sim.position[0] == pytest.approx([4, 0, 0])
        assert sim.unwrapped_position[0] == pytest.approx([4, 0, 0])

    def test_scene_with_changes(self):
        balls = carom.Spheres.of([(0, 0, 0), (2, 0, 0)], velocity=(1, 0, 0))
        scene = carom.Scene(balls, carom.Box(10, 10, 10), pace=3)
        sim = carom.Simulation(scene, gravity=(0, 0, -1), rule=carom.Smooth(0.9))
        assert sim.scene.walls == (carom.Box(10, 10, 10),)
        assert sim.scene.rule == sim.rule == carom.Smooth(0.9)
        assert sim.gravity.tolist() == [0, 0, -1]
        assert sim.pace == 3
        assert carom.Simulation().scene is None
        with pytest.raises(carom.InputError, match="must be a Scene"):
            carom.Simulation("gas")
        with pytest.raises(carom.UnknownNameError, match="did you mean 'exact'"):
            carom.Simulation(scene, method="exakt")
        with pytest.raises(carom.InputError, match="tick"):
            carom.Simulation(scene, method="tick", tick=0)
