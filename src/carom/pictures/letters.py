"""The letters of words in pictures: a font that has them, or the same in letters that it has."""

import unicodedata
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType
from typing import Any

#: The font that comes with Pillow has ASCII and little more; these lose nothing without it.
PLAIN = str.maketrans({"×": "x", "·": "-", "–": "-", "—": "-", "−": "-", "’": "'", "…": "..."})
PLAIN |= str.maketrans({"“": '"', "”": '"', "„": '"', "\N{NO-BREAK SPACE}": " "})
SPELLED = str.maketrans({"ß": "ss", "æ": "ae", "œ": "oe", "ø": "o", "Æ": "Ae", "Œ": "Oe", "Ø": "O"})
MISSING = "?"  #: stands for a letter that cannot be spelled


def wide_font() -> Path | None:
    """DejaVu Sans, which matplotlib brings along: Latin, Greek, indices, signs of mathematics."""
    library = find_spec("matplotlib")
    if library is None or library.origin is None:
        return None
    path = Path(library.origin).parent / "mpl-data" / "fonts" / "ttf" / "DejaVuSans.ttf"
    return path if path.exists() else None


class Letters:
    """A font for some text, in any size.

    Parameters
    ----------
    text : str
        Whose letters it must have.
    font : module
        Pillow's ImageFont.

    Attributes
    ----------
    text : str
        As it is drawn: letters that neither font has are spelled, or a question mark.
    """

    def __init__(self, text: str, font: ModuleType) -> None:
        self._module = font
        self.text = " ".join(text.translate(PLAIN).split())
        self._path = None if self.text.isascii() else wide_font()
        if self._path is None:
            self.text = "".join(map(spelled, self.text.translate(SPELLED)))
            return
        some = self.sized(20)
        box = bytes(some.getmask("\uffff"))  # what a font draws for a letter that it has not
        self.text = "".join(
            letter if letter == " " or bytes(some.getmask(letter)) != box else MISSING
            for letter in unicodedata.normalize("NFC", " ".join(text.split()))
        )

    def sized(self, size: float) -> Any:
        """The font in a size, in pixels."""
        if self._path is None:
            return self._module.load_default(size)
        return self._module.truetype(str(self._path), size)


def spelled(letter: str) -> str:
    """A letter in ASCII: without its accent, by its Greek name, or a question mark.

    Examples
    --------
    >>> "".join(map(spelled, "φ = ½ λ₀ é 粒"))
    'phi = 1/2 lambda0 e ?'
    """
    flat = unicodedata.normalize("NFKD", letter).replace("\N{FRACTION SLASH}", "/")
    return "".join(map(_spelled, flat))


def _spelled(letter: str) -> str:
    if letter.isascii():
        return letter if letter.isprintable() else ""
    if unicodedata.combining(letter):
        return ""
    if letter == "\N{MINUS SIGN}":
        return "-"
    kind, _, name = unicodedata.name(letter, "").rpartition(" LETTER ")
    name = name.removeprefix("FINAL ").replace("LAMDA", "LAMBDA")  # Unicode spells it so
    if kind.startswith("GREEK") and name.isalpha():
        return name.lower() if kind.endswith("SMALL") else name.title()
    return MISSING
