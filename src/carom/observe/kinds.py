"""Kinds of spheres, and how often they should meet."""

import math

import numpy as np
from numpy.typing import NDArray

from carom import mechanics
from carom.errors import InputError
from carom.state import Floats, State
from carom.world import World

MOST_KINDS = 16  #: more are a continuous distribution, of which pairs say nothing


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

    def rates(self, volume: float, temperature: float) -> Floats:
        """Collisions of one sphere of kind a with those of kind b per unit time, (K, K) float64.

        nu_ab = n_b sigma_ab^2 chi_ab sqrt(8 pi kT/mu_ab), with the contact values chi_ab of
        BMCSL (see `carom.theory.bmcsl`).
        """
        sigma, n = 2 * self.radius, self.count / volume
        two, three = (math.pi / 6 * float(n @ sigma**k) for k in (2, 3))
        u = 1 - three
        both = (sigma[:, None] + sigma) / 2
        d = sigma[:, None] * sigma / (2 * both) * two
        chi = 1 / u + 3 * d / u**2 + 2 * d**2 / u**3
        mu = 1 / (1 / self.mass[:, None] + 1 / self.mass)
        result: Floats = n * both**2 * chi * np.sqrt(8 * math.pi * temperature / mu)
        return result


def mean_free_time(state: State, world: World) -> float:
    """Roughly how long a sphere flies between two collisions: a scale to choose times by.

    By kinetic theory where there is a gas in a closed volume; else the time in which a sphere
    moves by its own radius.
    """
    volume, temperature = mechanics.volume(world), mechanics.temperature(state, world)
    kinds = Kinds(state)
    if world.collide and volume > 0 and temperature > 0 and 0 < len(kinds) <= MOST_KINDS:
        rates = kinds.rates(volume, temperature).sum(axis=1)
        mean = float(rates @ kinds.count / kinds.count.sum())
        if 0 < mean < math.inf:
            return 1 / mean
    return mechanics.crossing_time(state, world)


def is_periodic(world: World) -> bool:
    """Whether all axes are periodic and nothing is in the way."""
    return bool((world.period > 0).all()) and len(world.walls) == 0


def conserves_energy(world: World) -> bool:
    """Whether the kinetic energy can never change."""
    elastic = world.restitution == 1 and bool((world.walls["restitution"] == 1).all())
    return elastic and not world.gravity.any()


def labels(kinds: Kinds) -> NDArray[np.str_]:
    """A word for each kind."""
    return np.array([f"r={r:.4g} m={m:.4g}" for r, m in zip(kinds.radius, kinds.mass, strict=True)])


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
        msg = f"{name} needs a box that is periodic along all three axes; {instead}"
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
