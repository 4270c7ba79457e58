"""A gas in which all spheres start at one speed: collisions bring Maxwell's law.

Run it: python examples/gas.py
"""

import numpy as np

import carom

scene = carom.scenes.gas(n=1000)
sim = carom.Simulation(scene)
speeds = np.linalg.norm(sim.velocity, axis=1)
print(f"{len(sim)} spheres, all at speed {speeds.min():.6f} ... {speeds.max():.6f}")

sim.run(collisions=20 * len(sim))

speeds = np.linalg.norm(sim.velocity, axis=1)
counts, edges = np.histogram(speeds, bins=16, range=(0, 3 * np.sqrt(3 * sim.temperature)))
for count, low, high in zip(counts, edges, edges[1:], strict=False):
    # Maxwell: f(v) = 4 pi v^2 (2 pi T)^(-3/2) exp(-v^2 / 2T), mass 1.
    v = np.linspace(low, high, 50)
    density = 4 * np.pi * v**2 * np.exp(-(v**2) / (2 * sim.temperature))
    expected = len(sim) * density.mean() * (high - low) / (2 * np.pi * sim.temperature) ** 1.5
    print(f"{low:5.2f} to {high:5.2f} {count:5d}  Maxwell {expected:6.1f}  {'*' * (count // 4)}")
print(f"energy drift {sim.energy_drift:.1e} over {sim.collisions} collisions")
