"""Impacts foretold from counts alone, against the engine that has had them."""

from dataclasses import replace

import numpy as np
import pytest

import carom
from carom import scenes
from carom.view.impacts import Impacts
from carom.view.portrait import portrait


def foretold(state, about, left, step):
    """Positions and velocities a step later."""
    fall = np.where(state.fixed | state.resting, 0.0, np.array(about["gravity"])[:, None])
    impacts = Impacts(about, state.radius, np.where(state.fixed, np.inf, state.mass))
    before = state.position.copy(), state.velocity.copy()
    x, v, rest = impacts.fly(state.position.T, state.velocity.T, fall, left, step)
    assert np.array_equal(before, (state.position, state.velocity))
    x = x + v * rest + 0.5 * fall * rest * rest
    period = np.array(about["period"])[:, None]
    x -= period * np.round(np.divide(x, period, out=np.zeros_like(x), where=period > 0))
    return x.T, (v + fall * rest).T


def hits_and_misses(sim, steps, step):
    """Of spheres that collide: how many are foretold to rounding, and how many are not."""
    about = portrait(sim, sim.state, 1, (1.0, 1.0))
    right = wrong = 0
    for _ in range(steps):
        before = sim.state
        sim.run(duration=step)
        after = sim.state
        left = (after.collision_count - before.collision_count).astype(np.int64)
        x, v = foretold(before, about, left, step)
        size = np.abs(after.velocity).max()
        close = np.abs(x - after.position).max(axis=1) < 1e-9 * np.ptp(after.position)
        close &= np.abs(v - after.velocity).max(axis=1) < 1e-9 * size
        assert close[left == 0].all()
        right += np.count_nonzero(close & (left > 0))
        wrong += np.count_nonzero(~close & (left > 0))
    return right, wrong


def mixture():
    """Two sizes and masses in a box with gravity, inelastic, walls of another restitution."""
    scene = scenes.build("gas", {"n": 300})
    spheres = scene.spheres
    small = np.arange(300) % 2 == 0
    return replace(
        scene,
        spheres=replace(
            spheres,
            radius=np.where(small, 0.5, 1) * spheres.radius,
            mass=np.where(small, 0.2, 1),
        ),
        walls=[replace(wall, restitution=0.7) for wall in scene.walls],
        rule=carom.rules.Smooth(0.9),
        gravity=(0, 0, -1),
    )


@pytest.mark.parametrize(
    ("scene", "share"),
    [
        (scenes.build("fluid", {"n": 400, "packing_fraction": 0.4}), 0.93),
        (scenes.build("gas", {"n": 400}), 0.99),
        (scenes.build("giant", {"n": 300}), 0.97),
        (mixture(), 0.99),
    ],
    ids=["fluid", "gas", "giant", "mixture"],
)
def test_nearly_every_collision_is_foretold(scene, share):
    sim = carom.Simulation(scene)
    sim.run(duration=sim.pace)
    right, wrong = hits_and_misses(sim, 30, sim.pace / 30)
    assert right + wrong > 300
    assert right > share * (right + wrong)


def test_a_chain_of_collisions_is_foretold_in_order():
    """The first hits the second, this the third: each by the impulse of the one before."""
    spheres = carom.Spheres.of([(-3, 0, 0), (0, 0, 0), (3, 0, 0)], radius=0.5)
    spheres = replace(spheres, velocity=np.array([(10.0, 0, 0), (0, 0, 0), (0, 0, 0)]))
    state = carom.Simulation(carom.Scene(spheres)).state
    about = portrait(carom.Simulation(carom.Scene(spheres)), state, 1, (1.0, 1.0))
    x, v = foretold(state, about, np.array([1, 2, 1]), 1.0)
    assert v.tolist() == [[0, 0, 0], [0, 0, 0], [10, 0, 0]]
    assert x == pytest.approx(np.array([(-1, 0, 0), (2, 0, 0), (9, 0, 0)]))


def test_what_no_count_asks_for_does_not_happen():
    sim = carom.Simulation(scenes.build("two-balls"))
    about = portrait(sim, sim.state, 1, (1.0, 1.0))
    _, v = foretold(sim.state, about, np.zeros(2, np.int64), 10 * sim.pace)
    assert np.array_equal(v, sim.velocity)
    # And a count that nothing explains ends after some rounds.
    foretold(sim.state, about, np.full(2, 2**31 - 1), 10 * sim.pace)
