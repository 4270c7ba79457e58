"""Where the runs of the benchmark start: uniform fluids, and what an engine may stumble over.

Small spheres have diameter and mass 1, and the temperature is 1 at the start.
"""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from carom import walls
from carom.errors import InputError
from carom.place import cube_edge, cube_root, fcc, fluid_cells, maxwell, simple_cubic
from carom.random_numbers import Random
from carom.rules import Smooth
from carom.state import Floats, State
from carom.world import World

Start = tuple[State, World]

SEED = 1
#: Sites for each sphere of a fluid. With a fifth of them empty a lattice melts within some ten
#: collisions per sphere, just below freezing too; a full one lasts for hundreds.
SITES = 1.25
#: Of the contact-time model, which keeps the cooling gas from collapse; a five-hundredth of
#: the time between two collisions of a sphere at the start, and far less later.
CONTACT_TIME = 1e-3


def fluid(n: int, packing_fraction: float) -> Start:
    """N equal spheres in a periodic cube, on sites of a face-centred grid, a fifth of them empty.

    Where so many sites find no place, as few spheres may not, fewer are empty.
    """
    sites = math.ceil(SITES * n)
    try:
        cells = fluid_cells(sites, packing_fraction * sites / n)
    except InputError:
        cells = fluid_cells(n, packing_fraction)
    side = cube_edge(n, packing_fraction)
    return _thermal(n, fcc(*cells, size=side), _cube(side))


def lattice(edge: int) -> Start:
    """edge^3 spheres on a simple cubic lattice, of which every other layer moves against the rest.

    All speeds are equal and all numbers are short in binary, so that all collisions of a round
    happen in one moment, for ever: edge^3/2 events that a queue cannot tell apart in time.
    The spacing is 1.25 diameters, the packing fraction 0.268.
    """
    spacing = 1.25
    state = _spheres(simple_cubic(edge, edge, edge, spacing))
    layer = np.arange(edge).repeat(edge * edge)
    state.velocity[:, 0] = 1.0 - 2.0 * (layer % 2)
    return state, _cube(spacing * edge)


def lattice_start(cells: int, packing_fraction: float) -> Start:
    """4 cells^3 spheres on all sites of a face-centred lattice, with Maxwell velocities."""
    n = 4 * cells**3
    side = cube_edge(n, packing_fraction)
    return _thermal(n, fcc(cells, cells, cells, size=side), _cube(side))


def giant(n: int, ratio: float, packing_fraction: float) -> Start:
    """One giant among n small spheres that fill this share of the space around it.

    It is as dense as they are, and in the middle of a periodic cube.
    """
    volume = math.pi / 6 * (n / packing_fraction + ratio**3)
    return _among(n, np.zeros((1, 3)), ratio / 2, cube_root(volume))


def two_sizes(cells: int, ratio: int, packing_fraction: float) -> Start:
    """4 cells^3 large spheres, and small ones of the same total volume, in a periodic cube."""
    large = 4 * cells**3
    small = large * ratio**3
    side = cube_edge(2 * small, packing_fraction)
    return _among(small, fcc(cells, cells, cells, size=side), ratio / 2, side)


def cooling(n: int, packing_fraction: float, restitution: float) -> Start:
    """A granular gas: a fluid that loses energy at collisions, cools, and gathers in clusters."""
    state, world = fluid(n, packing_fraction)
    return state, replace(world, restitution=restitution, contact_time=CONTACT_TIME)


def sediment(n: int, width: float, gravity: float) -> Start:
    """A fluid that gravity holds on a floor: dense at the bottom, a thin gas at the top.

    The floor is hard and width x width, periodic at the sides; there is no lid.
    """
    ground = walls.Plane((0, 0, 1), 0), walls.Periodic(width, width, None)
    world = walls.world(ground, Smooth(), (0.0, 0.0, -gravity), True)
    height = n * math.pi / 6 / 0.35 / width**2
    across = round(width / cube_root(4 / (SITES * n) * width**2 * height))
    up = math.ceil(SITES * n / 4 / across**2)
    sites = fcc(across, across, up, size=(width, width, height))
    sites[:, 2] += height / 2 + 0.5
    return _thermal(n, sites, world, conserved=2)


def cloud(n: int, packing_fraction: float) -> Start:
    """A ball of hot fluid in open space, which flies apart."""
    radius = cube_root(n / packing_fraction) / 2
    cells = math.ceil(cube_root(SITES * n / (math.pi / 6) / 4))
    sites = fcc(cells, cells, cells, size=2 * radius)
    inside = np.flatnonzero((sites**2).sum(axis=1) < radius**2)
    return _thermal(n, sites[inside], World())


def _cube(side: float) -> World:
    return World(period=np.full(3, side))


def _spheres(position: Floats) -> State:
    state = State.empty(len(position))
    state.position[:] = position
    return state


def _thermal(n: int, sites: Floats, world: World, conserved: int = 3) -> Start:
    """N spheres on some of the sites, as the seed chooses, with Maxwell velocities."""
    random = Random(SEED)
    state = State.empty(n)
    state.position[:] = sites[random.choice(len(sites), n)]
    del sites
    state.velocity[:] = maxwell(random, state.mass, conserved=conserved)
    return state, world


def _among(n: int, large: NDArray[np.float64], radius: float, side: float) -> Start:
    """N small spheres on lattice sites outside a few large ones of equal density."""
    taken = len(large) * 4 / 3 * math.pi * (radius + 0.5) ** 3
    cells = math.ceil(cube_root(SITES * n / (1 - taken / side**3) / 4))
    sites = fcc(cells, cells, cells, size=side)
    free = np.ones(len(sites), np.bool_)
    for centre in large:
        apart = sites - centre
        apart -= side * np.round(apart / side)
        free &= (apart**2).sum(axis=1) > (radius + 0.5) ** 2
    random = Random(SEED)
    sites = sites[free]
    state = _spheres(np.concatenate([large, sites[random.choice(len(sites), n)]]))
    state.radius[: len(large)] = radius
    state.mass[: len(large)] = (2 * radius) ** 3
    state.velocity[:] = maxwell(random, state.mass)
    return state, _cube(side)
