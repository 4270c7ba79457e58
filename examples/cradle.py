"""Newton's cradle: as many balls leave the row as come in.

Run it: python examples/cradle.py
"""

import carom

for moving in (1, 2, 3):
    sim = carom.Simulation(carom.scenes.newton_cradle(n=5, moving=moving))
    before = [round(v, 9) + 0.0 for v in sim.velocity[:, 0].tolist()]
    sim.run(until=2)
    after = [round(v, 9) + 0.0 for v in sim.velocity[:, 0].tolist()]
    print(f"{before} -> {after} in {sim.collisions} collisions")
