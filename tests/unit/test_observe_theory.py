"""Where theory ends, observables go on without it and say so."""

import math

import numpy as np
import pytest

import carom
from carom import observe, theory
from carom.observe.fluid import FREEZES
from carom.observe.kinds import mean_free_time


def run(scene, *observables, collisions=3000):
    sim = carom.Simulation(scene)
    sim.run(collisions=collisions, observe=observables)
    return sim


def two_sizes(filling, n=64):
    """A crystal of two sizes."""
    side = (n * math.pi / 6 * (1 + 0.9**3) / 2 / filling) ** (1 / 3)
    sim = carom.Simulation(walls=carom.Periodic(side, side, side))
    sites = 4
    grid = np.stack(np.meshgrid(*[np.arange(sites)] * 3), -1).reshape(-1, 3)
    even = grid.sum(axis=1) % 2 == 0
    sim.add_many(
        (grid + 0.5) * side / sites - side / 2,
        velocity=np.random.default_rng(1).normal(size=(n, 3)),
        radius=np.where(even, 0.5, 0.45),
    )
    return sim


@pytest.mark.parametrize("filling", [0.494, 0.4941])
def test_lines_end_where_the_fluid_freezes(filling):
    scene = carom.scenes.fluid(n=108, packing_fraction=filling, seed=1)
    several = [
        observe.Compressibility(),
        observe.PressureTensor(),
        observe.CollisionRate(),
        observe.FreeTime(),
        observe.FreePath(),
        observe.MSD(),
        observe.VACF(),
        observe.Diffusion(between=(0.1, 0.2)),
    ]
    run(scene, *several, collisions=30_000)
    for one in several:
        table = one.table()
        lines = [table[name] for name in table.columns if name.endswith("_theory")]
        assert len(lines) == 1
        assert np.isfinite(lines[0]).any() == (filling < 0.4941), one.name
        assert (FREEZES in table.theory) == (filling > 0.494), one.name
        assert "nan" not in str(table)


def test_no_line_of_theory_stands_in_no_column():
    rate = observe.CollisionRate()
    run(carom.scenes.fluid(n=108, packing_fraction=0.55), rate)
    assert "rate (theory)" not in rate.result().heading()
    assert "rate (theory)" in run_rate(0.2).heading()


def run_rate(filling):
    rate = observe.CollisionRate()
    run(carom.scenes.fluid(n=108, packing_fraction=filling), rate)
    return rate.result()


def test_diffusion_without_a_viscosity():
    scene = carom.scenes.fluid(n=108, packing_fraction=0.5)
    alone, given = observe.Diffusion((0.1, 0.2)), observe.Diffusion((0.1, 0.2), viscosity=7.0)
    run(scene, alone, given, collisions=10_000)
    assert len(alone.result()) == 1
    assert "no size correction" in alone.result().notes[0]
    here, beyond = given.result()["value"]
    side = float(alone.world.period[0])
    kT = carom.Simulation(scene).temperature
    assert beyond - here == pytest.approx(theory.finite_size_diffusion(side, 7.0, kT), rel=1e-12)


@pytest.mark.parametrize(("filling", "speaks"), [(0.3, True), (0.5, False)])
def test_mixtures(filling, speaks):
    sim = two_sizes(filling)
    z, rate = observe.Compressibility(), observe.CollisionRate()
    sim.run(collisions=2000, observe=[z, rate])
    for table in (z.table(), rate.table()):
        assert (FREEZES in table.theory) != speaks
        assert ("BMCSL" in table.theory) == speaks


def test_walls_of_a_crowded_room():
    sim = carom.Simulation(walls=carom.Box(4.1, 4.1, 4.1))
    grid = np.stack(np.meshgrid(*[np.arange(4)] * 3), -1).reshape(-1, 3)
    sim.add_many((grid - 1.5) * 1.02, velocity=np.random.default_rng(2).normal(size=(64, 3)))
    walls = observe.WallPressure()
    sim.run(collisions=2000, observe=walls)
    assert np.isnan(walls.result()["pressure_theory"]).all()
    assert walls.result().theory == FREEZES


@pytest.mark.parametrize(("restitution", "n", "said"), [
    (1.0, 27, "barometric formula, up to"),
    (1.0, 125, "none, the barometric formula holds up to packing fraction 0.02 at the floor"),
    (0.9, 27, ""),
])  # fmt: skip
def test_an_atmosphere(restitution, n, said):
    walls = [carom.Periodic(12, 12, None), carom.Plane((0, 0, 1), 0), carom.Plane((0, 0, -1), -60)]
    rule = carom.Smooth(restitution=restitution)
    sim = carom.Simulation(walls=walls, gravity=(0, 0, -0.1), rule=rule)
    each = round(n ** (1 / 3))
    grid = np.stack(np.meshgrid(*[np.arange(each)] * 3), -1).reshape(-1, 3)
    velocity = np.random.default_rng(3).normal(size=(n, 3))
    sim.add_many(grid * 2.2 - [6, 6, -1], velocity=velocity)
    density = observe.DensityProfile(bins=20, every=1)
    sim.run(duration=20, observe=density)
    table = density.result()
    line = table["density_theory"]
    assert table.theory.startswith(said)
    if said.startswith("barometric"):
        assert line.sum() * 144 * 3 == pytest.approx(n, rel=1e-12)
        kT = density._series.mean(20).value
        # Far up it falls as exp(-m g z/kT).
        assert line[11] / line[10] == pytest.approx(math.exp(-0.1 * 3 / kT), rel=0.01)
    else:
        assert np.isnan(line).all()
        assert bool(table.theory) == bool(said)


def test_a_crystal_has_a_scale_of_time_too():
    sim = carom.Simulation(carom.scenes.fluid(n=108, packing_fraction=0.6))
    scale = mean_free_time(sim.state, sim.world)
    true = theory.mean_free_time(0.6, sim.temperature, equation=theory.speedy_fcc)
    assert 0.5 < scale / true < 2
