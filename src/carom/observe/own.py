"""Observables of your own, from one function."""

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np

from carom.checks import number
from carom.errors import InputError
from carom.observe.batch import Batch, Moment
from carom.observe.estimate import Estimate
from carom.observe.observable import Observable
from carom.observe.sampled import Sampled
from carom.observe.series import Rates, Series
from carom.state import readonly


class OfState(Sampled):
    """Mean of a function of the state over the samples of a schedule."""

    function: Callable[[Any], Any]

    def begin(self, moment: Moment) -> None:
        """Start a series."""
        super().begin(moment)
        self._series = Series(1)

    def sample(self, moment: Moment) -> None:
        """Ask the function."""
        value = number(f"what {self.name} returns", type(self).function(readonly(moment.state)))
        self._series.add(np.array([[value]]))

    def result(self) -> Estimate:
        """Mean over the samples."""
        self.over_samples()
        return self._series.mean(0)


class OfEvents(Observable):
    """Sum of a function of events over the time."""

    function: Callable[[Any], Any]

    def begin(self, moment: Moment) -> None:
        """Start a series."""
        self._rates = Rates()

    def events(self, batch: Batch) -> None:
        """Ask the function."""
        values = np.asarray(type(self).function(batch))
        if values.shape != (len(batch),):
            msg = (
                f"{self.name} returned an array of shape {values.shape} for {len(batch)} events; "
                "return one number for each"
            )
            raise InputError(msg)
        if values.dtype.kind not in "biuf" or not np.isfinite(values).all():
            msg = f"{self.name} returned what is no finite number for some events: {values!r:.60}"
            raise InputError(msg)
        self._rates.add(batch, values.astype(np.float64))

    def result(self) -> Estimate:
        """Sum over the duration."""
        self.over_time()
        return self._rates.rate()


def observable(function: Callable[[Any], Any]) -> Callable[..., Observable]:
    """Make an observable from a function, as a decorator.

    A function of ``state`` returns a number for a `State`; the result is its mean over samples,
    and what it makes takes ``every=`` or ``at=``. A function of ``batch`` returns one number for
    each event of a `Batch`; the result is their sum for each unit of time.

    Parameters
    ----------
    function : callable
        With one parameter, named ``state`` or ``batch``.

    Returns
    -------
    class
        Call it to make an observable, once for each measurement.

    Raises
    ------
    InputError
        If the parameter has another name.

    Examples
    --------
    >>> import carom
    >>> from carom import observe
    >>> @observe.observable
    ... def push_to_the_left(batch):
    ...     return batch.impulse[0] * (batch.j == -2)
    >>> sim = carom.Simulation(walls=carom.Box(4, 4, 4))
    >>> ball = sim.add(velocity=(1, 0, 0))
    >>> push = push_to_the_left()
    >>> sim.run(until=300, observe=push)
    >>> push.result().value
    -0.3333333333333333
    """
    names = list(inspect.signature(function).parameters)
    if names not in (["state"], ["batch"]):
        msg = f"an observable is a function of one parameter, state or batch, not of {names}"
        raise InputError(msg)
    base = OfState if names == ["state"] else OfEvents
    content = {"function": staticmethod(function), "__doc__": function.__doc__}
    content["__module__"] = function.__module__
    return type(function.__name__, (base,), content)
