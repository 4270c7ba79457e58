"""Nothing repeats for ever: sticking, rest and wake, the contact-time cure, the watchdog."""

import math

import numpy as np
import pytest

from carom.engine import FastEngine, Stop
from carom.reference.exact import ExactEngine
from carom.state import CAME_TO_REST, WOKE
from carom.world import World

from .worlds import DOWN, UP, ball, box, energy, gas, plane, run, spheres, walls

each_engine = pytest.mark.parametrize("engine", [FastEngine, ExactEngine])
DRAWS = range(25)


def direction(seed):
    """A unit vector along no axis, and another one across it."""
    n, across = np.random.default_rng(seed).normal(size=(2, 3))
    n /= np.linalg.norm(n)
    across -= (across @ n) * n
    return n, across / np.linalg.norm(across)


class TestNoRepeat:
    @each_engine
    @pytest.mark.parametrize("seed", DRAWS)
    def test_spheres_that_stick_meet_once(self, engine, seed):
        n, across = direction(seed)
        state = spheres([-2 * n, 2 * n], [n + 0.2 * across, -n])
        engine = engine(state, World(restitution=0.0))
        assert run(engine) is Stop.IDLE
        assert engine.collisions == 1

    @each_engine
    @pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
    def test_a_touch_without_speed_happens_once(self, engine, restitution):
        state = spheres([(0, 0, 0), (1, 0, 0)], [(1e-15, 1, 0), (0, 1, 0)])
        engine = engine(state, World(restitution=restitution))
        assert run(engine) is Stop.IDLE
        assert engine.collisions == 1
        speeds = engine.state().velocity[:, 0]
        assert speeds[1] - speeds[0] == pytest.approx(restitution * 1e-15, abs=1e-30)

    @each_engine
    @pytest.mark.parametrize("pull", [0.0, 1.0])
    @pytest.mark.parametrize("seed", DRAWS)
    def test_a_ball_dead_on_a_plane_or_lid_leaves_it(self, engine, seed, pull):
        n, across = direction(seed)
        world = World(walls=walls(plane(n, 0.0, 0.0)), gravity=pull * (n + 0.3 * across))
        engine = engine(spheres(3 * n, across - 4 * n), world)
        assert run(engine, 50.0) is Stop.TIME
        assert engine.wall_collisions == 1

    @each_engine
    @pytest.mark.parametrize("seed", DRAWS)
    def test_a_ball_dead_under_a_fixed_one_falls_off(self, engine, seed):
        n, _ = direction(seed)
        engine = engine(
            spheres([(0, 0, 0), 2 * n], [(0, 0, 0), -5 * n], fixed=[True, False]),
            World(gravity=n, restitution=0.0),
        )
        assert run(engine, 50.0) is Stop.TIME
        assert engine.collisions == 1
        assert engine.state().position[1] @ n > 1000.0

    @each_engine
    @pytest.mark.parametrize("seed", DRAWS)
    def test_a_ball_dead_under_the_top_of_a_sphere_falls(self, engine, seed):
        n, _ = direction(seed)
        engine = engine(
            spheres((0, 0, 0), -5 * n), World(gravity=n, walls=walls(ball(3.0, restitution=0.0)))
        )
        assert run(engine, 1.5, max_events=100) is Stop.TIME
        assert engine.wall_collisions < 20
        assert engine.state().position[0] @ n > -2.5


class TestRest:
    @each_engine
    @pytest.mark.parametrize("restitution", [0.0, 0.5, 0.9])
    def test_a_dropped_ball_stops_when_it_should(self, engine, restitution):
        """t = sqrt(2 h/g) (1 + e)/(1 - e); all bounces after the last one counted are left out."""
        world = World(walls=walls(plane(UP, 0.0, restitution)), gravity=2 * DOWN)
        engine = engine(spheres((0, 0, 1.5), (0.25, 0, 0)), world)
        assert run(engine) is Stop.IDLE
        last = engine.take_events()[-1]
        assert last["j"] == CAME_TO_REST
        end = math.sqrt(2 * 1.0 / 2.0) * (1 + restitution) / (1 - restitution)
        assert last["time"] == pytest.approx(end, rel=1e-3)
        run(engine, 50.0)
        state = engine.state()
        assert state.resting[0]
        assert tuple(state.velocity[0]) == (0.25, 0.0, 0.0)
        assert state.position[0] == pytest.approx((50 * 0.25, 0, 0.5), rel=1e-12)
        assert engine.dissipated == pytest.approx(2.0, rel=1e-9)

    def test_an_elastic_ball_never_stops(self):
        world = World(walls=walls(plane(UP)), gravity=DOWN)
        engine = FastEngine(spheres((0, 0, 2.0)), world)
        run(engine, 10_000.0)
        assert not engine.state().resting[0]
        assert energy(engine.state(), world) == pytest.approx(2.0, rel=1e-12)

    @each_engine
    def test_a_blow_wakes(self, engine):
        world = World(walls=walls(plane(UP, 0.0, 0.5)), gravity=DOWN)
        state = spheres([(0, 0, 0.5), (1.5, 0, 1.5)], [(0, 0, 0), (-2, 0, 0)])
        state.resting[:] = [True, False]
        engine = engine(state, world)
        run(engine, max_collisions=1)
        cause, woke = engine.take_events()[-2:]
        assert (cause["i"], cause["j"]) == (0, 1)
        assert (woke["i"], woke["j"], woke["time"]) == (0, WOKE, cause["time"])
        assert not woke["impulse"].any()
        assert not engine.state().resting.any()
        assert run(engine) is Stop.IDLE
        assert engine.state().resting.all()

    @each_engine
    def test_a_level_blow_leaves_both_at_rest(self, engine):
        world = World(walls=walls(plane(UP, 0.0, 0.5)), gravity=DOWN)
        state = spheres([(0, 0, 0.5), (2.5, 0, 0.5)], [(0, 0, 0), (-2, 0, 0)])
        state.resting[:] = True
        engine = engine(state, world)
        run(engine, 5.0)
        assert engine.state().resting.all()
        assert engine.take_events()["j"].tolist() == [1]
        assert engine.state().velocity[:, 0].tolist() == [-2.0, 0.0]

    def test_a_heap_settles(self):
        world = World(walls=box(7.0, 0.5), restitution=0.5, gravity=DOWN)
        engine = FastEngine(gas(2, 2.5), world, log=False)
        run(engine, 60.0)
        state = engine.state()
        assert state.resting.all()
        assert state.position[:, 2] == pytest.approx(np.full(8, -3.0), abs=1e-8)
        lost = energy(gas(2, 2.5), world) - energy(state, world)
        assert engine.dissipated == pytest.approx(lost, rel=1e-9)

    def test_a_ball_slides_down_a_slope(self):
        slope = np.array([0.6, 0.0, 0.8])
        world = World(walls=walls(plane(slope, 0.0, 0.9)), gravity=DOWN)
        engine = FastEngine(spheres(0.5 * slope), world, log=False)
        run(engine, 3.0)
        state = engine.state()
        assert not state.resting[0]
        down = np.array([0.8, 0.0, -0.6])
        assert state.position[0] @ down == pytest.approx(0.5 * 0.6 * 3.0**2, rel=1e-6)
        assert state.position[0] @ slope == pytest.approx(0.5, abs=1e-8)

    def test_a_ball_on_a_ball_stays_there(self):
        world = World(walls=walls(plane(UP, 0.0, 0.5)), restitution=0.5, gravity=DOWN)
        engine = FastEngine(spheres([(0, 0, 0.5), (0, 0, 1.6)]), world, log=False)
        assert run(engine, 3.0) is Stop.TIME
        assert engine.state().position[:, 2] == pytest.approx([0.5, 1.5], abs=1e-6)


class TestCollapse:
    def line(self, **options):
        """Three on a line, the outer ones closing in: they collapse if e < 7 - 4 sqrt(3)."""
        state = spheres([(-2, 0, 0), (0, 0, 0), (2, 0, 0)], [(1, 0, 0), (0, 0, 0), (-1, 0, 0)])
        state.position[1, 0] = 0.01  # one after the other, not both at once
        return FastEngine(state, World(**options))

    def test_the_watchdog_stops_it(self):
        engine = self.line(restitution=0.05)
        assert run(engine) is Stop.COLLAPSE
        time, i, j = engine.collapse
        assert (i, j) in {(0, 1), (1, 2)}
        assert time == engine.time == pytest.approx(1.0, abs=0.1)
        end = engine.state()
        assert np.isfinite(end.position).all()
        assert end.velocity.sum() == pytest.approx(0.0, abs=1e-12)
        assert engine.max_overlap() < 1e-12
        assert engine.advance(math.inf) is Stop.COLLAPSE

    @pytest.mark.parametrize("restitution", [0.09, 0.5, 1.0])
    def test_it_stays_silent_above_the_threshold(self, restitution):
        engine = self.line(restitution=restitution)
        assert run(engine) is Stop.IDLE
        assert engine.collapse is None
        assert engine.collisions <= 10

    def test_contact_time_cures_it(self):
        engine = self.line(restitution=0.05, contact_time=1e-3)
        assert run(engine) is Stop.IDLE
        assert engine.collapse is None
        assert engine.withheld > 0.0

    @each_engine
    def test_what_the_cure_withholds(self, engine):
        """The second collision within the contact time is elastic and keeps (1 - e^2)/4 v_n^2."""
        state = spheres([(0, 0, 0), (2, 0, 0), (3.5, 0, 0)], [(1, 0, 0), (0, 0, 0), (0, 0, 0)])
        engine = engine(state, World(restitution=0.5, contact_time=10.0))
        run(engine, max_collisions=2)
        assert engine.dissipated == pytest.approx(0.25 * 0.75, rel=1e-14)
        assert engine.withheld == pytest.approx(0.25 * 0.75 * 0.75**2, rel=1e-14)
        assert engine.state().velocity[:, 0] == pytest.approx([0.25, 0.0, 0.75], rel=1e-15)

    @each_engine
    def test_the_cure_ends_with_the_contact_time(self, engine):
        state = spheres([(0, 0, 0), (2, 0, 0), (3.5, 0, 0)], [(1, 0, 0), (0, 0, 0), (0, 0, 0)])
        engine = engine(state, World(restitution=0.5, contact_time=0.6))  # 2/3 between the two
        run(engine, max_collisions=2)
        assert engine.withheld == 0.0
        assert engine.dissipated == pytest.approx(0.25 * 0.75 * (1 + 0.75**2), rel=1e-14)

    @each_engine
    def test_a_wall_takes_part_in_the_cure(self, engine):
        world = World(walls=walls(plane((1, 0, 0), 0.0, 0.5)), contact_time=10.0)
        engine = engine(spheres([(2, 0, 0), (4, 0, 0)], [(0, 0, 0), (-1, 0, 0)]), world)
        run(engine, max_events=2)
        assert engine.dissipated == 0.0
        assert engine.withheld == pytest.approx(0.5 * 0.75, rel=1e-15)

    def test_an_elastic_squeeze_is_no_collapse(self):
        """A heavy ball drives a light one into a wall: 3141 collisions, ever faster."""
        heavy = spheres([(2, 0, 0), (5, 0, 0)], [(0, 0, 0), (-1, 0, 0)], mass=[1.0, 1e6])
        engine = FastEngine(heavy, World(walls=walls(plane((1, 0, 0), 0.0, 1.0))))
        assert run(engine) is Stop.IDLE
        assert engine.collisions + engine.wall_collisions == 3141
