"""The event loop in C++: moves spheres from one collision to the next."""

from collections.abc import Sequence
from typing import Annotated

import numpy
from numpy.typing import NDArray

class Engine:
    """Moves spheres from one collision to the next."""

    def __init__(
        self,
        position: Annotated[
            NDArray[numpy.float64], dict(shape=(None, 3), order="C", device="cpu", writable=False)
        ],
        velocity: Annotated[
            NDArray[numpy.float64], dict(shape=(None, 3), order="C", device="cpu", writable=False)
        ],
        mass: Annotated[
            NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)
        ],
        radius: Annotated[
            NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)
        ],
        fixed: Annotated[
            NDArray[numpy.bool_], dict(shape=(None,), order="C", device="cpu", writable=False)
        ],
        resting: Annotated[
            NDArray[numpy.bool_], dict(shape=(None,), order="C", device="cpu", writable=False)
        ],
        image: Annotated[
            NDArray[numpy.int32], dict(shape=(None, 3), order="C", device="cpu", writable=False)
        ],
        count: Annotated[
            NDArray[numpy.uint32], dict(shape=(None,), order="C", device="cpu", writable=False)
        ],
        time: float,
        period: Annotated[
            NDArray[numpy.float64], dict(shape=(3), order="C", device="cpu", writable=False)
        ],
        walls: Annotated[
            NDArray[numpy.float64], dict(shape=(None, 7), order="C", device="cpu", writable=False)
        ],
        restitution: float,
        contact_time: float,
        gravity: Annotated[
            NDArray[numpy.float64], dict(shape=(3), order="C", device="cpu", writable=False)
        ],
        collide: bool,
        margin: float = 0.0,
        cell: float = 0.0,
        log: bool = True,
        slice: float = 0.05,
        simd: str = "",
        sort: bool = True,
        grid: int = -1,
        ahead: int = -1,
        profile: bool = False,
    ) -> None: ...
    def advance(self, until: float, max_collisions: int, max_events: int) -> int:
        """Runs until a time or a count; see Stop."""

    def state(
        self,
    ) -> tuple[
        NDArray[numpy.float64],
        NDArray[numpy.float64],
        NDArray[numpy.int32],
        NDArray[numpy.uint32],
        NDArray[numpy.uint8],
    ]:
        """(position, velocity, image, count, resting) at `time`."""

    def take_log(self) -> NDArray[numpy.uint8]:
        """Records since the last call, as bytes."""

    def max_overlap(self) -> float:
        """Deepest overlap met, in contact distances."""

    def check(self) -> None:
        """Raises if two structures contradict one another."""

    def checkpoint(self) -> bytes:
        """The stored states, for the same bits after a restart."""

    def restore(self, checkpoint: bytes) -> None:
        """Continues from a checkpoint of the same scene."""

    @property
    def time(self) -> float:
        """Simulated time now."""

    @property
    def collisions(self) -> int:
        """Between spheres."""

    @property
    def wall_collisions(self) -> int:
        """With walls."""

    @property
    def dissipated(self) -> float:
        """Energy the rules have taken."""

    @property
    def withheld(self) -> float:
        """Energy the contact-time cure kept."""

    def profile(self) -> dict[str, float]:
        """Seconds that each part of the work took, from a sample of the events."""

    def work(self) -> dict[str, int]:
        """
        What it has done: predictions, shells remade or cells crossed, predictions of a
        partner hit by another, pairs solved exactly.
        """

    @property
    def memory(self) -> int:
        """Bytes in use."""

    @property
    def collapse(self) -> tuple[float, int, int] | None:
        """(time, i, j) of an inelastic collapse, or None."""

class Helfand:
    """What the fluxes of momentum, energy and charge add up to."""

    def __init__(
        self,
        velocity: Annotated[
            NDArray[numpy.float64], dict(shape=(None, 3), order="C", device="cpu", writable=False)
        ],
        mass: Annotated[
            NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)
        ],
        radius: Annotated[
            NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)
        ],
        charge: Annotated[
            NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)
        ],
        time: float,
    ) -> None: ...
    def advance(
        self, records: NDArray[numpy.uint8], times: NDArray[numpy.float64]
    ) -> NDArray[numpy.float64]:
        """
        Takes collisions, as bytes; the moments at rising times, (m, 12): xx, yy, zz, xy,
        xz, yz of momentum, then x, y, z of energy and of charge.
        """

def simd_levels() -> list[str]:
    """Instruction sets that this machine can run, slowest first."""

def simd() -> str:
    """
    The instruction set in use; the environment variable CAROM_SIMD chooses another.
    """

def first_overlap(
    position: Annotated[
        NDArray[numpy.float64], dict(shape=(None, 3), order="C", device="cpu", writable=False)
    ],
    radius: Annotated[
        NDArray[numpy.float64], dict(shape=(None,), order="C", device="cpu", writable=False)
    ],
    fixed: Annotated[
        NDArray[numpy.bool_], dict(shape=(None,), order="C", device="cpu", writable=False)
    ],
    period: Annotated[
        NDArray[numpy.float64], dict(shape=(3), order="C", device="cpu", writable=False)
    ],
) -> tuple[int, int, float] | None:
    """The deepest overlapping pair (i, j, depth), or None."""

class Raster:
    """Draws pictures of spheres in a room, from one place."""

    def __init__(
        self,
        width: int,
        height: int,
        samples: int,
        pixel: float,
        eye: Annotated[
            NDArray[numpy.float64], dict(shape=(4, 3), order="C", device="cpu", writable=False)
        ],
        look: dict[str, object],
        faces: Annotated[
            NDArray[numpy.float64], dict(shape=(None, 23), order="C", device="cpu", writable=False)
        ],
        edges: Annotated[
            NDArray[numpy.float64], dict(shape=(None, 8), order="C", device="cpu", writable=False)
        ],
        shells: Sequence[float],
    ) -> None:
        """
        eye: place, right, up, forward. faces and edges: rows as in core/raster/picture.hpp.
        """

    def draw(
        self,
        position: NDArray[numpy.float64],
        radius: NDArray[numpy.float64],
        color: NDArray[numpy.uint32],
        own: int,
    ) -> NDArray[numpy.uint8]:
        """
        (height, width, 3). All but the first `own` spheres are images of these.
        """
