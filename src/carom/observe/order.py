"""Bond order: how the neighbours of a sphere stand around it. By freud."""

from typing import Any

import numpy as np

from carom.checks import number
from carom.errors import InputError
from carom.observe.batch import Moment
from carom.observe.kinds import refuse_walls
from carom.observe.sampled import Sampled
from carom.observe.series import Series
from carom.observe.table import Table
from carom.state import Floats

DEGREES = (4, 6)
BINS = 100  #: of q, from 0 to 1


class Steinhardt(Sampled):
    """Steinhardt's bond orders q4 and q6 of each sphere of a periodic box, and those of the whole.

    With Y_lm in the directions of the neighbours of sphere i ::

        q_lm(i) = mean of Y_lm,   q_l(i)^2 = 4 pi/(2 l + 1) sum over m of |q_lm(i)|^2

    and Q_l the same of the mean of q_lm over all spheres: near 0 in a fluid, in a crystal that of
    the lattice. Without heat:

    ==============================  ========  ========
    lattice (number of neighbours)  q4        q6
    ==============================  ========  ========
    face-centred cubic (12)         0.190941  0.574524
    hexagonal close-packed (12)     0.097222  0.484762
    body-centred cubic (14)         0.036370  0.510688
    body-centred cubic (8)          0.509175  0.628539
    simple cubic (6)                0.763763  0.353553
    ==============================  ========  ========

    Result: `Table` of the distributions of q4 and q6; `means` are those of q_l and Q_l. Errors are
    by blocking over the samples. Needs freud: ``pip install "carom[analysis]"``.

    Parameters
    ----------
    neighbors : int or None
        How many of the nearest, 12 if left out. None: those whose Voronoi cells touch its own,
        weighted by the area, which needs no number but three times as long.
    every, at
        As of `Sampled`, but four hundred mean free times if left out: it takes long.

    Raises
    ------
    InputError
        If freud is not installed.

    References
    ----------
    P. J. Steinhardt, D. R. Nelson, M. Ronchetti, Phys. Rev. B 28, 784 (1983),
    doi:10.1103/PhysRevB.28.784; weights: W. Mickel et al., J. Chem. Phys. 138, 044501 (2013),
    doi:10.1063/1.4774084; freud: V. Ramasubramani et al., Comput. Phys. Commun. 254, 107275
    (2020), doi:10.1016/j.cpc.2020.107275.
    """

    apart = 400.0

    def __init__(
        self, neighbors: int | None = 12, every: float | None = None, *, at: object = None
    ) -> None:
        super().__init__(every, at=at)
        self._freud = _freud()
        least = {"at_least": 1, "at_most": 100}
        self._nearest = None if neighbors is None else int(number("neighbors", neighbors, **least))

    def begin(self, moment: Moment) -> None:
        """Refuse a box without images, where spheres at the border have fewer neighbours."""
        super().begin(moment)
        refuse_walls(moment.world, self.name, "take carom.Periodic, where no sphere is at a border")
        n, least = len(moment.state), 1 + (self._nearest or 1)
        if n < least:
            msg = f"{self.name} needs {least} spheres at least, and here are {n}; add some"
            raise InputError(msg)
        self._box = self._freud.box.Box(*moment.world.period)
        self._whole, self._counts = Series(2 * len(DEGREES)), Series(len(DEGREES) * BINS)

    def sample(self, moment: Moment) -> None:
        """Let freud look at the spheres."""
        each, whole = self._look(moment.state.position)
        place = np.minimum((each * BINS).astype(np.int64), BINS - 1)
        place += BINS * np.arange(len(DEGREES))
        counts = np.bincount(place.ravel(), minlength=len(DEGREES) * BINS)
        self._whole.add(np.concatenate([each.mean(axis=0), whole])[None])
        self._counts.add(counts[None] * np.float64(BINS / len(each)))

    def _look(self, position: Floats) -> tuple[Floats, Floats]:
        """q_l of each sphere, (N, 2), and Q_l."""
        freud, here = self._freud, (self._box, position)
        with freud.parallel.NumThreads(1):  # sums in one order: the same bits each time
            neighbors: Any = {"num_neighbors": self._nearest}
            if self._nearest is None:
                neighbors = freud.locality.Voronoi().compute(here).nlist
            order = freud.order.Steinhardt(list(DEGREES), weighted=self._nearest is None)
            order.compute(here, neighbors=neighbors)
            return np.array(order.particle_order, np.float64), np.array(order.order)

    def means(self) -> Table:
        """Means of q4, q6, Q4 and Q6 over the samples."""
        self.over_samples()
        names = [f"{kind}{degree}" for kind in "qQ" for degree in DEGREES]
        rows = {name: (self._whole.mean(k), None) for k, name in enumerate(names)}
        return Table.of_estimates("Bond order", rows)

    def result(self) -> Table:
        """The distributions so far."""
        means = self.means()
        said = ", ".join(
            f"{name} {means.estimate('value', k)}" for k, name in enumerate(means["quantity"])
        )
        columns = {"q": (np.arange(BINS) + 0.5) / BINS}
        for place, degree in enumerate(DEGREES):
            found = [self._counts.mean(place * BINS + k) for k in range(BINS)]
            columns[f"q{degree}"] = np.array([e.value for e in found])
            columns[f"q{degree}_error"] = np.array([e.error for e in found])
        return Table(f"Bond order: {said}", columns, notes=means.notes)


def _freud() -> Any:
    try:
        import freud
    except ImportError as error:
        msg = 'Steinhardt needs freud: pip install "carom[analysis]"'
        raise InputError(msg) from error
    return freud
