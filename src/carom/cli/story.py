"""What the paper's phase 2 prints: each collision of its two balls."""

from collections.abc import Iterator

import numpy as np

from carom.scenes import phase_2_lines
from carom.simulation import Simulation
from carom.state import State

#: Collisions told in full; the paper's program goes on for ever.
TOLD = 3


def story(start: State, sim: Simulation) -> Iterator[str]:
    """Tell the first collisions of two balls in a box, from a start state and the events since.

    Between events nothing acts on the balls, so their impulses give every velocity.
    """
    velocity, mass = start.velocity.copy(), start.mass
    events = sim.events
    if len(events) < sim.collisions + sim.wall_collisions:
        return  # the run was too long for its first events to be held
    number = 0
    for event in events:
        i, j, impulse = int(event["i"]), int(event["j"]), event["impulse"]
        if j < 0:
            velocity[i] += impulse / mass[i]
            continue
        normal = impulse / np.linalg.norm(impulse)
        psi = float((velocity[i] - velocity[j]) @ normal)
        velocity[i] += impulse / mass[i]
        velocity[j] -= impulse / mass[j]
        number += 1
        energies = 0.5 * mass * (velocity * velocity).sum(axis=1)
        yield phase_2_lines(number, normal, psi, energies)
        if number == TOLD:
            return
