"""Pressure on walls: the book-keeping, the rooms, and a gas that agrees with theory."""

import math
import time

import numpy as np
import pytest

import carom
from carom.mechanics import volume as volume_of
from carom.theory import wall_pressure
from carom.view.pressure import WallPressure


def grid(n, spacing=2.0):
    axis = spacing * (np.arange(n) - (n - 1) / 2)
    return np.stack(np.meshgrid(axis, axis, axis), -1).reshape(-1, 3)


def filled(walls, n=4, spacing=2.0, radius=0.5, **options):
    """Spheres on a grid between walls, with random velocities."""
    sim = carom.Simulation(walls=walls, **options)
    places = grid(n, spacing)
    velocity = np.random.default_rng(3).normal(size=places.shape)
    sim.add_many(places, velocity=velocity, radius=radius)
    return sim


def meter(sim, **options):
    return WallPressure(sim.world, sim.state, **options)


class TestCounting:
    def test_one_ball_between_walls(self):
        sim = carom.Simulation(walls=carom.Box(5, 6, 7))
        sim.add(velocity=(2, 0, 0), mass=3)
        walls = meter(sim)
        assert np.isnan(walls.pressure).all()
        for _ in range(10):
            sim.run(duration=4)
            walls.add(sim.events, 4)
        # Centres reach 4 x 5 x 6. Ten hits of each wall in 40, with 2 m v each.
        expected = 10 * 2 * 3 * 2 / 40 / (5 * 6)
        assert walls.duration == 40
        assert walls.pressure == pytest.approx([expected, expected, 0, 0, 0, 0], rel=1e-12)
        assert sim.wall_collisions == 20

    def test_the_window_slides(self):
        sim = carom.Simulation(walls=carom.Box(5, 5, 5))
        sim.add(velocity=(2, 0, 0))
        walls = meter(sim, window=8)
        for _ in range(10):
            sim.run(duration=2)
            walls.add(sim.events, 2)
        assert walls.duration == 8
        early = walls.pressure.sum()
        sim.velocity = 2 * sim.velocity
        for _ in range(4):
            sim.run(duration=2)
            walls.add(sim.events, 2)
        assert walls.pressure.sum() == pytest.approx(4 * early)

    def test_a_slanting_hit_counts_its_normal_part(self):
        for back in ("specular", "bounce-back"):
            sim = carom.Simulation(walls=carom.Box(5, 5, 5, reflection=back))
            sim.add(velocity=(1, 0.7, 0))
            walls = meter(sim)
            sim.run(events=1)
            walls.add(sim.events, sim.time)
            assert walls.pressure[1] == pytest.approx(2 / sim.time / 16)

    def test_round_walls(self):
        sphere = carom.Simulation(walls=carom.Sphere(3.5))
        sphere.add(velocity=(1, 2, 2))
        tube = carom.Simulation(walls=carom.Cylinder(3.5, 7))
        tube.add(velocity=(3, 0, 0))
        areas = 4 * math.pi * 9, 2 * math.pi * 3 * 6
        for sim, area in zip((sphere, tube), areas, strict=True):
            walls = meter(sim)
            sim.run(events=8)
            walls.add(sim.events, sim.time)
            assert walls.pressure[0] == pytest.approx(8 * 2 * 3 / sim.time / area)
        turned = carom.Simulation(walls=carom.Sphere(3.5, reflection="bounce-back"))
        turned.add(velocity=(1, 2, 2))
        walls = meter(turned)
        turned.run(events=8)
        walls.add(turned.events, turned.time)
        assert np.isnan(walls.pressure).all()

    def test_the_impulse_of_coming_to_rest_counts_and_waking_has_none(self):
        floor = carom.Box(9, 9, 9, restitution=0.5)
        sim = carom.Simulation(walls=floor, gravity=(0, 0, -1))
        sim.add()
        walls = meter(sim)
        sim.run(until=30)
        walls.add(sim.events, 30)
        assert sim.state.resting.all()
        resting = sim.events["j"] <= -(2**20)
        assert resting.sum() == 1
        total = np.abs(sim.events["impulse"][:, 2]).sum()
        assert walls.pressure[4] == pytest.approx(total / 30 / 64, rel=1e-12)
        sim.add(position=(0, 0, 3), velocity=(0, 0, -1))
        walls = meter(sim)
        sim.run(duration=4)
        assert (sim.events["j"] == -(2**21)).any()
        walls.add(sim.events, 4)
        hits = sim.events["j"] == -5
        total = np.abs(sim.events["impulse"][hits, 2]).sum()
        assert walls.pressure[4] >= total / 4 / 64 > 0

    def test_it_costs_next_to_nothing(self):
        sim = carom.Simulation(carom.scenes.gas(n=2000, packing_fraction=0.02))
        sim.run(events=10_000)
        walls, taken = meter(sim), []
        for _ in range(20):
            begin = time.perf_counter()
            walls.add(sim.events, 1.0)
            taken.append(time.perf_counter() - begin)
        assert min(taken) < 1e-3


class TestRooms:
    @pytest.mark.parametrize(
        "walls",
        [
            carom.Box(9, 10, 11),
            carom.Sphere(7.5),
            carom.Cylinder(6.5, 9),
            [carom.Periodic(9, 10, None), carom.Plane((0, 0, 1), -5), carom.Plane((0, 0, -1), -5)],
        ],
        ids=str,
    )
    def test_an_ideal_gas_has_the_volume_that_centres_reach(self, walls):
        sim = filled(walls, n=3, collide=False)
        # Walls half a diameter further in leave that volume to points.
        inner = sim.world
        inner.walls["offset"][:] += np.where(inner.walls["kind"] == 0, 0.5, -0.5)
        reached = 27 / volume_of(inner)
        assert meter(filled(walls, n=3, collide=False)).theory(2.0) == pytest.approx(2 * reached)

    def test_surface_and_stretch_follow_from_moving_all_walls_outwards(self):
        d = 1e-6
        for walls, wider in [
            (carom.Box(9, 10, 11), carom.Box(9 + 2 * d, 10 + 2 * d, 11 + 2 * d)),
            (carom.Sphere(7.5), carom.Sphere(7.5 + d)),
            (carom.Cylinder(6.5, 9), carom.Cylinder(6.5 + d, 9 + 2 * d)),
        ]:
            rooms = [meter(filled(w, n=3, collide=False)) for w in (walls, wider)]
            volumes = [27 / each.theory(1.0) for each in rooms]
            areas = [each._areas.sum() for each in rooms]
            area = (volumes[1] - volumes[0]) / d
            assert areas[0] == pytest.approx(area, rel=1e-5)
            stretch = (areas[1] - areas[0]) / (volumes[1] - volumes[0])
            expected = wall_pressure(np.full(27, 0.5), volumes[0], areas[0], stretch)
            assert meter(filled(walls, n=3)).theory(1.0) == pytest.approx(expected, rel=1e-6)

    @pytest.mark.parametrize(
        ("walls", "options"),
        [
            (carom.Plane((0, 0, 1), -9), {}),
            (carom.Periodic(9, 9, 9), {}),
            (carom.Open(), {}),
            ([carom.Plane((0, 0, 1), -9), carom.Plane((0, 0, -1), -9)], {}),
            ([carom.Sphere(9), carom.Plane((0, 0, 1), -5)], {}),
            ([carom.Box(9, 9, 9), carom.Plane((1, 1, 0), -9)], {}),
            ([carom.Box(9, 9, 9), carom.Plane((0, 0, 1), -5)], {}),
            (carom.Box(9, 9, 9, restitution=0.9), {}),
            (carom.Box(9, 9, 9), {"rule": carom.Smooth(0.9)}),
            (carom.Box(9, 9, 9), {"gravity": (0, 0, -1)}),
            (carom.Box(3.3, 3.3, 3.3), {"n": 3, "spacing": 1.05}),
            (carom.Box(9, 9, 9), {"n": 2}),
        ],
        ids=str,
    )
    def test_where_there_is_no_gas_in_equilibrium_there_is_no_theory(self, walls, options):
        sim = filled(walls, **{"n": 3, **options})
        assert meter(sim).theory(1.0) is None

    def test_fixed_spheres_and_no_temperature(self):
        sim = filled(carom.Box(9, 9, 9), n=3)
        assert meter(sim).theory(1.0) > 27 / 8**3
        assert meter(sim).theory(math.nan) is None
        sim.add(position=(1, 1, 1), radius=0.1, fixed=True)
        assert meter(sim).theory(1.0) is None
        empty = carom.Simulation(walls=carom.Box(3, 3, 3))
        assert meter(empty).theory(1.0) is None

    def test_a_wall_without_end_has_no_pressure(self):
        sim = filled(carom.Plane((0, 0, 1), -5), n=3)
        walls = meter(sim)
        sim.run(until=3)
        walls.add(sim.events, 3)
        assert np.isnan(walls.pressure).all()


@pytest.mark.parametrize(
    ("walls", "radius", "within"),
    [
        (carom.Box(14, 16, 18), 0.5, 0.012),
        (carom.Sphere(11), 0.5, 0.012),
        (carom.Cylinder(9, 13.5), 0.5, 0.012),
        (carom.Box(14, 16, 18), np.where(np.arange(343) % 2, 0.6, 0.3), 0.012),
    ],
    ids=["box", "sphere", "cylinder", "mixture"],
)
def test_a_gas_presses_as_theory_says(walls, radius, within):
    options = {"n": 7, "spacing": 1.6}
    sim = filled(walls, radius=radius, **options)
    sim.run(collisions=5_000)
    gauge = meter(sim)
    measured = []
    for _ in range(10):
        before = sim.time
        sim.run(collisions=20_000)
        gauge.add(sim.events, sim.time - before)
        one = meter(sim)
        one.add(sim.events, sim.time - before)
        measured.append(float((one.pressure * one._areas).sum() / one._areas.sum()))
    mean, error = np.mean(measured), np.std(measured, ddof=1) / math.sqrt(len(measured))
    theory = gauge.theory(sim.temperature)
    total = float((gauge.pressure * gauge._areas).sum() / gauge._areas.sum())
    assert total == pytest.approx(mean, rel=1e-3)
    assert theory == pytest.approx(mean, abs=within * mean + 4 * error)
    assert error < 0.004 * mean
    # Without what the walls do, the same formulas are off by far more.
    n, volume = len(sim), len(sim) / meter(filled(walls, **options, collide=False)).theory(1.0)
    assert abs(n / volume * sim.temperature / mean - 1) > 3 * within
