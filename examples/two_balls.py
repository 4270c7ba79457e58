"""Two balls meet off centre: what each collision keeps.

Run it: python examples/two_balls.py
"""

import carom

sim = carom.Simulation()
red = sim.add(position=(-2, 0, 0), velocity=(1, 0, 0), color="red")
blue = sim.add(position=(2, 0.4, 0), mass=2, radius=0.7, color="blue")

print(f"before   energy {sim.kinetic_energy:.15f}   momentum {sim.momentum}")
sim.run(collisions=1)
print(f"after    energy {sim.kinetic_energy:.15f}   momentum {sim.momentum}")
print(f"they touched at time {sim.time:.9f}, and part like this:")
print(red)
print(blue)

# sim.show() would open the live view in the browser.
