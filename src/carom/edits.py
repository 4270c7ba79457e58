"""New states from old ones: what a user's assignment or addition makes of the spheres."""

from dataclasses import fields, replace
from typing import Any

import numpy as np

from carom import fit
from carom.errors import InputError
from carom.scene import Spheres
from carom.state import Floats, State


def assigned(state: State, name: str, index: int | slice, value: Any, period: Floats) -> State:
    """`state` with one array, or one row of it, replaced; the old state is left alone.

    Parameters
    ----------
    state : State
    name : str
        A field that `Spheres` has too; its rules of shape and type hold here.
    index : int or slice
        One sphere, or ``slice(None)`` for all.
    value : array_like
        One value for all, or one for each. What it means is checked by `carom.fit`.
    period : (3,) float64
        A new position is wrapped; whole boxes travelled before are kept.

    Raises
    ------
    InputError
        If shape or type does not fit, or a fixed sphere is given a mass.
    """
    where = slice(index, index + 1) if isinstance(index, int) else index
    old = {"position": state.position[where], "fixed": state.fixed[where]}
    if name == "mass" and isinstance(index, int) and state.fixed[index]:
        msg = f"sphere {index} is fixed, so nothing can move it and its mass stays infinite"
        raise InputError(msg)
    spheres = Spheres.of(**{**old, name: value})
    if len(spheres) != len(old["position"]):
        msg = f"{name} has {len(spheres)} rows; give one for each of {len(old['position'])} spheres"
        raise InputError(msg)
    array = getattr(state, name).copy()
    array[where] = getattr(spheres, name)
    after = replace(state, **{name: array})
    if name == "position":
        after.position, boxes = fit.wrap(array, period)
        after.image = state.image + boxes
    return awake(state, after)


def awake(before: State, after: State) -> State:
    """`after`, in which each sphere moved, pushed or resized since `before` rests no longer."""
    same = (
        np.all(before.position == after.position, axis=1)
        & np.all(before.velocity == after.velocity, axis=1)
        & (before.radius == after.radius)
    )
    return replace(after, resting=after.resting & same)


def joined(state: State, spheres: Spheres, period: Floats) -> State:
    """`state` with more spheres at its end."""
    more = State.empty(len(spheres))
    for field in fields(spheres):
        setattr(more, field.name, getattr(spheres, field.name))
    more.position, more.image = fit.wrap(spheres.position, period)
    after = replace(state)
    for name in _arrays(state):
        setattr(after, name, np.concatenate([getattr(state, name), getattr(more, name)]))
    return after


def without(state: State, index: int) -> State:
    """`state` without one sphere; the others keep their order."""
    after = replace(state)
    for name in _arrays(state):
        setattr(after, name, np.delete(getattr(state, name), index, axis=0))
    return after


def _arrays(state: State) -> list[str]:
    """Names of what a state has one row of for each sphere."""
    return [f.name for f in fields(state) if isinstance(getattr(state, f.name), np.ndarray)]
