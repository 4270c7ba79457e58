"""Gases that cool: Haff's law, the shape of the speeds, two kinds with two temperatures."""

import math
from functools import partial

import numpy as np

from carom import theory
from carom.observe import Estimate
from carom.rules import Smooth
from carom.simulation import Simulation
from carom.validate import references as known
from carom.validate.mixtures import mixed
from carom.validate.row import Check, Found, Panel
from carom.validate.runs import fluid, of_blocks

N, PHI = 4000, 0.05
#: Collisions per sphere; before, the speeds take on their cooling shape.
FIRST = 3
#: Until when the gas is even enough, by restitution: later, more so if much is lost, spheres
#: begin to flow together in whirls, and cool more slowly.
LAST = {0.95: 25, 0.9: 25, 0.8: 12}
HAFF = "P. K. Haff, J. Fluid Mech. 134, 401 (1983), with a2"
SONINE = "T. P. C. van Noije, M. H. Ernst, Granul. Matter 1, 57 (1998)"
GARZO = "V. Garzó, J. W. Dufty, Phys. Rev. E 60, 5706 (1999)"
#: Kinetic theory knows no correlations of partners, which make cooling that much slower.
CORRELATIONS = 0.004
#: They also make collisions rarer, by a percent for e = 0.8.
RATE = 0.0075


def temperature(sim: Simulation) -> float:
    """Return kT of a gas at rest as a whole."""
    return 2 * sim.kinetic_energy / (3 * len(sim) - 3)


def kurtosis(sim: Simulation) -> float:
    """Return a2 of this moment."""
    squares = (sim.velocity**2).sum(axis=1)
    return float((squares**2).mean() / squares.mean() ** 2) * 3 / 5 - 1


def cooling(e: float, size: float) -> list[Found]:
    """T falls by the same share in each collision, and as 1/t^2."""
    runs = max(6, round(20 * size))
    slopes, rates, shapes, kept = [], [], [], []
    last = LAST[e]
    curve = np.zeros((runs, last - FIRST + 1))
    gas = fluid(N, PHI, per_sphere=20)
    met = 0
    for k in range(runs):
        gas.run(collisions=10 * N)
        sim = Simulation(walls=gas.walls, rule=Smooth(e), keep_events=0)
        sim.add_many(gas.position, velocity=gas.velocity)
        times, a2 = [], []
        for place, c in enumerate(range(FIRST, last + 1)):
            sim.run(collisions=c * N // 2 - sim.collisions)
            curve[k, place] = temperature(sim)
            times.append(sim.time)
            a2.append(kurtosis(sim))
        met += sim.collisions
        kept.append((sim.kinetic_energy + sim.dissipated) / gas.kinetic_energy)
        slopes.append(math.log(curve[k, -1] / curve[k, 0]) / (last - FIRST))
        roots = curve[k, [0, -1]] ** -0.5
        rates.append(2 * (roots[1] - roots[0]) / (times[-1] - times[0]))
        shapes.append(float(np.mean(a2)))
    found = Found(f"cooling gas, φ = {PHI:g}, e = {e:g}", N, met)
    slope = math.log(float(theory.haff_temperature_by_collisions(1.0, e)))
    share, note = of_blocks(slopes), "correlations: 0.4 %"
    name = f"cooling-{e:g}"
    allowed = CORRELATIONS * abs(slope)
    found.against(f"{name}-collisions", "d ln T/dC", share, slope, HAFF, allowed, note)
    if e == 0.9:
        number = known.EDMD_COOLING
        found.against(f"{name}-EDMD", "d ln T/dC", share, number.value, known.EDMD, number.error)
    if e in known.DSMC_A2:
        number = known.DSMC_A2[e]
        found.against(
            f"{name}-DSMC", "a2 of the speeds", of_blocks(shapes), number.value, known.DSMC,
            math.hypot(number.error, 0.002), "correlations: 0.002",
        )  # fmt: skip
    expected = float(theory.sonine_a2(e))
    unsure = 0.0025
    found.against(
        f"{name}-a2", "a2 of the speeds", of_blocks(shapes), expected, SONINE, unsure,
        "correlations, higher terms: 0.0025",
    )  # fmt: skip
    omega = float(theory.collision_rate(PHI))
    per_time = 2 * (float(theory.haff_temperature(1.0, e, omega)) ** -0.5 - 1)
    found.against(
        f"{name}-time", "d(2/√T)/dt", of_blocks(rates), per_time, HAFF, RATE * per_time,
        "correlations: 0.75 %",
    )  # fmt: skip
    worst = max(abs(one - 1) for one in kept)
    what = "error of kinetic and dissipated energy"
    found.exact(f"{name}-energy", what, worst, 0.0, 1e-10, "conservation")
    each = np.arange(FIRST, last + 1.0)
    ratio = curve / curve[:, :1]
    line = np.exp(slope * (each - FIRST))
    found.panels.append(
        Panel(
            f"Cooling, e = {e:g}",
            "collisions per sphere",
            "T over Haff's law",
            each,
            ratio.mean(axis=0) / line,
            ratio.std(axis=0, ddof=1) / math.sqrt(runs) / line,
            each,
            np.ones(len(each)),
        )
    )
    return [found]


def two_kinds(mass: float, e: float, size: float) -> list[Found]:
    """Kinds of equal size and unlike mass cool alike, at different temperatures."""
    phi, n = 0.05, 1000  # in a larger box masses part, and the ratio grows
    radius, masses = np.array([0.5, 0.5]), np.array([1.0, mass])
    gas = mixed((n // 2, n // 2), radius, masses, phi)
    sim_ratios = []
    met = 0
    heavy = gas.mass == 1.0
    for _ in range(max(4, round(20 * size))):
        gas.run(collisions=10 * n)
        sim = Simulation(walls=gas.walls, rule=Smooth(e), keep_events=0)
        sim.add_many(gas.position, velocity=gas.velocity, radius=gas.radius, mass=gas.mass)
        sim.run(collisions=5 * n)
        seen = []
        for _ in range(4):
            sim.run(collisions=n)
            squares = sim.mass * (sim.velocity**2).sum(axis=1)
            seen.append(float(squares[heavy].mean() / squares[~heavy].mean()))
        met += sim.collisions
        sim_ratios.append(float(np.mean(seen)))
    found = Found(f"two kinds, masses 1 : {mass:g}, e = {e:g}", n, met)
    volume = float(gas.world.period.prod())
    expected = theory.granular_temperature_ratio(radius, volume, [n / 2, n / 2], masses, e)
    measured: Estimate = of_blocks(sim_ratios)
    found.against(
        f"two-kinds-{mass:g}-{e:g}", "T heavy/T light", measured, expected, GARZO,
        0.01 * expected, "Gaussian speeds: 1 %",
    )  # fmt: skip
    return [found]


def checks() -> list[Check]:
    """All of this file."""
    gases = [Check(f"cooling-{e:g}", "cooling", partial(cooling, e), 3.0, 3) for e in LAST]
    kinds = [
        Check(f"two-kinds-{mass:g}-{e:g}", "two-kinds", partial(two_kinds, mass, e), 1.0, 6)
        for mass, e in ((0.25, 0.8), (0.1, 0.95))
    ]
    return [*gases, *kinds]
