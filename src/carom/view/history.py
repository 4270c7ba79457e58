"""Bookmarks of a run, dense lately and sparse long ago, so that it can be stepped back."""

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

BYTES = 128 * 2**20  #: that bookmarks may take
MOST = 64
EVERY = 0.5  #: seconds of the clock between bookmarks
SHARE = 30.0  #: a bookmark that takes this part of the time between two is worth it


@dataclass(frozen=True, slots=True)
class Mark:
    """A moment of a run and how to return to it."""

    count: int  #: collisions until then
    reversed: bool  #: whether time ran backwards
    marks: tuple[Any, ...]  #: a `Bookmark` of each simulation on show

    @property
    def nbytes(self) -> int:
        """Memory it takes."""
        return sum(mark.nbytes for mark in self.marks)


class History:
    """The marks of one run, oldest first; the first stays as long as the run."""

    def __init__(self) -> None:
        self._marks: list[Mark] = []
        self._due = 0.0

    def clear(self) -> None:
        """Forget all, because another run begins."""
        self._marks.clear()
        self._due = 0.0

    def note(self, make: Callable[[], Mark]) -> None:
        """Take a mark of now with `make`, if it is time for one."""
        begin = time.perf_counter()
        if begin < self._due:
            return
        self.keep(make())
        cost = time.perf_counter() - begin
        self._due = begin + max(EVERY, SHARE * cost)

    def keep(self, mark: Mark) -> None:
        """Add a mark; of those too many, let go the ones that leave the smallest gaps."""
        marks = self._marks
        marks.append(mark)
        while len(marks) > 2 and (len(marks) > MOST or sum(mark.nbytes for mark in marks) > BYTES):
            now = len(marks)
            # A gap counts for less the longer ago it is.
            least = min(
                range(1, now - 1),
                key=lambda k: (
                    (marks[k + 1].count - marks[k - 1].count + 1)
                    / (mark.count - marks[k].count + 1)
                ),
            )
            del marks[least]

    def before(self, count: int) -> Mark | None:
        """The newest mark before the collision of this number, else the first; later ones go."""
        while len(self._marks) > 1 and self._marks[-1].count >= count:
            self._marks.pop()
        return self._marks[-1] if self._marks else None
