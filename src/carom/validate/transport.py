"""Diffusion, and how it depends on the size of the cube; viscosities and conduction of heat."""

import math
from functools import partial

from carom import theory
from carom.observe import (
    BulkViscosity,
    Diffusion,
    Estimate,
    ShearViscosity,
    ThermalConductivity,
)
from carom.simulation import Simulation
from carom.validate import references as known
from carom.validate.row import Check, Found
from carom.validate.runs import count, fluid, scaled

N = 1372
ENSKOG = "Enskog, Lindenfeld and Shizgal 1979"
YEH_HUMMER = "I.-C. Yeh, G. Hummer, J. Phys. Chem. B 108, 15873 (2004)"


def diffusion(
    n: int, density: float, duration: float, lags: tuple[float, float]
) -> tuple[Simulation, Diffusion]:
    """A fluid, and D of its own periodic cube."""
    sim = fluid(n, density * math.pi / 6)
    measured = Diffusion(between=lags)
    sim.run(duration=duration, observe=measured)
    return sim, measured


def in_this_cube(measured: Diffusion) -> Estimate:
    """D without the correction for size."""
    return measured.result().estimate("value", 0)


def against_dynamo(density: float, size: float) -> list[Found]:
    """D between lags 5 and 30, as another program measured it."""
    duration = 30.0 * max(16, round(20 * size))
    sim, measured = diffusion(N, density, duration, (5.0, 30.0))
    found = Found(f"fluid, nσ³ = {density:g}", N, sim.collisions)
    number = known.DYNAMO_DIFFUSION[density]
    found.against(
        f"diffusion-{density:g}",
        "D in this cube",
        in_this_cube(measured),
        number.value,
        known.DYNAMO,
        number.error,
    )
    if density == 0.5:
        # The correction of theirs, from the same shear viscosity.
        side = (N / density) ** (1 / 3)
        shift = float(theory.finite_size_diffusion(side, known.DYNAMO_SHEAR[density].value))
        infinite = measured.result().estimate("value", 1)
        found.against(
            f"diffusion-{density:g}-infinite",
            "D, infinite",
            infinite,
            number.value + shift,
            f"{known.DYNAMO}; {YEH_HUMMER}",
            math.hypot(number.error, 0.02 * shift),
        )
    return [found]


def by_size(size: float) -> list[Found]:
    """D of a small and a large cube differ as the images of a sphere say."""
    # Flow goes round a cube of 14 and comes back in a time of about 5: L^2 n/(4 pi^2 eta).
    density, eta = 0.5, known.DYNAMO_SHEAR[0.5]
    ways = []
    shifts = []
    met = 0
    for n, windows, lags in ((108, 300, (5.0, 20.0)), (N, 30, (15.0, 40.0))):
        sim, measured = diffusion(n, density, lags[1] * round(windows * size), lags)
        ways.append(in_this_cube(measured))
        shifts.append(float(theory.finite_size_diffusion((n / density) ** (1 / 3), eta.value)))
        met += sim.collisions
    found = Found("fluid, nσ³ = 0.5, two cubes", 108, met)
    expected = shifts[0] - shifts[1]
    difference = Estimate(
        ways[1].value - ways[0].value, math.hypot(ways[0].error, ways[1].error), 2
    )
    # The next term is of order (σ/L)^3; the viscosity is known to 1.5 percent.
    note = "good to 4 %: next term, viscosity"
    found.against(
        "diffusion-size",
        f"D(N = {N}) − D(108)",
        difference,
        expected,
        YEH_HUMMER,
        0.04 * expected,
        note,
    )
    return [found]


def dilute(size: float) -> list[Found]:
    """D of a gas, which Enskog knows to a few percent."""
    phi = 0.02
    sim = fluid(N, phi, per_sphere=30)
    free = float(theory.mean_free_time(phi))
    measured = Diffusion(between=(12 * free, 40 * free))
    sim.run(duration=40 * free * max(16, round(25 * size)), observe=measured)
    found = Found(f"gas, φ = {phi:g}", N, sim.collisions)
    side = float(sim.world.period[0])
    shift = float(theory.finite_size_diffusion(side, float(theory.shear_viscosity(phi))))
    expected = float(theory.self_diffusion(phi))
    found.against(
        "diffusion-gas",
        "D, infinite",
        scaled(in_this_cube(measured), 1, shift),
        expected,
        ENSKOG,
        0.02 * expected,
        "good to 2 %",
    )
    return [found]


def coefficients(density: float, lags: tuple[float, float], size: float) -> list[Found]:
    """Viscosities and conduction of heat, as another program measured them; and by Enskog."""
    sim = fluid(N, density * math.pi / 6)
    shear, bulk, heat = ShearViscosity(lags), BulkViscosity(lags), ThermalConductivity(lags)
    collisions = count(size, 4e6)
    sim.run(collisions=collisions, observe=[shear, bulk, heat])
    found = Found(f"fluid, nσ³ = {density:g}", N, collisions)
    phi = density * math.pi / 6
    for name, quantity, measured, numbers, enskog in (
        ("shear", "shear viscosity", shear, known.DYNAMO_SHEAR, theory.shear_viscosity(phi)),
        ("bulk", "bulk viscosity", bulk, known.DYNAMO_BULK, theory.bulk_viscosity(phi)),
        ("heat", "thermal conductivity", heat, known.DYNAMO_HEAT, theory.thermal_conductivity(phi)),
    ):
        value = measured.result().estimate("value", 0)
        row = f"transport-{density:g}-{name}"
        if density in numbers:
            number = numbers[density]
            found.against(row, quantity, value, number.value, known.DYNAMO, number.error)
        if density == 0.5 or name == "bulk":
            limit = 0.05 if density == 0.5 else 0.1
            note = f"good to {100 * limit:.0f} %"
            found.against(f"{row}-Enskog", quantity, value, enskog, ENSKOG, limit * enskog, note)
    return [found]


def gas(size: float) -> list[Found]:
    """Viscosity and conduction of heat of a gas, which Enskog knows to a percent."""
    phi = 0.02
    sim = fluid(N, phi, per_sphere=30)
    shear, heat = ShearViscosity(), ThermalConductivity()
    collisions = count(size, 4e6)
    sim.run(collisions=collisions, observe=[shear, heat])
    found = Found(f"gas, φ = {phi:g}", N, collisions)
    for name, quantity, measured, enskog in (
        ("shear", "shear viscosity", shear, theory.shear_viscosity(phi)),
        ("heat", "thermal conductivity", heat, theory.thermal_conductivity(phi)),
    ):
        value = measured.result().estimate("value", 0)
        unsure = 0.01 * enskog
        found.against(
            f"transport-gas-{name}", quantity, value, enskog, ENSKOG, unsure, "good to 1 %"
        )
    return [found]


def checks() -> list[Check]:
    """All of this file."""
    dense = [
        Check(f"diffusion-{rho:g}", "diffusion", partial(against_dynamo, rho), seconds, 3)
        for rho, seconds in ((0.5, 2.2), (0.8, 5.5))
    ]
    flows = [
        Check(f"transport-{rho:g}", "transport", partial(coefficients, rho, lags), 4.0, 3)
        for rho, lags in ((0.5, (0.5, 2.0)), (0.8, (0.3, 1.0)))
    ]
    return [
        *dense,
        *flows,
        Check("transport-gas", "transport", gas, 6.0, 3),
        Check("diffusion-size", "diffusion", by_size, 5.0, 4),
        Check("diffusion-gas", "diffusion", dilute, 1.3, 4),
    ]
