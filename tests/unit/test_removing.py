"""Simulation.remove: the others stay who they are, and the books stay right."""

import dataclasses

import numpy as np
import pytest

import carom
from carom.reference.exact import ExactEngine

from .gases import each_method, gas


@each_method
@pytest.mark.parametrize("index", [0, 13, 26, -1, np.int64(5)])
def test_the_others_keep_their_order_and_everything_they_have(method, index):
    sim = gas(method)
    sim.color = np.arange(27)
    sim.run(until=0.5)
    before = sim.state
    sim.remove(index)
    after = sim.state
    assert len(sim) == 26
    for f in dataclasses.fields(before):
        old, new = getattr(before, f.name), getattr(after, f.name)
        if isinstance(old, np.ndarray):
            old = np.delete(old, index, axis=0)
        assert np.array_equal(old, new), f.name


@each_method
def test_the_run_goes_on_as_if_the_sphere_had_never_been(method):
    with_it, without = carom.Simulation(method=method), carom.Simulation(method=method)
    for sim in (with_it, without):
        sim.add(position=(-3, 0, 0), velocity=(1, 0, 0))
        sim.add(position=(3, 0.2, 0))
    with_it.add(position=(0, 0, 0))
    with_it.remove(2)
    for sim in (with_it, without):
        sim.run(until=9)
    assert with_it.collisions == without.collisions == 1
    assert np.array_equal(with_it.velocity, without.velocity)


@each_method
def test_clock_counters_and_events_stay(method):
    sim = gas(method, rule=carom.Smooth(0.9))
    sim.run(until=1)
    names = ["time", "collisions", "wall_collisions", "dissipated", "max_overlap", "energy_drift"]
    before = [getattr(sim, name) for name in names]
    events = sim.events.copy()
    assert min(before[1:4]) > 0
    sim.remove(4)
    assert [getattr(sim, name) for name in names] == before
    assert np.array_equal(sim.events, events)
    sim.run(until=2)
    assert sim.collisions > before[1]
    assert abs(sim.energy_drift) < 1e-13


@each_method
def test_the_drift_stays_small_when_the_fast_ones_go(method):
    sim = gas(method)
    sim.run(until=0.5)
    slow = np.argmin((sim.velocity**2).sum(axis=1))
    sim[slow].velocity = (0, 0, 1e-6)
    while len(sim) > 1:
        sim.remove(0 if slow else 1)
        slow = max(0, slow - 1)
        assert abs(sim.energy_drift) < 1e-13
    sim.run(duration=0.1)
    assert abs(sim.energy_drift) < 1e-13


@each_method
def test_the_last_one_may_go_and_another_come(method):
    sim = carom.Simulation(method=method, gravity=(0, 0, -1))
    sim.add(velocity=(0.1, 0.2, 0.3))
    sim.run(until=0.7)
    sim.remove(0)
    assert (len(sim), sim.time, sim.kinetic_energy) == (0, 0.7, 0)
    assert abs(sim.energy_drift) < 1e-14
    with pytest.raises(carom.InputError, match="there is no sphere 0 to remove; there are none"):
        sim.remove(0)
    ball = sim.add(velocity=(1, 0, 0))
    sim.run(until=1.7)
    assert ball.position[0] == pytest.approx(1)


@pytest.mark.parametrize("index", [27, -28, 1.0, "a", None])
def test_what_is_not_there_cannot_be_removed(index):
    sim = gas()
    with pytest.raises(carom.InputError, match="give a whole number from 0 to 26"):
        sim.remove(index)
    assert len(sim) == 27


@each_method
def test_neighbours_meet_where_the_removed_one_stood(method):
    sim = carom.Simulation(method=method)
    left = sim.add(position=(-3, 0, 0), velocity=(1, 0, 0))
    sim.add(position=(0, 0, 0), fixed=True)
    right = sim.add(position=(3, 0, 0), velocity=(-1, 0, 0))
    sim.remove(1)
    sim.run(collisions=1)
    assert sim.time == pytest.approx(2.5)
    assert left.velocity[0] == -1
    assert right.velocity[0] == 1


def test_a_ball_falls_when_the_fixed_one_below_it_goes():
    sim = carom.Simulation(
        gravity=(0, 0, -1), walls=carom.Plane((0, 0, 1), -9), rule=carom.Smooth(0.5)
    )
    rock = sim.add(fixed=True)
    ball = sim.add(position=(0, 0, 1.25))
    sim.run(until=9)
    assert ball.position[2] == pytest.approx(1, abs=1e-3)
    sim.remove(rock.index)
    sim.run(duration=1)
    assert ball.position[2] == pytest.approx(0.5, abs=1e-3)


class TestBalls:
    @each_method
    def test_a_view_follows_its_sphere(self, method):
        sim = gas(method)
        sim.color = np.arange(27)
        balls = [sim[i] for i in range(27)]
        sim.run(until=0.2)
        for index in (20, 0, 7):
            sim.remove(index)
        assert [balls[i].index for i in (1, 7, 9, 26)] == [0, 6, 7, 23]
        alive = [ball for i, ball in enumerate(balls) if i not in (20, 0, 8)]
        assert [ball.color for ball in alive] == sim.color.tolist()
        alive[7].velocity = (0, 0, 9)
        assert sim.velocity[7].tolist() == [0, 0, 9]
        assert repr(alive[7]).startswith("<Ball 7: ")

    def test_a_view_of_the_removed_one_says_so(self):
        sim = gas()
        ball = sim[5]
        sim.remove(5)
        for use in (
            lambda: ball.velocity,
            lambda: ball.index,
            lambda: setattr(ball, "mass", 2),
            lambda: repr(ball),
        ):
            with pytest.raises(carom.InputError, match="ball 5 is gone: it was removed"):
                use()
        assert sim.mass.tolist() == [1.0] * 26

    def test_a_new_sphere_is_never_taken_for_a_removed_one(self):
        sim = carom.Simulation()
        ball = sim.add()
        sim.remove(0)
        other = sim.add(mass=3)
        assert other.mass == 3
        with pytest.raises(carom.InputError, match="ball 0 is gone"):
            ball.mass  # noqa: B018

    def test_reset_brings_spheres_and_views_back(self):
        sim = gas()
        ball = sim[5]
        sim.run(until=0.1)
        sim.remove(5)
        late = sim.add(position=sim.state.position[5] * 0 + (2.9, 2.9, 2.9), radius=0.05)
        sim.reset()
        assert ball.index == 5
        with pytest.raises(carom.InputError, match="ball 26 is gone"):
            late.mass  # noqa: B018


def test_an_engine_of_your_own_is_built_anew():
    made = []

    def engine(state, world):
        made.append(len(state))
        return ExactEngine(state, world)

    sim = gas(engine)
    sim.run(until=0.1)
    sim.remove(3)
    sim.run(until=0.2)
    assert made == [27, 26]
