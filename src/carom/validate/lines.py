"""Spheres on a line: counts and final states that are known exactly, and where balls collapse."""

import math
from functools import partial

import numpy as np

from carom import scenes, theory
from carom.errors import CollapseError
from carom.random_numbers import Random
from carom.rules import Smooth
from carom.simulation import Simulation
from carom.state import Floats
from carom.validate.references import CLOSED, DIGITS, table
from carom.validate.row import Check, Found
from carom.validate.runs import columns
from carom.walls import Plane

GALPERIN = "G. Galperin, Regul. Chaotic Dyn. 8, 375 (2003): digits of π"
TONKS = "L. Tonks, Phys. Rev. 50, 955 (1936)"
MCNAMARA = "S. McNamara, W. R. Young, Phys. Fluids A 4, 496 (1992)"


def galperin(digits: int, size: float) -> list[Found]:
    """Collisions of two balls and a wall, and the speed that is left to the heavy one."""
    sim = Simulation(scenes.galperin(digits=digits), keep_events=0)
    energy = sim.kinetic_energy
    sim.run(until=1e3)
    total = sim.collisions + sim.wall_collisions
    found = Found(f"masses 1 : 100^{digits - 1}", 2, total)
    exact = math.floor(math.pi * 10 ** (digits - 1))
    found.exact(f"galperin-{digits}", "collisions", total, exact, 0.5, GALPERIN)
    # Each pair collision turns (sqrt M V, sqrt m v) by the same angle in the plane.
    share = 100.0 ** (digits - 1)
    turns = (exact + 1) // 2
    angle = 2 * math.atan(share**-0.5)
    speed = abs(math.cos(turns * angle))
    heavy = abs(float(sim.velocity[1, 0]))
    found.exact(f"galperin-{digits}-speed", "speed of the heavy ball", heavy, speed, 1e-9, CLOSED)
    kept = sim.kinetic_energy / energy
    found.exact(f"galperin-{digits}-energy", "energy kept", kept, 1.0, 1e-9, "conservation")
    return [found]


def on_a_line(places: Floats, velocities: Floats, radius: float, **world: object) -> Simulation:
    """Equal spheres along x."""
    zero = np.zeros(len(places))
    sim = Simulation(**world)  # type: ignore[arg-type]
    sim.add_many(
        np.column_stack([places, zero, zero]),
        velocity=np.column_stack([velocities, zero, zero]),
        radius=radius,
    )
    return sim


def rods(size: float) -> list[Found]:
    """Ten rods between walls: places, counts, rates and force."""
    rows = table("tonks_line")
    start = np.array([columns(row, "x0", "v0") for row in rows])
    end = np.array([columns(row, "x_T", "v_T") for row in rows])
    ends = [Plane((1, 0, 0), 0), Plane((-1, 0, 0), -10)]
    sim = on_a_line(start[:, 0], start[:, 1], 0.25, walls=ends)
    speeds, mass, duration = start[:, 1].copy(), 1.0, 1000.0
    sim.run(until=duration)
    found = Found("10 rods between walls", 10, sim.collisions + sim.wall_collisions)
    found.exact("rods-pairs", "collisions of pairs", sim.collisions, 10709, 0.5, DIGITS)
    found.exact("rods-walls", "hits of walls", sim.wall_collisions, 1672, 0.5, DIGITS)
    off = float(np.abs(sim.position[:, 0] - end[:, 0]).max())
    found.exact("rods-places", "largest error of a place", off, 0.0, 1e-9, DIGITS)
    # Point k hits a wall |v| t/(L - N sigma) times within one, and meets each other within one.
    n = len(start)
    rate = theory.rod_collision_rate(speeds, 10.0, 0.25)
    found.exact(
        "rods-rate",
        "collisions of pairs per time",
        sim.collisions / duration,
        rate,
        n * (n - 1) / 2 / duration,
        TONKS,
        "one each",
    )
    hits = theory.rod_wall_rate(speeds, 10.0, 0.25)
    found.exact(
        "rods-hits",
        "hits of walls per time",
        sim.wall_collisions / duration,
        hits,
        2 * n / duration,
        TONKS,
        "one each",
    )
    records = sim.events
    impulse = np.abs(records["impulse"][records["j"] < 0, 0]).sum()
    kT = mass * float(speeds @ speeds) / n
    force = float(theory.rod_force(n, 10.0, kT, 0.25))
    bound = 2 * float(np.abs(speeds).sum()) / duration
    found.exact("rods-force", "force on a wall", impulse / 2 / duration, force, bound, TONKS)
    return [found]


def collapses(n: int, restitution: float, starts: int) -> int:
    """How many of some random starts of n closing balls collapse."""
    random, count = Random(1), 0
    for _ in range(starts):
        gaps = random.uniform(n - 1, low=0.1, high=2.0)
        places = np.concatenate([[0.0], np.cumsum(1 + gaps)])
        velocities = np.sort(random.normal(n))[::-1]
        sim = on_a_line(places, velocities, 0.5, rule=Smooth(restitution), keep_events=0)
        try:
            sim.run(until=1e6)
        except CollapseError:
            count += 1
    return count


def collapse(size: float) -> list[Found]:
    """Three balls: below e = 7 - 4 sqrt 3 closing balls collapse, above none does."""
    starts = 100
    found = Found("3 balls on a line", 3, 0)
    for e, expected in ((0.06, starts), (0.09, 0)):
        count = collapses(3, e, starts)
        quantity = f"of {starts} starts collapse, e = {e:g}"
        found.exact(f"collapse-{e:g}", quantity, count, expected, 0.5, MCNAMARA)
    low, high = 0.05, 0.1
    while high - low > 1e-4:
        middle = (low + high) / 2
        if collapses(3, middle, 20):
            low = middle
        else:
            high = middle
    threshold = 7 - 4 * math.sqrt(3)
    found.exact(
        "collapse-threshold",
        "largest e of a collapse",
        low,
        threshold,
        1e-3,
        MCNAMARA + ": 7 − 4√3",
    )
    return [found]


def checks() -> list[Check]:
    """All of this file."""
    counts = [
        Check(f"galperin-{digits}", "galperin", partial(galperin, digits), seconds)
        for digits, seconds in ((2, 0.1), (4, 0.1), (6, 0.1), (7, 0.8))
    ]
    return [
        *counts,
        Check("rods", "rods", rods, 0.2),
        Check("collapse", "collapse", collapse, 0.4),
    ]
