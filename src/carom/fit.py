"""Do the spheres fit their world? Every refusal names the sphere, the limit and the remedy."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom._core import first_overlap as deepest_overlap
from carom.checks import LARGEST
from carom.errors import InputError, OverlapError
from carom.state import Floats, State
from carom.world import CYLINDER, PLANE, SPHERE, World

#: Touching is welcome: an overlap is a distance below sigma (1 - TOUCH).
TOUCH = 1e-12
#: Between two opposite walls a sphere needs this share of its radius to move in, and a ball
#: that touches a round container must leave it at least at this angle: with less it would
#: bounce some 1e9 times per diameter of its path, and the run would never get on.
ROOM = 1e-9


def check(state: State, world: World, wall_names: Sequence[str]) -> None:
    """Refuse a state that no engine can run in this world.

    Parameters
    ----------
    state : State
        Positions are wrapped already on periodic axes, see `wrap`.
    world : World
    wall_names : sequence of str
        What to call each of `World.walls`, see `carom.walls.wall_names`.

    Raises
    ------
    OverlapError
        If spheres reach into one another or through a wall.
    InputError
        If a number cannot be used, or a sphere is too large for its world.
    """
    check_values(state)
    check_sizes(state, world, wall_names)
    check_walls(state, world, wall_names)
    if world.collide:
        check_overlap(state, world)


def check_values(state: State) -> None:
    """Refuse numbers that no sphere can have.

    Raises
    ------
    InputError
        For NaN, infinity (but for the mass of a fixed sphere), a radius or mass that is not
        positive, a fixed sphere that moves.
    """
    for name in ("position", "velocity", "radius", "mass"):
        values = getattr(state, name)
        good = np.abs(values) <= LARGEST  # False for NaN too
        if name == "mass":
            good |= state.fixed & (values == np.inf)
        if good.all():
            continue
        k = int(np.argwhere(~good)[0][0])
        msg = f"sphere {k} has {name} {_text(values[k])}; {_remedy(name, values[k])}"
        raise InputError(msg)
    for name in ("radius", "mass"):
        values = getattr(state, name)
        if (values < 1 / LARGEST).any():
            k = int(np.argmax(values < 1 / LARGEST))
            limit = "more than 0" if values[k] <= 0 else f"at least {1 / LARGEST:g}"
            msg = f"sphere {k} has {name} {_text(values[k])}; it must be {limit}"
            raise InputError(msg)
    moving = state.fixed & (state.velocity != 0).any(axis=1)
    if moving.any():
        k = int(np.argmax(moving))
        velocity = _text(state.velocity[k])
        msg = f"sphere {k} is fixed but has velocity {velocity}; set it to 0 or fixed to False"
        raise InputError(msg)


def _remedy(name: str, value: Any) -> str:
    if np.isfinite(value).all():
        return f"beyond {LARGEST:g} the arithmetic overflows: choose other units"
    if name == "mass" and value == np.inf:
        return "use fixed=True for a sphere that nothing can move"
    return "give finite numbers"


def _text(value: Any) -> str:
    """Write a number, or a vector, as people do."""
    numbers = [f"{x:.6g}" for x in np.atleast_1d(value)]
    return numbers[0] if len(numbers) == 1 else f"({', '.join(numbers)})"


def check_sizes(state: State, world: World, wall_names: Sequence[str]) -> None:
    """Refuse a world too small for its largest sphere.

    Raises
    ------
    InputError
        If a periodic axis is shorter than a diameter, or the space between opposite walls
        or inside a round container leaves a free sphere no room to move.
    """
    if world.collide and len(state):
        k = int(np.argmax(state.radius))
        diameter = 2 * state.radius[k]
        for axis in np.flatnonzero(world.period):
            length = world.period[axis]
            if length < diameter * (1 - TOUCH):
                msg = (
                    f"the periodic axis {'xyz'[axis]} is {length:g} long, less than the "
                    f"diameter {diameter:g} of sphere {k}, which would overlap its own image; "
                    "make the axis longer or the sphere smaller"
                )
                raise InputError(msg)
    free = np.flatnonzero(~state.fixed)
    if len(free) == 0:
        return
    k = int(free[np.argmax(state.radius[free])])
    needed = state.radius[k] * (1 + ROOM)
    for w, wall in enumerate(world.walls):
        if wall["kind"] != PLANE:
            if wall["offset"] < needed:
                _refuse_size(k, state.radius[k], wall["offset"], wall_names[w])
            continue
        for v in range(w):
            other = world.walls[v]
            width = -(wall["offset"] + other["offset"])
            facing = other["kind"] == PLANE and (wall["normal"] == -other["normal"]).all()
            if facing and width < 2 * needed:
                _refuse_size(k, state.radius[k], width / 2, f"{wall_names[v]} and {wall_names[w]}")


def _refuse_size(k: int, radius: float, half: float, where: str) -> None:
    msg = (
        f"sphere {k} of radius {radius:g} has no room to move in {where}, which leave space "
        f"for a radius below {half:g}; use a smaller sphere or a larger space"
    )
    raise InputError(msg)


def check_walls(state: State, world: World, wall_names: Sequence[str]) -> None:
    """Refuse a free sphere outside a wall, or sliding along the inside of a round one.

    Raises
    ------
    OverlapError
        If a sphere reaches through a wall by more than rounding.
    InputError
        If a ball touches a round container and moves along it: it would bounce infinitely
        often.
    """
    free = np.flatnonzero(~state.fixed)
    position, radius = state.position[free], state.radius[free]
    for wall, name in zip(world.walls, wall_names, strict=True):
        gap = room(wall, position, radius)
        # The gap is a difference of numbers as large as the wall's offset: allow its rounding.
        slack = TOUCH * radius + 8 * np.finfo(float).eps * abs(wall["offset"])
        if (gap < -slack).any():
            k = int(np.argmin(gap + slack))
            msg = (
                f"sphere {free[k]} reaches {-gap[k]:.6g} through {name}; "
                "move it inside, make it smaller or the space larger"
            )
            raise OverlapError(msg)
        if wall["kind"] != PLANE:
            _refuse_sliding(state, free, gap, slack, int(wall["kind"]), name)


def _refuse_sliding(
    state: State, free: NDArray[np.intp], gap: Floats, slack: Floats, kind: int, name: str
) -> None:
    axes = 3 if kind == SPHERE else 2
    x, v = state.position[free, :axes], state.velocity[free, :axes]
    lengths = np.sqrt((x * x).sum(axis=1) * (v * v).sum(axis=1))
    along = np.abs((x * v).sum(axis=1)) <= ROOM * lengths
    sliding = along & (lengths > 0) & (gap <= slack)
    if sliding.any():
        msg = (
            f"sphere {free[np.argmax(sliding)]} touches {name} and moves exactly along it, so "
            "it would bounce infinitely often; move it inward or tilt its velocity"
        )
        raise InputError(msg)


def check_overlap(state: State, world: World) -> None:
    """Refuse spheres that overlap, nearest images included; two fixed ones may.

    Raises
    ------
    OverlapError
        Names the pair and the depth.
    """
    found = first_overlap(state.position, state.radius, state.fixed, world.period)
    if found:
        i, j, depth = found
        msg = (
            f"spheres {i} and {j} overlap by {depth:.6g}; move one, make them smaller, "
            "or place them with carom.place.random_positions"
        )
        raise OverlapError(msg)


def first_overlap(
    position: Floats, radius: Floats, fixed: NDArray[np.bool_], period: Floats
) -> tuple[int, int, float] | None:
    """Find the pair (i < j) that overlaps most, if any does.

    Cost: about N; only spheres in neighbouring cells are compared.

    Parameters
    ----------
    position : (N, 3) float64
    radius : (N,) float64
    fixed : (N,) bool
        Two fixed spheres may overlap.
    period : (3,) float64
        Length of each periodic axis, 0 elsewhere.

    Returns
    -------
    (i, j, depth) or None
        Depth is sigma - r.
    """
    try:
        return deepest_overlap(position, radius, fixed, period)
    except ValueError as error:  # CAROM_SIMD names no instruction set of this machine
        raise InputError(str(error)) from None


def room(wall: NDArray[Any], position: Floats, radius: Floats) -> Floats:
    """Gap between one flattened wall and each sphere, negative where a sphere is through it.

    A plane leaves n . x - offset - R; a container of radius A leaves A - R - |x|, where
    for a cylinder |x| is the distance from the z axis.

    Parameters
    ----------
    wall : () WALL
        One row of `World.walls`.
    position : (N, 3) float64
    radius : (N,) float64

    Returns
    -------
    (N,) float64
    """
    if wall["kind"] == PLANE:
        n = wall["normal"]
        along = position[:, 0] * n[0] + position[:, 1] * n[1] + position[:, 2] * n[2]
        return np.asarray(along - wall["offset"] - radius)
    axes = 2 if wall["kind"] == CYLINDER else 3
    distance = np.sqrt((position[:, :axes] ** 2).sum(axis=1))
    return np.asarray(wall["offset"] - radius - distance)


def wrap(position: Floats, period: Floats) -> tuple[Floats, NDArray[np.int32]]:
    """Bring positions into [-L/2, L/2) on each periodic axis.

    Parameters
    ----------
    position : (N, 3) float64
    period : (3,) float64
        Length L of each periodic axis, 0 elsewhere.

    Returns
    -------
    wrapped : (N, 3) float64
    image : (N, 3) int32
        ``position = wrapped + image * period``; positions inside come back as they are.

    Raises
    ------
    InputError
        If a position is more than 1e9 boxes away.
    """
    wrapped = position.copy()
    image = np.zeros(position.shape, np.int32)
    for axis in np.flatnonzero(period):
        length = period[axis]
        boxes = np.floor(position[:, axis] / length + 0.5)
        if len(boxes) and np.abs(boxes).max() > 1e9:
            k = int(np.argmax(np.abs(boxes)))
            msg = (
                f"sphere {k} is more than 1e9 boxes of length {length:g} from the origin; "
                "place it inside the periodic box"
            )
            raise InputError(msg)
        x = position[:, axis] - boxes * length
        # Rounding may leave x just outside, on either side.
        over = x >= length / 2
        x[over], boxes[over] = x[over] - length, boxes[over] + 1
        under = x < -length / 2
        x[under], boxes[under] = x[under] + length, boxes[under] - 1
        wrapped[:, axis], image[:, axis] = x, boxes
    return wrapped, image
