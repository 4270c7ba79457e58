"""Measuring while time runs: numbers with error bars, beside what theory says of them."""

from carom.observe.batch import Batch, Moment
from carom.observe.blocking import Settling, blocking, settling
from carom.observe.estimate import Estimate
from carom.observe.observable import Observable
from carom.observe.own import observable
from carom.observe.table import Table

__all__ = [
    "Batch",
    "Estimate",
    "Moment",
    "Observable",
    "Settling",
    "Table",
    "blocking",
    "observable",
    "settling",
]
