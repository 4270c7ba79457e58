"""Observables that look at the state now and then."""

from typing import Any

from carom.checks import number
from carom.errors import InputError
from carom.observe.batch import Moment
from carom.observe.kinds import mean_free_time
from carom.observe.observable import Observable, Schedule, every, once


class Sampled(Observable):
    """Base of observables with a schedule.

    Parameters
    ----------
    every : float, optional
        Simulated time between samples; `apart` mean free times if left out.
    at : sequence of float, optional
        Times of samples instead, counted from where measuring begins.

    Raises
    ------
    InputError
        If both are given, or they are no such times.
    """

    #: Mean free times between samples, where nothing else is asked for.
    apart = 3.0

    def __init__(self, every: float | None = None, *, at: Any = None) -> None:
        self._fixed = schedule(every, at)

    def begin(self, moment: Moment) -> None:
        """Choose the times."""
        scale = mean_free_time(moment.state, moment.world)
        self.schedule = self._fixed or every(self.apart * scale)


class Reaching(Sampled):
    """Base of those that look up to some distance or wave number; as that takes long, rarely.

    Parameters
    ----------
    reach : float, optional
    every, at
        As of `Sampled`, but a hundred mean free times if left out.
    """

    apart = 100.0

    def __init__(
        self, reach: float | None = None, every: float | None = None, *, at: Any = None
    ) -> None:
        super().__init__(every, at=at)
        self._asked = None if reach is None else number("reach", reach, above=0)


def schedule(interval: float | None, at: Any) -> Schedule | None:
    """The schedule that two options ask for; None if neither does."""
    if interval is not None and at is not None:
        msg = "every= and at= are both given; a schedule is one or the other"
        raise InputError(msg)
    if at is not None:
        return once(at)
    return None if interval is None else every(interval)
