"""What a page must know of a scene besides the motion: walls, colours, scales, where to look."""

from typing import Any, Protocol

from carom import mechanics
from carom.pictures.room import extent
from carom.pictures.scales import full_gravity
from carom.scene import Scene
from carom.state import State
from carom.walls import wall_names
from carom.world import World


class Sitter(Protocol):
    """Whose portrait it is: a `carom.Simulation`, or what a replay knows of one."""

    @property
    def scene(self) -> Scene | None:
        """Where it started from."""

    @property
    def world(self) -> World:
        """Everything but the spheres."""

    @property
    def walls(self) -> Any:
        """Descriptions of the walls."""

    @property
    def pace(self) -> float:
        """Simulated time per second at speed 1."""

    @property
    def method(self) -> Any:
        """How contacts are found."""


def portrait(sim: Sitter, state: State, key: int, full: tuple[float, float]) -> dict[str, Any]:
    """Describe a scene for the page, as plain lists and numbers fit for JSON.

    `key` changes when another scene was loaded, so that the page begins afresh. `full` is where
    the scales of energy and speed end now.
    """
    scene, world = sim.scene, sim.world
    camera = scene.camera if scene else None
    origin = scene.origin if scene else None
    low, high = extent(state)
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
        "restitution": float(world.restitution),
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
                "restitution": float(wall["restitution"]),
                "name": name.removeprefix("the "),
            }
            for wall, name in zip(world.walls, wall_names(sim.walls), strict=True)
        ],
        "low": low.tolist(),
        "high": high.tolist(),
        "full_energy": full[0],
        "full_speed": full[1],
        "full_gravity": full_gravity(state, world),
    }
