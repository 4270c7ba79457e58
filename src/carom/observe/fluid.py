"""What `carom.theory` is told about the fluid at hand, and where it does not speak."""

import math
from collections.abc import Callable
from typing import NamedTuple, ParamSpec, TypeVar

from carom import mechanics, theory
from carom.errors import InputError
from carom.observe.batch import Moment
from carom.observe.kinds import Kinds, conserves_energy, is_periodic
from carom.state import State
from carom.world import World

P = ParamSpec("P")
R = TypeVar("R")

UP_TO = f"up to packing fraction {theory.FREEZING}"
#: Stands in place of a theory's name, so that nobody wonders where its line is.
FREEZES = f"none, above packing fraction {theory.FREEZING} hard spheres freeze"


class Fluid(NamedTuple):
    """A fluid of equal hard spheres, as formulas take it: ``theory.collision_rate(*fluid)``."""

    packing_fraction: float
    temperature: float
    mass: float
    radius: float


def is_gas(state: State, world: World) -> bool:
    """Whether it is an elastic fluid in a periodic box, of spheres that all move and collide."""
    elastic = is_periodic(world) and conserves_energy(world) and world.collide
    return elastic and not state.fixed.any() and mechanics.temperature(state, world) > 0


def fluid_of(moment: Moment) -> tuple[Fluid | None, str]:
    """The fluid of one kind, if there is one; otherwise `FREEZES`, where that is the reason."""
    state, world = moment.state, moment.world
    if not is_gas(state, world):
        return None, ""
    kinds = Kinds(state)
    if len(kinds) != 1:
        return None, ""
    filling = mechanics.packing_fraction(state, world)
    if filling > theory.FREEZING:
        return None, FREEZES
    kT = mechanics.temperature(state, world)
    return Fluid(filling, kT, float(kinds.mass[0]), float(kinds.radius[0])), ""


def in_range(formula: Callable[P, R], *args: P.args, **kwargs: P.kwargs) -> R | None:
    """What a formula of `carom.theory` gives; None out of its range, which it alone knows."""
    try:
        return formula(*args, **kwargs)
    except InputError:
        return None


def mean_speed(fluid: Fluid) -> float:
    """<v> of Maxwell's law."""
    return math.sqrt(8 * fluid.temperature / (math.pi * fluid.mass))
