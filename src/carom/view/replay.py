"""Replays: a motion as one file that any browser plays from the disk, without carom or network."""

import base64
import math
from collections.abc import Callable, Iterable, Iterator, Sized
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from carom.errors import FileError, InputError, unwritable
from carom.pictures.look import is_paper
from carom.pictures.scales import Scales
from carom.scene import Scene
from carom.state import Floats
from carom.view import bundle
from carom.view.portrait import portrait
from carom.view.protocol import counts_of, encode_scene
from carom.view.reel import Reel, encode
from carom.view.viewable import Instant
from carom.world import World

#: Spheres times frames; more would fill the memory of a phone.
MOST = 5_000_000
#: Frames per second at speed 1, and how many, where nobody asks for others.
PER_SECOND, MOST_FRAMES = 30, 6000
ENTRY = "replay.js"


class Source(Protocol):
    """What can be shown: a `carom.Simulation`, or a recording of one."""

    @property
    def scene(self) -> Scene | None:
        """Where it started from."""

    @property
    def pace(self) -> float:
        """Simulated time per second at speed 1."""

    @property
    def frames(self) -> Callable[..., Iterator[Any]]:
        """``frames(at=times)`` gives an `Instant` for each time."""


class Recorded(Source, Protocol):
    """A source that has an end."""

    def __getitem__(self, index: int) -> Any:
        """One of its frames."""

    @property
    def start(self) -> float:
        """Time of the first frame."""

    @property
    def end(self) -> float:
        """Time of the last frame."""


@dataclass(frozen=True, slots=True)
class _Sitter:
    """Whose portrait a replay shows: the first of its frames, with what is the source's."""

    scene: Scene | None
    world: World
    walls: Any
    pace: float
    method: str = "exact"


def write_replay(
    source: Source,
    path: str | Path,
    times: Iterable[float],
    *,
    color: str | None = None,
    title: str | None = None,
    speed: float = 1.0,
    progress: Callable[[float], object] | None = None,
) -> None:
    """Write a motion as an ``.html`` file that plays in any browser.

    Between two frames the page draws the exact motion of every sphere that has collided at most
    once, as the live view does. A position is off by less than 1e-5 of the size of the scene.

    Parameters
    ----------
    source : Simulation or Recording
        A simulation runs on to the last of the times.
    path : str or Path
        Must end in ``.html``; a file that is there is replaced.
    times : iterable of float
        Rising simulated times of the frames, at least two.
    color : str, optional
        "energy", "speed", "collisions", "species" or "own"; as the scene asks for if left out.
    title : str, optional
        That of the scene if left out.
    speed : float
        At which it begins to play, in multiples of the scene's pace.
    progress : callable, optional
        Told the time of each frame twice: when it is there, and when it is packed.

    Raises
    ------
    InputError
        If the motion cannot be shown so, or is too much for one page.
    FileError
        If the file cannot be written.

    Examples
    --------
    >>> import carom
    >>> from carom.view import write_replay
    >>> sim = carom.Simulation(carom.scenes.two_balls())
    >>> write_replay(sim, "two balls.html", [k / 30 for k in range(300)])
    >>> Path("two balls.html").unlink()
    """
    path = Path(path)
    if path.suffix.lower() != ".html":
        msg = f"a replay is a web page, so its name ends in .html; {path.name!r} does not"
        raise InputError(msg)
    part = path.with_name(f"{path.name}.part")  # no half file, whatever happens
    try:
        part.touch()  # that it cannot be written is said before the work is done
        text = replay(source, times, color=color, title=title, speed=speed, progress=progress)
        part.write_text(text, encoding="utf-8", newline="\n")
        part.replace(path)
    except FileError:  # the recording's
        raise
    except OSError as error:
        raise unwritable(path, error) from error
    finally:
        part.unlink(missing_ok=True)


def even_times(run: Recorded) -> Floats:
    """Times from the start of a recording to its end: thirty a second, fewer if it is long."""
    wanted = math.ceil((run.end - run.start) / run.pace * PER_SECOND) + 1
    frames = max(2, min(wanted, MOST_FRAMES, MOST // max(1, len(run[0]))))
    times: Floats = np.linspace(run.start, run.end, frames)
    return times


def replay(
    source: Source,
    times: Iterable[float],
    *,
    color: str | None = None,
    title: str | None = None,
    speed: float = 1.0,
    progress: Callable[[float], object] | None = None,
) -> str:
    """Make the text of the file that `write_replay` writes; see there."""
    if color is not None and color not in COLORS:
        msg = f"color is {color!r}; it must be one of {', '.join(COLORS)}"
        raise InputError(msg)
    data, name = pack(source, times, color=color, title=title, speed=speed, progress=progress)
    return bundle.page(ENTRY, name, base64.b64encode(data).decode())


COLORS = ("energy", "speed", "collisions", "species", "own")


def pack(
    source: Source,
    times: Iterable[float],
    *,
    color: str | None,
    title: str | None,
    speed: float,
    progress: Callable[[float], object] | None,
) -> tuple[bytes, str]:
    """Make the reel of a motion, and its title."""
    first: Any = None
    asked = len(times) if isinstance(times, Sized) else 0
    rows: list[list[float]] = []
    scales = Scales(is_paper(source.scene))
    full = scales.ends
    places: list[Any] = []
    speeds: list[Any] = []
    counts: list[Any] = []
    for frame in source.frames(at=times):
        first = frame if first is None else first
        if len(frame) != len(first):
            msg = (
                f"there are {len(frame)} spheres at time {frame.time:g} and {len(first)} before; "
                "a replay shows the same spheres throughout: end it earlier or begin it later"
            )
            raise InputError(msg)
        if rows and frame.time <= rows[-1][0]:
            continue
        if len(frame) * max(len(rows) + 1, asked) > MOST:
            most = MOST // len(frame)
            msg = (
                f"{len(frame):,} spheres in more than {most:,} frames are too much for one page, "
                f"which holds {MOST:,} in all: take fewer frames (--fps, a shorter stretch)"
            )
            raise InputError(msg)
        ends = scales.follow(frame.state, frame.world)
        full = full if rows else ends
        rows.append([*_row(frame), *ends])
        places.append(np.asarray(frame.position, np.float32).T)
        speeds.append(np.asarray(frame.velocity, np.float32).T)
        counts.append(counts_of(frame))
        if progress is not None:
            progress(frame.time)
    if len(rows) < 2:
        msg = f"a replay needs at least two frames at different times; there are {len(rows)}"
        raise InputError(msg)
    sitter = _Sitter(source.scene, first.world, first.walls, source.pace)
    about = portrait(sitter, first.state, 0, full)
    about |= {} if color is None else {"color": color}
    about |= {} if title is None else {"title": title}
    reel = Reel(
        encode_scene(first.state, 1, about),
        np.array(rows),
        np.array(places, np.float64),
        np.array(speeds, np.float64),
        np.array(counts, np.uint32),
        speed,
    )
    return encode(reel, progress), about["title"] or "carom"


def _row(frame: Instant) -> list[float]:
    """`wire.REEL_COLUMNS` but for the ends of scales; seven digits are enough to be shown."""
    shown = [frame.kinetic_energy, frame.potential_energy, frame.dissipated, frame.energy_drift]
    moved = [*np.asarray(frame.momentum).tolist(), frame.temperature]
    short = np.array([*shown, *moved], np.float32).astype(float).tolist()
    gravity = frame.world.gravity.tolist()
    return [
        *(frame.time, *gravity, *short[:4]),
        *(float(frame.collisions), float(frame.wall_collisions), *short[4:]),
    ]
