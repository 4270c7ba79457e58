"""Structure factors and bond orders, against theory, lattices and sums made otherwise."""

import math
import sys

import numpy as np
import pytest

import carom
import carom.place
from carom import observe, theory
from carom.observe.structure import VECTORS, powers, wave_vectors

from .observed import measured, misses


def lattice(sites, side, **options):
    """Spheres that rest on sites, in units of the side."""
    sim = carom.Simulation(walls=carom.Periodic(*np.broadcast_to(side, 3)))
    sim.add_many(np.asarray(sites) * side, **options)
    return sim


def look(sim, observable):
    sim.run(until=0, observe=observable)
    return observable


def cells(basis, count):
    """Sites of a lattice of cubic cells (or bricks), as shares of the side."""
    grid = np.stack(np.meshgrid(*[np.arange(count)] * 3), -1).reshape(-1, 1, 3)
    return ((grid + np.asarray(basis)).reshape(-1, 3) + 0.1) / count - 0.5


FCC = [(0, 0, 0), (0, 0.5, 0.5), (0.5, 0, 0.5), (0.5, 0.5, 0)]
BCC = [(0, 0, 0), (0.5, 0.5, 0.5)]
SC = [(0, 0, 0)]
#: In a brick of 1 x sqrt(3) x sqrt(8/3).
HCP = [(0, 0, 0), (0.5, 0.5, 0), (0.5, 5 / 6, 0.5), (0, 1 / 3, 0.5)]
BRICK = np.array([1, math.sqrt(3), math.sqrt(8 / 3)])


class TestStructureFactor:
    def test_powers_are_those_of_the_plain_sum(self):
        place = np.random.default_rng(1).random((500, 3)) - 0.5
        waves, _ = wave_vectors(np.array([5.0, 6.0, 7.0]), 20.0)
        plain = np.abs(np.exp(2j * np.pi * (waves @ place.T)).sum(axis=1)) ** 2
        assert powers(place, waves) == pytest.approx(plain, rel=1e-4, abs=1e-3)

    @pytest.mark.parametrize("period", [(6.0, 6.0, 6.0), (3.0, 4.0, 20.0), (200.0, 200.0, 200.0)])
    def test_wave_vectors(self, period):
        period = np.array(period)
        waves, shell = wave_vectors(period, 15.0)
        assert len(np.unique(np.concatenate([waves, -waves]), axis=0)) == 2 * len(waves)
        assert np.bincount(shell).min() >= 1
        assert np.bincount(shell).max() <= VECTORS
        k = np.sqrt(((waves * 2 * np.pi / period) ** 2).sum(axis=1))
        assert k.min() == pytest.approx(2 * np.pi / period.max())
        assert 14.5 < k.max() < 15.5
        means = np.bincount(shell, k) / np.bincount(shell)
        assert (np.diff(means) > 0).all()
        assert (wave_vectors(period, 15.0)[0] == waves).all()

    def test_a_crystal_has_bragg_peaks_and_nothing_else(self):
        sim = lattice(cells(FCC, 4), 4 * 1.5)
        table = look(sim, observe.StructureFactor(at=[0])).result()
        one = 2 * np.pi / 1.5  # the edge of the reciprocal cell; (1, 1, 1) is the first peak
        assert table["s"][table["k"] < 1.5 * one].max() < 1e-6
        waves = np.array([(4, 4, 4), (8, 0, 0), (4, 0, 0), (4, 4, 0), (1, 2, 3)])
        found = powers(sim.position / 6, waves) / 256
        assert found == pytest.approx([256, 256, 0, 0, 0], abs=1e-3)

    def test_chance(self):
        place = np.random.default_rng(2).random((2000, 3)) - 0.5
        sim = carom.Simulation(walls=carom.Periodic(20, 20, 20), collide=False)
        sim.add_many(place * 20, velocity=np.random.default_rng(3).normal(size=(2000, 3)))
        s = observe.StructureFactor(every=20)
        sim.run(until=200, observe=s)
        table = s.result()
        off = (table["s"] - 1) / table["s_error"]
        assert np.nanmean(off**2) == pytest.approx(1, abs=0.5)
        assert np.isnan(table["s_theory"]).all()

    def test_a_fluid(self):
        s = observe.StructureFactor(every=0.5)
        measured(0.3, s, collisions=1_000_000)
        assert s.samples > 300
        table = s.result()
        assert "Percus and Yevick" in table.theory
        # Percus and Yevick are some percent off around the first peak; elsewhere less.
        allowed = np.hypot(table["s_error"], 0.04 * table["s_theory"])
        assert (np.abs(table["s"] - table["s_theory"]) < 4 * allowed).all()
        assert np.median(np.abs(misses(table, "s"))) < 2

    def test_long_waves_tell_the_compressibility(self):
        """Towards k = 0 it is that of the equation of state, where Percus and Yevick's is low."""
        s = observe.StructureFactor(every=0.2, reach=2.0)
        phi = 0.4
        measured(phi, s, collisions=2_000_000)
        table = s.result()
        step = 1e-5
        z = theory.kolafa_labik_malijevsky([phi + step, phi - step])
        s0 = 2 * step / float(z @ [phi + step, -phi + step])
        # The shape of the rise is Percus and Yevick's, its height is compared.
        shape = table["s_theory"] / theory.percus_yevick(0.0, phi)
        found = table["s"][:2] / shape[:2]
        error = table["s_error"][:2] / shape[:2]
        mean = float((found / error**2).sum() / (1 / error**2).sum())
        error = float((1 / error**2).sum() ** -0.5)
        assert abs(mean - s0) < 4 * error
        assert error < 0.05 * s0


class TestSteinhardt:
    @pytest.mark.parametrize(("basis", "brick", "count", "neighbors", "q4", "q6"), [
        (FCC, 1, 4, 12, 0.190941, 0.574524),
        (HCP, BRICK, 4, 12, 0.097222, 0.484762),
        (BCC, 1, 4, 14, 0.036370, 0.510688),
        (BCC, 1, 4, 8, 0.509175, 0.628539),
        (SC, 1, 5, 6, 0.763763, 0.353553),
        # By Voronoi's cells, whose faces are one for each of the same neighbours, alike in area.
        (FCC, 1, 4, None, 0.190941, 0.574524),
        (HCP, BRICK, 4, None, 0.097222, 0.484762),
        (SC, 1, 5, None, 0.763763, 0.353553),
    ])  # fmt: skip
    def test_lattices(self, basis, brick, count, neighbors, q4, q6):
        sim = lattice(cells(basis, count), count * 2.2 * np.broadcast_to(brick, 3))
        order = look(sim, observe.Steinhardt(neighbors, at=[0]))
        means = order.means()
        assert means["quantity"].tolist() == ["q4", "q6", "Q4", "Q6"]
        assert means["value"] == pytest.approx([q4, q6, q4, q6], abs=2e-5)
        table = order.result()
        assert table["q"][table["q4"].argmax()] == pytest.approx(q4, abs=0.0051)
        assert table["q"][table["q6"].argmax()] == pytest.approx(q6, abs=0.0051)
        for name in ("q4", "q6"):
            assert table[name].sum() * 0.01 == pytest.approx(1)

    def test_a_fluid_has_order_around_each_sphere_and_none_of_the_whole(self):
        order = observe.Steinhardt(every=0.5)
        measured(0.45, order, collisions=2_000_000)
        q4, q6, whole4, whole6 = (order.means().estimate("value", k) for k in range(4))
        # Uncorrelated bonds: Q^2 = 1/(number of bonds), which N q^2/N^2 estimates.
        assert whole6.value < 3 * q6.value / math.sqrt(1000)
        assert whole4.value < 3 * q4.value / math.sqrt(1000)
        assert 0.3 < q6.value < 0.5
        assert q6.error < 0.002
        assert "q6 0." in str(order.result())

    def test_bad_input(self, monkeypatch):
        with pytest.raises(carom.InputError, match="neighbors is 0"):
            observe.Steinhardt(0)
        few = lattice(cells(SC, 2), 6.0)
        with pytest.raises(carom.InputError, match="needs 13 spheres at least, and here are 8"):
            look(few, observe.Steinhardt(at=[0]))
        box = carom.Simulation(walls=carom.Box(9, 9, 9))
        box.add()
        with pytest.raises(carom.InputError, match="where no sphere is at a border"):
            look(box, observe.Steinhardt(at=[0]))
        monkeypatch.setitem(sys.modules, "freud", None)
        with pytest.raises(
            carom.InputError, match=r"needs freud: pip install .carom\[analysis\].$"
        ):
            observe.Steinhardt()
