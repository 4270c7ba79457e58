"""Kinds of spheres, and what kind of world they are in."""

import math

import numpy as np
from numpy.typing import NDArray

from carom import mechanics, theory
from carom.errors import InputError
from carom.state import Floats, State
from carom.world import World

MOST_KINDS = 16  #: more are a continuous distribution, of which pairs say nothing
DENSEST = 0.49  #: packing fraction for which `mean_free_time` asks theory, just below freezing


class Kinds:
    """Spheres that are not fixed, grouped by radius and mass.

    Attributes
    ----------
    of : (N,) int64
        The kind of each sphere; -1 where fixed.
    radius, mass : (K,) float64
        In rising order.
    count : (K,) int64
    """

    def __init__(self, state: State) -> None:
        free = ~state.fixed
        pairs = np.column_stack([state.radius[free], state.mass[free]])
        found, of = np.unique(pairs, axis=0, return_inverse=True)
        self.of = np.full(len(state), -1)
        self.of[free] = of.ravel()
        self.radius, self.mass = found[:, 0], found[:, 1]
        self.count = np.bincount(self.of[free], minlength=len(found))

    def __len__(self) -> int:
        return len(self.mass)

    @classmethod
    def few(cls, state: State, name: str) -> "Kinds":
        """The kinds, if they are few enough for a table.

        Raises
        ------
        InputError
            If there are more than 16.
        """
        kinds = cls(state)
        if len(kinds) > MOST_KINDS:
            msg = (
                f"{name} has a row for each radius and mass, and here are {len(kinds)}; "
                f"give spheres at most {MOST_KINDS} different ones"
            )
            raise InputError(msg)
        return kinds


def mean_free_time(state: State, world: World) -> float:
    """Roughly how long a sphere flies between two collisions: a scale to choose times by.

    By kinetic theory where there is a gas in a closed volume, or as if it were no denser than a
    fluid can be; else the time in which a sphere moves by its own radius.
    """
    volume, temperature = mechanics.volume(world), mechanics.temperature(state, world)
    kinds = Kinds(state)
    several = kinds.count.sum() > 1 and len(kinds) <= MOST_KINDS
    if world.collide and volume > 0 and temperature > 0 and several:
        volume = max(volume, 4 / 3 * math.pi * float(kinds.count @ kinds.radius**3) / DENSEST)
        each = theory.pair_rates(kinds.radius, volume, kinds.count, kinds.mass, temperature)
        mean = float(each.sum(axis=1) @ kinds.count / kinds.count.sum())
        if 0 < mean < math.inf:
            return 1 / mean
    return mechanics.crossing_time(state, world)


def is_periodic(world: World) -> bool:
    """Whether all axes are periodic and nothing is in the way."""
    return bool((world.period > 0).all()) and len(world.walls) == 0


def is_elastic(world: World) -> bool:
    """Whether no collision takes energy."""
    return world.restitution == 1 and bool((world.walls["restitution"] == 1).all())


def conserves_energy(world: World) -> bool:
    """Whether the kinetic energy can never change."""
    return is_elastic(world) and not world.gravity.any()


def labels(kinds: Kinds) -> NDArray[np.str_]:
    """A word for each kind."""
    return np.array([f"r={r:.4g} m={m:.4g}" for r, m in zip(kinds.radius, kinds.mass, strict=True)])


def letters(kinds: Kinds) -> list[str]:
    """A letter for each kind, where a column has its name; `MOST_KINDS` at most."""
    return [chr(ord("A") + k) for k in range(len(kinds))]


def legend(kinds: Kinds) -> str:
    """Which letter is which kind."""
    words = zip(letters(kinds), labels(kinds), strict=True)
    return ", ".join(f"{letter}: {label}" for letter, label in words)


def refuse_losses(world: World, name: str) -> None:
    """Refuse a world in which the temperature changes by itself.

    Raises
    ------
    InputError
        Where a rule takes energy, or gravity gives it.
    """
    if not conserves_energy(world):
        msg = (
            f"{name} is of equilibrium, where kinetic energy is conserved; "
            "take restitution 1 everywhere and no gravity"
        )
        raise InputError(msg)


def refuse_walls(world: World, name: str, instead: str) -> None:
    """Refuse a world that is not periodic along all axes.

    Raises
    ------
    InputError
        With `instead` as the remedy.
    """
    if not is_periodic(world):
        walls = len(world.walls)
        here = f"here are {walls} walls" if walls > 1 else "here is a wall"
        if walls == 0:
            bare = [axis for axis, length in zip("xyz", world.period, strict=True) if length == 0]
            here = f"{' and '.join(bare)} {'are' if len(bare) > 1 else 'is'} open here"
        msg = f"{name} needs a box periodic along all three axes, and {here}; {instead}"
        raise InputError(msg)


def one_kind(state: State, name: str) -> Kinds:
    """The kinds, of which there is one.

    Raises
    ------
    InputError
        If there are several, or no free sphere.
    """
    kinds = Kinds(state)
    if len(kinds) != 1:
        msg = (
            f"{name} is of spheres of one radius and mass, and here are {len(kinds)} kinds of them"
        )
        raise InputError(msg)
    return kinds


def unmoved(state: State, world: World) -> Floats:
    """Velocities about the centre of mass along the axes where momentum is conserved, (N, 3).

    Those of fixed spheres mean nothing.
    """
    mass = np.where(state.fixed, 0.0, state.mass)
    drift = np.zeros(3)
    axes = mechanics.conserved_axes(state, world)
    drift[axes] = mechanics.momentum(state)[axes] / mass.sum()
    result: Floats = state.velocity - drift
    return result
