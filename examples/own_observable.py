"""An observable of your own: how hard do the collisions of a gas hit, compared with theory?

Run it: python examples/own_observable.py
"""

import math

import numpy as np

import carom
from carom import observe


@observe.observable
def impulse_rate(batch):
    """Sum of the impulses of all collisions, for each unit of time: one number for each event."""
    return batch.size


@observe.observable
def mean_speed(state):
    """One number for each state it is shown."""
    return np.linalg.norm(state.velocity, axis=1).mean()


sim = carom.Simulation(carom.scenes.fluid(n=500, packing_fraction=0.2))
sim.run(collisions=50 * len(sim))  # it forgets its lattice

impulses, speed = impulse_rate(), mean_speed()
before = sim.collisions
sim.run(collisions=1000 * len(sim), observe=[impulses, speed])

hits = (sim.collisions - before) / impulses.duration
print(f"impulse per time {impulses.result()}   Maxwell {hits * math.sqrt(math.pi):.1f}")
print(f"mean speed       {speed.result()}   Maxwell {math.sqrt(8 / math.pi):.4f}")
