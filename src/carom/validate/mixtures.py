"""Two kinds of spheres in a periodic cube: pressure, rates of each pair, equipartition."""

import numpy as np

from carom import place, theory
from carom.observe import CollisionRate, Compressibility, Estimate, Temperature
from carom.random_numbers import Random
from carom.simulation import Simulation
from carom.state import Floats
from carom.validate import references as known
from carom.validate.row import Check, Found
from carom.validate.runs import count, scaled
from carom.walls import Periodic

N = 2000
BMCSL = "BMCSL, Boublík 1970, Mansoori et al. 1971"


def mixed(counts: tuple[int, int], radius: Floats, mass: Floats, phi: float) -> Simulation:
    """Spheres of two kinds in a periodic cube at kT = 1.

    They start at random places; where there is no room for that, on sites of a grid.
    """
    n = sum(counts)
    side = place.cube_root(np.pi * 4 / 3 * float(np.array(counts) @ radius**3) / phi)
    random = Random(3)
    kind = np.repeat([0, 1], counts)
    if phi > 0.2:
        sites = place.fcc(*place.fluid_cells(n, 0.5), size=side)
        places = sites[random.choice(len(sites), n)]
    else:
        places = place.random_positions(random, radius[kind], np.full(3, side), (True,) * 3)
    velocity = place.maxwell(random, mass[kind])
    sim = Simulation(walls=Periodic(side, side, side))
    sim.add_many(places, velocity=velocity, radius=radius[kind], mass=mass[kind])
    sim.run(collisions=50 * n)
    return sim


def half_and_half(size: float) -> list[Found]:
    """Equal numbers of diameter 1 and 1/2: Z, three pair rates, one temperature."""
    radius, mass = np.array([0.25, 0.5]), np.array([0.125, 1.0])
    sim = mixed((N // 2, N // 2), radius, mass, 0.3)
    volume = float(sim.world.period.prod())
    pressure, rate, heat = Compressibility(), CollisionRate(), Temperature()
    collisions = count(size, 4e6)
    sim.run(collisions=collisions, observe=[pressure, rate, heat])
    found = Found("mixture 2:1, φ = 0.3", N, collisions)
    z = pressure.result()
    # Both had as many or twice as many spheres, whose number matters less than the errors.
    found.against("mixture-Z", "Z", z, known.MIXTURE_Z.value, known.EDMD, known.MIXTURE_Z.error)
    bmcsl = theory.bmcsl(radius, volume, N / 2)
    found.against("mixture-Z-BMCSL", "Z", z, bmcsl, BMCSL, 0.005 * bmcsl, "good to 0.5 %")
    table = rate.result()
    rows = {"small-small": 0, "big-small": 1, "big-big": 3}
    rates = theory.pair_rates(radius, volume, N / 2, mass)
    places = {"small-small": (0, 0), "big-small": (1, 0), "big-big": (1, 1)}
    for pair, number in known.MIXTURE_PAIRS.items():
        one = table.estimate("rate", rows[pair])
        density = N / 2 / volume
        met = scaled(one, density if pair == "big-small" else density / 2)
        found.against(
            f"mixture-{pair}",
            f"pairs {pair}/(V t)",
            met,
            number.value,
            known.EDMD,
            number.error,
        )
        expected = float(rates[places[pair]])
        found.against(
            f"mixture-{pair}-BMCSL",
            f"a sphere's rate {pair}",
            one,
            expected,
            f"Enskog with {BMCSL}",
            0.01 * expected,
            "good to 1 %",
        )
    temperatures = heat.result()
    for place_, kind in enumerate(("small", "big")):
        kT = temperatures.estimate("temperature", place_)
        found.against(f"mixture-kT-{kind}", f"kT of the {kind}", kT, 1.0, "equipartition")
    return [found]


def colloid(size: float) -> list[Found]:
    """A few heavy spheres among many light ones: how often any sphere collides."""
    radius, mass = np.array([0.5, 0.25]), np.array([1.0, 0.001])
    counts = (50, 1950)
    volume = sum(counts) / 1.4
    phi = np.pi * 4 / 3 * float(np.array(counts) @ radius**3) / volume
    sim = mixed(counts, radius, mass, phi)
    sim.run(collisions=1_000_000)  # heavy and light ones share energy slowly
    rate = CollisionRate()
    collisions = count(size, 3e6)
    sim.run(collisions=collisions, observe=rate)
    found = Found("heavy among light, nσ³ = 1.4", sum(counts), collisions)
    met = rate.result()
    per = [met.estimate("rate", k) for k in range(4)]
    # Rows: light-light, light-heavy, heavy-light, heavy-heavy.
    share = np.array([1950, 1950, 50, 50]) / 2000
    total = float(sum(s * e.value for s, e in zip(share, per, strict=True)))
    error = float(sum(s * e.error for s, e in zip(share, per, strict=True)))
    free = Estimate(1 / total, error / total**2, per[0].n_independent)
    number = known.COLLOID_FREE_TIME
    found.against("mixture-colloid", "mean free time", free, number.value, known.EDMD, number.error)
    expected = theory.pair_rates(radius, volume, counts, mass)
    mean = float(1 / (np.array(counts) / sum(counts) @ expected.sum(axis=1)))
    found.against(
        "mixture-colloid-BMCSL",
        "mean free time",
        free,
        mean,
        f"Enskog with {BMCSL}",
        0.002 * mean,
        "good to 0.2 %",
    )
    return [found]


def checks() -> list[Check]:
    """All of this file."""
    return [
        Check("mixture-half", "mixture", half_and_half, 5.5, 3),
        Check("mixture-colloid", "mixture", colloid, 5.0, 3),
    ]
