"""A small gas that many tests start from."""

import numpy as np
import pytest

import carom

METHODS = ["exact", "reference"]
each_method = pytest.mark.parametrize("method", METHODS)


def gas(method="exact", n=3, **options):
    """n x n x n spheres on a grid in a box, with random velocities; elastic unless told."""
    options = {"walls": carom.Box(2 * n, 2 * n, 2 * n), "method": method, **options}
    sim = carom.Simulation(**options)
    places = 2 * np.stack(np.meshgrid(*[np.arange(n)] * 3), -1).reshape(-1, 3) - (n - 1)
    velocity = np.random.default_rng(1).normal(size=places.shape)
    sim.add_many(places, velocity=velocity, radius=0.5)
    return sim
