"""What carom measures against what theory and literature say, by its own error bars."""

import math
from functools import cache

import numpy as np
import pytest

import carom
import carom.place
from carom import observe, theory

from .test_equation_of_state import reference

N = 1000


@cache
def fluid(phi, n=N, seed=5):
    """A fluid that has forgotten its lattice; go back to the bookmark before each use."""
    sim = carom.Simulation(carom.scenes.fluid(n=n, packing_fraction=phi, seed=seed))
    sim.run(collisions=60 * n)
    return sim, sim.bookmark()


def measured(phi, *observables, collisions=400_000, n=N):
    sim, mark = fluid(phi, n)
    sim.return_to(mark)
    sim.run(collisions=collisions, observe=observables)
    return sim


def misses(table, column):
    """How many standard errors each row is off the theory."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return (table[column] - table[f"{column}_theory"]) / table[f"{column}_error"]


def mixture(n=1000, seed=2):
    """As many spheres of diameter 1/2 and mass 1/8 as of diameter and mass 1, phi = 0.3."""
    side = (n / 2 * math.pi / 6 * (1 + 1 / 8) / 0.3) ** (1 / 3)
    cells = math.ceil((n / 4) ** (1 / 3))
    rng = np.random.default_rng(seed)
    cell = side / cells
    base = np.array([[0, 0, 0], [0, 0.5, 0.5], [0.5, 0, 0.5], [0.5, 0.5, 0]])
    grid = np.stack(np.meshgrid(*[np.arange(cells)] * 3), -1).reshape(-1, 1, 3)
    sites = ((grid + base) * cell).reshape(-1, 3)[:n] - side / 2 + cell / 4
    big = np.zeros(n, bool)
    big[rng.permutation(n)[: n // 2]] = True
    mass = np.where(big, 1.0, 0.125)
    velocity = rng.normal(size=(n, 3)) / np.sqrt(mass)[:, None]
    velocity -= (mass @ velocity) / mass.sum()
    velocity *= math.sqrt((3 * n - 3) / float(mass @ (velocity**2).sum(axis=1)))
    sim = carom.Simulation(walls=carom.Periodic(side, side, side))
    sim.add_many(sites, velocity=velocity, radius=np.where(big, 0.5, 0.25), mass=mass)
    sim.run(collisions=100 * n)
    return sim


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
        assert z.theory().value == pytest.approx(theory.carnahan_starling(float(eta)), rel=1e-12)

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
        assert z.theory() is None
        assert math.isnan(z.table()["value_theory"][0])

    def test_tensor(self):
        tensor, z = observe.PressureTensor(), observe.Compressibility()
        sim = measured(0.3, tensor, z)
        found = tensor.result()
        assert (np.abs(misses(found, "pressure")) < 4).all()
        density_kT = N * sim.temperature / sim.world.period.prod()
        trace = found["pressure"][:3].mean()
        # The kinetic part of N spheres at rest together is (N - 1) kT.
        assert trace == pytest.approx((z.result().value - 1 / N) * density_kT, rel=1e-3)
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

    def test_times_are_no_exponential(self, dilute):
        """<t^2>/<t>^2 = 2.0761308 by quadrature of the kinetic theory; an exponential has 2."""
        flights = dilute[1]._enskog
        t = (np.arange(12_000) + 0.5) * 5e-3 / flights.rate
        density = flights.times(t)
        step = t[1] - t[0]
        assert density @ t**2 * step * flights.rate**2 == pytest.approx(2.0761308, abs=1e-5)

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
        found = observe.space.distances(position, period, centres, reach)
        assert np.sort(found) == pytest.approx(np.sort(all_), rel=1e-12)

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
