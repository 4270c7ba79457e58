"""One picture, and how it is made."""

from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from carom.errors import InputError, unwritable
from carom.pictures.caption import Caption, Legend
from carom.pictures.painter import Painter, Pixels, Style
from carom.pictures.png import png
from carom.state import State
from carom.world import World

SMALL = (640, 400)  #: pixels of a picture that a notebook shows unasked


@dataclass(frozen=True, eq=False)
class Picture:
    """A picture; notebooks show it.

    Attributes
    ----------
    pixels : (height, width, 3) uint8
        Red, green and blue.
    """

    pixels: Pixels

    def save(self, path: str | Path) -> None:
        """Write it as a PNG file.

        Raises
        ------
        InputError
            If the name does not end in ``.png``.
        FileError
            If the file cannot be written.
        """
        target = Path(path)
        if target.suffix.lower() != ".png":
            msg = f"a picture is a .png file, not {str(path)!r}; give it a name that ends so"
            raise InputError(msg)
        part = target.with_name(target.name + ".part")
        try:
            part.write_bytes(png(self.pixels))
            part.replace(target)
        except OSError as error:
            with suppress(OSError):
                part.unlink(missing_ok=True)
            raise unwritable(target, error) from error

    def _repr_png_(self) -> bytes:
        return png(self.pixels)

    def __repr__(self) -> str:
        height, width = self.pixels.shape[:2]
        return f"<Picture: {width} x {height} pixels>"


def paint(state: State, world: World, style: Style, title: str, caption: bool) -> Picture:
    """Draw a moment, with words if asked.

    Raises
    ------
    InputError
        If there are no spheres, or Pillow is missing for the words.
    """
    if len(state) == 0:
        msg = "there are no spheres to show; add some first"
        raise InputError(msg)
    painter = Painter(state, world, style)
    pixels = painter.paint(state)
    if caption:
        words = Caption(title, Legend.of(state, style), style, 0.0)
        pixels = words.write(pixels, state.time, painter.end_of_scale(state))
    return Picture(pixels)


def small_png(state: State, world: World, scene: Any) -> bytes:
    """Draw what a notebook shows of a simulation or a scene; needs no further library."""
    return png(Painter(state, world, Style.of(scene, size=SMALL)).paint(state))
