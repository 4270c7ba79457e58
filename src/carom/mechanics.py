"""Energy, momentum, temperature and filling of a `State` in a `World`.

Sums run over contiguous arrays so that NumPy adds them pairwise: the rounding error grows
with log N, not with N, and stays below 1e-14 of the energy for a million spheres.
"""

import math

import numpy as np

from carom.state import Floats, State
from carom.world import CYLINDER, PLANE, SPHERE, World


def kinetic_energy(state: State) -> float:
    """½ Σ m v² over the spheres that are not fixed."""
    return _kinetic(_masses(state), state.velocity)


def potential_energy(state: State, world: World) -> float:
    """-Σ m g·x over the spheres that are not fixed: zero at the origin."""
    if not np.any(world.gravity):
        return 0.0
    return -float(np.sum(_masses(state) * (state.position @ world.gravity)))


def energy(state: State, world: World) -> float:
    """Kinetic and potential energy together."""
    return kinetic_energy(state) + potential_energy(state, world)


def energy_and_size(state: State, world: World) -> tuple[float, float]:
    """The energy, and Σ ½ m v² + Σ |m g·x|: a measure for its errors where the two cancel."""
    kinetic = kinetic_energy(state)
    if not np.any(world.gravity):
        return kinetic, kinetic
    depths = _masses(state) * (state.position @ world.gravity)
    return kinetic - float(np.sum(depths)), kinetic + float(np.sum(np.abs(depths)))


def momentum(state: State) -> Floats:
    """Σ m v over the spheres that are not fixed, (3,) float64."""
    columns = np.ascontiguousarray(state.velocity.T)
    total: Floats = (columns * _masses(state)).sum(axis=1)
    return total


def conserved_axes(state: State, world: World) -> list[int]:
    """Axes along which no wall, fixed sphere or gravity can change the total momentum."""
    if world.collide and state.fixed.any():
        return []
    broken = world.gravity != 0
    for wall in world.walls:
        if wall["kind"] == SPHERE or wall["bounce_back"]:
            return []
        across = wall["normal"] != 0 if wall["kind"] == PLANE else np.array([True, True, False])
        broken = broken | across
    return [axis for axis in range(3) if not broken[axis]]


def temperature(state: State, world: World) -> float:
    """2K/f with k = 1, K about the centre-of-mass motion along the axes where that is conserved.

    f = 3N - (number of such axes), N the number of spheres that are not fixed; nan if f = 0.
    """
    axes = conserved_axes(state, world)
    freedom = 3 * int(np.count_nonzero(~state.fixed)) - len(axes)
    if freedom <= 0:
        return math.nan
    masses = _masses(state)
    drift = np.zeros(3)
    drift[axes] = momentum(state)[axes] / masses.sum()
    return 2 * _kinetic(masses, state.velocity - drift) / freedom


def packing_fraction(state: State, world: World) -> float:
    """Volume of all spheres over the volume of the world; nan where that is not closed."""
    spheres = 4 / 3 * math.pi * float(np.sum(state.radius**3))
    return spheres / volume(world)


def volume(world: World) -> float:
    """Volume of a box, sphere or cylinder, periodic or between planes; nan in open space.

    Worlds cut by a slanted plane, or by several curved walls, have no simple formula: nan.
    """
    walls = world.walls
    curved = walls[walls["kind"] != PLANE]
    planes = walls[walls["kind"] == PLANE]
    if len(curved) > 1 or np.any(np.count_nonzero(planes["normal"], axis=1) > 1):
        return math.nan
    lengths = [_length(world, planes, axis) for axis in range(3)]
    if len(curved) == 0:
        return math.prod(lengths)
    radius = float(curved[0]["offset"])
    if curved[0]["kind"] == CYLINDER:
        inside = math.isnan(lengths[0]) and math.isnan(lengths[1])
        return math.pi * radius**2 * lengths[2] if inside else math.nan
    return 4 / 3 * math.pi * radius**3 if len(planes) == 0 else math.nan


def crossing_time(state: State, world: World) -> float:
    """How long a typical sphere takes for its own radius, by its speed or by falling.

    A scale to choose short times by; 1 where nothing moves.
    """
    free = ~state.fixed
    if not free.any():
        return 1.0
    radius = float(state.radius[free].mean())
    speed = math.sqrt(float((state.velocity[free] ** 2).sum(axis=1).mean()))
    fall = math.sqrt(radius * float(np.linalg.norm(world.gravity)))
    return radius / max(speed, fall) if max(speed, fall) > 0 else 1.0


def _length(world: World, planes: np.ndarray, axis: int) -> float:
    """Distance between the planes (or images) that bound an axis; nan if it is open."""
    if world.period[axis] > 0:
        return float(world.period[axis])
    normal = planes["normal"][:, axis]
    below, above = planes["offset"][normal > 0], planes["offset"][normal < 0]
    if len(below) == 0 or len(above) == 0:
        return math.nan
    return float(-above.max() - below.max())


def _masses(state: State) -> Floats:
    """Masses with 0 where fixed: such spheres count in no energy or momentum."""
    return np.where(state.fixed, 0.0, state.mass)


def _kinetic(masses: Floats, velocity: Floats) -> float:
    x, y, z = velocity.T  # five times as fast as sum(axis=1), with the same bits
    return 0.5 * float(np.sum(masses * (x * x + y * y + z * z)))
