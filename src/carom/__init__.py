"""carom: exact collisions of spheres in three dimensions.

>>> import carom
>>> sim = carom.Simulation(walls=carom.Box(10, 10, 10))
>>> ball = sim.add(position=(0, 0, 0), velocity=(1, 0, 0))
>>> sim.run(until=6)
>>> ball.position.tolist(), sim.wall_collisions
([3.0, 0.0, 0.0], 1)
"""

from typing import TYPE_CHECKING

from carom import observe, scenes
from carom.ball import Ball
from carom.errors import (
    CaromError,
    CollapseError,
    FileError,
    InputError,
    OverlapError,
    RunError,
    UnknownNameError,
)
from carom.event_file import Events, load_events
from carom.measuring import measure
from carom.observe.observable import log_times
from carom.record import Recording, load
from carom.rendering import render
from carom.rules import Smooth
from carom.scene import Camera, Scene, Spheres
from carom.simulation import Bookmark, Simulation
from carom.state import EVENT, State
from carom.vector import Vector
from carom.walls import Box, Cylinder, Open, Periodic, Plane, Sphere

__all__ = [
    "EVENT",
    "Ball",
    "Bookmark",
    "Box",
    "Camera",
    "CaromError",
    "CollapseError",
    "Cylinder",
    "Events",
    "FileError",
    "InputError",
    "Open",
    "OverlapError",
    "Periodic",
    "Plane",
    "Recording",
    "RunError",
    "Scene",
    "Simulation",
    "Smooth",
    "Sphere",
    "Spheres",
    "State",
    "UnknownNameError",
    "Vector",
    "__version__",
    "load",
    "load_events",
    "log_times",
    "measure",
    "observe",
    "render",
    "scenes",
]

if TYPE_CHECKING:
    __version__: str


def __getattr__(name: str) -> str:
    """Look up `__version__` when it is asked for: the look-up takes a tenth of the import."""
    if name != "__version__":
        msg = f"module 'carom' has no attribute {name!r}"
        raise AttributeError(msg)
    from importlib.metadata import PackageNotFoundError, version

    try:
        return version("carom")
    except PackageNotFoundError:  # run from the source tree
        return "0+unknown"
