"""What both kinds of event files have in common when they are read."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from numpy.typing import NDArray

from carom.errors import InputError


class Span(NamedTuple):
    """How many events a part of a file has, and their first and last time."""

    size: int
    first: float
    last: float


class Source(ABC):
    """An event file that is read part by part.

    Attributes
    ----------
    about : dict
    spans : list of Span
        Its parts in their order.
    """

    about: Mapping[str, Any]
    spans: list[Span]

    @abstractmethod
    def read(self, part: int, names: Sequence[str]) -> dict[str, NDArray[Any]]:
        """Read columns of one part."""

    @abstractmethod
    def arrays(self) -> dict[str, NDArray[Any]]:
        """Where the run began, see `layout.packed`; the engine's own state under ``engine``."""


def refused(path: Path, reason: str) -> InputError:
    """Refuse a file."""
    return InputError(f"{path} is no event file that can be read: {reason}")


#: How the names of event files end.
ENDINGS = (".parquet", ".npz")


def ending(path: Path) -> str:
    """Which of `ENDINGS` a name has.

    Raises
    ------
    InputError
        If it is none.
    """
    if path.suffix.lower() not in ENDINGS:
        msg = f"{path} is no name for an event file; let it end in {' or '.join(ENDINGS)}"
        raise InputError(msg)
    return path.suffix.lower()
