"""The methods by which a simulation may go on, and the engine that each name stands for."""

from typing import Literal, TypeAlias

from carom.checks import nearest
from carom.engine import FastEngine
from carom.errors import UnknownNameError
from carom.motion import MakeEngine
from carom.reference.exact import ExactEngine
from carom.reference.tick import TickEngine

Method: TypeAlias = Literal["exact", "tick", "reference"] | MakeEngine
METHODS = ("exact", "tick", "reference")
TICKS_PER_SECOND = 60  #: what the paper shows at speed 1


def engine_maker(method: Method, tick: float, log: bool) -> MakeEngine:
    """What builds the engine that a method's name stands for."""
    if callable(method):
        return method
    if method == "tick":
        return lambda state, world: TickEngine(state, world, tick, count_missed=True)
    if method == "reference":
        return ExactEngine
    if method == "exact":
        return lambda state, world: FastEngine(state, world, log=log)
    msg = f"there is no method {method!r}{nearest(str(method), METHODS)}"
    raise UnknownNameError(msg)
