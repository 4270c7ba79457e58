"""What carom measures at moments, against theory and literature, by its own error bars."""

import math

import numpy as np
import pytest

import carom
import carom.place
from carom import observe

from .observed import measured, misses, mixture


class TestEnergy:
    def test_where_it_goes(self):
        sim = carom.Simulation(
            walls=carom.Box(9, 9, 9, restitution=0.9),
            rule=carom.Smooth(restitution=0.95),
            gravity=(0, 0, -0.05),
        )
        grid = 2.0 * np.stack(np.meshgrid(*[np.arange(4)] * 3), -1).reshape(-1, 3) - 3
        sim.add_many(grid, velocity=np.random.default_rng(1).normal(size=(64, 3)))
        energy = observe.Energy(every=0.5)
        sim.run(until=20, observe=energy)
        table = energy.result()
        assert len(table) == 41
        whole = sum(table[name] for name in list(table.columns)[1:5])
        assert whole == pytest.approx(np.full(41, whole[0]), rel=1e-12)
        assert table["dissipated_by_spheres"][-1] + table["dissipated_by_walls"][-1] == (
            pytest.approx(sim.dissipated, rel=1e-12)
        )
        for name in ("dissipated_by_spheres", "dissipated_by_walls"):
            assert (np.diff(table[name]) >= -1e-12).all()
            assert table[name][-1] > 1

    def test_rest_takes_what_is_left(self):
        sim = carom.Simulation(walls=carom.Box(9, 9, 9, restitution=0.5), gravity=(0, 0, -1))
        sim.add(position=(0, 0, 1))
        energy = observe.Energy(at=[50])
        sim.run(until=50, observe=energy)
        table = energy.result()
        assert sim.resting[0]
        assert table["dissipated_by_walls"][-1] == pytest.approx(sim.dissipated, rel=1e-12)
        assert abs(table["dissipated_by_spheres"][-1]) < 1e-12

    def test_what_the_cure_withholds(self):
        rule = carom.Smooth(restitution=0.5, contact_time=0.5)
        sim = carom.Simulation(carom.scenes.fluid(n=100, packing_fraction=0.3), rule=rule)
        energy = observe.Energy(every=0.1)
        sim.run(until=2, observe=energy)
        assert energy.result()["withheld"][-1] == pytest.approx(sim.withheld, rel=0.2)
        assert sim.withheld > 0

    def test_equipartition(self):
        sim, kT = mixture(), observe.Temperature()
        sim.run(collisions=400_000, observe=kT)
        table = kT.result()
        assert len(table) == 2
        assert (np.abs(misses(table, "temperature")) < 4).all()
        for axis in ("along_x", "along_y", "along_z"):
            for row in (0, 1):
                assert abs(table.estimate(axis, row).deviation(1.0)) < 4

    def test_overlap_is_rounding(self):
        deepest = observe.MaxOverlap()
        sim = measured(0.3, deepest, collisions=20_000)
        assert deepest.result().value == sim.max_overlap < 1e-12


class TestSpeeds:
    @pytest.mark.parametrize("walls", [carom.Periodic(4, 4, 4), carom.Box(4, 4, 4)])
    def test_six_spheres_follow_their_law_and_not_maxwells(self, walls):
        sim = carom.Simulation(walls=walls)
        rng = np.random.default_rng(4)
        places = [(1, 1, 1), (-1, -1, 1), (-1, 1, -1), (1, -1, -1), (1, 1, -1), (-1, -1, -1)]
        velocity = rng.normal(size=(6, 3))
        velocity -= velocity.mean(axis=0)
        sim.add_many(places, velocity=velocity)
        sim.run(collisions=1000)
        speeds = observe.SpeedDistribution()
        sim.run(collisions=150_000, observe=speeds)
        found = speeds.chi_square()
        assert found.p > 1e-3
        assert found.freedom > 10
        v = speeds.result()["speed"]
        density = v**2 * np.exp(-(v**2) / (2 * sim.temperature))
        maxwell = density / density.sum() * speeds._counts.sum()
        wrong = type(found).of(speeds._counts[:-1], maxwell, 1)
        assert wrong.p < 1e-6

    def test_p_values(self):
        """Against tables: chi-square of 18.307 has p = 0.05 with ten degrees of freedom."""
        e = np.full(11, 100.0)
        off = math.sqrt(18.307 * 100 / 2)
        o = e + np.array([off, -off] + [0.0] * 9)
        found = observe.speeds.ChiSquare.of(o, e, 1)
        assert found.value == pytest.approx(18.307)
        assert found.p == pytest.approx(0.05, abs=0.003)
        few = observe.speeds.ChiSquare.of(np.full(9, 2.0), np.full(9, 2.0), 1)
        assert few.freedom == 2  # three and three of two each are joined

    def test_a_fluid(self):
        speeds = observe.SpeedDistribution()
        measured(0.3, speeds)
        assert speeds.chi_square().p > 1e-3
        assert "energy" in speeds.result().theory

    def test_h_falls_to_its_equilibrium(self):
        sim = carom.Simulation(carom.scenes.gas(n=2000, seed=3))
        h = observe.HFunction(every=0.4)
        sim.run(collisions=20_000, observe=h)
        table = h.result()
        assert table["time"][0] == 0
        assert table["h"][0] > table["h"][3] > table["h"][10] > table["h_theory"][0]
        late = misses(table, "h")[-20:]
        assert np.abs(late).max() < 5
        assert 0.3 < late.std() < 2


class TestMemory:
    def test_free_flight(self):
        scene = carom.scenes.fluid(n=200, packing_fraction=0.1)
        sim = carom.Simulation(scene, collide=False)
        msd, vacf = observe.MSD(at=[1, 10, 100]), observe.VACF(at=[1, 10])
        sim.run(until=100, observe=[msd, vacf])
        square = (sim.velocity**2).sum(axis=1).mean()
        assert msd.result()["msd"] == pytest.approx(square * np.array([1, 100, 1e4]), rel=1e-12)
        assert vacf.result()["vacf"] == pytest.approx([1, 1], rel=1e-12)

    def test_a_moving_whole_does_not_count(self):
        sim = carom.Simulation(walls=carom.Periodic(9, 9, 9))
        sim.add_many([(0, 0, 0), (2, 2, 2)], velocity=(1, 2, 3))
        msd = observe.MSD(at=[50])
        sim.run(until=50, observe=msd)
        assert msd.result()["msd"][0] < 1e-20

    def test_short_times_are_enskogs(self):
        msd, vacf = (kind(at=[0.002, 0.01, 0.02]) for kind in (observe.MSD, observe.VACF))
        measured(0.3, msd, vacf, collisions=100_000)
        # Exact are the slopes at 0; the lines hold to (omega t)^2/20 or so.
        for table, column in ((msd.result(), "msd"), (vacf.result(), "vacf")):
            line, error = table[f"{column}_theory"], table[f"{column}_error"]
            allowed = np.hypot(error, 0.01 * (10.1 * table["time"]) ** 2 * line)
            assert (np.abs(table[column] - line) < 4 * allowed).all()

    def test_errors_of_one_window_are_as_large_as_the_scatter_of_many(self):
        one, many = observe.MSD(at=[0.5]), observe.MSD(at=[0.5])
        sim = measured(0.3, many, collisions=400_000)
        assert many.samples > 100
        sim.run(duration=0.6, observe=one)
        error = float(many.result()["msd_error"][0]) * math.sqrt(many.samples)
        assert float(one.result()["msd_error"][0]) == pytest.approx(error, rel=0.25)

    def test_diffusion(self):
        """rho = 1/2, N = 1372: D(L) = 0.2490(24) by two other programs, windows 5 to 30."""
        phi = math.pi / 12
        d = observe.Diffusion(between=(5, 30))
        measured(phi, d, collisions=2_000_000, n=1372)
        table = d.result()
        here, beyond = table.estimate("value", 0), table.estimate("value", 1)
        assert abs(here.deviation(0.2490, 0.0024)) < 4
        assert here.error < 0.02
        # Yeh and Hummer: 2.837297/(6 pi eta L), Enskog's eta = 0.557 here.
        side = (1372 / 0.5) ** (1 / 3)
        assert beyond.value - here.value == pytest.approx(
            2.837297 / (6 * math.pi * 0.557 * side), rel=0.01
        )
        # Enskog: 1.018954 * 3/(8 rho chi sqrt(pi)) with chi = 2.167.
        assert table["value_theory"][1] == pytest.approx(0.1990, rel=0.003)
        given = observe.Diffusion(between=(0.5, 1), viscosity=0.538)
        measured(phi, given, collisions=20_000, n=1372)
        assert "with viscosity 0.538" in given.result().notes[0]


class TestSpace:
    def test_a_crystal(self):
        """Twelve neighbours at one distance, six at sqrt(2) times it."""
        side = 4 * math.sqrt(2) * 1.2
        sites = carom.place.fcc(4, 4, 4, size=side)
        sim = carom.Simulation(walls=carom.Periodic(side, side, side))
        sim.add_many(sites)
        rdf = observe.RDF(at=[0])
        sim.run(until=0, observe=rdf)
        table = rdf.result()
        width = table["distance"][1] - table["distance"][0]
        shell = 4 * math.pi * table["distance"] ** 2 * width
        around = table["g"] * shell * 255 / side**3
        for distance, many in ((1.2, 12), (1.2 * math.sqrt(2), 6)):
            near = np.abs(table["distance"] - distance) < 0.03
            assert around[near].sum() == pytest.approx(many, rel=2e-4)
        assert around[table["distance"] < 1.1].sum() == 0
        assert np.isnan(table["g_error"][0])

    def test_contact_value_of_a_fluid(self):
        rdf = observe.RDF(every=0.5)
        measured(0.3, rdf, collisions=200_000)
        table = rdf.result()
        first = np.flatnonzero((table["distance"] > 1) & (table["distance"] < 1.1))
        fit = np.polyfit(table["distance"][first] - 1, table["g"][first], 1)
        chi = (1 - 0.15) / (1 - 0.3) ** 3
        assert fit[1] == pytest.approx(chi, rel=0.03)
        assert table["distance"][0] == pytest.approx(1.01)
        far = table["distance"] > 2.7
        assert table["g"][far].mean() == pytest.approx(1, abs=0.02)

    def test_in_a_small_box_too_a_bin_begins_at_contact(self):
        """A bin that reaches below it would show too few where spheres are densest."""
        rdf = observe.RDF(every=1)
        sim = carom.Simulation(carom.scenes.fluid(n=32, packing_fraction=0.3, seed=1))
        sim.run(collisions=2000)
        sim.run(collisions=200_000, observe=rdf)
        table = rdf.result()
        assert table["distance"][:2] == pytest.approx([1.01, 1.03], abs=1e-9)
        assert table["distance"][-1] < sim.world.period[0] / 2
        chi = (1 - 0.15) / (1 - 0.3) ** 3
        assert table["g"][0] == pytest.approx(chi, abs=5 * table["g_error"][0])

    @pytest.mark.parametrize("reach", [0.6, 1.5, 2.9])
    def test_distances_are_those_of_all_pairs(self, reach):
        rng = np.random.default_rng(1)
        period = np.array([6.0, 7.0, 8.0])
        position = (rng.random((200, 3)) - 0.5) * period
        centres = np.arange(0, 200, 3)
        apart = position[centres, None] - position
        apart -= period * np.rint(apart / period)
        all_ = np.sqrt((apart**2).sum(axis=2))
        all_ = all_[(all_ <= reach) & (all_ > 0)]
        found, start, end = observe.radial.distances(position, period, centres, reach)
        assert np.sort(found) == pytest.approx(np.sort(all_), rel=1e-12)
        apart = position[start] - position[end]
        apart -= period * np.rint(apart / period)
        assert found == pytest.approx(np.sqrt((apart**2).sum(axis=1)), rel=1e-12)

    def test_a_uniform_fluid(self):
        density, kT = (
            observe.DensityProfile("x", 10, every=2), observe.TemperatureProfile("y", 8, every=2)
        )  # fmt: skip
        measured(0.2, density, kT, collisions=1_000_000, n=300)
        for table, column in ((density.result(), "density"), (kT.result(), "temperature")):
            off = misses(table, column)
            assert np.isfinite(off).sum() >= 6
            assert np.nanmax(np.abs(off)) < 4.5
        assert density.result()["density"].mean() == pytest.approx(0.2 * 6 / math.pi, rel=1e-12)

    def test_an_atmosphere(self):
        """Dilute enough that the barometric formula holds to a hundredth or so."""
        width, high = 60.0, 60.0
        walls = [carom.Periodic(width, width, None), carom.Plane((0, 0, 1), 0),
                 carom.Plane((0, 0, -1), -high)]  # fmt: skip
        sim = carom.Simulation(walls=walls, gravity=(0, 0, -0.2))
        rng = np.random.default_rng(3)
        grid = np.stack(np.meshgrid(*[np.arange(6)] * 3), -1).reshape(-1, 3)
        velocity = rng.normal(size=(216, 3))
        sim.add_many(grid * [9, 9, 2] - [25, 25, -1], velocity=velocity)
        sim.run(until=600)
        density, kT = observe.DensityProfile(bins=12, every=4), observe.TemperatureProfile(
            bins=12, every=4
        )  # fmt: skip
        sim.run(duration=8000, observe=[density, kT])
        table = density.result()
        low = np.isfinite(table["density_error"])  # higher up spheres come too rarely
        low &= table["density"] > 0
        assert low.sum() >= 4
        off = table["density"][low] / table["density_theory"][low] - 1
        error = table["density_error"][low] / table["density"][low]
        assert (np.abs(off) < 4 * np.hypot(error, 0.03)).all()
        assert table["density"][0] > 10 * table["density"][-4]
        warm = kT.result()
        assert math.isnan(warm["temperature_theory"][0])
        assert warm["temperature"][:4] == pytest.approx(sim.temperature, rel=0.1)
