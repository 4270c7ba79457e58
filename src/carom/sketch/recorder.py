"""What a sketch has said so far, and the list of shapes of the frame it is drawing."""

import struct
from contextvars import ContextVar
from dataclasses import dataclass

from carom.errors import InputError
from carom.random_numbers import Random
from carom.sketch.matrices import Matrix, MatrixStack
from carom.sketch.paint import Color, ColorMode

MOST_SHAPES = 20_000
FARTHEST = 1e9  #: pixels; beyond, a shape is nowhere to be seen
SPHERE, BOX, LINE = 0, 1, 2

#: One shape: its matrix column by column, fill and stroke (alpha 0: none), stroke weight, kind,
#: and how many meridians a wire sphere has.
SHAPE = struct.Struct("<12fIIfHH")

BATCH = 256  #: random numbers drawn at once
NONE = Color(0, 0, 0, 0)
BLACK, WHITE, GREY = Color(0, 0, 0), Color(255, 255, 255), Color(204, 204, 204)


@dataclass(frozen=True, slots=True)
class Picture:
    """One frame: the sheet, and `n` shapes on it, packed as `SHAPE`."""

    width: int = 100
    height: int = 100
    background: Color = GREY
    frame: int = 0
    n: int = 0
    shapes: bytes = b""


class Recorder:
    """The state behind the functions of `carom.sketch`.

    Style lasts from frame to frame, as in Processing; the matrix starts afresh.

    Parameters
    ----------
    seed : int
        Of `random`.
    """

    def __init__(self, seed: int = 1) -> None:
        self.width = self.height = 100
        self.background = GREY
        self.mode = ColorMode()
        self.fill, self.stroke, self.weight = WHITE, BLACK, 1.0
        self.detail = 24
        self.rate = 60.0
        self.looping = True
        self.owed = 0  # frames asked for by redraw()
        self.frame = 0
        self.stack = MatrixStack()
        self._shapes = bytearray()
        self._n = 0
        self.seed(seed)

    def seed(self, seed: int) -> None:
        """Start the random numbers afresh."""
        self._random = Random(seed)
        self._drawn: list[float] = []

    def fraction(self) -> float:
        """Draw a number from 0 to 1: the stream of `Random.uniform`, one by one."""
        if not self._drawn:
            self._drawn = self._random.uniform(BATCH).tolist()[::-1]
        return self._drawn.pop()

    def begin(self) -> None:
        """Start a frame."""
        self.frame += 1
        self.clear()

    def clear(self) -> None:
        """Take a new sheet."""
        self.stack = MatrixStack()
        self._shapes = bytearray()
        self._n = 0

    def picture(self) -> Picture:
        """What has been drawn on this sheet."""
        return Picture(
            self.width, self.height, self.background, self.frame, self._n, bytes(self._shapes)
        )

    def shape(self, where: str, kind: int, matrix: Matrix) -> None:
        """Add a shape in the present style.

        Raises
        ------
        InputError
            If it is one too many, or too far away.
        """
        fill = self.fill if kind != LINE else NONE
        if not (fill.alpha or self.stroke.alpha):
            return
        if self._n >= MOST_SHAPES:
            msg = (
                f"draw() draws more than {MOST_SHAPES:,} shapes in one frame; draw fewer "
                "(is there a loop that goes round too often?)"
            )
            raise InputError(msg)
        size = sum(map(abs, matrix))
        if not size < FARTHEST:
            msg = (
                f"{where} lies at {size:.3g}, beyond {FARTHEST:g} pixels; check what was given "
                "to translate() and scale()"
            )
            raise InputError(msg)
        self._shapes += SHAPE.pack(
            *matrix, fill.rgba, self.stroke.rgba, self.weight, kind, self.detail
        )
        self._n += 1


#: The sketch that is running; set by `carom.sketch.program` around a student's code.
CURRENT: ContextVar[Recorder] = ContextVar("carom_sketch")


def current(where: str) -> Recorder:
    """The sketch that is running.

    Raises
    ------
    InputError
        If none is.
    """
    recorder = CURRENT.get(None)
    if recorder is None:
        msg = f"{where} works only while a sketch runs; start yours with: carom sketch FILE.py"
        raise InputError(msg)
    return recorder
