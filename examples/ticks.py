"""How many collisions do ticks miss? The paper's method against exact motion.

Run it: python examples/ticks.py
"""

import carom

scene = carom.scenes.phase_4()
exact = carom.Simulation(scene)
exact.run(until=300)
print("tick    collisions   deepest overlap")
print(f"exact   {exact.collisions:10d}   {exact.max_overlap:.1e}")
for tick in (0.1, 0.5, 1, 2, 4):
    sim = carom.Simulation(scene, method="tick", tick=tick)
    sim.run(until=300)
    print(f"{tick:<7g} {sim.collisions:10d}   {100 * sim.max_overlap:.1f} %")
