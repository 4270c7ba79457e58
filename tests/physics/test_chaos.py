"""The largest Lyapunov exponent, against other methods and where it is 0."""

import math

import numpy as np
import pytest

import carom
from carom import observe

from .observed import fluid, measured


def tangent_exponent(sim, mark, collisions):
    """The exponent by tangent vectors: linear motion between collisions, and its jump at each.

    With the relative position r, velocity v and perturbations dr, dv of a pair in contact, n = r/r
    and the time dt = -(dr.n)/(v.n) by which the perturbed pair meets later ::

        dr' = dr - 2 n (n.dr),  dv' = dv - 2 n (n.dv) - 2 [n (v.q) + q (v.n)]
        q = (dr + v dt)/sigma

    C. Dellago, H. A. Posch, W. G. Hoover, Phys. Rev. E 53, 1485 (1996),
    doi:10.1103/PhysRevE.53.1485. Equal spheres of diameter and mass 1 without walls.
    """
    sim.return_to(mark)
    v = sim.velocity.copy()
    last = np.full(len(v), sim.time)
    dr, dv = np.random.default_rng(7).normal(size=(2, len(v), 3))
    sim.run(collisions=collisions)
    grown, begun = 0.0, 0.0
    for k, event in enumerate(sim.events):
        i, j, time = event["i"], event["j"], event["time"]
        for s in (i, j):
            dr[s] += dv[s] * (time - last[s])
            last[s] = time
        # The recorded impulse, along -n, keeps to the run; a replay from positions would leave it.
        impulse = event["impulse"]
        normal, w = -impulse / np.linalg.norm(impulse), v[j] - v[i]
        a, b = dr[j] - dr[i], dv[j] - dv[i]
        q = a - w * ((a @ normal) / (w @ normal))
        jump_r = -2 * normal * (normal @ a)
        jump_v = -2 * normal * (normal @ b) - 2 * (normal * (w @ q) + q * (w @ normal))
        for s, sign in ((i, -0.5), (j, 0.5)):
            dr[s] += sign * jump_r
            dv[s] += sign * jump_v
        v[i] += impulse
        v[j] -= impulse
        if k % 50 == 49:
            size = math.sqrt((dr**2).sum() + (dv**2).sum())
            dr, dv = dr / size, dv / size
            if k < 1000:
                begun = time
            else:
                grown += math.log(size)
    return grown / (last.max() - begun)


@pytest.mark.parametrize("phi", [0.05, 0.3])
def test_tangent_vectors_give_the_same(phi):
    """Another method, on the same run, event by event."""
    sim = carom.Simulation(carom.scenes.fluid(n=32, packing_fraction=phi), keep_events=10**6)
    sim.run(collisions=2000)
    mark = sim.bookmark()
    twin = observe.Lyapunov()
    sim.run(collisions=30_000, observe=twin)
    found = twin.result()
    assert found.error < 0.03 * found.value
    # Both see the same fluctuations; what is left is where each begins to count.
    expected = tangent_exponent(sim, mark, 30_000)
    assert abs(found.value - expected) < 2 * found.error


@pytest.mark.parametrize("options", [
    {"separation": 1e-11}, {"separation": 1e-6}, {"every": 0.03}, {"every": 1.0}, {"seed": 8},
])  # fmt: skip
def test_it_depends_on_no_option(options):
    usual, other = observe.Lyapunov(), observe.Lyapunov(**options)
    measured(0.3, usual, other, collisions=20_000, n=108)
    a, b = usual.result(), other.result()
    # They follow the same run, and see the same fluctuations.
    assert b.value == pytest.approx(a.value, rel=0.01)
    assert (a.note, b.note) == ("", "")


def test_stretches_that_are_too_long_are_lost_and_that_is_said():
    long = observe.Lyapunov(every=6.0)
    measured(0.3, long, collisions=100_000, n=108)
    assert long.samples > 20
    with pytest.raises(carom.InputError, match="counts from stretch 9 on, and has seen 0"):
        long.result()
    some = observe.Lyapunov(every=2.2)
    measured(0.3, some, collisions=100_000, n=108)
    assert "of the stretches were lost; take every= shorter" in some.result().note


def one(walls, **options):
    sim = carom.Simulation(walls=walls, **options)
    sim.add((0.3, 0.1, -0.2), velocity=(1, 0.7, 0.3))
    return sim


def side_by_side():
    sim = carom.Simulation(walls=carom.Periodic(9, 9, 9))
    sim.add_many([(0, 0, 0), (0, 2, 0), (0, 0, 2)], velocity=(1, 0.2, 0.1))
    return sim


def ideal():
    sim = carom.Simulation(walls=carom.Box(9, 9, 9), collide=False)
    sim.add_many([(0, 0, 0), (0, 2, 0)], velocity=[(1, 0.2, 0.1), (0.5, 0.3, -1)])
    return sim


@pytest.mark.parametrize("make", [
    lambda: one(carom.Box(5, 6, 7)), lambda: one(carom.Periodic(5, 6, 7)),
    lambda: one(carom.Box(5, 6, 20), gravity=(0, 0, -0.3)), side_by_side, ideal,
])  # fmt: skip
def test_it_is_0_where_motion_is_regular(make):
    """Separations rise as the time, so their logarithm over the time falls towards 0."""
    sim = make()
    rates = []
    for duration in (100, 3_000):
        exponent = observe.Lyapunov(every=1)
        sim.run(duration=duration, observe=exponent)
        rates.append(abs(exponent.result().value))
    assert rates[1] < 0.005
    assert rates[1] < rates[0] / 10


def test_the_hexagonal_lorentz_gas_of_another_program():
    """A point between discs of radius 1 whose centres are 2 sqrt(3) apart, in the plane.

    The manual of DynamicalBilliards.jl shows four runs of it with random starts: 0.6815, 0.6239,
    0.6479 and 0.7061, so 0.665(18).
    """
    d = 2 * math.sqrt(3)
    sim = carom.Simulation(walls=carom.Periodic(d, d * math.sqrt(3), 2))
    sim.add_many([(0, 0, 0), (d / 2, d * math.sqrt(3) / 2, 0)], radius=0.5, fixed=True)
    sim.add((1.0, 0.4, 0.0), velocity=(math.cos(0.5), math.sin(0.5), 0), radius=0.5)
    sim.run(until=1000)
    exponent = observe.Lyapunov()
    sim.run(duration=20_000, observe=exponent)
    assert sim.position[2, 2] == 0
    assert sim.velocity[2] @ sim.velocity[2] == pytest.approx(1)
    assert exponent.result().error < 0.01
    assert abs(exponent.result().deviation(0.665, 0.018)) < 3


def test_twins_that_begin_at_contact():
    """Rounds of collisions in which all spheres touch, at the very moments of samples."""
    sim = carom.Simulation(walls=carom.Periodic(4, 4, 4))
    sim.add_many([(-1, 0, 0), (1, 0.2, 0)], velocity=[(1, 0, 0), (-1, 0, 0)])
    sim.run(collisions=1)
    exponent = observe.Lyapunov(every=0.37)
    sim.run(collisions=500, observe=exponent)
    assert exponent.result().value > 0.1
    assert exponent.result().note == ""


def test_several_runs_are_one():
    whole, parts = observe.Lyapunov(), observe.Lyapunov()
    sim = measured(0.3, whole, collisions=6000, n=108)
    sim, mark = fluid(0.3, 108)
    sim.return_to(mark)
    for _ in range(6):
        sim.run(collisions=1000, observe=parts)
    assert parts.result() == whole.result()


@pytest.mark.parametrize(("sim", "message"), [
    (carom.Simulation(carom.scenes.fluid(n=108), rule=carom.Smooth(0.9)), "take restitution 1"),
    (carom.Simulation(walls=carom.Box(9, 9, 9)), "give them velocities"),
])  # fmt: skip
def test_where_it_has_no_meaning(sim, message):
    if len(sim) == 0:
        sim.add()
    with pytest.raises(carom.InputError, match=message):
        sim.run(duration=1, observe=observe.Lyapunov())


@pytest.mark.parametrize("options", [{"every": 0}, {"separation": 1e-3}, {"seed": -1}])
def test_bad_options(options):
    with pytest.raises(carom.InputError, match=f"{next(iter(options))} is"):
        observe.Lyapunov(**options)
