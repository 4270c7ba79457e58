"""One and two spheres, where every answer has a closed form."""

import math

import numpy as np
import pytest

from carom.engine import FastEngine, Stop
from carom.reference.exact import ExactEngine
from carom.state import CAME_TO_REST
from carom.walls import Box, Plane, Sphere, world
from carom.world import World

from .tools import EPS, drive, numbers, spheres, table

PAIRS = table("two_body")
both = pytest.mark.parametrize("make", [FastEngine, ExactEngine])


def pair(row):
    xyz = [[f"{q}{axis}{k}" for axis in "xyz"] for q in ("", "v") for k in "12"]
    x1, x2, v1, v2 = (numbers(row, *names) for names in xyz)
    state = spheres([x1, x2], [v1, v2], numbers(row, "r1", "r2"), numbers(row, "m1", "m2"))
    return state, World(restitution=float(row["e"]))


def time_error(state, contact):
    """How far rounding alone can move the time of contact.

    The error of |r x v|^2, about eps sigma |r| v^2, moves the root by eps |r|/v_n: much where
    spheres graze (v_n is small) or come from far.
    """
    r = state.position[0] - state.position[1]
    v = state.velocity[0] - state.velocity[1]
    n = r + v * contact
    approach = abs(v @ n) / np.linalg.norm(n)
    return 20.0 * EPS * (contact + np.linalg.norm(r) / approach)


def reach(state, contact):
    """Largest coordinate at the contact."""
    return np.abs(state.position + state.velocity * contact).max()


def velocity_error(state, contact, late):
    """The same for velocities: the normal turns by the error of positions at contact."""
    v = state.velocity[0] - state.velocity[1]
    turned = (20.0 * EPS * reach(state, contact) + np.linalg.norm(v) * late) / state.radius.sum()
    return 20.0 * EPS * np.abs(state.velocity).max() + 4.0 * np.linalg.norm(v) * turned


@both
@pytest.mark.parametrize("row", PAIRS, ids=lambda row: f"{row['case']}-{row['kind']}")
def test_two_spheres_meet_when_and_how_they_must(make, row):
    state, surroundings = pair(row)
    engine = make(state, surroundings)
    contact = float(row["t"])
    if row["kind"] == "miss":
        assert math.isnan(contact)
        assert drive(engine) is Stop.IDLE
        assert engine.collisions == 0
        return
    drive(engine, collisions=1)
    after = engine.state()
    late = time_error(state, contact)
    assert engine.time == pytest.approx(contact, rel=0, abs=late)
    expected = np.array([numbers(row, *(f"u{axis}{k}" for axis in "xyz")) for k in "12"])
    assert np.abs(after.velocity - expected).max() <= velocity_error(state, contact, late)


@both
@pytest.mark.parametrize("row", table("bouncing_ball"), ids=lambda row: f"e{row['e']}")
def test_a_ball_bounces_on_a_floor(make, row):
    """Bounce n happens at sqrt(2h/g) (1 + 2 (e + ... + e^(n-1))), and rest follows in time."""
    height, e = numbers(row, "h", "e")
    floor = world(Plane((0, 0, 1), 0, restitution=e), gravity=(0, 0, -1))
    engine = make(spheres([(0, 0, height + 0.5)]), floor)
    drive(engine, events=10)
    assert engine.state().velocity[0, 2] == pytest.approx(float(row["speed_after_10"]), rel=1e-12)
    drive(engine, until=2.0 * float(row["t_inf"]), events=3000)
    events = engine.take_events()
    for n in (1, 2, 10, 50):
        if n < len(events):
            assert events["time"][n - 1] == pytest.approx(float(row[f"t_{n}"]), rel=1e-12)
    assert events["j"][-1] == CAME_TO_REST
    # What is left when the rise falls below 1e-9 R: less than 2 v/(g (1 - e)), v^2 = 2 g rise.
    left = 2.0 * math.sqrt(2.0 * 0.5e-9) / (1.0 - e)
    assert 0.0 <= float(row["t_inf"]) - events["time"][-1] < left
    assert engine.dissipated == pytest.approx(height, rel=1e-12)


BOUNCES = [(int(row["case"]), int(row["n"]), row) for row in table("sphere_container_single")]


@pytest.mark.parametrize("case", sorted({case for case, _, _ in BOUNCES}))
def test_a_ball_in_a_hollow_sphere_keeps_its_chord(case):
    """Bounce n at t_1 + (n - 1) chord/v.

    Each bounce turns the path by about eps at random; the angle walks as sqrt(n) eps, and the
    place, its sum, as n^1.5 eps. In doubles nothing better can be had: 1e-8 at bounce 1e5.
    """
    rows = [(n, row) for c, n, row in BOUNCES if c == case]
    radius, own = numbers(rows[0][1], "R", "a")
    state = spheres(
        [numbers(rows[0][1], *"xyz")], [numbers(rows[0][1], "vx", "vy", "vz")], radius=own
    )
    engine = FastEngine(state, world(Sphere(radius)), log=False)
    speed, done = np.linalg.norm(state.velocity), 0
    for n, row in rows:
        drive(engine, events=n - done)
        done = n
        allowed = 20.0 * EPS * radius + 10.0 * EPS * n**1.5 * radius
        assert engine.time * speed == pytest.approx(float(row["t_n"]) * speed, rel=0, abs=allowed)
        error = np.abs(engine.state().position[0] - numbers(row, "X_n", "Y_n", "Z_n")).max()
        assert error < allowed
    assert np.linalg.norm(engine.state().velocity) == pytest.approx(speed, rel=1e-12)


def test_a_ball_in_a_box_is_folded():
    """x(t) = fold(x0 + v t) about the walls; |v_k| stays, to the last bit."""
    sides, start, v = np.array([4.0, 5.0, 6.0]), np.array([0.3, -0.9, 1.7]), (1.1, -0.7, 0.45)
    engine = FastEngine(spheres([start], [v], radius=0.25), world(Box(*sides)), log=False)
    drive(engine, until=12345.0)
    end, free = engine.state(), sides - 0.5
    walked = start + free / 2 + np.array(v) * 12345.0
    turned = np.abs((walked % (2 * free)) - free)
    assert np.abs(end.position[0] - (free / 2 - turned)).max() < 1e-9
    assert np.abs(end.velocity[0]).tolist() == np.abs(v).tolist()
    assert engine.wall_collisions == np.abs(np.floor(walked / free)).sum()
