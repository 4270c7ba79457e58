"""The static structure factor: how far density waves stand out."""

import math

import numpy as np
from numpy.typing import NDArray

from carom import theory
from carom.observe.batch import Moment
from carom.observe.blocking import FEWEST_BLOCKS
from carom.observe.fluid import UP_TO, fluid_of
from carom.observe.kinds import refuse_walls
from carom.observe.sampled import Reaching
from carom.observe.table import Table
from carom.state import Floats

REACH = 15.0  #: wave numbers go up to this over the mean diameter
SHELLS = 100  #: at most
VECTORS = 16  #: in a shell at most; -k says the same as k and is left out
AT_ONCE = 2**15  #: phases that are held at once, few enough for the cache


class StructureFactor(Reaching):
    """Structure factor S(k) = <|sum exp(i k.r)|^2>/N of a periodic box, over all spheres alike.

    k are wave vectors that the box allows, 2 pi (a/L_x, b/L_y, c/L_z), averaged over shells of
    |k| as wide as 2 pi/L of the longest side. The smallest are always among them; in larger
    shells 16 stand for all, the nearest to 16 fixed directions. The error is that of the means over
    time of different vectors, which in a fluid are independent; of fewer than 8 vectors it
    is not known. Theory, for one kind: `carom.theory.percus_yevick`. Result: `Table`.

    Parameters
    ----------
    reach : float, optional
        Where the last shell is; 15 over the mean diameter if left out.
    every, at
        As of `Sampled`, but a hundred mean free times if left out: waves take long to sum.

    References
    ----------
    J.-P. Hansen, I. R. McDonald, Theory of Simple Liquids, 4th ed., Academic Press 2013,
    section 4.1.
    """

    def begin(self, moment: Moment) -> None:
        """Choose the wave vectors."""
        super().begin(moment)
        state, world = moment.state, moment.world
        refuse_walls(world, self.name, "take carom.Periodic, whose waves fit into the box")
        reach = self._asked or REACH / (2 * float(state.radius.mean()))
        longest = 2 * math.pi / float(world.period.max())
        self._waves, self._shell = wave_vectors(world.period, max(reach, longest))
        self._power = np.zeros(len(self._waves))
        self._fluid, self._said = fluid_of(moment)

    def sample(self, moment: Moment) -> None:
        """Add the powers of all waves."""
        state = moment.state
        self._power += powers(state.position / moment.world.period, self._waves) / len(state)

    def result(self) -> Table:
        """S(k) so far."""
        samples = self.over_samples()
        assert self.world is not None
        k = np.sqrt(((self._waves * (2 * math.pi / self.world.period)) ** 2).sum(axis=1))
        line = np.full(len(k), math.nan)
        if self._fluid is not None:
            phi, radius = self._fluid.packing_fraction, self._fluid.radius
            line = theory.percus_yevick(k, phi, radius)
        of, many = self._shell, np.bincount(self._shell)
        power = self._power / samples
        mean = np.bincount(of, power) / many
        spread = np.bincount(of, (power - mean[of]) ** 2)
        with np.errstate(divide="ignore", invalid="ignore"):
            student = 1 + 1 / (2 * (many - 1))  # as `blocking` does
            error = np.sqrt(spread / (many - 1) / many) * student
        return Table(
            "Structure factor",
            {
                "k": np.bincount(of, k) / many,
                "vectors": many,
                "s": mean,
                "s_error": np.where(many >= FEWEST_BLOCKS, error, math.nan),
                "s_theory": np.bincount(of, line) / many,
            },
            {"k": "1/length"},
            self._said if self._fluid is None else f"Percus and Yevick, {UP_TO}",
        )


def wave_vectors(period: Floats, reach: float) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Wave vectors of a box up to |k| = `reach`, and the shell of |k| that each is in.

    Each stands for its opposite too. No random number is in it.

    Returns
    -------
    (M, 3) int64
        How many waves there are along each axis.
    (M,) int64
        In rising order, from 0, without gaps; at most 16 in each shell.
    """
    width = max(2 * math.pi / float(period.max()), reach / SHELLS)
    # Points on a spiral lie evenly on the sphere; the half of it above z = 0 is enough.
    step = np.arange(VECTORS) + 0.5
    height, turn = step / VECTORS, step * math.pi * (3 - math.sqrt(5))
    across = np.sqrt(1 - height**2)
    directions = np.column_stack([across * np.cos(turn), across * np.sin(turn), height])
    radii = width * np.arange(1, round(reach / width) + 1)
    far = np.rint(radii[:, None, None] * directions * (period / (2 * math.pi))).reshape(-1, 3)
    near = np.stack(np.meshgrid(*[np.arange(-2.0, 3.0)] * 3, indexing="ij"), -1).reshape(-1, 3)
    found = np.unique(np.concatenate([near, far]).astype(np.int64), axis=0)
    x, y, z = found.T
    found = found[(z > 0) | ((z == 0) & ((y > 0) | ((y == 0) & (x > 0))))]
    k = np.sqrt(((found * (2 * math.pi / period)) ** 2).sum(axis=1))
    order = np.argsort(k, kind="stable")
    order = order[np.rint(k[order] / width) <= len(radii)]
    found, number_of = found[order], np.rint(k[order] / width)
    _, first, shell, many = np.unique(
        number_of, return_index=True, return_inverse=True, return_counts=True
    )
    # Of more than 16 those at equal distances in the row stay.
    place = np.arange(len(found)) - first[shell]
    stays = place * VECTORS // many[shell] != (place - 1) * VECTORS // many[shell]
    stays |= many[shell] <= VECTORS
    return found[stays], shell[stays]


def powers(place: Floats, waves: NDArray[np.int64]) -> Floats:
    """|sum exp(2 pi i n.s)|^2 over all spheres, for each wave n; (M,) float64.

    Parameters
    ----------
    place : (N, 3) float64
        s, in periods.
    waves : (M, 3) int64
        n.
    """
    found = np.empty(len(waves))
    step = max(1, AT_ONCE // len(place))
    for begin in range(0, len(waves), step):
        turns = waves[begin : begin + step].astype(np.float64) @ place.T
        # What is left of whole turns is short enough for single precision, which is faster.
        angle = ((turns - np.rint(turns)) * (2 * math.pi)).astype(np.float32)
        real, imaginary = (wave(angle).sum(axis=1, dtype=np.float64) for wave in (np.cos, np.sin))
        found[begin : begin + step] = real**2 + imaginary**2
    return found
