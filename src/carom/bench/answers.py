"""Is what was timed a right computation? Every row is asserted before its speed is told."""

import math
from typing import NamedTuple

import numpy as np

from carom.bench.cases import DENSE, Case
from carom.errors import RunError
from carom.state import State
from carom.theory import carnahan_starling, collision_rate
from carom.world import World

#: Where each seeded run is after its warm-up, or after one repetition if it has none: collisions
#: (between spheres) and time. They are the same on every machine; if a change of the engine or of a
#: start moves them on purpose, take the new ones from the JSON results of ``carom bench --full``.
KNOWN: dict[str, tuple[int, float]] = {
    "fluid-2-0.25": (100, 19.504978151078845),
    "fluid-16-0.25": (800, 15.04049202705986),
    "fluid-128-0.25": (6_400, 14.271567018046737),
    "fluid-1000-0.25": (50_000, 14.29916858664918),
    "fluid-4000-0.05": (200_000, 130.27387162611993),
    "fluid-4000-0.25": (200_000, 14.216313867056115),
    "fluid-4000-0.49": (200_000, 2.3415819658259296),
    "fluid-10000-0.25": (500_000, 14.268493099542054),
    "fluid-32000-0.05": (1_600_000, 130.19342961259377),
    "fluid-32000-0.1": (1_600_000, 56.75830998002641),
    "fluid-32000-0.25": (1_600_000, 14.269957009959555),
    "fluid-32000-0.49": (1_600_000, 2.437684950980013),
    "fluid-100000-0.25": (5_000_000, 14.28255195329117),
    "fluid-256000-0.05": (5_000_000, 51.0289518207921),
    "fluid-256000-0.25": (5_000_000, 5.618811198622803),
    "fluid-256000-0.49": (12_800_000, 2.439339982783466),
    "fluid-1000000-0.05": (5_000_000, 13.306276526131338),
    "fluid-1000000-0.1": (5_000_000, 5.844374129214255),
    "fluid-1000000-0.25": (5_000_000, 1.4930536246936232),
    "fluid-1000000-0.49": (50_000_000, 2.4615207499293876),
    "fluid-10000000-0.25": (20_000_000, 0.6410460317163323),
    "cloud": (411_437, 100.0),
    "clusters": (3_200_000, 137303.50035742982),
    "giant": (5_000_000, 5.80368296493286),
    "lattice": (320_000, 4.875),
    "lattice-start": (256_000, 0.4178217163383493),
    "sediment": (1_600_000, 7.792161389543564),
    "two-sizes": (1_600_000, 32.68696207063422),
}

#: Relative: of the energy, for each collision that a sphere has had, and to begin with.
DRIFT_PER_COLLISION, DRIFT = 1e-16, 1e-12
#: In contact distances.
DEEPEST = 1e-12
#: Relative standard error of a collision rate, times the root of the number of collisions: those
#: of one sphere follow one another in bursts.
SCATTER = 1.2
#: Relative: of Carnahan's and Starling's formula, and of a fluid that may remember its lattice.
THEORY, YOUNG = 0.004, 0.04
#: Collisions per sphere after which it does not; a dense fluid takes ten times as many.
OLD = 10
#: Spheres below which the fluid is not the theory's, which is that of infinitely many.
MANY = 1_000
#: Variance over mean of the number of spheres in cells of `CELL` diameters above which they are
#: clustered: at most 1 in a fluid, 3 and more in a gas of restitution 0.6 after 50 collisions each.
CLUSTERED, CELL = 2.0, 4.0


class Rate(NamedTuple):
    """Collisions per sphere and time, as measured and as in theory; errors are relative."""

    measured: float
    expected: float
    error: float
    allowed: float


def assert_known(case: Case, collisions: int, time: float) -> None:
    """The seeded run is where it was on every machine before.

    Raises
    ------
    RunError
        If it is somewhere else.
    """
    known = KNOWN.get(case.name)
    if known and known != (collisions, time):
        msg = (
            f"{case.name}: the seeded run is at time {time!r} after {collisions:,} collisions; it "
            f"should be at {known[1]!r} after {known[0]:,}: this build computes something else"
        )
        raise RunError(msg)


def assert_kept(case: Case, drift: float, overlap: float, collisions: int) -> None:
    """Energy is kept, what rules took included, and no two spheres are in one another.

    Raises
    ------
    RunError
        If not, with the value and the limit.
    """
    limit = DRIFT + DRIFT_PER_COLLISION * 2 * collisions / case.n
    if not abs(drift) < limit:
        msg = f"{case.name}: energy has drifted by {drift:.2g} of itself; the limit is {limit:.2g}"
        raise RunError(msg)
    if not overlap < DEEPEST:
        msg = f"{case.name}: spheres overlap by {overlap:.2g}; the limit is {DEEPEST:g}"
        raise RunError(msg)


def rate(case: Case, state: State, before: int, collisions: int, time: float) -> Rate | None:
    """Compare how often spheres collided with theory; None where there is none.

    Parameters
    ----------
    case : Case
    state : State
        Now.
    before, collisions : int
        So many collisions happened untimed, and so many since.
    time : float
        In which the latter did.

    Raises
    ------
    RunError
        If they differ by more than four standard errors and what the theory is good for.
    """
    if not case.is_fluid or case.n < MANY:
        return None
    assert case.packing_fraction is not None
    kinetic = 0.5 * float(np.sum(state.velocity**2))
    temperature = 2 * kinetic / (3 * case.n - 3)
    # Spheres of the cases have diameter and mass 1.
    expected = collision_rate(case.packing_fraction, temperature, equation=carnahan_starling)
    measured = 2 * collisions / case.n / time
    error = SCATTER / math.sqrt(collisions)
    forgets = OLD if case.packing_fraction < DENSE else 10 * OLD
    theory = THEORY if 2 * before >= forgets * case.n else YOUNG
    allowed = theory + 4 * error
    if not abs(measured / expected - 1) < allowed:
        msg = (
            f"{case.name}: {measured:.5g} collisions per sphere and time; Enskog and "
            f"Carnahan-Starling have {expected:.5g}, and {100 * allowed:.2g} % may be between them"
        )
        raise RunError(msg)
    return Rate(measured, expected, error, allowed)


def clumping(state: State, world: World) -> float:
    """Variance over mean of the numbers of spheres in cells about `CELL` wide; periodic cubes."""
    side = float(world.period[0])
    cells = round(side / CELL)
    index = np.floor((state.position / side + 0.5) * cells).astype(np.int64) % cells
    numbers = np.bincount(index @ [cells * cells, cells, 1], minlength=cells**3)
    return float(numbers.var() / numbers.mean())


def assert_clustered(case: Case, state: State, world: World) -> None:
    """The gas has gathered in clusters, if it is to.

    Raises
    ------
    RunError
        If it has not.
    """
    if case.clustered and not (found := clumping(state, world)) > CLUSTERED:
        msg = (
            f"{case.name}: the variance of the density is {found:.2g} times its mean; "
            f"more than {CLUSTERED:g} was to be reached"
        )
        raise RunError(msg)
