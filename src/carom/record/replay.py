"""From one frame to any later time, by the events in between.

Between events spheres fly freely, so positions are sums of what each event gave:

    x(t) = x0 + v0 (t - t0) + a0 (t - t0)²/2 + Σ [(J/m)(t - t_k) + (a_k - a_{k-1})(t - t_k)²/2]

with the sum over the sphere's events k, and a the gravity that acts on it: none while it rests.
No equation is solved and no engine is needed; the result is exact but for rounding.
"""

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom import fit
from carom.state import CAME_TO_REST, WOKE, Floats, State
from carom.world import World


def later(state: State, world: World, events: NDArray[Any], time: float) -> State:
    """The state at `time`.

    Parameters
    ----------
    state : State
        Some time before.
    world : World
    events : (n,) EVENT
        All between the two, in order, with absolute times.
    time : float
    """
    n, span = len(state), time - state.time
    pair, woke = events["j"] >= 0, events["j"] == WOKE
    rested = (events["j"] <= CAME_TO_REST) & ~woke
    left = time - events["time"]
    # Impulses, on i and their opposite on j; a fixed sphere takes none.
    who = np.concatenate([events["i"], events["j"][pair]])
    impulse = np.concatenate([events["impulse"], -events["impulse"][pair]])
    kick = impulse / state.mass[who][:, np.newaxis]
    velocity = state.velocity + _sums(who, kick, n)
    moved = _sums(who, kick * np.concatenate([left, left[pair]])[:, np.newaxis], n)
    # Gravity, with how long it acts, and what that weighs in the position.
    falls = ~(state.fixed | state.resting)
    changes = woke | rested
    sign, at, length = np.where(woke, 1.0, -1.0)[changes], events["i"][changes], left[changes]
    acts = falls * span + _sum(at, sign * length, n)
    weight = falls * (0.5 * span**2) + _sum(at, 0.5 * sign * length**2, n)
    velocity += acts[:, np.newaxis] * world.gravity
    moved += state.velocity * span + weight[:, np.newaxis] * world.gravity
    position, boxes = fit.wrap(state.position + moved, world.period)
    resting = state.resting.copy()
    resting[at] = sign < 0  # the last of a sphere's changes counts
    return replace(
        state,
        position=position,
        velocity=velocity,
        image=state.image + boxes,
        collision_count=state.collision_count + _counts(events, pair, woke, n),
        resting=resting,
        time=time,
        collisions=state.collisions + int(np.count_nonzero(pair)),
        wall_collisions=state.wall_collisions + int(np.count_nonzero(~(pair | woke))),
    )


def _sums(who: NDArray[np.int32], values: Floats, n: int) -> Floats:
    """(n, 3), the sum of each sphere's rows."""
    return np.column_stack([_sum(who, column, n) for column in values.T])


def _sum(who: NDArray[np.int32], values: Floats, n: int) -> Floats:
    """(n,), the sum of each sphere's values."""
    return np.bincount(who, values, n).astype(np.float64)  # of nothing it would be of integers


def _counts(
    events: NDArray[Any], pair: NDArray[np.bool_], woke: NDArray[np.bool_], n: int
) -> NDArray[np.uint32]:
    who = np.concatenate([events["i"][~woke], events["j"][pair]])
    return np.bincount(who, minlength=n).astype(np.uint32)
