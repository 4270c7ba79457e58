"""Balances that hold exactly at every instant, from the log of up to a million events.

Momentum, its moment about the centre (the virial), energy and angular momentum at any time
follow from the start and the impulses in the log; the state of the engine must agree.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest

from carom.engine import FastEngine
from carom.rules import Smooth
from carom.state import State
from carom.walls import Box, Cylinder, Plane, Sphere, world
from carom.world import PLANE, World

from .test_conservation import in_a_ball
from .tools import angular, drive, kinetic

#: Of the sums of absolute values; the plain sums of a million roundings are good to 1e-13.
CLOSE = 1e-12
LOSS = 0.9999  #: a restitution that takes a tenth of the energy or so
STEPS = 4
EVENTS = {"box": 1_000_000, "sphere": 1_000_000}
FEWER = 250_000


def mixture() -> State:
    state = in_a_ball(500, radius=5.8)
    state.radius[::2], state.mass[::2] = 0.35, 0.3
    return state


RULE = Smooth(LOSS)
WORLDS = {
    "box": world(Box(12, 12.5, 13, restitution=LOSS), RULE, gravity=(0, 0, -0.05)),
    "sphere": world(Sphere(6.0, restitution=LOSS), RULE),
    "sphere, gravity": world(Sphere(6.0), RULE, gravity=(0, 0, -0.05)),
    "cylinder": world(Cylinder(6.0, 12.0, restitution=LOSS), RULE, gravity=(0, 0, -0.05)),
    "tilted": world([Sphere(6.0), Plane((1, 2, 3), -5.9)], RULE, gravity=(0.02, 0.01, -0.05)),
}


@dataclass
class Budget:
    """What the log says about the whole at its last event, and what has gone into it."""

    momentum: np.ndarray
    first_moment: np.ndarray  #: sum of m x
    energy: float
    twice_action: float = 0.0  #: integral of 2 K + M g . R
    virial: float = 0.0  #: sum of J . r of pairs and walls
    impulse: float = 0.0  #: sum of |J|
    time: float = 0.0

    def add(self, events: np.ndarray, until: float, state: State, there: World) -> None:
        weight, gravity = float(state.mass.sum()), there.gravity
        size = np.linalg.norm(events["impulse"], axis=1)
        on_wall = events["j"] < 0
        i, j = events["i"], np.where(on_wall, 0, events["j"])
        wall = np.where(on_wall, -1 - events["j"], 0)
        mass = np.where(on_wall, state.mass[i], 1 / (1 / state.mass[i] + 1 / state.mass[j]))
        e = np.where(on_wall, there.walls["restitution"][wall], there.restitution)
        # J = (1 + e) mu u takes mu (1 - e^2) u^2/2 of energy.
        taken = size**2 * (1 - e) / (2 * mass * (1 + e))
        flat = there.walls["kind"][wall] == PLANE
        at = np.where(flat, 1, -1) * there.walls["offset"][wall] + state.radius[i]
        arm = np.where(on_wall, at, state.radius[i] + state.radius[j])
        # Between events the centre of mass flies freely, and K + U stays.
        times = np.concatenate([[self.time], events["time"], [until]])
        dt = np.diff(times)[:, None]
        pushes = np.where(on_wall[:, None], events["impulse"], 0.0)
        momentum = self.momentum + np.concatenate([np.zeros((1, 3)), np.cumsum(pushes, axis=0)])
        momentum += weight * gravity * (times[:-1] - self.time)[:, None]
        steps = momentum * dt + weight * gravity * dt**2 / 2
        moment = self.first_moment + np.concatenate([np.zeros((1, 3)), np.cumsum(steps, axis=0)])
        weighed = moment[:-1] * dt + momentum * dt**2 / 2 + weight * gravity * dt**3 / 6
        energy = self.energy - np.concatenate([[0.0], np.cumsum(taken)])
        self.twice_action += 2 * math.fsum(energy * dt[:, 0])
        self.twice_action += 3 * float(weighed.sum(axis=0) @ gravity)
        self.virial += math.fsum(size * arm)
        self.impulse += float(size.sum())
        self.energy, self.time = float(energy[-1]), until
        self.first_moment = moment[-1]
        self.momentum = momentum[-1] + weight * gravity * dt[-1]


def sums(state: State, there: World) -> tuple[np.ndarray, np.ndarray, float, float]:
    """Momentum, first moment, energy and sum of m x . v."""
    moment = state.mass @ state.position
    energy = kinetic(state) - float(moment @ there.gravity)
    virial = float((state.mass * (state.position * state.velocity).sum(axis=1)).sum())
    return state.mass @ state.velocity, moment, energy, virial


@pytest.mark.parametrize("name", WORLDS)
def test_budgets(name):
    there, state = WORLDS[name], mixture()
    engine = FastEngine(state, there)
    momentum, moment, energy, virial = sums(state, there)
    budget = Budget(momentum, moment, energy)
    scale, events_in_all = kinetic(state), EVENTS.get(name, FEWER)
    for _ in range(STEPS):
        drive(engine, events=events_in_all // STEPS)
        drive(engine, until=engine.time + 0.003)
        events, now = engine.take_events(), engine.state()
        assert events["j"].min() >= -len(there.walls)  # nothing came to rest
        budget.add(events, engine.time, state, there)
        found = sums(now, there)
        assert np.abs(found[0] - budget.momentum).max() < CLOSE * budget.impulse
        reach = CLOSE * budget.impulse * max(1.0, engine.time)
        assert np.abs(found[1] - budget.first_moment).max() < reach
        assert abs(found[2] - budget.energy) < CLOSE * scale
        assert abs(energy - found[2] - engine.dissipated) < CLOSE * scale
        gained = budget.twice_action + budget.virial
        assert abs(found[3] - virial - gained) < CLOSE * 12.0 * budget.impulse
    assert engine.dissipated > 0.02 * scale
    assert engine.wall_collisions > 0.02 * events_in_all


@pytest.mark.parametrize("gravity", [0.0, -0.05])
def test_angular_momentum_in_an_inelastic_hollow_sphere(gravity):
    """Smooth walls and smooth spheres cannot turn the whole, even where they take energy."""
    there = replace(WORLDS["sphere"], gravity=np.array([0.0, 0.0, gravity]))
    state = mixture()
    engine = FastEngine(state, there, log=False)
    drive(engine, events=FEWER)
    kept = slice(None) if gravity == 0.0 else slice(2, 3)
    before, after = angular(state), angular(engine.state())
    size = np.linalg.norm(state.mass[:, None] * np.cross(state.position, state.velocity), axis=1)
    assert np.abs(after - before)[kept].max() < 1e-12 * size.sum()
    assert engine.dissipated > 0.01 * kinetic(state)
    if gravity:
        assert np.abs(after - before)[:2].max() > 1e-3 * size.sum()
