"""Where spheres are around one another."""

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from carom import mechanics, theory
from carom.errors import InputError
from carom.observe.batch import Moment
from carom.observe.estimate import Estimate
from carom.observe.fluid import FREEZES, UP_TO, in_range, is_gas
from carom.observe.kinds import MOST_KINDS, Kinds, labels, legend, letters, refuse_walls
from carom.observe.sampled import Reaching
from carom.observe.series import poisson
from carom.observe.table import Table, Theory
from carom.state import Floats, State

WIDTH = 0.02  #: of a bin, in mean diameters
CENTRES = 500  #: spheres around which one sample counts the others
NEAR = 0.2  #: diameters beyond contact from which the contact value is extrapolated


class RDF(Reaching):
    """Radial distribution g(r): spheres at a distance, over those that chance would put there.

    In a periodic box, over all spheres alike, in column `g`, and where there are several kinds
    (radius and mass) of each pair of them, `g_AB` and so on. Each sample looks around 500 spheres,
    others each time. Errors are those of independent pairs. Result: `Table`, at the middles of
    0.02 mean diameters, from where the smallest spheres touch; `contact` gives the values where
    they touch.

    Parameters
    ----------
    reach : float, optional
        Largest distance; three mean diameters if left out, or half the shortest side. The last
        0.02 diameters that it cuts are left away.
    every, at
        As of `Sampled`, but a hundred mean free times if left out: counting pairs takes long.

    References
    ----------
    M. P. Allen, D. J. Tildesley, Computer Simulation of Liquids, 2nd ed., Oxford 2017,
    section 8.2.
    """

    def begin(self, moment: Moment) -> None:
        """Refuse what has no mean density."""
        super().begin(moment)
        state, world = moment.state, moment.world
        refuse_walls(world, self.name, "take carom.Periodic, or there is no mean density")
        diameter, half = 2 * float(state.radius.mean()), float(world.period.min()) / 2
        self._reach = min(3 * diameter, half) if self._asked is None else self._asked
        if self._reach > half:
            msg = f"reach is {self._reach:g}, more than half the shortest side, {half:.6g}"
            raise InputError(msg)
        # Of whole bins: one of them begins where spheres of the mean diameter touch.
        self._bins = max(1, math.floor(self._reach / (WIDTH * diameter) + 1e-9))
        self._reach = self._bins * WIDTH * diameter
        self._contact = 2 * float(state.radius.min()) if world.collide else 0.0
        if self._contact >= self._reach or len(state) < 2:
            msg = f"{self.name} reaches to {self._reach:.6g}, where no two spheres can be"
            raise InputError(msg)
        self._kinds, kind = _kinds(state)
        self._kind, many = kind, len(self._kinds)
        self._counts = np.zeros((many, many, self._bins))
        self._centres, self._offset = np.zeros(many), 0
        self._share = min(1.0, CENTRES / len(state))
        self._volume = mechanics.volume(world)
        self._theory: tuple[Floats, str] | None = None
        if is_gas(state, world):
            self._theory = _contact_theory(self._kinds, self._volume)

    def sample(self, moment: Moment) -> None:
        """Count the others around some spheres."""
        n = len(moment.state)
        some = min(n, CENTRES)
        # Neighbours in number are often neighbours in space: take them from everywhere.
        centres = (self._offset + np.arange(some) * n // some) % n
        self._offset += 1
        distance, from_, to = distances(
            moment.state.position, moment.world.period, centres, self._reach
        )
        place = np.minimum((distance * (self._bins / self._reach)).astype(np.int64), self._bins - 1)
        many = len(self._kinds)
        if many > 1:
            place += self._bins * (many * self._kind[from_] + self._kind[to])
        found = np.bincount(place, minlength=self._counts.size)
        self._counts += found.reshape(self._counts.shape)
        self._centres += np.bincount(self._kind[centres], minlength=many)

    def _pairs(self, a: list[int], b: list[int]) -> tuple[Floats, Floats]:
        """Pairs of one group of kinds with another that were counted, and expected by chance."""
        edges = np.linspace(0, self._reach, self._bins + 1)
        shell = 4 / 3 * math.pi * np.diff(edges**3)
        found, expected = np.zeros(self._bins), 0.0
        for x, y in {(x, y) for x in a for y in b} | {(y, x) for x in a for y in b}:
            found += self._counts[x, y]
            others = self._kinds.count[y] - (x == y)
            expected += self._centres[x] * others / self._volume
        return found, expected * shell

    def _g(self, a: list[int], b: list[int]) -> tuple[Floats, Floats]:
        """Return g and its error; where both of a pair are centres it is counted twice."""
        found, expected = self._pairs(a, b)
        with np.errstate(divide="ignore", invalid="ignore"):
            return found / expected, poisson(found) * math.sqrt(1 + self._share) / expected

    def result(self) -> Table:
        """g(r) so far."""
        self.over_samples()
        edges = np.linspace(0, self._reach, self._bins + 1)
        first = int(np.searchsorted(edges, self._contact * (1 + 1e-9), "right")) - 1
        every_kind = list(range(len(self._kinds)))
        columns = {"distance": ((edges[1:] + edges[:-1]) / 2)[first:]}
        shown = {"g": (every_kind, every_kind)}
        if len(self._kinds) > 1:
            shown |= {f"g_{pair}": ([a], [b]) for pair, a, b in self._of_kinds()}
        for name, (a, b) in shown.items():
            g, error = self._g(a, b)
            columns[name], columns[f"{name}_error"] = g[first:], error[first:]
        notes = [legend(self._kinds)] if len(self._kinds) > 1 else []
        return Table(
            "Radial distribution",
            columns,
            {"distance": "length"},
            notes=(*notes, *self._contacts()),
        )

    def _contacts(self) -> list[str]:
        """A sentence for each contact value that is known."""
        table, said = self.contact(), []
        for row, (pair, _, _) in enumerate(self._of_kinds()):
            found, line = table.estimate("value", row), table["value_theory"][row]
            which = f" {pair}" if len(self._kinds) > 1 else ""
            theory = "" if math.isnan(line) else f", theory {line:.5g}"
            if math.isfinite(found.error):
                said.append(f"at contact{which}: g = {found}{theory}")
        return said

    def _of_kinds(self) -> list[tuple[str, int, int]]:
        """Pairs of kinds that there are: letters and numbers."""
        names, many = letters(self._kinds), self._kinds.count
        return [
            (names[a] + names[b], a, b)
            for a in range(len(names))
            for b in range(a, len(names))
            if a != b or many[a] > 1
        ]

    def contact(self) -> Table:
        """Values of g where spheres of two kinds touch, by a parabola through ln g beyond them.

        A row for each pair of kinds. Theory: BMCSL; of one kind `carom.theory.contact_value`.

        Raises
        ------
        InputError
            If there is too little to say anything.
        """
        self.over_samples()
        rows: dict[str, tuple[Estimate, Theory | None]]
        rows = {}
        edges = np.linspace(0, self._reach, self._bins + 1)
        middle = (edges[1:] + edges[:-1]) / 2
        names = labels(self._kinds)
        for _, a, b in self._of_kinds():
            sigma = float(self._kinds.radius[a] + self._kinds.radius[b])
            g, error = self._g([a], [b])
            near = (edges[:-1] >= sigma * (1 - 1e-9)) & (edges[1:] <= sigma * (1 + NEAR)) & (g > 0)
            value = _extrapolated(middle[near] - sigma, g[near], error[near])
            line = Theory(float(self._theory[0][a, b]), self._theory[1]) if self._theory else None
            rows[f"{names[a]} with {names[b]}"] = (value, line)
        return Table.of_estimates("Contact values", rows)


def _kinds(state: State) -> tuple[Kinds, NDArray[np.int64]]:
    """Kinds of all spheres, fixed ones too, and which each is; one if they are too many."""
    found = Kinds(replace(state, fixed=np.zeros(len(state), np.bool_)))
    if len(found) > MOST_KINDS:
        same = np.ones(len(state))
        found = Kinds(replace(state, fixed=same < 0, radius=same, mass=same))
    return found, found.of


def _contact_theory(kinds: Kinds, volume: float) -> tuple[Floats, str]:
    """Contact values of a fluid, and whose they are."""
    if len(kinds) == 1:
        phi = 4 / 3 * math.pi * float(kinds.count @ kinds.radius**3) / volume
        fluid = phi <= theory.FREEZING
        value = theory.contact_value(phi) if fluid else math.nan
        name = f"Kolafa, Labik and Malijevsky, a fluid {UP_TO}"
        return np.full((1, 1), value), name if fluid else FREEZES
    found = in_range(theory.bmcsl_contact, kinds.radius, volume, kinds.count)
    if found is None:
        return np.full((len(kinds), len(kinds)), math.nan), FREEZES
    return found, f"BMCSL, a fluid {UP_TO}"


def _extrapolated(beyond: Floats, g: Floats, error: Floats) -> Estimate:
    """Return g at 0 by a parabola through ln g, weighted by errors."""
    if len(g) < 6:
        return Estimate(math.nan, math.nan, math.nan)
    weight = g / error
    terms = beyond[:, None] ** np.arange(3) * weight[:, None]
    inverse = np.linalg.inv(terms.T @ terms)
    value = math.exp(float((inverse @ terms.T @ (np.log(g) * weight))[0]))
    return Estimate(value, value * math.sqrt(float(inverse[0, 0])), math.nan)


def distances(
    position: Floats, period: Floats, centres: NDArray[np.int64], reach: float
) -> tuple[Floats, NDArray[np.int64], NDArray[np.int64]]:
    """Distances up to `reach` from some spheres to all others, by cells as long as that.

    Returns
    -------
    (n,) float64
        In no order.
    (n,) int64
        From which sphere, and
    (n,) int64
        to which.
    """
    cells = np.maximum(1, np.floor(period / reach)).astype(np.int64)
    if (cells < 3).any():
        cells[:] = 1
    place = np.floor((position / period + 0.5) * cells).astype(np.int64) % cells
    number_of = (place[:, 0] * cells[1] + place[:, 1]) * cells[2] + place[:, 2]
    order = np.argsort(number_of, kind="stable")
    starts = np.searchsorted(number_of[order], np.arange(cells.prod() + 1))
    steps = np.arange(-1, 2) if cells[0] > 1 else np.zeros(1, np.int64)
    found = []
    for step in np.stack(np.meshgrid(steps, steps, steps), -1).reshape(-1, 3):
        beside = (place[centres] + step) % cells
        cell = (beside[:, 0] * cells[1] + beside[:, 1]) * cells[2] + beside[:, 2]
        many = starts[cell + 1] - starts[cell]
        from_ = np.repeat(centres, many)
        within = np.arange(many.sum()) - np.repeat(np.cumsum(many) - many, many)
        to = order[np.repeat(starts[cell], many) + within]
        apart = position[to] - position[from_]
        apart -= period * np.rint(apart / period)
        square = (apart * apart).sum(axis=1)
        near = (square <= reach * reach) & (to != from_)
        found.append((np.sqrt(square[near]), from_[near], to[near]))
    distance, begins, ends = (np.concatenate(part) for part in zip(*found, strict=True))
    return distance, begins, ends
