"""What a page must know of a scene besides the motion: walls, colours, scales, where to look."""

import math
from typing import Any

import numpy as np

from carom import mechanics
from carom.scene import Scene
from carom.state import State
from carom.view.viewable import Viewable
from carom.walls import wall_names
from carom.world import World

#: Kinetic energy at which the paper's saturation KE/5 reaches 100 percent.
PAPER_FULL = 500.0


def portrait(sim: Viewable, state: State, key: int) -> dict[str, Any]:
    """Describe a scene for the page, as plain lists and numbers fit for JSON.

    `key` changes when another scene was loaded, so that the page begins afresh.
    """
    scene, world = sim.scene, sim.world
    camera = scene.camera if scene else None
    origin = scene.origin if scene else None
    low, high = _extent(state)
    return {
        "key": key,
        "origin": None if origin is None else {"name": origin.name, "options": origin.options},
        "method": sim.method if isinstance(sim.method, str) else "exact",
        "free_axes": len(mechanics.conserved_axes(state, world)),
        "title": scene.title if scene else "",
        "pace": sim.pace,
        "wire": bool(scene.wire) if scene else False,
        "color": scene.color if scene else "own",
        "collide": bool(world.collide),
        "camera": None
        if camera is None
        else {"position": list(camera.position), "target": list(camera.target)},
        "period": world.period.tolist(),
        "gravity": world.gravity.tolist(),
        "walls": [
            {
                "kind": int(wall["kind"]),
                "normal": wall["normal"].tolist(),
                "offset": float(wall["offset"]),
                "name": name.removeprefix("the "),
            }
            for wall, name in zip(world.walls, wall_names(sim.walls), strict=True)
        ],
        "low": low,
        "high": high,
        **_scales(scene, state, world),
    }


def _extent(state: State) -> tuple[list[float], list[float]]:
    """Corners of the smallest box along the axes around all spheres."""
    if len(state) == 0:
        return [-1.0] * 3, [1.0] * 3
    r = state.radius[:, None]
    return (state.position - r).min(axis=0).tolist(), (state.position + r).max(axis=0).tolist()


def _scales(scene: Scene | None, state: State, world: World) -> dict[str, float]:
    """Kinetic energy of full saturation, and where the scales of speed and gravity end.

    Scenes in the paper's look keep the paper's number: saturation is KE/5 percent, so full at
    500. Others have other units: there it is three times the mean energy of a free sphere,
    rounded to 1, 2 or 5 times a power of ten. Where little moves yet, the energy of falling
    through the scene counts.
    """
    free = ~state.fixed
    if not free.any():
        return {"full_energy": 1.0, "full_speed": 1.0, "full_gravity": 1.0}
    mass, squares = state.mass[free], (state.velocity[free] ** 2).sum(axis=1)
    fall = float(np.ptp(state.position[free] @ world.gravity))
    energy = max(float((mass * squares).mean()) / 2, float(mass.mean()) * fall / 3)
    speed = math.sqrt(max(float(squares.mean()), fall))
    paper = scene is not None and scene.wire and scene.color == "energy"
    # A sphere of the mean energy then rises a fifth of the way across the world.
    across = float(np.ptp(state.position, axis=0).max()) or float(state.radius.max())
    strength = max(2.5 * float(squares.mean()) / across, 2 * float(np.abs(world.gravity).max()))
    return {
        "full_energy": PAPER_FULL if paper else _round(3 * energy),
        "full_speed": _round(2 * speed),
        "full_gravity": _round(strength),
    }


def _round(value: float) -> float:
    """Round to the nearest of 1, 2, 5 times a power of ten; 1 for 0."""
    if value <= 0 or not math.isfinite(value):
        return 1.0
    power = 10.0 ** math.floor(math.log10(value))
    return float(
        min((1.0, 2.0, 5.0, 10.0), key=lambda step: abs(math.log(value / power / step))) * power
    )
