"""Where a picture is seen from: the view that the page begins with, or a camera's."""

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from carom.pictures.room import Room
from carom.state import Floats

HALF_ANGLE = math.tan(math.radians(17))  #: half the picture's height at distance 1
STEEPEST = 1.54  #: radians; at a right angle left and right lose their meaning
PLUMB = 1e-9  #: radians from straight down or up, where there is no direction to look in
AZIMUTH, HEIGHT = -0.42, 0.3  #: radians: two walls and the floor are seen
FREE = 0.92  #: of the picture, for what must fit


class Viewpoint(Protocol):
    """A `carom.Camera`."""

    @property
    def position(self) -> tuple[float, float, float]:
        """Where it stands."""

    @property
    def target(self) -> tuple[float, float, float]:
        """What it looks at."""


@dataclass(frozen=True, eq=False)
class Eye:
    """A place and the axes of a picture seen from there.

    Attributes
    ----------
    place, right, up, forward : (3,) float64
        In the world; unit vectors.
    above : (3,) float64
        Away from gravity, or z.
    distance, reach : float
        To the middle of what is seen, and from there to its ends.
    size : (width, height)
        Of the picture, in pixels.
    """

    place: Floats
    right: Floats
    up: Floats
    forward: Floats
    above: Floats
    distance: float
    reach: float
    size: tuple[int, int]

    @property
    def pixel(self) -> float:
        """Width of a pixel at distance 1."""
        return 2 * HALF_ANGLE / self.size[1]

    def project(self, point: Floats) -> tuple[float, float]:
        """Where a place is seen, in pixels from the upper left corner."""
        line = point - self.place
        scale = 1 / (self.pixel * float(line @ self.forward))
        x = self.size[0] / 2 + float(line @ self.right) * scale
        return x, self.size[1] / 2 - float(line @ self.up) * scale


def look(room: Room, gravity: Floats, size: tuple[int, int], camera: Viewpoint | None) -> Eye:
    """See everything, or what a camera says."""
    above = _above(gravity)
    forward, side = compass(above)
    deep, wide = np.ptp(room.points @ forward), np.ptp(room.points @ side)
    slender = wide / deep if wide > 0 and deep > 0 else 1.0
    azimuth = AZIMUTH / max(1.0, math.sqrt(slender))
    # From the gas's side of a plane that stands alone.
    back = _axes(above, azimuth, HEIGHT)[2]
    if any(face.endless and face.normal @ back < 0 for face in room.faces):
        azimuth = -azimuth
    right, up, back = _axes(above, azimuth, HEIGHT)
    target, distance = room.center, 0.0
    tan = HALF_ANGLE * FREE * np.array([size[0] / size[1], 1.0])
    reach = room.margin
    for point in room.points - room.center:
        # The cone of half angle a around a ball of radius m touches it at distance m/sin a.
        sides = np.abs([point @ right, point @ up]) + room.margin * np.hypot(1, tan)
        distance = max(distance, float(point @ back + (sides / tan).max()))
        reach = max(reach, float(np.linalg.norm(point)) + room.margin)
    if camera is not None:
        target = np.array(camera.target)
        line = np.array(camera.position) - target
        distance = math.hypot(*line)  # which does not underflow
        height = math.asin(max(-1.0, min(1.0, float(line @ above) / distance)))
        level = float(line @ side), -float(line @ forward)
        # Straight down, and nearly so, no direction is left but the sign of a zero.
        azimuth = math.atan2(*level) if math.hypot(*level) > PLUMB * distance else 0.0
        right, up, back = _axes(above, azimuth, max(-STEEPEST, min(STEEPEST, height)))
    return Eye(target + back * distance, right, up, -back, above, distance, reach, size)


def _above(gravity: Floats) -> Floats:
    """Away from gravity if there is any, along an axis where it nearly is."""
    size = float(np.linalg.norm(gravity))
    above: Floats = -gravity / size if size > 0 else np.array([0.0, 0.0, 1.0])
    return np.round(above) + 0.0 if np.abs(above).max() > 1 - 1e-9 else above


def compass(above: Floats) -> tuple[Floats, Floats]:
    """Forward and rightward horizontal axes at azimuth 0."""
    forward = np.array([0.0, 0.0, -1.0] if abs(above[1]) > 0.9 else [0.0, 1.0, 0.0])
    right = np.cross(forward, above)
    right /= np.linalg.norm(right)
    return np.cross(above, right), right


def _axes(above: Floats, azimuth: float, height: float) -> tuple[Floats, Floats, Floats]:
    """Unit vectors right, up and back, towards the eye."""
    forward, side = compass(above)
    flat = math.sin(azimuth) * side - math.cos(azimuth) * forward
    back = math.cos(height) * flat + math.sin(height) * above
    back /= np.linalg.norm(back)
    right = np.cross(above, back)
    right /= np.linalg.norm(right)
    return right, np.cross(back, right), back


def lamp(eye: Eye, room: Room) -> Floats:
    """Where the lamp stands: above the left shoulder of who looks.

    Where there are flat walls it stays in the room wherever the eye is; elsewhere it comes along.
    """
    right, back = eye.right, -eye.forward
    if room.faces:
        forward, side = compass(eye.above)
        right = math.cos(AZIMUTH) * side + math.sin(AZIMUTH) * forward
        back = math.sin(AZIMUTH) * side - math.cos(AZIMUTH) * forward
    flat = np.cross(eye.above, right)  # into the picture, level
    sign = 1.0 if flat @ back >= 0 else -1.0
    towards: Floats = 0.8 * eye.above - 0.3 * right + 0.38 * sign * flat
    return towards / np.linalg.norm(towards)
