"""Simulation: energy, momentum, temperature, filling and their errors."""

import math

import numpy as np
import pytest

import carom
from carom import mechanics

from .gases import each_method, gas


class TestNumbers:
    @pytest.mark.parametrize(
        ("options", "conserved"),
        [
            ({}, "xyz"),
            ({"walls": carom.Periodic(9, 9, 9)}, "xyz"),
            ({"walls": carom.Box(9, 9, 9)}, ""),
            ({"walls": carom.Box(9, 9, 9), "collide": False}, ""),
            ({"walls": [carom.Periodic(9, 9, None), carom.Plane((0, 0, 1), -5)]}, "xy"),
            ({"walls": carom.Plane((0, 0, 1), -5, 1, "bounce-back")}, ""),
            ({"walls": carom.Plane((1, 1, 0), -5)}, "z"),
            ({"walls": carom.Sphere(9)}, ""),
            ({"walls": carom.Cylinder(9, 9)}, ""),
            ({"gravity": (0, 0, -1)}, "xy"),
        ],
    )
    def test_temperature(self, options, conserved):
        sim = carom.Simulation(**options)
        velocity = np.array([[1.0, 2, 3], [0, -1, 1], [2, 2, -1]])
        mass = np.array([1.0, 2, 3])
        sim.add_many([(0, 0, 0), (2, 0, 0), (-2, 0, 0)], velocity=velocity, mass=mass)
        for axis in conserved:
            k = "xyz".index(axis)
            velocity[:, k] -= (mass @ velocity[:, k]) / mass.sum()
        kinetic = 0.5 * (mass[:, None] * velocity**2).sum()
        assert sim.temperature == pytest.approx(2 * kinetic / (9 - len(conserved)), rel=1e-14)

    def test_temperature_without_freedom_and_with_fixed(self):
        sim = carom.Simulation()
        assert math.isnan(sim.temperature)
        sim.add(velocity=(1, 0, 0))
        assert math.isnan(sim.temperature)
        sim.add(position=(5, 0, 0), fixed=True)
        assert sim.temperature == pytest.approx(1 / 3)

    @pytest.mark.parametrize(
        ("walls", "volume"),
        [
            (carom.Box(4, 5, 6), 120),
            (carom.Periodic(4, 5, 6), 120),
            (carom.Sphere(3), 36 * math.pi),
            (carom.Cylinder(3, 5), 45 * math.pi),
            (carom.Periodic(4, 5, None), math.nan),
            (
                [
                    carom.Periodic(4, 5, None),
                    carom.Plane((0, 0, 2), -1),
                    carom.Plane((0, 0, -1), -3),
                ],
                80,
            ),
            (carom.Open(), math.nan),
            (carom.Plane((0, 0, 1), -3), math.nan),
            ([carom.Sphere(3), carom.Plane((0, 0, 1), -1)], math.nan),
            ([carom.Box(4, 5, 6), carom.Plane((1, 1, 0), -2)], math.nan),
        ],
    )
    def test_packing_fraction(self, walls, volume):
        sim = carom.Simulation(walls=walls)
        sim.add(radius=0.5)
        expected = math.pi / 6 / volume
        assert sim.packing_fraction == pytest.approx(expected, rel=1e-14, nan_ok=True)

    def test_sums_are_accurate_for_a_million(self):
        rng = np.random.default_rng(2)
        state = carom.State.empty(10**6)
        state.velocity[:] = rng.normal(size=(10**6, 3)) + 3
        state.mass[:] = rng.uniform(0.5, 2, 10**6)
        half = 0.5 * state.mass * (state.velocity**2).sum(axis=1)
        assert mechanics.kinetic_energy(state) == pytest.approx(math.fsum(half), rel=1e-15)
        exact = [math.fsum(state.mass * column) for column in state.velocity.T]
        assert mechanics.momentum(state) == pytest.approx(exact, rel=1e-14)

    @each_method
    def test_drift_counts_errors_only(self, method):
        sim = gas(method, rule=carom.Smooth(0.9), gravity=(0, 0, -1))
        assert sim.energy_drift == 0
        sim.run(until=0.5)
        sim.velocity = 2 * sim.velocity
        sim.add(position=(0, 0, 0.99), radius=0.01)
        sim.mass = 3
        sim.run(until=1)
        assert sim.dissipated > 0.1
        assert abs(sim.energy_drift) < 1e-13

    def test_drift_sums_the_kinetic_energy_once(self, monkeypatch):
        sim = gas("exact", gravity=(0, 0, -1))
        sim.run(until=0.5)
        summed = []
        once = mechanics._kinetic
        monkeypatch.setattr(mechanics, "_kinetic", lambda *a: summed.append(a) or once(*a))
        assert abs(sim.energy_drift) < 1e-13
        assert len(summed) == 1

    @pytest.mark.parametrize("gravity", [(0, 0, 0), (0.1, -2, 0.3)])
    def test_energy_and_size(self, gravity):
        sim = gas("exact", gravity=gravity)
        state, world = sim.state, sim.world
        potential = -state.mass * (state.position @ world.gravity)
        energy, size = mechanics.energy_and_size(state, world)
        assert energy == mechanics.energy(state, world)
        assert size == pytest.approx(mechanics.kinetic_energy(state) + np.abs(potential).sum())

    @each_method
    def test_drift_is_never_nan(self, method):
        sim = carom.Simulation(method=method)
        sim.add()
        assert sim.energy_drift == 0
        sim.run(until=1)
        assert sim.energy_drift == 0
        sim = carom.Simulation(gravity=(0, 0, -1), method=method)
        sim.add(velocity=(0, 0, 1), position=(0, 0, -0.5))
        assert sim.kinetic_energy + sim.potential_energy == 0
        sim.run(until=3)
        assert abs(sim.energy_drift) < 1e-14

    def test_ticks_overlap_and_drift_and_are_told(self):
        sim = carom.Simulation(method="tick", tick=0.3, rule=carom.Smooth(1))
        sim.add(position=(-2, 0.3, 0), velocity=(1, 0, 0))
        ball = sim.add(position=(2, 0, 0), velocity=(-1, 0, 0))
        sim.run(until=3)
        assert sim.max_overlap > 0.01
        deepest = sim.max_overlap
        ball.velocity = (0, 1, 0)
        assert sim.max_overlap >= deepest
        sim.gravity = (0, 0, 0)
        sim.walls = carom.Box(20, 20, 20)
        sim.run(until=4)
        assert sim.time == pytest.approx(4)
