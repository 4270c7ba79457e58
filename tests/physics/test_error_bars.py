"""Error bars against what they claim: the scatter of many runs that differ in their seed alone."""

import numpy as np
import pytest

import carom
from carom import observe

SEEDS = 24

#: Observables, the column that is looked at, and how often an error may be too large: of short lags
#: the spheres share their energy, which the error of independent ones does not know.
WATCHED = {
    "compressibility": (observe.Compressibility, {}, "value"),
    "msd": (observe.MSD, {"at": [0.1, 0.3]}, "msd"),
    "rdf": (observe.RDF, {"every": 0.3, "reach": 1.6}, "g"),
    "free-time": (observe.FreeTime, {}, "density"),
    "collision-rate": (observe.CollisionRate, {}, "rate"),
    "structure-factor": (observe.StructureFactor, {"every": 0.5}, "s"),
}


@pytest.fixture(scope="module")
def runs():
    """Values and claimed errors of each, (seeds, rows, 2)."""
    found = {name: [] for name in WATCHED}
    for seed in range(SEEDS):
        sim = carom.Simulation(carom.scenes.fluid(n=108, packing_fraction=0.3, seed=seed + 1))
        sim.run(collisions=40 * 108)
        made = {name: make(**options) for name, (make, options, _) in WATCHED.items()}
        sim.run(collisions=30_000, observe=list(made.values()))
        for name, observable in made.items():
            table, column = observable.table(), WATCHED[name][2]
            rows = np.column_stack([table[column], table[f"{column}_error"]])
            found[name].append(rows[:30])
    return {name: np.array(rows) for name, rows in found.items()}


@pytest.mark.validate
@pytest.mark.parametrize("name", WATCHED)
def test_results_scatter_as_their_errors_say(runs, name):
    value, error = runs[name][..., 0], runs[name][..., 1]
    assert np.isfinite(error).all()
    ratio = np.sqrt((value.var(axis=0, ddof=1) / (error**2).mean(axis=0)).mean())
    # Of one row the ratio itself is known to 1/sqrt(2 (SEEDS - 1)) = 15 percent; rows share a run,
    # so those of several are not much better known.
    assert 0.6 < ratio < 1.4


def test_every_sixteenth_sphere_and_five_hundred_centres():
    """What is looked at to save time is what is claimed."""
    found = {"free-time": [], "rdf": []}
    for seed in range(SEEDS):
        sim = carom.Simulation(carom.scenes.fluid(n=1300, packing_fraction=0.3, seed=seed + 1))
        sim.run(collisions=20 * 1300)
        made = {"free-time": observe.FreeTime(), "rdf": observe.RDF(every=0.5, reach=1.6)}
        sim.run(collisions=20_000, observe=list(made.values()))
        for name, column in (("free-time", "density"), ("rdf", "g")):
            table = made[name].table()
            found[name].append(np.column_stack([table[column], table[f"{column}_error"]])[:25])
    for name, rows in found.items():
        value, error = np.moveaxis(np.array(rows), 2, 0)
        ratio = np.sqrt((value.var(axis=0, ddof=1) / (error**2).mean(axis=0)).mean())
        assert 0.7 < ratio < 1.3, name
