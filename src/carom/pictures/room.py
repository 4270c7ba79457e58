"""What is drawn of the walls, and what a camera must fit; as the page's ``walls.js`` has it."""

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from carom.state import Floats, State
from carom.world import CYLINDER, PLANE, SPHERE, World

ROUND = 96  #: corners of a drawn circle
STAVES = 16  #: lines along a cylinder
SQUARES = 10  #: of the grid along the longest side of a box
ENDLESS = 16  #: steps from the middle of an endless plane to where it ends


@dataclass(frozen=True, slots=True)
class Face:
    """A flat wall: a rectangle spanned by two sides, with the normal into the gas.

    `grid` holds, for both sides, the grid's step at the corner and the steps along the side.
    `endless` planes fade towards their rim.
    """

    corner: Floats
    sides: Floats
    normal: Floats
    grid: tuple[float, float, float, float]
    endless: bool = False

    @property
    def center(self) -> Floats:
        """Its middle."""
        center: Floats = self.corner + self.sides.sum(axis=0) / 2
        return center


@dataclass(frozen=True, slots=True)
class Edge:
    """A line; `outward` are the normals, out of the gas, of the walls it joins.

    `dash` is the length of a dash with its gap, 0 for an unbroken line.
    """

    begin: Floats
    end: Floats
    outward: Floats
    dash: float = 0.0


@dataclass(frozen=True, slots=True)
class Room:
    """Walls as they are drawn, and balls of radius `margin` around `points` to be in sight."""

    faces: list[Face] = field(default_factory=list)
    edges: list[Edge] = field(default_factory=list)
    shells: list[float] = field(default_factory=list)
    center: Floats = field(default_factory=lambda: np.zeros(3))
    points: Floats = field(default_factory=lambda: np.zeros((1, 3)))
    margin: float = 1.0

    @classmethod
    def of(cls, state: State, world: World) -> "Room":
        """See what is there."""
        planes = world.walls[world.walls["kind"] == PLANE]
        shells = [float(r) for r in world.walls["offset"][world.walls["kind"] == SPHERE]]
        tubes = [float(r) for r in world.walls["offset"][world.walls["kind"] == CYLINDER]]
        low, high, closed = _ends(state, world, planes)
        size = float((high - low).max())
        faces: list[Face] = []
        edges: list[Edge] = []
        if closed:
            _box(low, high, world.period > 0, faces, edges)
        for plane in planes:
            slanted = np.abs(plane["normal"]).max() <= 1 - 1e-9
            if slanted or not (closed or tubes):
                faces.append(_endless(plane, (low + high) / 2, 1.6 * size))
        for radius in tubes:
            edges += _tube(radius, low[2], high[2])
        return cls(faces, edges, shells, *_to_fit(low, high, closed, shells, tubes))

    def seen_from(self, eye: Floats) -> list[Face]:
        """The walls that hide nothing: those whose inside faces the eye, and endless ones."""
        return [
            face for face in self.faces if face.endless or face.normal @ (eye - face.center) > 0
        ]


def extent(state: State) -> tuple[Floats, Floats]:
    """Corners of the smallest box along the axes around all spheres."""
    if len(state) == 0:
        return np.full(3, -1.0), np.full(3, 1.0)
    r = state.radius[:, None]
    return (state.position - r).min(axis=0), (state.position + r).max(axis=0)


def lowest(state: State, world: World, above: Floats) -> float:
    """How high, along a unit vector, the lowest place is that walls let spheres reach.

    Where no wall is below them, that of the spheres themselves.
    """
    walls = world.walls
    low, high, _ = _ends(state, world, walls[walls["kind"] == PLANE])
    for kind, axes in ((SPHERE, slice(0, 3)), (CYLINDER, slice(0, 2))):
        for radius in walls["offset"][walls["kind"] == kind]:
            low[axes], high[axes] = -radius, radius
    return float(np.minimum(low * above, high * above).sum())


def _ends(state: State, world: World, planes: NDArray[np.void]) -> tuple[Floats, Floats, bool]:
    """Where the world ends along each axis: at walls, at the period, or where spheres are."""
    low, high = extent(state)
    closed = True
    for axis in range(3):
        if world.period[axis] > 0:
            low[axis], high[axis] = -world.period[axis] / 2, world.period[axis] / 2
            continue
        along = planes["normal"][:, axis]
        lows = planes["offset"][along > 1 - 1e-9]
        highs = -planes["offset"][along < -(1 - 1e-9)]
        low[axis] = lows.max() if len(lows) else low[axis]
        high[axis] = highs.min() if len(highs) else high[axis]
        closed &= len(lows) > 0 and len(highs) > 0
    return low, high, closed


def _box(
    low: Floats, high: Floats, periodic: NDArray[np.bool_], faces: list[Face], edges: list[Edge]
) -> None:
    size = float((high - low).max())
    ends = np.array([low, high])
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        sides = np.zeros((2, 3))
        sides[0, u], sides[1, v] = high[u] - low[u], high[v] - low[v]
        steps = [max(1.0, np.floor(SQUARES * (high[k] - low[k]) / size + 0.5)) for k in (u, v)]
        for side in (0, 1):
            if periodic[axis]:
                break
            corner = low.copy()
            corner[axis] = ends[side, axis]
            normal = np.zeros(3)
            normal[axis] = 1 - 2 * side
            faces.append(Face(corner, sides, normal, (0.0, steps[0], 0.0, steps[1])))
        for a, b in ((0, 0), (0, 1), (1, 0), (1, 1)):
            begin = low.copy()
            begin[u], begin[v] = ends[a, u], ends[b, v]
            end = begin.copy()
            end[axis] = high[axis]
            outward = np.zeros((2, 3))
            outward[0, u], outward[1, v] = 2 * a - 1, 2 * b - 1
            solid = not (periodic[u] and periodic[v])
            edges.append(Edge(begin, end, outward, 0.0 if solid else size / 40))


def across(normal: Floats) -> Floats:
    """Any unit vector across another."""
    other = np.array([0.0, 0.0, 1.0] if abs(normal[2]) < 0.9 else [1.0, 0.0, 0.0])
    side = np.cross(normal, other)
    unit: Floats = side / np.linalg.norm(side)
    return unit


def _endless(plane: np.void, middle: Floats, reach: float) -> Face:
    """A disc of an endless plane, around the scene's shadow on it."""
    normal = np.array(plane["normal"])
    center = middle + normal * (plane["offset"] - normal @ middle)
    a = across(normal)
    sides = 2 * reach * np.array([a, np.cross(normal, a)])
    steps = (-float(ENDLESS), 2.0 * ENDLESS)
    return Face(center - sides.sum(axis=0) / 2, sides, normal, steps + steps, endless=True)


def _tube(radius: float, low: float, high: float) -> list[Edge]:
    angles = 2 * np.pi * np.arange(ROUND + 1) / ROUND
    ring = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(ROUND + 1)])
    bottom, top = np.array([0.0, 0.0, low]), np.array([0.0, 0.0, high])
    edges = []
    for k in range(ROUND):
        for end, out in ((bottom, -1.0), (top, 1.0)):
            outward = np.array([ring[k], (0.0, 0.0, out)])
            edges.append(Edge(radius * ring[k] + end, radius * ring[k + 1] + end, outward))
        if k % (ROUND // STAVES) == 0:
            edges.append(Edge(radius * ring[k] + bottom, radius * ring[k] + top, ring[[k, k]]))
    return edges


def _to_fit(
    low: Floats, high: Floats, closed: bool, shells: list[float], tubes: list[float]
) -> tuple[Floats, Floats, float]:
    """Center, points and margin of what a camera must see."""
    if shells:
        return np.zeros(3), np.zeros((1, 3)), min(shells)
    if tubes:
        r = min(tubes)
        low, high = np.array([-r, -r, low[2]]), np.array([r, r, high[2]])
    bits = np.array([[k & 1, k >> 1 & 1, k >> 2 & 1] for k in range(8)])
    size = float(np.linalg.norm(high - low))
    # Open space: leave room for what flies out.
    margin = 0.005 * size if closed else 0.08 * size
    return (low + high) / 2, np.where(bits == 1, high, low), margin
