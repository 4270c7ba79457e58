"""The rows of the benchmark: what is run, for how long, and what it may cost.

Times are process time. Costs are per collision, those with walls included. To add a row, write
its start in `starts.py` and its line here.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

from carom.bench import starts
from carom.bench.starts import Start
from carom.checks import count, nearest, number
from carom.errors import UnknownNameError
from carom.theory import FREEZING

PHIS = (0.05, 0.25, 0.49)
QUICK_SIZES = (4_000, 32_000)
FULL_SIZES = (4_000, 32_000, 256_000, 1_000_000)
#: The law of scaling is measured at this packing fraction, with these sizes besides the full ones.
SCALING_PHI = 0.25
SCALING_SIZES = (2, 16, 128, 1_000, 10_000, 100_000, 10_000_000)
#: From here on a fluid is dense.
DENSE = 0.45
#: What a process takes for each sphere while it places them and builds the engine, at most; and
#: without any. By these, cases share the memory and too large ones are left out.
BYTES_PER_SPHERE, BYTES_ALONE = 700, 60_000_000


@dataclass(frozen=True)
class Case:
    """One row.

    Attributes
    ----------
    name : str
        As `named` finds it; ``fluid-N-PHI`` for the uniform fluids.
    n : int
        Number of spheres.
    packing_fraction : float or None
        None where it is not one number.
    start : callable
        Makes the state and the world.
    collisions : int
        In each repetition. 0: as many as happen until `until`.
    warm_up : int
        Collisions before the first repetition. 0: every repetition begins at the start.
    until : float
        Simulated time at which a repetition ends.
    uniform : str
        Name of the uniform case it is held against.
    bound : float
        Its cost per collision may be so many times that of the uniform case.
    most_memory : float
        Peak of the whole process, bytes.
    clustered : bool
        The answer is that the spheres have gathered in clusters.
    why : str
        What could make it slow.
    """

    name: str
    n: int
    packing_fraction: float | None
    start: Callable[[], Start]
    collisions: int
    warm_up: int = 0
    until: float = math.inf
    uniform: str = ""
    bound: float = math.inf
    most_memory: float = math.inf
    clustered: bool = False
    why: str = ""

    @property
    def kind(self) -> str:
        """The name without the size and packing fraction of a fluid."""
        return "fluid" if self.is_fluid else self.name

    @property
    def is_fluid(self) -> bool:
        """Whether it is in equilibrium, so that theory knows its rate of collisions."""
        return self.name.startswith("fluid-")

    @property
    def memory(self) -> int:
        """Bytes its process may take."""
        return BYTES_ALONE + BYTES_PER_SPHERE * self.n


def fluid(n: int, packing_fraction: float) -> Case:
    """Equal elastic spheres in a periodic cube: the uniform case.

    100 collisions per sphere are not timed; of more than 100 000 spheres fewer, 4 at least,
    except in a dense fluid, which needs them to forget its lattice.

    Raises
    ------
    InputError
        If n is below 2 or more than the memory holds, or the packing fraction not that of a fluid.
    """
    n = count("--n", n, at_least=2)
    phi = number("--phi", packing_fraction, at_least=1e-6, at_most=FREEZING)
    each = 100.0 if phi >= DENSE else max(4.0, min(100.0, 1e7 / n))
    name = f"fluid-{n}-{phi!r}"
    case = Case(
        name,
        n,
        phi,
        partial(starts.fluid, n, phi),
        collisions=min(max(10 * n, 200_000), 1_000_000),
        warm_up=math.ceil(each * n / 2),
    )
    return replace(case, **BOUNDS.get(name, {}))


#: Bounds of fluids of unusual size.
BOUNDS: dict[str, dict[str, Any]] = {
    "fluid-2-0.25": {
        "uniform": "fluid-1000-0.25",
        "bound": 3.0,
        "why": "two spheres meet through several images of the box",
    },
    "fluid-10000000-0.25": {
        "uniform": "fluid-1000000-0.25",
        "bound": 2.0,
        "most_memory": 3e9,
        "why": "nothing is in any cache, and 10 million spheres must fit into 3 GB",
    },
}

#: What an engine may stumble over: its cost is held against that of a uniform fluid.
CLIFFS = (
    Case(
        "lattice",
        32**3,
        None,
        partial(starts.lattice, 32),
        collisions=320_000,
        warm_up=320_000,
        uniform="fluid-32000-0.25",
        bound=3.0,
        why="16 384 collisions happen in one moment, again and again: one bucket of the queue "
        "holds all events",
    ),
    Case(
        "lattice-start",
        256_000,
        0.25,
        partial(starts.lattice_start, 40, 0.25),
        collisions=256_000,
        uniform="fluid-256000-0.25",
        bound=3.0,
        why="spheres on all sites of a face-centred lattice, timed from the first collision",
    ),
    Case(
        "giant",
        1_000_001,
        0.1,
        partial(starts.giant, 1_000_000, 100, 0.1),
        collisions=1_000_000,
        warm_up=5_000_000,
        uniform="fluid-1000000-0.1",
        bound=3.5,
        why="one sphere 100 times as wide touches thousands of the others at any time",
    ),
    Case(
        "two-sizes",
        32 + 32_000,
        0.25,
        partial(starts.two_sizes, 2, 10, 0.25),
        collisions=320_000,
        warm_up=1_600_000,
        uniform="fluid-32000-0.25",
        bound=3.0,
        why="two sizes 1:10 of equal volume: no width of cells suits both",
    ),
    Case(
        "clusters",
        32_000,
        0.1,
        partial(starts.cooling, 32_000, 0.1, 0.6),
        collisions=320_000,
        warm_up=3_200_000,
        uniform="fluid-32000-0.1",
        bound=3.0,
        clustered=True,
        why="restitution 0.6, cooled to 2e-8 of the energy: dense clusters in an empty box, and "
        "collisions ever slower",
    ),
    Case(
        "sediment",
        32_000,
        None,
        partial(starts.sediment, 32_000, 40.0, 0.3),
        collisions=320_000,
        warm_up=1_600_000,
        uniform="fluid-32000-0.25",
        bound=3.0,
        why="gravity makes layers on a floor and a thin gas above, without a lid",
    ),
    Case(
        "cloud",
        32_000,
        None,
        partial(starts.cloud, 32_000, 0.25),
        collisions=0,
        until=100.0,
        uniform="fluid-32000-0.05",
        bound=10.0,
        why="a hot ball flies apart in open space, to some 1 000 times its volume: collisions end, "
        "but each time it has doubled every sphere has left a dozen shells",
    ),
)


def quick() -> list[Case]:
    """What is run if nothing is asked for."""
    return grid(QUICK_SIZES, PHIS)


def grid(sizes: tuple[int, ...], phis: tuple[float, ...]) -> list[Case]:
    """Uniform fluids of these sizes and packing fractions."""
    return [fluid(n, phi) for n in sizes for phi in phis]


def full() -> list[Case]:
    """Everything: the grid, the law of scaling, the cliffs and what they are held against."""
    cases = grid(FULL_SIZES, PHIS) + [fluid(n, SCALING_PHI) for n in SCALING_SIZES]
    return with_uniform([*cases, *CLIFFS])


def with_uniform(cases: list[Case]) -> list[Case]:
    """These cases and the uniform ones they are held against, the smallest first."""
    needed = {case.name: case for case in cases}
    for case in cases:
        if case.uniform:
            needed.setdefault(case.uniform, named(case.uniform))
    return sorted(needed.values(), key=lambda case: case.n)


def named(name: str) -> Case:
    """The case of this name.

    Raises
    ------
    UnknownNameError
        If there is none.
    """
    for case in CLIFFS:
        if case.name == name:
            return case
    kind, _, rest = name.partition("-")
    size, _, phi = rest.partition("-")
    if kind != "fluid" or not size.isdigit():
        msg = f"there is no case {name!r}{nearest(name, [case.name for case in full()])}"
        raise UnknownNameError(msg)
    return fluid(int(size), float(phi))
