"""Those who follow a motion: what they are told, and when."""

from typing import Any, Protocol

from numpy.typing import NDArray

from carom.observe.batch import Moment


class Listener(Protocol):
    """Who hears of one run; `carom.observe.feed.Feed` is one.

    Nothing it is told lets it change the motion: its bits do not depend on who listens.
    """

    @property
    def takes_events(self) -> bool:
        """Whether it wants event records, which then all engines keep."""

    @property
    def due(self) -> float:
        """Time at which it wants to look; the engine stops exactly there. inf: never."""

    def events(self, records: NDArray[Any]) -> None:
        """Take records (n,) EVENT, absolute times; all since the run began, in order, once."""

    def moment(self, moment: Moment) -> None:
        """Time stands still for a moment, perhaps a `due` one; all events before were told."""

    def end(self, moment: Moment) -> None:
        """The run is over, or Ctrl-C has ended it."""


class Follower(Listener, Protocol):
    """Who follows a motion through all its runs and the changes between them.

    It is handed the motion when it is made and joins `Motion.followers`.
    """

    def begin(self, moment: Moment) -> None:
        """A run begins; none of its events have happened yet."""

    def cut(self, moment: Moment) -> None:
        """The motion is about to go on from elsewhere: it still is what it was so far.

        Somebody assigns, adds, removes, resets or returns to a bookmark. Comes between runs,
        perhaps often; the next `begin` tells where it goes on.
        """

    def close(self, moment: Moment) -> None:
        """Nothing will come any more: finish what is open.

        Raises
        ------
        FileError
            If what it has kept cannot be kept.
        """
