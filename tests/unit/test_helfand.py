"""Helfand's moments: by hand, against plain Python, and against positions where nothing wraps."""

import itertools
import math

import numpy as np
import pytest

import carom
from carom import observe
from carom._core import Helfand
from carom.observe import feed
from carom.observe.helfand import LAGS
from carom.state import EVENT

PAIRS = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
VISCOSITIES = (observe.ShearViscosity, observe.BulkViscosity, observe.ThermalConductivity)


def records(*events):
    return np.array(list(events), EVENT).view(np.uint8)


class Plain:
    """The same as the core, as it is written in books: sums over all spheres after each event."""

    def __init__(self, velocity, mass, radius, charge, time):
        self.v, self.mass, self.radius = velocity.copy(), mass, radius
        self.charge, self.time, self.moment = charge, time, np.zeros(12)

    def flux(self):
        energy = self.mass * (self.v**2).sum(axis=1) / 2
        stress = [(self.mass * self.v[:, a]) @ self.v[:, b] for a, b in PAIRS]
        return np.concatenate([stress, energy @ self.v, self.charge @ self.v])

    def wait(self, time):
        self.moment += self.flux() * (time - self.time)
        self.time = time

    def advance(self, events, times):
        found, times = [], list(times)
        for time, i, j, impulse in events:
            while times and times[0] < time:
                self.wait(times.pop(0))
                found.append(self.moment.copy())
            self.wait(time)
            before = self.mass[i] * (self.v[i] @ self.v[i]) / 2
            self.v[i] += impulse / self.mass[i]
            self.v[j] -= impulse / self.mass[j]
            after = self.mass[i] * (self.v[i] @ self.v[i]) / 2
            r = (self.radius[i] + self.radius[j]) * impulse / math.sqrt(impulse @ impulse)
            self.moment[:6] += [r[a] * impulse[b] for a, b in PAIRS]
            self.moment[6:9] += r * (after - before)
        for time in times:
            self.wait(time)
            found.append(self.moment.copy())
        return np.array(found)


class TestTwoSpheresByHand:
    def test_head_on(self):
        velocity = np.array([[1.0, 0, 0], [-1, 0, 0]])
        core = Helfand(velocity, np.ones(2), np.full(2, 0.5), np.array([1.0, 0]), 0.0)
        # Both stresses and no energy flux all along; at t = 2 the impulse crosses one diameter.
        found = core.advance(records((2.0, 0, 1, (-2.0, 0, 0))), np.array([1.0, 2.5]))
        assert found[0].tolist() == [2, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0]
        assert found[1].tolist() == [5 + 2, 0, 0, 0, 0, 0, 0, 0, 0, 2 - 0.5, 0, 0]

    def test_a_heavy_one_hit_from_the_side(self):
        velocity = np.array([[2.0, 1, 0], [0, 0, 1]])
        core = Helfand(
            velocity, np.array([1.0, 3]), np.array([0.5, 1]), np.array([1.0, -1]), 0.0
        )  # fmt: skip
        found = core.advance(records((1.0, 0, 1, (-3.0, 0, 0))), np.array([0.5, 3.0]))
        # Velocities (2, 1, 0) and (0, 0, 1) become (-1, 1, 0) and (1, 0, 1); energies 5/2 and 3/2
        # become 1 and 3. r = (-3/2, 0, 0); 3/2 of energy go against it, from 0 to 1.
        before = np.array([4, 1, 3, 2, 0, 0, 5, 2.5, 1.5, 2, 1, -1])
        after = np.array([4, 1, 3, -1, 3, 0, 2, 1, 3, -2, 1, -1])
        crossed = np.array([4.5, 0, 0, 0, 0, 0, 2.25, 0, 0, 0, 0, 0])
        assert found[0].tolist() == (before / 2).tolist()
        assert found[1].tolist() == (before + crossed + 2 * after).tolist()

    def test_it_is_what_the_observables_add_up(self):
        """Two spheres that meet head on along x, gaps of 3 and then of 8 between them."""
        sim = carom.Simulation(walls=carom.Periodic(10, 10, 10))
        sim.add_many([(-2, 0, 0), (2, 0, 0)], velocity=[(1, 0, 0), (-1, 0, 0)])
        shear, bulk, heat = made = [make(between=(24, 96)) for make in VISCOSITIES]
        sim.run(duration=192, observe=made)
        kT = 2 / 3  # of 3 degrees of freedom
        # They meet at t = 1.5, 5.5, 9.5 ...: 24 times in 96, and r J is 1 * 2.
        xx = 2 * 96 + 24 * 2
        squares = (xx**2 / 4 + xx**2 / 12) / 5  # of (xx - yy)/2 and (2 zz - xx - yy)/sqrt(12)
        assert shear.moments()["moment"][-1] == pytest.approx(squares / (2 * 1000 * kT))
        assert bulk.moments()["moment"] == pytest.approx(np.zeros(LAGS), abs=1e-9)
        assert heat.moments()["moment"] == pytest.approx(np.zeros(LAGS), abs=1e-9)

    def test_the_mean_pressure_goes_and_what_the_mean_hides_comes_back(self):
        """In windows a quarter as long as the run, a quarter is lost to the measured mean."""
        sim = carom.Simulation(walls=carom.Periodic(10, 10, 10))
        sim.add_many([(-2, 0, 0), (2, 0, 0)], velocity=[(1, 0, 0), (-1, 0, 0)])
        bulk = observe.BulkViscosity(between=(45, 90))  # steps of 3.75
        sim.run(duration=180, observe=bulk)
        # 45 collisions in all; in a window of 12 steps there are 11 or 12. G = (2 t + 2 n)/3.
        times = 1.5 + 4 * np.arange(45)
        ends = 3.75 * np.arange(LAGS, 49)
        counts = np.array([np.sum((times > end - 45) & (times <= end)) for end in ends])
        assert set(counts) == {11, 12}
        square = np.mean((2 / 3 * (counts - 45 / 4)) ** 2)
        expected = square / (2 * 1000 * 2 / 3) / (1 - 1 / 4)
        assert bulk.moments()["moment"][11] == pytest.approx(expected, rel=1e-9)


def of_three_kinds(n=60, seed=3):
    rng = np.random.default_rng(seed)
    sim = carom.Simulation(walls=carom.Periodic(5, 5, 5), keep_events=10**6)
    grid = np.stack(np.meshgrid(*[np.arange(4)] * 3), -1).reshape(-1, 3)[:n] * 1.25 - 1.9
    velocity = rng.normal(size=(n, 3))
    velocity -= velocity.mean(axis=0)
    sim.add_many(grid, velocity=velocity, radius=rng.choice([0.3, 0.4, 0.5], n))
    sim.mass = rng.choice([1.0, 2.0, 5.0], n)
    return sim


def test_as_plain_python():
    sim = of_three_kinds()
    charge = np.random.default_rng(1).normal(size=len(sim))
    given = sim.velocity.copy(), sim.mass.copy(), sim.radius.copy(), charge, 0.0
    sim.run(collisions=2000)
    times = np.linspace(0, sim.time, 50)
    found = Helfand(*given).advance(sim.events.view(np.uint8), times)
    expected = Plain(*given).advance(sim.events, times)
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-9 * np.abs(expected).max())


def test_its_bits_do_not_depend_on_batches():
    sim = of_three_kinds()
    given = sim.velocity.copy(), sim.mass.copy(), sim.radius.copy(), np.ones(len(sim)), 0.0
    sim.run(collisions=500)
    whole = Helfand(*given).advance(sim.events.view(np.uint8), np.array([sim.time]))
    core = Helfand(*given)
    for first in range(0, 500, 7):
        core.advance(sim.events[first : first + 7].view(np.uint8), np.zeros(0))
    assert (core.advance(records(), np.array([sim.time])) == whole).all()


def test_it_refuses_what_is_no_pair():
    core = Helfand(np.ones((2, 3)), np.ones(2), np.ones(2), np.ones(2), 0.0)
    for i, j in ((0, -1), (0, 2), (-1, 1)):
        with pytest.raises(ValueError, match="something else than two spheres"):
            core.advance(records((1.0, i, j, (1, 0, 0))), np.array([2.0]))
    with pytest.raises(ValueError, match="different lengths"):
        Helfand(np.ones((2, 3)), np.ones(3), np.ones(2), np.ones(2), 0.0)


def test_it_is_the_gain_of_what_is_carried():
    """Where nothing crosses a border, G_ab is sum x_a m v_b, and of energy and charge alike."""
    rng = np.random.default_rng(4)
    sim = carom.Simulation(walls=carom.Periodic(500, 500, 500), keep_events=10**6)
    grid = 1.1 * np.stack(np.meshgrid(*[np.arange(4)] * 3), -1).reshape(-1, 3)
    sim.add_many(grid, velocity=rng.normal(size=(64, 3)))
    sim.mass = rng.choice([1.0, 3.0], 64)
    charge = rng.normal(size=64)
    given = sim.velocity.copy(), sim.mass.copy(), sim.radius.copy(), charge, 0.0

    def carried():
        x, v, mass = sim.position.copy(), sim.velocity.copy(), sim.mass
        energy = mass * (v**2).sum(axis=1) / 2
        momentum = mass[:, None] * v
        return np.concatenate(
            [[x[:, a] @ momentum[:, b] for a, b in PAIRS], energy @ x, charge @ x]
        )

    before = carried()
    sim.run(until=20)
    assert sim.collisions > 50
    assert (np.abs(sim.position) < 200).all()
    found = Helfand(*given).advance(sim.events.view(np.uint8), np.array([20.0]))
    assert found[0] == pytest.approx(carried() - before, rel=1e-9, abs=1e-8)


SHORT = carom.scenes.fluid(n=108, packing_fraction=0.3, seed=2)
LAG = 0.1  # about a mean free time, so that no rounding error has grown far


def short(make, change=None, runs=1):
    sim = carom.Simulation(SHORT)
    sim.run(collisions=500)
    if change is not None:
        change(sim)
    made = make(between=(LAG / 2, LAG))
    for k in range(runs):
        sim.run(until=sim.time + 4 * LAG / runs if k < runs - 1 else START + 4 * LAG, observe=made)
    return made.moments()["moment"]


def _start():
    sim = carom.Simulation(SHORT)
    sim.run(collisions=500)
    return sim.time


START = _start()


@pytest.mark.parametrize("make", VISCOSITIES)
class TestWhatItMayNotDependOn:
    def test_steady_motion(self, make):
        def boost(sim):
            sim.velocity = sim.velocity + np.array([3.0, -2.0, 1.0])

        assert short(make, boost) == pytest.approx(short(make), rel=1e-8)

    def test_the_order_of_spheres(self, make):
        order = np.random.default_rng(1).permutation(108)

        def shuffle(sim):
            position, velocity = sim.position[order], sim.velocity[order]
            sim.position = position
            sim.velocity = velocity

        assert short(make, shuffle) == pytest.approx(short(make), rel=1e-8)

    def test_batches_and_slices(self, make, monkeypatch):
        whole = short(make)
        assert short(make, runs=3) == pytest.approx(whole, rel=1e-12)
        monkeypatch.setattr(feed, "BATCH", 50)
        assert (short(make) == whole).all()


class TestMutualDiffusion:
    """Four equal spheres, two of which are called by another species, in all six ways."""

    LATE = 6.0

    def measured(self, chosen):
        sim = carom.Simulation(walls=carom.Periodic(2.5, 2.5, 2.5))
        velocity = np.random.default_rng(7).normal(size=(4, 3))
        places = [(0, 0, 0), (1.2, 1.2, 0), (1.2, 0, 1.2), (0, 1.2, 1.2)]
        sim.add_many(places, velocity=velocity - velocity.mean(axis=0))
        sim.species = [int(k in chosen) for k in range(4)]
        made, msd = observe.MutualDiffusion(between=(1.0, self.LATE)), observe.MSD(at=[self.LATE])
        before = sim.state
        sim.run(duration=self.LATE, observe=[made, msd])
        after, sides = sim.state, np.full(3, 2.5)
        assert (np.abs(after.image) > 0).any()  # somebody went through a border
        moved = after.position + after.image * sides - before.position
        return made.moments()["moment"][-1], moved, msd.result()["msd"][0]

    def test_the_way_from_one_kind_to_the_other(self):
        moment, moved, _ = self.measured((1, 2))
        apart = moved[[1, 2]].mean(axis=0) - moved[[0, 3]].mean(axis=0)
        assert moment == pytest.approx(4 / 4 * (apart @ apart) / 6, rel=1e-9)

    def test_it_is_self_diffusion_when_only_names_differ(self):
        # The mean over all ways to name them is exact, but for N/(N - 1): displacements about the
        # centre of mass add up to zero.
        found = [self.measured(chosen) for chosen in itertools.combinations(range(4), 2)]
        mean = np.mean([moment for moment, _, _ in found])
        assert mean == pytest.approx(4 / 3 * found[0][2] / 6, rel=1e-9)


def test_the_table_and_its_picture():
    sim = carom.Simulation(carom.scenes.fluid(n=108, packing_fraction=0.3, seed=2))
    made = observe.ShearViscosity()
    sim.run(collisions=60_000, observe=made)
    table, moments = made.result(), made.moments()
    assert list(table.columns) == [
        "quantity", "value", "value_error", "n_independent", "value_theory", "ratio", "ratio_error",
    ]  # fmt: skip
    rise = moments["moment"][-1] - moments["moment"][5]
    assert table["value"][0] == pytest.approx(rise / (0.75 * moments["time"][-1]))
    assert table["ratio"][0] == pytest.approx(table["value"][0] / 0.7325, rel=1e-3)
    assert table.notes[0] == "slope between lags of 0.4967 and 1.987"
    assert len(moments) == LAGS
    slope = np.diff(moments["moment_theory"]) / np.diff(moments["time"])
    assert (np.diff(slope) > 0).all()
    assert slope[-1] == pytest.approx(table["value_theory"][0], rel=1e-4)
