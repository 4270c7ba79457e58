"""What each of the other scenes promises."""

import math

import numpy as np
import pytest

from carom import Simulation, scenes
from carom.errors import InputError
from carom.walls import Box, Open


def test_two_balls_meet_and_exchange_momentum():
    sim = Simulation(scenes.two_balls(box=False))
    momentum = sim.momentum.copy()
    assert sim.scene.walls == (Open(),)
    sim.run(collisions=1)
    assert sim.collisions == 1
    assert sim.velocity[1].any()
    np.testing.assert_allclose(sim.momentum, momentum, atol=1e-15)


@pytest.mark.parametrize("option", [{"offset": 4}, {"mass_ratio": 0}, {"restitution": 1.1}])
def test_two_balls_refuses(option):
    with pytest.raises(InputError, match=f"{next(iter(option))} is"):
        scenes.two_balls(**option)


@pytest.mark.parametrize(("n", "moving"), [(2, 1), (5, 1), (5, 2), (5, 4), (8, 3)])
def test_as_many_balls_leave_the_cradle_as_come_in(n, moving):
    sim = Simulation(scenes.newton_cradle(n=n, moving=moving))
    start = sim.velocity.copy()
    sim.run(until=1.6)
    assert sim.velocity[:, 0].tolist() == [0] * (n - moving) + [2] * moving
    assert sim.collisions == moving * (n - moving)
    sim.run(until=4.6)  # back from the far wall
    assert sim.velocity.tolist() == (-start).tolist()


@pytest.mark.parametrize(("n", "moving"), [(1, 1), (5, 5), (5, 0)])
def test_the_cradle_needs_moving_and_resting_balls(n, moving):
    with pytest.raises(InputError, match="it must be"):
        scenes.newton_cradle(n=n, moving=moving)


@pytest.mark.parametrize(("digits", "count"), [(1, 3), (2, 31), (3, 314), (4, 3141), (5, 31415)])
def test_galperin_counts_the_digits_of_pi(digits, count):
    scene = scenes.galperin(digits=digits)
    assert scene.spheres.mass.tolist() == [1, 100.0 ** (digits - 1)]
    assert scene.spheres.velocity[0].tolist() == [0, 0, 0]
    sim = Simulation(scene)
    sim.run(until=1e9)
    assert sim.collisions + sim.wall_collisions == count


@pytest.mark.parametrize("digits", [0, 10])
def test_galperin_refuses(digits):
    with pytest.raises(InputError, match=f"digits is {digits}"):
        scenes.galperin(digits=digits)


def test_the_break_shot_breaks_the_rack():
    scene = scenes.break_shot()
    assert len(scene.spheres) == 1 + 35
    assert len(scenes.break_shot(layers=2).spheres) == 1 + 4
    x = scene.spheres.position[1:]
    d = np.sqrt(((x[:, np.newaxis] - x) ** 2).sum(axis=2))
    neighbours = (np.abs(d - 1.001) < 1e-12).sum(axis=1)
    assert neighbours.max() == 12
    assert neighbours.sum() == 2 * 120  # of the pyramid's bonds: 5 layers, 6 C(5 + 1, 3)
    sim = Simulation(scene)
    energy = sim.kinetic_energy
    sim.run(until=3)
    assert (sim.velocity[1:] != 0).any(axis=1).sum() > 25
    assert sim.kinetic_energy == pytest.approx(energy, rel=1e-13)


def test_a_gas_starts_at_one_speed_in_all_directions():
    scene = scenes.gas(n=1000, packing_fraction=0.1, speed=2.5)
    v = scene.spheres.velocity
    np.testing.assert_allclose(np.sqrt((v**2).sum(axis=1)), 2.5, rtol=1e-14)
    assert np.abs(v.mean(axis=0)).max() < 4 * 2.5 / math.sqrt(3 * 1000)
    (box,) = scene.walls
    assert isinstance(box, Box)
    assert 1000 * math.pi / 6 / box.lx**3 == pytest.approx(0.1, rel=1e-14)


def test_a_gas_too_dense_is_refused():
    with pytest.raises(InputError, match=r"cannot reach packing fraction 0\.6"):
        scenes.gas(packing_fraction=0.6)


@pytest.mark.parametrize("packing_fraction", [0.01, 0.3, 0.49])
def test_a_fluid_has_its_packing_fraction_and_temperature(packing_fraction):
    scene = scenes.fluid(n=500, packing_fraction=packing_fraction, temperature=2, seed=5)
    sim = Simulation(scene)
    assert sim.packing_fraction == pytest.approx(packing_fraction, rel=1e-13)
    assert sim.temperature == pytest.approx(2, rel=1e-13)
    assert np.abs(sim.momentum).max() < 1e-12
    sim.run(collisions=2000)
    assert sim.temperature == pytest.approx(2, rel=1e-12)


def test_the_seed_chooses_the_vacancies():
    a, b = (scenes.fluid(n=400, seed=k).spheres.position for k in (1, 2))
    assert (a != b).any()


def test_a_fluid_that_cannot_be_placed_names_the_nearest():
    with pytest.raises(InputError, match=r"n = 5 cannot be placed .* nearest number that can is 4"):
        scenes.fluid(n=5, packing_fraction=0.49)
    with pytest.raises(InputError, match=r"packing_fraction is 0\.8"):
        scenes.fluid(packing_fraction=0.8)
    with pytest.raises(InputError, match="n is 1; it must be at least 2"):
        scenes.fluid(n=1)


@pytest.mark.parametrize("restitution", [0, 0.5, 0.8])
def test_bouncing_balls_come_to_rest_on_the_floor(restitution):
    sim = Simulation(scenes.bounce(n=10, restitution=restitution))
    assert (sim.position[:, 2] > 0).all()
    sim.run(until=200)  # they slide for ever, and now and then still kick one another up
    assert sim.state.resting.all()
    np.testing.assert_allclose(sim.position[:, 2], -5 + sim.radius, atol=1e-12)


def test_a_giant_among_small_ones():
    scene = scenes.giant(n=400, radius_ratio=10, mass_ratio=100, packing_fraction=0.05)
    s = scene.spheres
    assert (s.radius[0], s.mass[0]) == (5, 100)
    assert (s.radius[1:] == 0.5).all()
    assert s.velocity[0].tolist() == [0, 0, 0]
    (box,) = scene.walls
    free = box.lx**3 - 4 / 3 * math.pi * 5**3
    assert 400 * math.pi / 6 / free == pytest.approx(0.05, rel=1e-12)
    sim = Simulation(scene)
    sim.run(collisions=500)
    assert sim.velocity[0].any()


def test_the_box_is_wide_enough_for_the_giant():
    (box,) = scenes.giant(n=50, radius_ratio=40, packing_fraction=0.2).walls
    assert box.lx == 44
