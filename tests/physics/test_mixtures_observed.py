"""Mixtures: what is measured of each kind, and of each pair of kinds."""

import math

import numpy as np
import pytest

import carom
from carom import observe, theory

from .observed import fluid, misses, mixture


@pytest.fixture(scope="module")
def seen():
    sim = mixture()
    made = {
        "rdf": observe.RDF(every=0.3),
        "msd": observe.MSD(at=[0.005, 0.01, 0.02]),
        "vacf": observe.VACF(at=[0.005, 0.01, 0.02]),
    }
    sim.run(collisions=300_000, observe=list(made.values()))
    return made


def test_contact_values_are_those_of_bmcsl(seen):
    table = seen["rdf"].contact()
    assert table["quantity"].tolist() == [
        "r=0.25 m=0.125 with r=0.25 m=0.125",
        "r=0.25 m=0.125 with r=0.5 m=1",
        "r=0.5 m=1 with r=0.5 m=1",
    ]
    assert "BMCSL" in table.theory
    off = (table["value"] - table["value_theory"]) / table["value_error"]
    assert (np.abs(off) < 4).all()
    assert (table["value_error"] < 0.08 * table["value"]).all()
    assert table["value_theory"] == pytest.approx([1.979, 2.181, 2.611], abs=1e-3)


def test_partial_distributions_add_up_and_begin_at_contact(seen):
    table = seen["rdf"].result()
    assert [name for name in table.measured] == ["g", "g_AA", "g_AB", "g_BB"]
    # All pairs are pairs of kinds: 500 of each.
    whole = (table["g_AA"] + table["g_BB"]) * 499 / 999 / 2 + table["g_AB"] * 500 / 999
    assert table["g"] == pytest.approx(whole, rel=0.02, abs=0.02)
    for name, sigma in (("g_AA", 0.5), ("g_AB", 0.75), ("g_BB", 1.0)):
        assert table[name][table["distance"] < sigma - 0.01].sum() == 0
        assert table[name][table["distance"] > sigma + 0.01][0] > 1.5
    assert "A: r=0.25 m=0.125, B: r=0.5 m=1" in table.notes
    assert any(note.startswith("at contact AB: g = 2.") for note in table.notes)


def test_each_kind_moves_and_forgets_as_enskog_says(seen):
    for name in ("msd", "vacf"):
        table = seen[name].result()
        assert np.isnan(table[f"{name}_theory"]).all()
        for kind in "AB":
            line, error = table[f"{name}_{kind}_theory"], table[f"{name}_{kind}_error"]
            # The slopes at 0 are exact, but for BMCSL's percent; the rest is Enskog's.
            allowed = np.hypot(error, 0.012 * line)
            assert (np.abs(table[f"{name}_{kind}"] - line) < 4 * allowed).all()
        whole = (table[f"{name}_A"] + table[f"{name}_B"]) / 2
        if name == "msd":
            assert table["msd"] == pytest.approx(whole, rel=1e-12)


def test_one_kind_has_one_column():
    sim, mark = fluid(0.3, 200)
    sim.return_to(mark)
    rdf, msd = observe.RDF(every=0.3), observe.MSD(at=[0.1])
    sim.run(collisions=20_000, observe=[rdf, msd])
    assert rdf.result().measured == ["g"]
    assert msd.result().measured == ["msd"]
    table = rdf.contact()
    assert table["value_theory"][0] == pytest.approx(theory.contact_value(0.3))
    assert abs(misses(table, "value")[0]) < 4
    assert not math.isnan(table["value_error"][0])


def test_too_many_kinds_are_taken_together():
    sim = carom.Simulation(walls=carom.Periodic(9, 9, 9))
    grid = 2.0 * np.stack(np.meshgrid(*[np.arange(3)] * 3), -1).reshape(-1, 3) - 2
    sim.add_many(grid, velocity=np.random.default_rng(1).normal(size=(27, 3)),
                 mass=1 + np.arange(27.0))  # fmt: skip
    rdf, msd = observe.RDF(every=1), observe.MSD(at=[1])
    sim.run(duration=10, observe=[rdf, msd])
    assert rdf.result().measured == ["g"]
    assert msd.result().measured == ["msd"]
