"""Where spheres start and how fast: lattices, random places, Maxwell velocities."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from decimal import Decimal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.checks import number
from carom.errors import InputError
from carom.random_numbers import Random, total
from carom.state import Floats

#: Densest packing of equal spheres, pi/(3 sqrt 2).
DENSEST = 0.7404804896930611
#: Random placement tests this many candidates at a time, and gives up after so many such
#: batches in a row without a single place found.
BATCH, BARREN = 2_000, 30
#: Equal spheres thrown in one by one jam at packing fraction 0.384 (G. Zhang, S. Torquato,
#: Phys. Rev. E 88, 053312, 2013); different ones get a little further.
JAMMED = 0.45


def cube_root(x: float) -> float:
    """Cube root with the same bits on every machine (the C library's may differ)."""
    return float(Decimal(x) ** (Decimal(1) / Decimal(3)))


def simple_cubic(nx: int, ny: int, nz: int, spacing: float = 1.0) -> Floats:
    """Sites of a simple cubic lattice, centred on the origin.

    Parameters
    ----------
    nx, ny, nz : int
        Sites along each axis.
    spacing : float
        Distance of neighbours.

    Returns
    -------
    (nx ny nz, 3) float64

    Examples
    --------
    >>> simple_cubic(2, 1, 1, spacing=3)
    array([[-1.5,  0. ,  0. ],
           [ 1.5,  0. ,  0. ]])
    """
    cells = np.array([nx, ny, nz])
    return (_grid(cells) - (cells - 1) / 2) * spacing


def fcc(nx: int, ny: int, nz: int, size: ArrayLike) -> Floats:
    """Sites of a face-centred lattice that fills a periodic box about the origin.

    Each of the nx x ny x nz cells holds four sites; a cell need not be a cube.

    Parameters
    ----------
    nx, ny, nz : int
        Cells along each axis.
    size : (3,) or scalar array_like
        Lengths of the box.

    Returns
    -------
    (4 nx ny nz, 3) float64
        In [-size/2, size/2), a quarter of a cell from the border.

    Examples
    --------
    >>> len(fcc(3, 3, 3, size=5))
    108
    """
    base = np.array([[0, 0, 0], [0.5, 0.5, 0], [0.5, 0, 0.5], [0, 0.5, 0.5]]) + 0.25
    cells = np.array([nx, ny, nz])
    sites = (_grid(cells)[:, np.newaxis] + base).reshape(-1, 3)
    return np.asarray((sites / cells - 0.5) * np.broadcast_to(size, 3))


def _grid(cells: NDArray[np.int_]) -> Floats:
    """All (i, j, k) below `cells`, the last index running fastest."""
    return np.indices(tuple(cells)).reshape(3, -1).T.astype(np.float64)


def maxwell(random: Random, mass: Floats, temperature: float = 1.0, conserved: int = 3) -> Floats:
    """Maxwell velocities with total momentum exactly at rest and the temperature exact.

    Each component is normal with variance T/m; then the motion of the centre of mass is
    taken away, and all are scaled so that 2 K/f = T with f = 3 N - conserved. (Boltzmann's
    constant is 1.) Exact means to rounding.

    Parameters
    ----------
    random : Random
    mass : (N,) float64
        Finite.
    temperature : float
    conserved : int
        Axes along which the world conserves momentum: 3 if periodic, 0 in a box.

    Returns
    -------
    (N, 3) float64

    Raises
    ------
    InputError
        If the temperature is negative, or one sphere alone shall be warm while its momentum
        is 0.
    """
    temperature = number("temperature", temperature, at_least=0)
    n = len(mass)
    if n < 2 and temperature > 0:
        msg = f"{n} sphere with total momentum 0 is at rest; use two or more, or temperature=0"
        raise InputError(msg)
    if temperature == 0:
        return np.zeros((n, 3))
    heavy = mass[:, np.newaxis]
    velocity = random.normal(n, 3) / np.sqrt(heavy)
    velocity -= total(velocity * heavy) / total(mass)
    twice = total((velocity * velocity * heavy).reshape(-1))
    return np.asarray(velocity * np.sqrt(temperature * (3 * n - conserved) / twice))


def random_positions(
    random: Random,
    radius: Floats,
    size: ArrayLike,
    periodic: Sequence[bool] = (False, False, False),
    avoid: tuple[ArrayLike, ArrayLike] | None = None,
) -> Floats:
    """Random places in a box without overlap, the largest spheres first.

    Candidates are drawn evenly; one that overlaps a sphere already placed is dropped.

    Parameters
    ----------
    random : Random
    radius : (N,) float64
    size : (3,) array_like
        Lengths of the box, centred on the origin. Spheres stay inside its walls.
    periodic : three bools
        Axes without walls, where spheres also keep clear of the images of others.
    avoid : ((M, 3) positions, (M,) radii), optional
        A few spheres that are there already.

    Returns
    -------
    (N, 3) float64

    Raises
    ------
    InputError
        If a sphere does not fit into the box, or no free place was found: above a packing
        fraction of about 0.3 there is hardly one.

    Notes
    -----
    Costs 20 us per sphere at a packing fraction of 0.05, 70 us at 0.2, 1 ms at 0.3.
    """
    box = _Region(np.array(size, np.float64), np.array(periodic), 2 * float(radius.max(initial=0)))
    box.check()
    order = np.argsort(-radius, kind="stable")
    result = np.zeros((len(radius), 3))
    placed, waiting = order[:0], order
    barren = 0
    fraction = float(4 / 3 * np.pi * (radius**3).sum() / box.size.prod())
    while len(waiting):
        if fraction > JAMMED or barren == BARREN:
            _refuse(len(radius), fraction, len(placed))
        each = max(1, BATCH // len(waiting))
        ids = np.repeat(waiting, each)
        x = box.draw(random, radius[ids])
        good = ~box.overlaps(x, radius[ids], result[placed], radius[placed])
        if avoid is not None:
            good &= ~box.touched(x, radius[ids], *avoid)
        ids, x = ids[good], x[good]
        _, first = np.unique(_rank(order, ids), return_index=True)  # one candidate per sphere
        ids, x = ids[first], x[first]
        # Among the candidates the earlier one (the larger sphere) keeps its place.
        good = ~box.overlaps(x, radius[ids], x, radius[ids], earlier_only=True)
        result[ids[good]] = x[good]
        placed = np.concatenate([placed, ids[good]])
        waiting = waiting[~np.isin(waiting, ids[good])]
        barren = 0 if good.any() else barren + 1
    return result


def _rank(order: NDArray[np.intp], ids: NDArray[np.intp]) -> NDArray[np.intp]:
    """Place of each of `ids` in `order`."""
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    return rank[ids]


def _refuse(n: int, fraction: float, placed: int) -> None:
    msg = (
        f"random placement cannot reach packing fraction {fraction:.3g}: it found places for "
        f"{placed} of {n} spheres, and gets to about 0.3 at most; use fewer or smaller spheres, "
        "a larger box, or the sites of carom.place.fcc"
    )
    raise InputError(msg)


@dataclass(frozen=True)
class _Region:
    """A box with cells at least `reach` wide, so that only neighbouring cells can touch."""

    size: Floats
    periodic: NDArray[np.bool_]
    reach: float

    def check(self) -> None:
        """Refuse a box in which the largest sphere has no place."""
        if (self.size < np.where(self.periodic, 0, self.reach)).any():
            msg = (
                f"a sphere of radius {self.reach / 2:g} does not fit into a box of "
                f"{' x '.join(f'{s:g}' for s in self.size)}; make the box larger"
            )
            raise InputError(msg)

    def draw(self, random: Random, radius: Floats) -> Floats:
        """One even random place for each radius, inside the walls."""
        half = self.size / 2 - np.where(self.periodic, 0, radius[:, np.newaxis])
        return random.uniform(len(radius), 3, low=-half, high=half)

    def overlaps(
        self, x: Floats, r: Floats, y: Floats, s: Floats, earlier_only: bool = False
    ) -> NDArray[np.bool_]:
        """Whether each sphere (x, r) overlaps one of (y, s), or one before it."""
        hit = np.zeros(len(x), np.bool_)
        if len(y) == 0 or len(x) == 0:
            return hit
        cells = np.clip(np.floor(self.size / max(self.reach, 1e-300)), 1, 1000).astype(np.int64)
        home = self._cell(y, cells) @ self._strides(cells)
        by_cell = np.argsort(home, kind="stable")
        home = home[by_cell]
        own = self._cell(x, cells)
        for step in np.indices((3, 3, 3)).reshape(3, -1).T - 1:
            there = own + step
            inside = (self.periodic | ((there >= 0) & (there < cells))).all(axis=1)
            key = (there % cells) @ self._strides(cells)
            low = np.searchsorted(home, key, "left")
            count = np.where(inside, np.searchsorted(home, key, "right") - low, 0)
            a = np.repeat(np.arange(len(x)), count)
            b = by_cell[np.arange(len(a)) - np.repeat(np.cumsum(count) - count - low, count)]
            near = self._near(x[a], r[a], y[b], s[b])
            hit[a[near & (b < a) if earlier_only else near]] = True
        return hit

    def touched(self, x: Floats, r: Floats, y: ArrayLike, s: ArrayLike) -> NDArray[np.bool_]:
        """Say the same for a few spheres (y, s) of any size."""
        hit = np.zeros(len(x), np.bool_)
        for centre, radius in zip(np.atleast_2d(y), np.atleast_1d(s), strict=True):
            hit |= self._near(x, r, centre, radius)
        return hit

    def _near(self, x: Floats, r: Floats, y: Floats, s: Floats) -> NDArray[np.bool_]:
        d = x - y
        d -= np.where(self.periodic, np.rint(d / self.size) * self.size, 0)
        square = d[:, 0] * d[:, 0] + d[:, 1] * d[:, 1] + d[:, 2] * d[:, 2]
        return np.asarray(square < (r + s) * (r + s))

    def _cell(self, x: Floats, cells: NDArray[np.int64]) -> NDArray[np.int64]:
        index = np.floor((x / self.size + 0.5) * cells).astype(np.int64)
        return np.asarray(np.clip(index, 0, cells - 1))

    @staticmethod
    def _strides(cells: NDArray[np.int64]) -> NDArray[np.int64]:
        return np.array([cells[1] * cells[2], cells[2], 1])


def fluid_cells(n: int, packing_fraction: float, diameter: float = 1.0) -> tuple[int, int, int]:
    """Choose the nx x ny x nz face-centred cells for n spheres in a periodic cube.

    They have at least n sites, none nearer than a diameter; among all such grids this one
    has the widest spacing.

    Raises
    ------
    InputError
        If the fraction is above that of the densest packing, or no grid has place for n;
        names the nearest n that can be placed.
    """
    phi = number("packing_fraction", packing_fraction, above=0, at_most=DENSEST)
    if n < 1:
        msg = f"n is {n}; it must be at least 1"
        raise InputError(msg)
    grids = _grids(n)
    side = cube_edge(n, phi, diameter)
    fitting = [
        (spacing, -g[0] * g[1] * g[2], g)
        for g in grids
        if 4 * g[0] * g[1] * g[2] >= n and (spacing := _spacing(g) * side) >= diameter * (1 - 1e-13)
    ]
    if fitting:
        return max(fitting)[2]
    near = min((abs(m - n), m) for g in grids for m in _placeable(g, phi, n))[1]
    msg = (
        f"n = {n} cannot be placed on face-centred sites at packing fraction {phi:g}; "
        f"the nearest number that can is {near}"
    )
    raise InputError(msg)


def cube_edge(n: int, packing_fraction: float, diameter: float = 1.0) -> float:
    """Edge of a cube in which n spheres have this packing fraction: (pi n/6 phi)^(1/3) sigma."""
    return cube_root(np.pi * n / (6 * packing_fraction)) * diameter


def _grids(n: int) -> list[tuple[int, int, int]]:
    """Grids nx >= ny >= nz about as large as n spheres need."""
    k = round(cube_root(n / 4))
    span = range(max(1, k - 4), k + 6)
    return [(a, b, c) for a in span for b in span if b <= a for c in span if c <= b]


def _spacing(grid: tuple[int, int, int]) -> float:
    """Smallest distance of sites in a unit cube: half a face's diagonal, or a cell's edge."""
    a, b, c = (1 / k for k in grid)  # a is the shortest, c the longest
    return min(math.sqrt(a * a + b * b) / 2, a, b, c)


def _placeable(grid: tuple[int, int, int], phi: float, n: int) -> list[int]:
    """List the number nearest n that this grid can hold at packing fraction phi, if any."""
    most = 4 * grid[0] * grid[1] * grid[2]
    # The edge must be at least 1/spacing diameters, and it grows with the number.
    least = int(np.ceil(6 * phi / np.pi / _spacing(grid) ** 3 * (1 - 1e-12)))
    return [min(max(n, least), most)] if least <= most else []
