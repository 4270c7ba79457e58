"""Spheres on a line: counts of collisions and final states that are known exactly."""

import math

import numpy as np
import pytest

from carom import scenes
from carom.engine import FastEngine
from carom.reference.exact import ExactEngine
from carom.walls import Periodic, Plane, world
from carom.world import World

from .tools import EPS, drive, numbers, spheres, table

both = pytest.mark.parametrize("make", [FastEngine, ExactEngine])


def total(engine):
    return engine.collisions + engine.wall_collisions


@pytest.mark.parametrize("row", table("galperin"), ids=lambda row: row["mass_ratio"])
def test_galperin_counts_pi(row):
    """3, 31, 314 ... 3141592: a single one lost or seen twice spoils a digit."""
    ratio = float(row["mass_ratio"])
    start, count = (
        scenes.galperin(digits=1 + round(math.log(ratio, 100))),
        row["n_collisions_total"],
    )
    state, surroundings = start.build()
    assert state.mass.tolist() == [1.0, ratio]
    engine = FastEngine(state, surroundings, log=False)
    drive(engine, until=1e3)
    assert total(engine) == int(count)
    light, heavy = engine.state().velocity[:, 0]
    assert heavy == pytest.approx(float(row["V_heavy_final_over_absV0"]), abs=1e-9)
    # On its way the light ball is up to sqrt(M/m) as fast: each collision rounds by that.
    rounding = 4.0 * EPS * math.sqrt(ratio * int(count))
    assert light == pytest.approx(float(row["v_light_final_over_absV0"]), abs=rounding)


def rods(make):
    """Ten equal spheres on the x axis between walls at 0 and 10."""
    rows = table("tonks_line")
    start = np.array([numbers(row, "x0", "v0") for row in rows])
    zero = np.zeros(len(rows))
    state = spheres(
        np.column_stack([start[:, 0], zero, zero]),
        np.column_stack([start[:, 1], zero, zero]),
        radius=0.25,
    )
    ends = world([Plane((1, 0, 0), 0), Plane((-1, 0, 0), -10)])
    return make(state, ends), np.array([numbers(row, "x_T", "v_T") for row in rows])


@both
def test_ten_rods_between_walls(make):
    """Equal rods pass on their velocities, so that relabelled points fly free."""
    engine, expected = rods(make)
    drive(engine, until=1000.0)
    assert (engine.collisions, engine.wall_collisions) == (10709, 1672)
    end = engine.state()
    assert np.abs(end.position[:, 0] - expected[:, 0]).max() < 1e-9
    assert np.abs(end.velocity[:, 0] - expected[:, 1]).max() < 1e-13
    assert not end.position[:, 1:].any()
    assert not end.velocity[:, 1:].any()
    events = engine.take_events()
    on_walls = np.abs(events["impulse"][events["j"] < 0, 0]).sum()
    assert on_walls == pytest.approx(4044.8778712164454034, rel=1e-13)


def test_force_of_the_rods_on_a_wall():
    """2 K/(L - N sigma), for every number of rods.

    Point k, at speed v on the free length, hits a wall v t/(L - N sigma) times within one, and
    brings 2 v: that bounds the error.
    """
    engine, _ = rods(FastEngine)
    speeds, time = np.abs(engine.state().velocity[:, 0]), 20_000.0
    drive(engine, until=time)
    events = engine.take_events()
    for wall in (-1, -2):
        force = np.abs(events["impulse"][events["j"] == wall, 0]).sum() / time
        assert abs(force - (speeds**2).sum() / (10.0 - 5.0)) < 2.0 * speeds.sum() / time


@both
@pytest.mark.parametrize("gap", [0.25, 0.3, 1e-3])
def test_a_cradle_with_gaps_hands_the_speed_on(make, gap):
    """n - 1 collisions, gap/v apart; the last ball leaves with v, all others stay."""
    n, v = 7, 1.3
    places = np.zeros((n, 3))
    places[:, 0] = np.arange(n) * (1 + gap)
    velocity = np.zeros((n, 3))
    velocity[0, 0] = v
    engine = make(spheres(places, velocity), World())
    drive(engine, until=100.0)
    events = engine.take_events()
    assert events["i"].tolist() == list(range(n - 1))
    assert events["j"].tolist() == list(range(1, n))
    assert events["time"] == pytest.approx(np.arange(1, n) * gap / v, abs=1e-14)
    end = engine.state().velocity[:, 0]
    assert end[-1] == pytest.approx(v, rel=1e-15)
    assert np.abs(end[:-1]).max() <= 1e-15


@both
@pytest.mark.parametrize("moving", [1, 2, 3, 4])
def test_as_many_balls_leave_a_touching_cradle_as_come(make, moving):
    """Of collisions at one time the one with the smaller numbers comes first."""
    n, v = 5, 2.0
    places = np.zeros((n, 3))
    places[:, 0] = np.arange(n)
    places[:moving, 0] -= 0.5
    velocity = np.zeros((n, 3))
    velocity[:moving, 0] = v
    engine = make(spheres(places, velocity), World())
    drive(engine, until=10.0)
    assert engine.collisions == moving * (n - moving)
    assert engine.state().velocity[:, 0].tolist() == [0.0] * (n - moving) + [v] * moving


@both
def test_free_time_on_a_periodic_line(make):
    """One of six balls moves: exactly 3 between two collisions of a ball.

    Without their diameters the balls are points that pass through one another: on a ring of
    length L - n sigma one of them meets the n - 1 others once in every round.
    """
    length, n, v = 11.0, 6, 1.0
    places, velocity = np.zeros((n, 3)), np.zeros((n, 3))
    places[:, 0] = -5 + np.array([0.0, 1.2, 3.0, 4.1, 6.5, 8.0])
    velocity[0, 0] = v
    engine = make(spheres(places, velocity), world(Periodic(length, None, None)))
    drive(engine, until=200.02 * (length - n) / v)  # 200 rounds; the next meeting is at 0.04
    assert engine.collisions == 200 * (n - 1)
    assert n * 1000.0 / (2 * engine.collisions) == 3.0
