"""Gases under gravity and between walls."""

import math

import numpy as np

from carom import mechanics, place, theory
from carom.observe import Estimate, Moment, Observable, WallPressure
from carom.observe.observable import every
from carom.random_numbers import Random
from carom.simulation import Simulation
from carom.validate.row import Check, Found, Panel
from carom.validate.runs import count, of_blocks
from carom.walls import Box, Periodic, Plane, Wall

N, WIDTH, G = 500, 60.0, 0.2
TOP = 120.0
BLOCKS = 20
SOURCE = "hydrostatics with the second virial coefficient"


class Heights(Observable):
    """Heights of all spheres, and twice their kinetic energy, at equal intervals."""

    def __init__(self, interval: float) -> None:
        self.schedule = every(interval)

    def begin(self, moment: Moment) -> None:
        """None yet."""
        self.heights: list[np.ndarray] = []
        self.kinetic: list[float] = []

    def sample(self, moment: Moment) -> None:
        """Read them."""
        self.heights.append(moment.state.position[:, 2] - moment.state.radius)
        self.kinetic.append(mechanics.kinetic_energy(moment.state))

    def result(self) -> Estimate:
        """Mean height."""
        return in_blocks(np.array(self.heights).mean(axis=1))


def in_blocks(values: np.ndarray) -> Estimate:
    """Mean of a series in twenty blocks."""
    size = len(values) // BLOCKS
    return of_blocks(values[: BLOCKS * size].reshape(BLOCKS, size).mean(axis=1))


def atmosphere(size: float) -> list[Found]:
    """Mean height, shares of energy, layers, and the weight on the floor."""
    random = Random(8)
    room = (WIDTH, WIDTH, 20.0)
    start = place.random_positions(random, np.full(N, 0.5), room, (True, True, False))
    start[:, 2] += 10.0
    walls: list[Wall] = [Periodic(WIDTH, WIDTH, None), Plane((0, 0, 1), 0), Plane((0, 0, -1), -TOP)]
    sim = Simulation(walls=walls, gravity=(0, 0, -G))
    sim.add_many(start, velocity=place.maxwell(random, np.ones(N), temperature=0.8))
    sim.run(until=600.0)
    gap, samples = 6.0, count(size, 800)
    heights, pressure = Heights(gap), WallPressure()
    met = sim.collisions + sim.wall_collisions
    sim.run(duration=gap * samples, observe=[heights, pressure])
    met = sim.collisions + sim.wall_collisions - met
    found = Found(f"column of gas, g = {G:g}", N, met)
    kinetic = 2 * np.array(heights.kinetic) / (3 * N - 2)  # two axes keep their momentum
    kT = float(kinetic.mean())
    column = N / WIDTH**2
    z = np.array(heights.heights)
    scale = kT / G
    expected = float(theory.mean_height(column, G, kT)) / scale
    first = expected - 1
    ratio = in_blocks(z.mean(axis=1) * G / kinetic)
    found.against(
        "column-height", "m g ⟨z⟩/kT", ratio, expected, SOURCE, 0.1 * first,
        "next order: a tenth of the correction",
    )  # fmt: skip
    h = np.linspace(0, TOP, 8001)
    density = theory.barometric_density(h, column, G, kT) / column
    below = np.concatenate([[0], np.cumsum(np.diff(h) * (density[1:] + density[:-1]) / 2)])
    for k in (1, 2):
        share = 1 - float(np.interp(k * scale, h, below))
        measured = in_blocks((z > k * scale).mean(axis=1))
        found.against(
            f"column-above-{k}", f"share above {k} kT/(m g)", measured, share, SOURCE,
            0.1 * first * share, "next order",
        )  # fmt: skip
    floor = pressure.result().estimate("pressure", 0)
    found.against("column-weight", "pressure on the floor", floor, column * G, "weight: N m g/A")
    energy = in_blocks(
        z.mean(axis=1) * G * N / (z.mean(axis=1) * G * N + kinetic * (3 * N - 2) / 2)
    )
    share = expected * N / (expected * N + (3 * N - 2) / 2)
    found.against(
        "column-energy", "potential share of energy", energy, share, SOURCE, 0.1 * first * share,
        "2/5 for an ideal gas",
    )  # fmt: skip
    edges = scale * np.linspace(0, 5, 26)
    counts = np.array([np.histogram(one, edges)[0] for one in z]) / N
    middle = (edges[1:] + edges[:-1]) / 2
    line = np.diff(np.interp(edges, h, below))
    layers = [in_blocks(layer) for layer in counts.T]
    found.panels.append(
        Panel(
            "Column of gas",
            "height",
            "density over theory",
            middle,
            [one.value / of for one, of in zip(layers, line, strict=True)],
            [one.error / of for one, of in zip(layers, line, strict=True)],
            middle,
            np.ones(len(middle)),
        )
    )
    return [found]


def ideal(size: float) -> list[Found]:
    """Points that do not see one another, under gravity: exact for each."""
    n, g, gap = 400, 0.5, 0.37
    random = Random(4)
    # Heights and velocities of equilibrium at kT = 1 stay so.
    z = -np.log(random.uniform(n, low=1e-12)) / g
    radius = 1e-3
    start = np.column_stack([random.uniform(n, 2, low=-5, high=5), z + radius])
    sim = Simulation(
        walls=[Periodic(10, 10, None), Plane((0, 0, 1), 0), Plane((0, 0, -1), -2 * TOP)],
        gravity=(0, 0, -g),
        collide=False,
    )
    velocity = random.normal(n, 3)
    sim.add_many(start, velocity=velocity, radius=radius)
    energy = g * z + velocity[:, 2] ** 2 / 2
    # A ball that falls from height h is on average at 2 h/3, and hits the floor each 2 sqrt(2h/g).
    top = energy / g
    heights, pressure = Heights(gap), WallPressure()
    duration = gap * count(size, 4000)
    sim.run(duration=duration, observe=[heights, pressure])
    found = Found("ideal gas on a floor", n, sim.wall_collisions)
    mean = in_blocks(np.array(heights.heights).mean(axis=1))
    source = "closed form: 2/3 of the way up to the top"
    found.against("ideal-height", "mean height", mean, float(2 / 3 * top.mean()), source)
    floor = pressure.result().estimate("pressure", 0)
    # Each brings m g in the mean, within one hit of 2 m v.
    bound = float(2 * np.sqrt(2 * energy).sum()) / duration / 100
    found.exact(
        "ideal-weight", "pressure on the floor", floor.value, n * g / 100, bound, "N m g/A",
        "one hit each",
    )  # fmt: skip
    kept = sim.kinetic_energy + sim.potential_energy
    whole = float((energy + radius * g + (velocity[:, :2] ** 2).sum(axis=1) / 2).sum())
    found.exact("ideal-energy", "energy, of ½mv² + mgz", kept, whole, 1e-9 * whole, "conservation")
    return [found]


def between_walls(size: float) -> list[Found]:
    """The pressure that a fluid puts on six hard walls, at which it crowds."""
    n, phi = 500, 0.1
    side = place.cube_edge(n, phi)
    random = Random(6)
    sim = Simulation(walls=Box(side, side, side))
    start = place.random_positions(random, np.full(n, 0.5), np.full(3, side))
    sim.add_many(start, velocity=place.maxwell(random, np.ones(n), conserved=0))
    sim.run(collisions=30 * n)
    pressure = WallPressure()
    collisions = count(size, 4e5)
    sim.run(collisions=collisions, observe=pressure)
    table = pressure.result()
    found = Found(f"gas in a box, φ = {phi:g}", n, collisions)
    values = [table.estimate("pressure", wall) for wall in range(6)]
    mean = Estimate(
        float(np.mean([v.value for v in values])),
        math.sqrt(sum(v.error**2 for v in values)) / 6,
        6,
    )
    reach = side - 1.0
    kT = 2 * sim.kinetic_energy / (3 * n)
    expected = kT * theory.wall_pressure(np.full(n, 0.5), reach**3, 6 * reach**2, 4 / reach)
    source = "scaled particles: J. L. Lebowitz et al., J. Chem. Phys. 43, 774 (1965)"
    found.against(
        "walls-pressure", "pressure on six walls", mean, expected, source, 0.003 * expected,
        "good to 0.3 %",
    )  # fmt: skip
    return [found]


def checks() -> list[Check]:
    """All of this file."""
    return [
        Check("column", "column", atmosphere, 2.2, 8),
        Check("ideal", "column", ideal, 0.5, 2),
        Check("walls", "walls", between_walls, 0.6, 8),
    ]
