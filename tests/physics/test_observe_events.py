"""What carom measures from events, against theory and literature, by its own error bars."""

import math

import numpy as np
import pytest

import carom
import carom.place
from carom import observe, theory

from .observed import N, fluid, measured, misses, mixture
from .test_equation_of_state import reference


class TestPressure:
    @pytest.mark.parametrize("eta", ["0.1", "0.3", "0.45"])
    def test_compressibility(self, eta):
        z = observe.Compressibility()
        measured(float(eta), z)
        found, known = z.result(), reference(eta)
        # For N spheres Z is lower by fsc/N; `reference` has that of 4000.
        finite = {"0.1": -0.386, "0.3": -1.188, "0.45": -2.003}[eta]
        expected = 1 + known.excess + finite * (1 / N - 1 / 4000)
        assert abs(found.deviation(expected)) < 4
        assert 0 < found.error < 0.006 * found.value
        assert z.theory().value == pytest.approx(
            theory.kolafa_labik_malijevsky(float(eta)), rel=1e-12
        )

    def test_it_is_the_sum_of_the_impulses(self):
        z = observe.Compressibility()
        sim = measured(0.3, z, collisions=10_000)
        virial = np.linalg.norm(sim.events["impulse"], axis=1).sum()
        expected = 1 + virial / (3 * N * sim.temperature * z.duration)
        assert z.result().value == pytest.approx(expected, rel=1e-12)

    def test_error_bars_are_as_large_as_the_scatter(self):
        found = []
        for seed in range(12):
            sim, mark = fluid(0.2, 200, seed)
            sim.return_to(mark)
            z = observe.Compressibility()
            sim.run(collisions=30_000, observe=z)
            found.append(z.result())
        scatter = np.std([e.value for e in found], ddof=1)
        # Of twelve values the scatter itself is known to a fifth.
        assert 0.5 < scatter / np.mean([e.error for e in found]) < 1.7

    def test_a_mixture(self):
        z, sim = observe.Compressibility(), mixture()
        sim.run(collisions=300_000, observe=z)
        # Event-driven runs of 4000 spheres gave 3.5162(15); BMCSL says 3.5058.
        assert abs(z.result().deviation(3.5162, 0.004)) < 4
        assert z.theory().value == pytest.approx(3.5058, abs=1e-4)

    def test_an_ideal_gas(self):
        scene = carom.scenes.fluid(n=100, packing_fraction=0.1)
        z = observe.Compressibility()
        carom.Simulation(scene, collide=False).run(duration=1, observe=z)
        assert (z.result().value, z.theory().value) == (1, 1)

    def test_a_crystal_has_no_theory_of_fluids(self):
        z = observe.Compressibility()
        carom.Simulation(carom.scenes.fluid(n=500, packing_fraction=0.6)).run(
            collisions=5000, observe=z
        )
        assert math.isnan(z.theory().value)
        assert "hard spheres freeze" in z.table().theory

    def test_tensor(self):
        tensor, z = observe.PressureTensor(), observe.Compressibility()
        sim = measured(0.3, tensor, z)
        found = tensor.result()
        assert (np.abs(misses(found, "pressure")) < 4).all()
        density_kT = N * sim.temperature / sim.world.period.prod()
        trace = found["pressure"][:3].mean()
        # The kinetic part of N spheres at rest together is (N - 1) kT.
        assert trace == pytest.approx((z.result().value - 1 / N) * density_kT, rel=1e-3)
        volume = sim.world.period.prod()
        expected = z.theory().value * density_kT - sim.temperature / volume
        assert found["pressure_theory"][0] == pytest.approx(expected, rel=1e-12)
        assert found["component"].tolist() == ["xx", "yy", "zz", "xy", "xz", "yz"]

    def test_walls(self):
        sim = carom.Simulation(carom.scenes.gas(n=300))
        sim.run(collisions=20_000)
        walls = observe.WallPressure()
        sim.run(collisions=100_000, observe=walls)
        found = walls.result()
        assert len(found) == 6
        assert (np.abs(misses(found, "pressure")) < 4).all()
        assert found["pressure_theory"][0] > 0

    def test_the_floor_carries_the_weight(self):
        sim = carom.Simulation(
            walls=[carom.Periodic(8, 8, None), carom.Plane((0, 0, 1), 0),
                   carom.Plane((0, 0, -1), -40)],
            gravity=(0, 0, -0.5),
        )  # fmt: skip
        grid = np.stack(np.meshgrid(*[np.arange(4)] * 3), -1).reshape(-1, 3)
        sim.add_many(grid * 2 - [4, 4, -1], velocity=np.random.default_rng(1).normal(size=(64, 3)))
        sim.run(events=20_000)
        walls = observe.WallPressure()
        sim.run(events=100_000, observe=walls)
        assert abs(walls.result().estimate("pressure", 0).deviation(64 * 0.5 / 64)) < 4


class TestRates:
    @pytest.mark.parametrize("eta", ["0.1", "0.3", "0.45"])
    def test_one_kind(self, eta):
        rate = observe.CollisionRate()
        sim = measured(float(eta), rate)
        found = rate.result().estimate("rate", 0)
        assert found.value == pytest.approx(2 * 400_000 / (N * rate.duration), rel=1e-12)
        known = reference(eta)
        finite = {"0.1": -0.386, "0.3": -1.188, "0.45": -2.003}[eta]
        share = 1 + finite * (1 / N - 1 / 4000) / known.excess
        assert abs(found.deviation(known.rate * share)) < 4
        assert sim.collisions > 0

    def test_pairs_of_kinds(self):
        rate, sim = observe.CollisionRate(), mixture()
        start = sim.collisions
        sim.run(collisions=300_000, observe=rate)
        table = rate.result()
        assert table["of"].tolist()[:2] == ["r=0.25 m=0.125"] * 2
        small, mixed, back, big = (table.estimate("rate", row) for row in range(4))
        # Pairs per volume and time: 2.4260(25), 4.7686(41), 1.2830(21) with 4000 spheres.
        density = 500 / float(sim.world.period.prod())
        for found, known, factor in ((big, 2.4260, 2), (mixed, 4.7686, 1), (small, 1.2830, 2)):
            assert abs(found.deviation(known / density * factor, 0.004 * found.value)) < 4
        assert mixed.value == pytest.approx(back.value, rel=1e-12)
        both = (small.value + big.value) / 2 + mixed.value
        assert both * 500 * rate.duration == pytest.approx(sim.collisions - start, rel=1e-9)
        assert table["rate_theory"][3] == pytest.approx(2.4007 / density * 2, rel=1e-3)
        assert table["rate_theory"][1] == pytest.approx(4.7855 / density, rel=1e-3)

    def test_collisions_per_sphere(self):
        counts = observe.CollisionsPerSphere()
        measured(0.2, counts, collisions=20_000)
        table = counts.result()
        assert (table["collisions"] * table["spheres"]).sum() == 40_000
        assert table["spheres"].sum() == N == len(counts.counts())


@pytest.fixture(scope="module")
def dilute():
    time, path = observe.FreeTime(), observe.FreePath()
    return measured(0.005, time, path, collisions=1_500_000), time, path


class TestFlights:
    """Where it is dilute: flights know nothing of one another, and theory is exact."""

    def test_means(self, dilute):
        _, time, path = dilute
        for one in (time, path):
            found, expected = one.mean(), one.theory().value
            assert abs(found.deviation(expected, 1e-3 * expected)) < 4
            assert 0 < found.error < 0.02 * found.value
        # <v>/omega: n sigma^2 lambda = 1/(sqrt(2) pi chi) with the contact value chi.
        chi = (1 - 0.0025) / (1 - 0.005) ** 3
        assert path.theory().value * 0.005 * 6 / math.pi * chi == pytest.approx(
            0.2250790790, rel=1e-4
        )

    @pytest.mark.parametrize("which", [1, 2])
    def test_distributions(self, dilute, which):
        table = dilute[which].result()
        counted = table["density_error"] > 0
        off = misses(table, "density")[counted]
        assert (off**2).mean() < 2.2
        assert np.abs(off).max() < 5
        width = np.diff(table[next(iter(table.columns))])[0]
        assert table["density"].sum() * width == pytest.approx(1, abs=0.02)

    def test_of_many_spheres_the_distribution_is_as_wide(self):
        """In a batch few of them collide twice, and those that do have flown shortly."""
        sim = carom.Simulation(carom.scenes.fluid(n=30_000, packing_fraction=0.25, seed=1))
        sim.run(collisions=30_000)
        for one in (observe.FreeTime(), observe.FreePath()):
            sim.run(collisions=200_000, observe=one)
            table, mean = one.result(), one.mean().value
            along = table[next(iter(table.columns))]
            assert along[-1] == pytest.approx(8 * mean, rel=0.1)
            assert table["density"].sum() * (along[1] - along[0]) == pytest.approx(1, abs=0.02)

    def test_speeds_are_followed(self, dilute):
        sim, _, path = dilute
        followed = path._followed
        assert followed.sum() >= 62
        off = path._velocity.T[followed] - sim.velocity[followed]
        assert np.abs(off).max() < 1e-9

    def test_a_single_sphere_between_walls(self):
        sim = carom.Simulation(walls=carom.Box(5, 5, 5))
        sim.add(velocity=(2, 0, 0))
        time, path = observe.FreeTime(), observe.FreePath()
        sim.run(until=400, observe=[time, path])
        assert time.mean().value == pytest.approx(400 / 200, rel=1e-9)
        assert path.mean().value == pytest.approx(4, rel=1e-9)
        table = path.result()
        assert table["length"][table["density"].argmax()] == pytest.approx(4, abs=0.4)
