"""The methods by which a simulation may go on, and the engine that each name stands for."""

from typing import Literal, TypeAlias

from carom.checks import nearest
from carom.engine import FastEngine
from carom.errors import UnknownNameError
from carom.motion import MakeEngine, MakeLogging
from carom.reference.exact import ExactEngine
from carom.reference.tick import TickEngine

Method: TypeAlias = Literal["exact", "tick", "reference"] | MakeEngine
METHODS = ("exact", "tick", "reference")
TICKS_PER_SECOND = 60  #: what the paper shows at speed 1


def engine_maker(method: Method, tick: float) -> MakeLogging:
    """What builds the engine that a method's name stands for; only "exact" can do without a log."""
    if callable(method):
        return lambda state, world, _: method(state, world)
    if method == "tick":
        return lambda state, world, _: TickEngine(state, world, tick, count_missed=True)
    if method == "reference":
        return lambda state, world, _: ExactEngine(state, world)
    if method == "exact":
        return lambda state, world, log: FastEngine(state, world, log=log)
    msg = f"there is no method {method!r}{nearest(str(method), METHODS)}"
    raise UnknownNameError(msg)
