"""Simulation: placing, running, stopping."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

import carom
from carom.engine import Stop
from carom.reference.exact import ExactEngine

from .gases import each_method, gas


class TestStudent:
    @each_method
    def test_two_balls(self, method):
        sim = carom.Simulation(method=method)
        red = sim.add(position=(-2, 0, 0), velocity=(1, 0, 0), color="red")
        blue = sim.add(position=(2, 0.4, 0), mass=2, radius=0.7)
        sim.run(until=6)
        # By hand: they touch at distance 1.2, so n = (-√1.28, -0.4, 0)/1.2, and the impulse is
        # 2 m (v·n) n with the reduced mass m = 2/3.
        n = np.array([-math.sqrt(1.28), -0.4, 0]) / 1.2
        impulse = -2 * (2 / 3) * n[0] * n
        assert red.velocity == pytest.approx(np.array([1, 0, 0]) + impulse, abs=1e-14)
        assert blue.velocity == pytest.approx(-impulse / 2, abs=1e-14)
        assert sim.collisions == 1
        assert sim.time == 6
        assert sim.kinetic_energy == pytest.approx(0.5, rel=1e-15)
        assert sim.momentum == pytest.approx([1, 0, 0], abs=1e-15)
        assert red.color == 0xFF0000

    def test_defaults_of_a_sphere(self):
        ball = carom.Simulation().add()
        assert (ball.mass, ball.radius, ball.species, ball.fixed) == (1, 0.5, 0, False)
        assert ball.position.tolist() == ball.velocity.tolist() == [0, 0, 0]

    @each_method
    def test_fixed_sphere_counts_in_no_energy_or_momentum(self, method):
        sim = carom.Simulation(gravity=(0, 0, -1), method=method)
        rock = sim.add(position=(0, 0, -3), radius=2, fixed=True)
        ball = sim.add(position=(0, 0, 1), velocity=(0, 0, -1), mass=3)
        assert rock.fixed
        assert rock.mass == math.inf
        assert rock.kinetic_energy == 0
        assert sim.kinetic_energy == 1.5
        assert sim.potential_energy == 3
        assert sim.momentum.tolist() == [0, 0, -3]
        sim.run(collisions=1)
        assert ball.velocity[2] > 0
        assert rock.velocity.tolist() == [0, 0, 0]
        assert abs(sim.energy_drift) < 1e-14


class TestRun:
    @each_method
    def test_until_and_duration_end_exactly_there(self, method):
        sim = gas(method)
        for end in (0.1, 0.1 + 0.2, 0.77, 1.0):
            sim.run(until=end)
            assert sim.time == end
            assert sim.state.time == end
        sim.run(duration=0.3)
        assert sim.time == 1.3

    @each_method
    def test_counts_end_right_after_the_last(self, method):
        sim = gas(method)
        sim.run(collisions=7)
        assert sim.collisions == 7
        assert sim.events[-1]["time"] == sim.time
        sim.run(collisions=1e1)
        assert sim.collisions == 17
        before = sim.collisions + sim.wall_collisions
        sim.run(events=25)
        assert sim.collisions + sim.wall_collisions == before + 25
        assert len(sim.events) == 25

    @each_method
    def test_nothing_asked_is_nothing_done(self, method):
        sim = gas(method)
        sim.run(until=0.5)
        place = sim.position
        sim.run(until=0.5)
        sim.run(duration=0)
        sim.run(collisions=0)
        sim.run(events=0)
        assert np.array_equal(sim.position, place)
        assert sim.time == 0.5
        assert len(sim.events) == 0

    @each_method
    def test_the_number_of_runs_changes_no_bit(self, method):
        one, many = gas(method), gas(method)
        one.run(until=1)
        for end in np.linspace(0, 1, 14):
            many.run(until=end)
        assert np.array_equal(one.position, many.position)
        assert np.array_equal(one.velocity, many.velocity)

    @pytest.mark.parametrize(
        ("goal", "sentence"),
        [
            ({}, "got none"),
            ({"until": 1, "collisions": 2}, "got until=1 and collisions=2"),
            ({"until": math.nan}, "until is nan"),
            ({"until": math.inf}, "until is inf"),
            ({"until": 0.25}, "the time is 0.5 already"),
            ({"duration": -1}, "at least 0"),
            ({"duration": "long"}, "must be a number"),
            ({"collisions": 1.5}, "whole number"),
            ({"collisions": -1}, "at least 0"),
            ({"events": math.inf}, "finite"),
        ],
    )
    def test_goals_that_cannot_be(self, goal, sentence):
        sim = gas()
        sim.run(until=0.5)
        with pytest.raises(carom.InputError, match=sentence):
            sim.run(**goal)
        assert sim.time == 0.5

    def test_an_empty_simulation_does_not_run(self):
        with pytest.raises(carom.InputError, match="no spheres"):
            carom.Simulation().run(until=1)

    @each_method
    def test_progress_is_called_with_the_simulation(self, method):
        sim, seen = gas(method), []
        sim.run(until=1, progress=lambda s: seen.append((s is sim, s.time)))
        assert seen[-1] == (True, 1)


class TestNothingMoreHappens:
    @each_method
    def test_idle_names_how_many_happened(self, method):
        sim = carom.Simulation(method=method)
        sim.add(position=(-2, 0, 0), velocity=(1, 0, 0))
        sim.add(position=(2, 0, 0))
        with pytest.raises(carom.RunError, match="only 1 of 5 collisions happened"):
            sim.run(collisions=5)
        assert sim.collisions == 1
        with pytest.raises(carom.RunError, match="only 0 of 1 events happened"):
            sim.run(events=1)

    @pytest.mark.parametrize("options", [{}, {"collide": False}])
    def test_bouncing_for_ever_without_a_collision(self, options):
        sim = carom.Simulation(walls=carom.Box(4, 4, 4), **options)
        sim.add(velocity=(1, 0, 0))
        if options:
            sim.add(velocity=(0, 1, 0))
        with pytest.raises(carom.RunError, match="only 0 of 3 collisions happened"):
            sim.run(collisions=3)
        sim.run(events=3)
        assert sim.wall_collisions == 3

    @each_method
    def test_collapse_names_time_spheres_and_cure(self, method):
        # Two outer balls press on the middle one: below e = 7 - 4√3 = 0.072 they collapse.
        sim = carom.Simulation(rule=carom.Smooth(0.05), method=method)
        for x in (-3.0, 0.0, 2.5):
            sim.add(position=(x, 0, 0), velocity=(-np.sign(x), 0, 0))
        with pytest.raises(
            carom.CollapseError, match=r"spheres 1 and 2 collapse at time 1.85714286"
        ) as e:
            sim.run(until=10)
        assert "Smooth(restitution=0.05, contact_time=0.0006)" in str(e.value)
        assert sim.time < 3
        sim.rule = carom.Smooth(0.05, contact_time=1e-3)
        sim.run(until=10)
        assert sim.time == 10
        assert sim.withheld > 0
        assert abs(sim.energy_drift) < 1e-14


class TestEvents:
    @each_method
    def test_absolute_times_of_the_last_run(self, method):
        sim = gas(method)
        sim.run(until=0.5)
        first = sim.events
        assert first.dtype == carom.EVENT
        sim.run(until=1)
        second = sim.events
        assert first["time"].max() <= 0.5 <= second["time"].min()
        assert np.all(np.diff(second["time"]) >= 0)
        pairs = second["j"] >= 0
        assert np.all(second["i"][pairs] < second["j"][pairs])
        assert set(second["j"][~pairs]) <= {-1, -2, -3, -4, -5, -6}

    @each_method
    def test_the_newest_are_kept(self, method):
        everything, few, none = gas(method), gas(method, keep_events=5), gas(method, keep_events=0)
        for sim in (everything, few, none):
            sim.run(until=1)
        assert np.array_equal(few.events, everything.events[-5:])
        assert len(none.events) == 0
        assert np.array_equal(none.position, everything.position)

    def test_batches_beyond_the_limit_are_let_go(self):
        class Batches(ExactEngine):
            def advance(self, until, max_collisions=2**62, max_events=2**62):
                stop = super().advance(until, max_collisions, min(max_events, 3))
                return Stop.SLICE if stop is Stop.COUNT and max_events > 3 else stop

        sim = gas(Batches, keep_events=4)
        sim.run(events=20)
        whole = gas("reference")
        whole.run(events=20)
        assert np.array_equal(sim.events, whole.events[-4:])


class TestReset:
    @each_method
    def test_back_to_the_first_run(self, method):
        sim = gas(method)
        sim.velocity = 2 * sim.velocity
        start = sim.state
        sim.run(until=1)
        first = sim.position
        sim.rule = carom.Smooth(0.5)
        sim.gravity = (0, 0, -1)
        sim.add(position=(0, 0, 0.99), radius=0.01)
        sim.run(until=2)
        sim.reset()
        assert (sim.time, sim.collisions, sim.wall_collisions) == (0, 0, 0)
        assert np.array_equal(sim.position, start.position)
        assert np.array_equal(sim.velocity, start.velocity)
        assert (sim.rule, sim.gravity.tolist()) == (carom.Smooth(), [0, 0, 0])
        assert (sim.dissipated, sim.energy_drift, sim.max_overlap) == (0, 0, 0)
        assert len(sim.events) == 0
        sim.run(until=1)
        assert np.array_equal(sim.position, first)

    def test_before_the_first_run_it_is_where_it_is(self):
        sim = carom.Simulation()
        sim.add()
        sim.reset()
        assert len(sim) == 1

    @each_method
    def test_to_the_start_of_another_scene(self, method):
        first, second = carom.scenes.two_balls(), carom.scenes.newton_cradle()
        sim = carom.Simulation(first, gravity=(0, 0, -1), method=method, keep_events=3)
        ball = sim[0]
        sim.run(until=3)
        sim.reset(second)
        assert (sim.time, sim.collisions, sim.wall_collisions, len(sim.events)) == (0, 0, 0, 0)
        assert (sim.dissipated, sim.energy_drift, sim.max_overlap) == (0, 0, 0)
        assert sim.scene is second
        assert (sim.pace, sim.method, len(sim)) == (second.pace, method, 5)
        assert (sim.walls, sim.gravity.tolist()) == (second.walls, [0, 0, 0])
        with pytest.raises(carom.InputError, match="ball 0 is gone"):
            ball.mass  # noqa: B018
        fresh = carom.Simulation(second, method=method)
        for each in (sim, fresh):
            each.run(until=6)
        assert np.array_equal(sim.velocity, fresh.velocity)
        assert np.array_equal(sim.position, fresh.position)
        assert len(sim.events) == 3 < len(fresh.events)
        sim.reset()
        assert sim.scene is second
        assert np.array_equal(sim.position, second.spheres.position)

    def test_a_scene_that_cannot_be_run_changes_nothing(self):
        sim = gas()
        sim.run(until=0.5)
        before = sim.state
        inside = carom.Scene(carom.Spheres.of([(0, 0, 0), (0.5, 0, 0)]))
        for scene, sentence in [
            ("gas", "scene must be a Scene"),
            (carom.scenes.gas, "scene must be a Scene"),
            (inside, "overlap by 0.5"),
            (carom.Scene(carom.Spheres.of([])), "no spheres"),
        ]:
            with pytest.raises(carom.InputError, match=sentence):
                sim.reset(scene)
        assert (sim.scene, sim.time, len(sim.events) > 0) == (None, 0.5, True)
        assert np.array_equal(sim.position, before.position)


class TestManners:
    @each_method
    def test_context_length_and_text(self, method):
        with gas(method) as sim:
            sim.run(collisions=3)
        assert len(sim) == 27
        text = repr(sim)
        assert text.startswith("<Simulation: 27 spheres, time 0.")
        assert text.endswith(f"3 collisions, method {method}>")
        assert (sim.method, sim.tick) == (method, 1.0)
        assert sim.collide
        assert not sim.fixed.any()
        assert sim.world.collide

    def test_an_engine_of_your_own(self):
        made = []

        def engine(state, world):
            made.append(ExactEngine(state, world))
            return made[-1]

        sim = gas(engine)
        sim.run(until=0.5)
        sim.run(until=1)
        assert len(made) == 1
        assert sim.collisions == made[0].collisions
        assert "method its own" in repr(sim)

    def test_show_hands_itself_to_the_view(self, monkeypatch, capsys):
        import carom.view

        calls = []

        def serve(sim, *, host, port, open_browser, on_ready):
            calls.append((sim, host, port, open_browser))
            public = host != "127.0.0.1"
            on_ready(SimpleNamespace(url="http://h/#c", watch_url="http://h/#w", is_public=public))

        monkeypatch.setattr(carom.view, "serve", serve)
        sim = gas()
        sim.show(port=1234, open_browser=False)
        assert calls == [(sim, "127.0.0.1", 1234, False)]
        assert capsys.readouterr().err == "carom is at http://h/#c (Ctrl-C ends it)\n"
        sim.show(host="0.0.0.0")
        assert calls[1][1:] == ("0.0.0.0", 0, True)
        assert capsys.readouterr().err.endswith("to watch only: http://h/#w\n")
