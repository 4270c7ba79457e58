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
    """The marks of one run, oldest first; the first stays as long as the run.

    A change from outside begins another stretch of the run: what came after it cannot be
    reached from a mark made before.
    """

    def __init__(self) -> None:
        self._marks: list[tuple[int, Mark]] = []  # each with the number of its stretch
        self._ends: list[int] = []  # collisions until the end of each stretch but the last
        self._due = 0.0

    def clear(self) -> None:
        """Forget all, because another run begins."""
        self._marks.clear()
        self._ends.clear()
        self._due = 0.0

    def turn(self, count: int) -> None:
        """Take note of a change from outside after so many collisions; a mark is due."""
        self._ends.append(count)
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
        marks.append((len(self._ends), mark))
        while len(marks) > 2 and (len(marks) > MOST or sum(m.nbytes for _, m in marks) > BYTES):
            counts = [each.count for _, each in marks]
            # A gap counts for less the longer ago it is. Counts can also fall: of one sphere
            # alone they are the collisions with walls, of two those between the two.
            least = min(
                range(1, len(marks) - 1),
                key=lambda k: (
                    (abs(counts[k + 1] - counts[k - 1]) + 1) / (abs(counts[-1] - counts[k]) + 1)
                ),
            )
            del marks[least]

    def before(self, count: int) -> tuple[Mark, int] | None:
        """Find the newest mark from which collisions lead to the one of this number.

        Of stretches that ended before, it leads to their last one. Later marks go.

        Returns
        -------
        (Mark, int) or None
            And how many collisions there are to go; 0 from the first mark of all.
        """
        ends = [*self._ends, count]
        while len(self._marks) > 1:
            stretch, mark = self._marks[-1]
            if mark.count < ends[stretch]:
                break
            self._marks.pop()
        if not self._marks:
            return None
        stretch, mark = self._marks[-1]
        del self._ends[stretch:]
        return mark, max(0, ends[stretch] - mark.count)
