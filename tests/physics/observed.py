"""Fluids that the tests of observables measure."""

import math
from functools import cache

import numpy as np

import carom

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


def mixture(n=1000, seed=2, phi=0.3):
    """As many spheres of diameter 1/2 and mass 1/8 as of diameter and mass 1."""
    side = (n / 2 * math.pi / 6 * (1 + 1 / 8) / phi) ** (1 / 3)
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
