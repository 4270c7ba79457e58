"""The paper's tick method, flaws included."""

import math

import numpy as np
import pytest

import carom
from carom.engine import Stop
from carom.errors import InputError
from carom.reference.tick import TickEngine
from carom.state import EVENT, State
from carom.world import CYLINDER, PLANE, SPHERE, WALL, World


def scene(position, velocity, **more):
    state = State.empty(len(position))
    state.position[:], state.velocity[:] = position, velocity
    for name, values in more.items():
        getattr(state, name)[:] = values
    return state


def planes(half, *, bounce_back=0, restitution=1.0, axes=(0, 1, 2)):
    normals = [[s * (k == axis) for k in range(3)] for axis in axes for s in (1, -1)]
    return np.array([(PLANE, bounce_back, n, -half, restitution) for n in normals], WALL)


def crowd(count, seed=1, half=50.0, speed=3.0):
    """Balls of radius 5 and all masses on a lattice of their own in a cube."""
    rng = np.random.default_rng(seed)
    places = (np.stack(np.meshgrid(*[range(4)] * 3), -1).reshape(-1, 3) - 1.5) * 0.4 * half
    state = scene(places[:count], speed * rng.normal(size=(count, 3)))
    state.radius[:], state.mass[:] = 0.1 * half, rng.uniform(0.5, 2.0, count)
    return state


def fly(engine, until):
    while (stop := engine.advance(until)) is Stop.SLICE:
        pass
    assert stop is Stop.TIME


def energy(state):
    return 0.5 * np.sum(state.mass[:, None] * state.velocity**2)


def test_a_ball_moves_by_its_velocity_each_tick():
    engine = TickEngine(scene([(1, 2, 3)], [(10, 20, 30)]), World())
    fly(engine, 3.0)
    assert engine.state().position.tolist() == [[31.0, 62.0, 93.0]]


def test_the_last_tick_is_shortened():
    engine = TickEngine(scene([(0, 0, 0)], [(1, 0, 0)]), World(), tick=0.4)
    fly(engine, 1.0)
    state = engine.state()
    assert engine.time == state.time == 1.0
    assert state.position[0, 0] == pytest.approx(1.0)


def test_a_contact_counts_once_until_the_balls_have_parted():
    slow = scene([(-0.6, 0, 0), (0.6, 0, 0)], [(0.02, 0, 0), (-0.02, 0, 0)])
    engine = TickEngine(slow, World(restitution=0.1))
    fly(engine, 12.0)  # they stay overlapped for many ticks after the collision
    assert engine.collisions == 1
    assert engine.max_overlap() > 0.0
    fly(engine, 1000.0)
    assert engine.collisions == 1


def test_the_impulse_is_the_papers():
    a, b = np.array([1.0, -2.0, 0.5]), np.array([-1.0, 0.5, 0.0])
    start = scene([(-0.5, 0.1, 0), (0.6, -0.1, 0.2)], [a, b], mass=[1.0, 3.0])
    engine = TickEngine(start, World(restitution=0.6), tick=0.125)
    fly(engine, 0.125)
    line = (start.position[0] + a / 8) - (start.position[1] + b / 8)
    n = line / np.linalg.norm(line)
    strength = 1.6 * ((a - b) @ n) / (1.0 + 1.0 / 3.0)
    assert engine.collisions == 1
    np.testing.assert_allclose(engine.state().velocity[0], a - strength * n, rtol=1e-14)
    np.testing.assert_allclose(engine.state().velocity[1], b + strength / 3.0 * n, rtol=1e-14)
    event = engine.take_events()[0]
    assert event["time"] == 0.125
    np.testing.assert_allclose(event["impulse"], -strength * n, rtol=1e-14)
    lost = energy(start) - energy(engine.state())
    assert engine.dissipated == pytest.approx(lost)


def test_elastic_contacts_keep_energy_and_momentum():
    start = crowd(40)
    engine = TickEngine(start, World())
    fly(engine, 100.0)
    end = engine.state()
    assert engine.collisions > 5
    assert energy(end) == pytest.approx(energy(start), rel=1e-12)
    momentum = [state.mass @ state.velocity for state in (start, end)]
    np.testing.assert_allclose(*momentum, atol=1e-11)
    assert engine.dissipated == engine.withheld == 0.0
    assert engine.collapse is None
    assert end.collision_count.sum() == 2 * engine.collisions


def test_each_wall_of_a_cube_flips_its_own_component():
    engine = TickEngine(scene([(8, 0, 0)], [(3, 2, 1)]), World(walls=planes(10.0)))
    fly(engine, 1.0)
    assert engine.state().velocity.tolist() == [[-3.0, 2.0, 1.0]]
    (event,) = engine.take_events()
    assert (event["time"], event["i"], event["j"]) == (1.0, 0, -2)
    assert event["impulse"].tolist() == [-6.0, 0.0, 0.0]


def test_bounce_back_reverses_the_whole_velocity():
    wall = np.array([(SPHERE, 1, (0, 0, 0), 10.0, 1.0)], WALL)
    engine = TickEngine(scene([(8, 0, 0)], [(3, 2, 1)]), World(walls=wall))
    fly(engine, 1.0)
    assert engine.state().velocity.tolist() == [[-3.0, -2.0, -1.0]]
    assert engine.wall_collisions == 1


@pytest.mark.parametrize("kind", [SPHERE, CYLINDER])
def test_a_specular_curved_wall_reflects(kind):
    wall = np.array([(kind, 0, (0, 0, 0), 10.0, 0.5)], WALL)
    engine = TickEngine(scene([(8, 0, 0)], [(3, 0, 0.1)]), World(walls=wall))
    fly(engine, 1.0)
    expected = (-1.5, 0, 0.1)
    if kind == SPHERE:
        n = np.array([11.0, 0, 0.1]) / math.hypot(11.0, 0.1)
        expected = np.array([3, 0, 0.1]) - 1.5 * (n @ [3, 0, 0.1]) * n
    np.testing.assert_allclose(engine.state().velocity[0], expected, rtol=1e-14)


def test_a_ball_far_outside_a_wall_flips_every_tick_and_sticks():
    engine = TickEngine(scene([(30, 0, 0)], [(1, 0, 0)]), World(walls=planes(10.0)))
    fly(engine, 8.0)
    assert engine.wall_collisions == 8
    assert engine.state().position[0, 0] == 31.0 - 1.0


def test_fast_balls_tunnel_and_the_miss_is_counted():
    start = scene([(-4, 0, 0), (4, 0, 0)], [(5, 0, 0), (-5, 0, 0)])
    engine = TickEngine(start, World(), count_missed=True)
    fly(engine, 5.0)
    assert engine.collisions == 0
    assert engine.missed == 1


def test_a_short_tick_misses_nothing():
    start = scene([(-4, 0, 0), (4, 0, 0)], [(5, 0, 0), (-5, 0, 0)])
    engine = TickEngine(start, World(), tick=0.01, count_missed=True)
    fly(engine, 2.0)
    assert engine.collisions == 1
    assert engine.missed == 0


def test_a_touch_at_the_very_end_of_a_tick_is_not_missed():
    start = scene([(-2.5, 0, 0), (2.5, 0, 0)], [(0.25, 0, 0), (-0.25, 0, 0)])
    engine = TickEngine(start, World(), count_missed=True)
    fly(engine, 8.0)
    assert engine.collisions == engine.missed == 0
    fly(engine, 20.0)
    assert engine.collisions == 1
    assert engine.missed == 0


def test_a_crowd_misses_some_and_fewer_with_shorter_ticks():
    missed = []
    for tick in (2.0, 0.1):
        engine = TickEngine(crowd(40), World(walls=planes(60.0)), tick=tick, count_missed=True)
        fly(engine, 100.0)
        missed.append(engine.missed)
    assert missed[0] > 4 * missed[1]


def test_gravity_adds_to_the_velocity_each_tick():
    engine = TickEngine(scene([(0, 0, 0)], [(1, 0, 0)]), World(gravity=np.array([0, 0, -2.0])))
    fly(engine, 3.0)
    assert engine.state().velocity.tolist() == [[1.0, 0.0, -6.0]]
    assert engine.state().position.tolist() == [[3.0, 0.0, -12.0]]


def test_balls_that_do_not_collide_pass_through_one_another():
    start = scene([(-0.2, 0, 0), (0.2, 0, 0)], [(0.1, 0, 0), (-0.1, 0, 0)])
    engine = TickEngine(start, World(collide=False), count_missed=True)
    fly(engine, 10.0)
    assert engine.collisions == engine.missed == 0
    assert engine.max_overlap() == 0.0


def test_a_contact_across_the_border_of_a_periodic_box():
    start = scene([(-4.75, 0, 0), (4, 0, 0)], [(-0.5, 0, 0), (0.25, 0, 0)])
    engine = TickEngine(start, World(period=np.array([10.0, 0, 0])))
    fly(engine, 1.0)
    state = engine.state()
    assert engine.collisions == 1
    assert state.position[:, 0].tolist() == [4.75, 4.25]
    assert state.image[:, 0].tolist() == [-1, 0]
    assert state.velocity[:, 0].tolist() == [0.25, -0.5]


def test_a_fixed_ball_stays():
    start = scene([(0, 0, 0), (2, 0, 0)], [(0, 0, 0), (-1, 0, 0)], fixed=[1, 0])
    start.mass[0] = math.inf
    engine = TickEngine(start, World(gravity=np.array([0, -1e-3, 0]), walls=planes(0.1)))
    fly(engine, 2.0)
    state = engine.state()
    assert state.position[0].tolist() == state.velocity[0].tolist() == [0.0, 0.0, 0.0]


def test_one_ball_exactly_on_another_is_pushed_back_along_its_way():
    start = scene([(-5, 0, 0), (5, 0, 0)], [(5, 0, 0), (-5, 0, 0)])
    engine = TickEngine(start, World())
    fly(engine, 1.0)
    assert engine.state().velocity[:, 0].tolist() == [-5.0, 5.0]


def test_it_stops_after_the_tick_that_reaches_the_count():
    engine = TickEngine(crowd(40), World(walls=planes(60.0)))
    while (stop := engine.advance(math.inf, max_collisions=5)) is Stop.SLICE:
        pass
    assert stop is Stop.COUNT
    assert engine.collisions >= 5
    events = engine.take_events()
    assert events.dtype == EVENT
    assert np.sum(events["j"] >= 0) == engine.collisions
    assert np.sum(events["j"] < 0) == engine.wall_collisions
    assert engine.advance(math.inf, max_events=0) is Stop.COUNT


def test_nothing_that_stands_still_is_waited_for():
    engine = TickEngine(scene([(0, 0, 0)], [(0, 0, 0)]), World())
    assert engine.advance(math.inf) is Stop.IDLE
    fly(engine, 5.0)
    assert engine.time == 5.0


@pytest.mark.parametrize("tick", [0.0, -1.0, math.inf, math.nan])
def test_a_tick_must_be_a_step_in_time(tick):
    with pytest.raises(InputError, match="tick"):
        TickEngine(State.empty(1), World(), tick=tick)


def test_the_past_is_refused():
    engine = TickEngine(State.empty(1), World())
    fly(engine, 2.0)
    with pytest.raises(InputError, match="already"):
        engine.advance(1.0)


class TestTwin:
    """`Simulation.in_ticks` and `missed`."""

    def test_it_starts_where_the_scene_starts(self):
        sim = carom.Simulation(carom.scenes.phase_4(n=6), gravity=(0, 0, -0.01))
        start = sim.state
        sim.run(until=30)
        sim.gravity = (0, 0, 0)
        twin = sim.in_ticks()
        assert (twin.method, twin.tick, twin.time, twin.collisions) == ("tick", 1.0, 0, 0)
        assert twin.scene is sim.scene
        assert (twin.walls, twin.gravity.tolist()) == (sim.walls, [0, 0, -0.01])
        assert np.array_equal(twin.position, start.position)
        assert np.array_equal(twin.velocity, start.velocity)
        twin.run(until=10)
        twin.remove(0)
        assert (sim.time, len(sim), sim.method) == (30, 6, "exact")
        assert np.array_equal(start.position, sim.in_ticks().position)

    def test_without_a_scene_it_starts_from_the_spheres_there_are(self):
        sim = carom.Simulation(walls=carom.Box(9, 9, 9), rule=carom.Smooth(0.5), keep_events=4)
        sim.add(velocity=(1, 2, 3))
        sim.add(position=(2, 0, 0))
        twin = sim.in_ticks(0.25)
        assert (twin.tick, twin.scene, twin.rule) == (0.25, None, carom.Smooth(0.5))
        assert sim.in_ticks().tick == 1 / 60
        twin.run(until=20)
        assert twin.wall_collisions > 4 == len(twin.events)
        twin.reset()
        assert twin.velocity[0].tolist() == [1, 2, 3]
        assert sim.wall_collisions == 0

    def test_what_is_missed_is_counted_through_changes(self):
        # Two fast balls pass through one another within a tick; exact flight has them collide.
        sim = carom.Simulation()
        for side in (-1.0, 1.0):
            sim.add(position=(2.5 * side, 0, 0), velocity=(-4 * side, 0, 0))
        twin = sim.in_ticks(1)
        twin.run(until=2)
        assert (twin.collisions, twin.missed) == (0, 1)
        twin.gravity = (0, 0, 0)
        twin.velocity = -twin.velocity
        twin.run(until=4)
        assert (twin.collisions, twin.missed) == (0, 2)
        mark = twin.bookmark()
        twin.reset()
        assert twin.missed == 0
        twin.return_to(mark)
        assert twin.missed == 2
        sim.run(until=4)
        assert (sim.collisions, sim.missed) == (1, 0)

    def test_the_method_by_its_name_counts_too(self):
        scene = carom.scenes.phase_4()
        by_name = carom.Simulation(scene, method="tick", tick=1)
        twin = carom.Simulation(scene, method="reference").in_ticks()
        for sim in (by_name, twin):
            sim.run(until=100)
        assert by_name.missed == twin.missed > 0
        assert np.array_equal(by_name.position, twin.position)

    @pytest.mark.parametrize("tick", [0, -1, math.nan, "a"])
    def test_a_tick_is_above_0(self, tick):
        with pytest.raises(carom.InputError, match="tick"):
            carom.Simulation(carom.scenes.two_balls()).in_ticks(tick)
