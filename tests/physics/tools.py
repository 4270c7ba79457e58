"""What the physics tests share: reference tables, runs, and numbers with error bars."""

import csv
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from carom import place
from carom.engine import Engine, FastEngine, Stop
from carom.random_numbers import Random
from carom.state import State
from carom.validate import references
from carom.world import World

DATA = Path(__file__).parent / "data"
EPS = float(np.finfo(float).eps)


def table(name: str) -> list[dict[str, str]]:
    """Rows of a reference table, without the lines that begin with #.

    Those that ``carom validate`` uses too are in the package.
    """
    if not (DATA / f"{name}.csv").exists():
        return references.table(name)
    with (DATA / f"{name}.csv").open(newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def numbers(row: dict[str, str], *names: str) -> np.ndarray:
    return np.array([float(row[name]) for name in names])


def spheres(position, velocity=0.0, radius=0.5, mass=1.0) -> State:
    """A state; one value for all or one for each."""
    state = State.empty(len(position))
    state.position[:], state.velocity[:] = position, velocity
    state.radius[:], state.mass[:] = radius, mass
    return state


def drive(engine: Engine, until=math.inf, collisions=None, events=None) -> Stop:
    """Let an engine run to a time, or through exactly so many collisions or events."""
    pairs, walls = engine.collisions, engine.wall_collisions
    while True:
        limits = {}
        met = engine.collisions - pairs
        if collisions is not None:
            limits["max_collisions"] = collisions - met
        if events is not None:
            limits["max_events"] = events - met - (engine.wall_collisions - walls)
        stop = engine.advance(until, **limits)
        if stop is not Stop.SLICE:
            return stop


@dataclass(frozen=True)
class Number:
    """A value with its standard error."""

    value: float
    error: float

    @classmethod
    def of_blocks(cls, blocks) -> "Number":
        """Mean of blocks long enough to know nothing of one another."""
        blocks = np.asarray(blocks)
        return cls(float(blocks.mean()), float(blocks.std(ddof=1) / math.sqrt(len(blocks))))

    def is_off(self, reference: float, error: float = 0.0) -> float:
        """Distance from a reference, in standard errors of both together."""
        return abs(self.value - reference) / math.hypot(self.error, error)


def kinetic(state: State) -> float:
    """Kinetic energy, the sum correctly rounded."""
    squares = (state.velocity * state.velocity).sum(axis=1)
    return 0.5 * math.fsum(state.mass * squares)


def angular(state: State) -> np.ndarray:
    """Angular momentum about the origin."""
    return (state.mass[:, None] * np.cross(state.position, state.velocity)).sum(axis=0)


def cube(n: int, packing_fraction: float) -> World:
    """A periodic cube for n spheres of diameter 1."""
    return World(period=np.full(3, place.cube_edge(n, packing_fraction)))


def maxwell_gas(n: int, packing_fraction: float, seed: int, cells: int = 0) -> State:
    """n spheres of diameter 1 on random ones of 4 cells^3 face-centred sites, kT = 1.

    A grid with as many sites as spheres is a crystal, which does not melt just below freezing;
    with a fifth of its sites empty it does.
    """
    random = Random(seed)
    cells = cells or math.ceil((n / 3.2) ** (1 / 3))
    sites = place.fcc(cells, cells, cells, size=place.cube_edge(n, packing_fraction))
    return spheres(sites[random.choice(len(sites), n)], place.maxwell(random, np.ones(n)))


def equilibrium(n: int, packing_fraction: float, seed: int, per_sphere: int = 100) -> State:
    """A fluid that has forgotten its lattice in so many collisions of each sphere."""
    engine = FastEngine(
        maxwell_gas(n, packing_fraction, seed), cube(n, packing_fraction), log=False
    )
    drive(engine, collisions=per_sphere * n // 2)
    state = engine.state()
    state.time, state.collisions = 0.0, 0
    state.collision_count[:] = 0
    return state
