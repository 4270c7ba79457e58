"""One kind of spheres in a periodic cube: pressure and rate of collisions, fluid and crystal."""

import math
from functools import partial

import numpy as np

from carom import place, theory
from carom.observe import (
    RDF,
    VACF,
    CollisionRate,
    CollisionsPerSphere,
    Compressibility,
    HFunction,
    PressureTensor,
)
from carom.random_numbers import Random
from carom.simulation import Simulation
from carom.validate import references as known
from carom.validate.references import EDMD_Z, FLUID_SIZE
from carom.validate.row import Check, Found, Panel
from carom.validate.runs import Impulses, count, fluid, of_blocks, scaled
from carom.walls import Periodic

N = 2000
EQUATION = "S. Pieprzyk et al., Phys. Chem. Chem. Phys. 21, 6886 (2019), for N spheres"
#: Two fits by different hands agree to this, relative.
FITS = 2e-5


def expected(n: int, phi: float) -> tuple[float, float]:
    """Z and the rate of collisions of n spheres."""
    z = float(theory.kolafa_labik_malijevsky(phi))
    finite = FLUID_SIZE[phi] / n
    return z + finite, float(theory.collision_rate(phi)) * (1 + finite / (z - 1))


def equation_of_state(phi: float, size: float) -> list[Found]:
    """Z from impulses, the rate from counting, and the identity that ties them."""
    sim = fluid(N, phi)
    pressure, rate, impulse = Compressibility(), CollisionRate(), Impulses()
    collisions = count(size, 2e6)
    sim.run(collisions=collisions, observe=[pressure, rate, impulse])
    found = Found(f"fluid, φ = {phi:g}", N, collisions)
    z, omega = expected(N, phi)
    name = f"fluid-{phi:g}"
    measured = pressure.result()
    found.against(f"{name}-Z", "Z", measured, z, EQUATION, FITS * z)
    met = rate.result().estimate("rate", 0)
    source = "Z = 1 + (√π/6) σω √(m/kT), " + EQUATION
    found.against(f"{name}-rate", "collisions of a sphere", met, omega, source, FITS * omega)
    finite = FLUID_SIZE[phi] / N
    if phi == 0.1:
        series = float(theory.virial_series(phi)) + finite
        source = "ten virial coefficients, N. Clisby, B. M. McCoy, J. Stat. Phys. 122, 15 (2006)"
        found.against(f"{name}-virial", "Z", measured, series, source, FITS * z)
    if phi == 0.3:
        simple = float(theory.carnahan_starling(phi)) + finite
        source = "N. F. Carnahan, K. E. Starling, J. Chem. Phys. 51, 635 (1969)"
        found.against(f"{name}-Carnahan", "Z", measured, simple, source, 0.003 * z, "good to 0.3 %")
    if phi in (0.1, 0.4):
        # Of a fixed energy shared by f squares; it is √π for infinitely many.
        f = 3 * N - 3
        mean = math.sqrt(math.pi) * math.exp(
            math.lgamma(f / 2 + 0.5) - math.lgamma(f / 2 + 1) + 0.5 * math.log(f / 2)
        )
        kinetic = "kinetic theory, √(π m kT) for N spheres"
        found.against(f"{name}-impulse", "mean impulse", impulse.result(), mean, kinetic)
    found.panels.append(
        Panel(
            "Pressure of the fluid",
            "packing fraction",
            "Z measured/Z expected − 1, 10⁻³",
            [phi],
            [1e3 * (measured.value / z - 1)],
            [1e3 * measured.error / z],
            [phi],
            [0],
        )
    )
    return [found]


def structure(size: float) -> list[Found]:
    """What else there is to see in a fluid: each observable by a number it must give."""
    phi = 0.3
    sim = fluid(N, phi)
    omega, z = float(theory.collision_rate(phi)), expected(N, phi)[0]
    tensor, memory = PressureTensor(), VACF(at=[0.1 / omega])
    boltzmann, pairs, counts = HFunction(50 / omega), RDF(reach=5.0), CollisionsPerSphere()
    collisions = count(size, 1e6)
    sim.run(collisions=collisions, observe=[tensor, memory, boltzmann, pairs, counts])
    found = Found(f"fluid, φ = {phi:g}", N, collisions)
    pressure = tensor.result()
    ideal = phi * 6 / math.pi  # n kT
    parts = [pressure.estimate("pressure", k) for k in range(6)]
    # Spheres at rest together lack the motion of one of N.
    for k in (0, 2):
        found.against(
            f"fluid-P{'xxyyzz'[2 * k : 2 * k + 2]}",
            f"pressure {'xyz'[k]}{'xyz'[k]}/(n kT)",
            scaled(parts[k], 1 / ideal),
            z - 1 / N,
            EQUATION,
        )
    found.against("fluid-Pxy", "pressure xy/(n kT)", scaled(parts[3], 1 / ideal), 0.0, "symmetry")
    kept = memory.result().estimate("vacf", 0)
    source = "slope −2ω/3 at the start, exact"
    found.against("fluid-memory", "⟨v(0)·v(t)⟩ at 0.1/ω", kept, math.exp(-0.2 / 3), source, 5e-4)
    h = of_blocks(boltzmann.result()["h"])
    least = -1.5 * (1 + math.log(2 * math.pi))
    found.against("fluid-H", "Boltzmann's H", h, least, "Maxwell's law", 5e-3, "bins: 0.005")
    around = pairs.result()
    far = around["distance"] > 4
    g = of_blocks(around["g"][far].reshape(10, -1).mean(axis=1))
    found.against("fluid-g-far", "g(r), r from 4 to 5", g, 1.0, "no order far away", 2e-3)
    mean = float(counts.counts().mean())
    twice = 2 * collisions / N
    found.exact(
        "fluid-counts", "mean of the spheres' counters", mean, twice, 1e-9, "2 collisions/N"
    )
    return [found]


def other_program(n: int, phi: float, size: float) -> list[Found]:
    """Z against another program's, with as many spheres."""
    sim, pressure = fluid(n, phi), Compressibility()
    collisions = count(size, 2e6)
    sim.run(collisions=collisions, observe=pressure)
    found = Found(f"fluid, φ = {phi:g}", n, collisions)
    number = EDMD_Z[n, phi]
    found.against(f"md-Z-{n}-{phi:g}", "Z", pressure.result(), *_sourced(number, known.EDMD))
    return [found]


def free_time(density: float, size: float) -> list[Found]:
    """Mean free time against another program's."""
    n = 1372
    sim, rate = fluid(n, density * math.pi / 6), CollisionRate()
    collisions = count(size, 2e6)
    sim.run(collisions=collisions, observe=rate)
    met = rate.result().estimate("rate", 0)
    found = Found(f"fluid, nσ³ = {density:g}", n, collisions)
    number = known.DYNAMO_FREE_TIME[density]
    measured = scaled(met, 1 / met.value**2, 0)
    found.against(
        f"md-free-time-{density:g}",
        "mean free time",
        measured,
        *_sourced(number, known.DYNAMO),
    )
    return [found]


def _sourced(number: known.Known, source: str) -> tuple[float, str, float]:
    return number.value, source, number.error


def crystal(density: float, size: float) -> list[Found]:
    """Z of the face-centred crystal.

    The centre of mass is given, so N spheres press as N - 1 do: exact where the crystal is
    nearly packed, and taken to be good to a third elsewhere.
    """
    cells = 9
    n = 4 * cells**3
    phi = density * math.pi / 6
    side = place.cube_edge(n, phi)
    sim = Simulation(walls=Periodic(side, side, side))
    random = Random(1)
    velocity = place.maxwell(random, np.ones(n))
    sim.add_many(place.fcc(cells, cells, cells, size=side), velocity=velocity)
    sim.run(collisions=50 * n)
    pressure = Compressibility()
    collisions = count(size, 2e6)
    sim.run(collisions=collisions, observe=pressure)
    found = Found(f"crystal, nσ³ = {density:g}", n, collisions)
    z = known.CRYSTAL_Z[density]
    finite = (z - 1) / n
    unsure = math.hypot(known.CRYSTAL_SCATTER * z, finite / 3)
    note = "fits scatter by 3e-4"
    found.against(
        f"crystal-{density:g}-Z", "Z", pressure.result(), z - finite, known.ETOMICA, unsure, note
    )
    speedy = float(theory.speedy_fcc(phi))
    unsure = math.hypot(6e-4 * speedy, finite / 3)
    source = "R. J. Speedy, J. Phys.: Condens. Matter 10, 4387 (1998)"
    found.against(
        f"crystal-{density:g}-Speedy",
        "Z",
        pressure.result(),
        speedy - finite,
        source,
        unsure,
        "good to 6e-4",
    )
    return [found]


def checks() -> list[Check]:
    """All of this file."""
    fluids = [
        Check(f"fluid-{phi:g}", "fluid", partial(equation_of_state, phi), 1.7, 6)
        for phi in FLUID_SIZE
    ]
    programs = [
        Check(f"md-Z-{n}-{phi:g}", "programs", partial(other_program, n, phi), 1.5, 4)
        for n, phi in EDMD_Z
    ]
    times = [
        Check(f"md-free-time-{rho:g}", "programs", partial(free_time, rho), 1.5, 4)
        for rho in known.DYNAMO_FREE_TIME
    ]
    crystals = [
        Check(f"crystal-{rho:g}", "crystal", partial(crystal, rho), 1.4, 4)
        for rho in known.CRYSTAL_Z
    ]
    shapes = [Check("fluid-structure", "fluid", structure, 6.0, 2)]
    return [*fluids, *shapes, *programs, *times, *crystals]
