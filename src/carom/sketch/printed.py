"""What a sketch prints: to the terminal, and the last of it to the page."""

import io
from typing import TextIO

LONGEST = 4000  #: characters the page shows


class Printed(io.TextIOBase):
    """A text stream that passes everything on and remembers the end of it.

    Parameters
    ----------
    echo : text stream, optional
        Where everything goes as well.

    Attributes
    ----------
    number : int
        Counts what was written, so that others see whether there is more.
    """

    def __init__(self, echo: TextIO | None = None) -> None:
        self._echo = echo
        self._tail = ""
        self.number = 0

    def write(self, text: str) -> int:
        """Take some text."""
        if self._echo is not None:
            self._echo.write(text)
            if "\n" in text:
                self._echo.flush()  # a program that runs for hours is read while it runs
        self._tail = (self._tail + text)[-LONGEST:]
        self.number += 1
        return len(text)

    def flush(self) -> None:
        """Pass on what waits."""
        if self._echo is not None:
            self._echo.flush()

    def writable(self) -> bool:
        """Whether text can be written: yes."""
        return True

    def forget(self) -> None:
        """Start with an empty page."""
        self._tail = ""
        self.number += 1

    @property
    def tail(self) -> str:
        """The last of what was written, from the beginning of a line."""
        if len(self._tail) < LONGEST:
            return self._tail
        _, _, whole_lines = self._tail.partition("\n")
        return whole_lines or self._tail
