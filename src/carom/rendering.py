"""`render`: a scene, simulation or recording as a picture or a film."""

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from carom.checks import number
from carom.errors import FileError, InputError
from carom.pictures import film
from carom.pictures.caption import Caption, Legend
from carom.pictures.look import Color, Theme
from carom.pictures.painter import Painter, Pixels, Style
from carom.pictures.picture import paint
from carom.scene import Camera, Scene
from carom.state import Floats

SECONDS = 10  #: of a film of a simulation, if nothing is said
FPS = {".gif": 25.0, ".mp4": 30.0, ".html": 30.0}
MOST = 200_000  #: pictures in a film: almost two hours


class Source(Protocol):
    """What can be shown: a `carom.Simulation` or a `carom.Recording`."""

    @property
    def scene(self) -> Scene | None:
        """Where it started from."""

    @property
    def pace(self) -> float:
        """Simulated time per second at speed 1."""

    @property
    def frames(self) -> Callable[..., Iterator[Any]]:
        """``frames(at=times)`` gives a `carom.Frame` for each time."""


@dataclass(frozen=True)
class Progress:
    """How far a film is.

    Attributes
    ----------
    done, total : int
        Pictures; those of a replay count twice, when they are there and when they are packed.
    time : float
        Simulated time of the last one.
    """

    done: int
    total: int
    time: float


def render(
    source: Source,
    path: str | Path,
    *,
    size: tuple[int, int] = (1280, 720),
    begin: float | None = None,
    until: float | None = None,
    speed: float = 1.0,
    fps: float | None = None,
    camera: Camera | None = None,
    color: Color | None = None,
    theme: Theme = "dark",
    shadows: bool = True,
    quality: str = "good",
    caption: bool = True,
    progress: Callable[[Progress], object] | None = None,
) -> None:
    """Write a picture (``.png``), a film (``.mp4``, ``.gif``) or a replay (``.html``).

    What is seen is what the live view shows, drawn without a browser. Films need
    ``pip install "carom[video]"``. Ctrl-C, or a run that cannot go on, leaves a film of what was
    drawn so far. A replay is a page to look around in: of the options below only times, speed,
    fps and color matter to it.

    Parameters
    ----------
    source : Simulation or Recording
        A simulation runs on to the last moment shown.
    path : str or Path
        Its ending says which kind of file; one that is there is replaced.
    size : (width, height)
        In pixels; even numbers for MP4.
    begin : float, optional
        Simulated time at which a film begins; now, or where the recording does, if left out.
    until : float, optional
        Simulated time at which a film ends, or which a picture shows. If left out, a film of a
        simulation takes 10 seconds, one of a recording ends with it, and a picture shows `begin`.
    speed : float
        Of a film, in multiples of the scene's pace; 0.1 is slow motion, and as exact.
    fps : float, optional
        Pictures per second: 30, for a GIF 25, if left out.
    camera : Camera, optional
        Where to look from: the scene's own, or where everything is in sight, if left out.
    color : {"energy", "speed", "collisions", "own", "species"}, optional
        What colours mean; as the scene asks for if left out.
    theme : {"dark", "light"}
    shadows : bool
    quality : {"good", "draft"}
        "draft" has rough edges, and takes half the time.
    caption : bool
        Draw the title, the clock and the meaning of colours into the picture.
    progress : callable, optional
        Called with a `Progress` after each picture of a film or replay.

    Raises
    ------
    InputError
        If a value cannot be used, a library is missing, or there are no spheres.
    FileError
        If the file cannot be written.

    Examples
    --------
    >>> import carom
    >>> sim = carom.Simulation(carom.scenes.gas(n=50))
    >>> carom.render(sim, "gas.mp4", until=2, size=(640, 360))  # doctest: +SKIP
    """
    style = Style.of(
        source.scene,
        size=size, camera=camera, color=color, theme=theme, shadows=shadows, quality=quality,
    )  # fmt: skip
    job = _Job(source, Path(path), style, begin, until, speed, fps, caption, progress)
    job.writer()(job)


@dataclass(frozen=True)
class _Job:
    """The arguments of `render`, checked."""

    source: Any
    path: Path
    style: Style
    begin: float | None
    until: float | None
    speed: float
    fps: float | None
    caption: bool
    progress: Callable[[Progress], object] | None

    def __post_init__(self) -> None:
        number("speed", self.speed, above=0)
        for name in ("begin", "until", "fps"):
            value = getattr(self, name)
            if value is not None:
                number(name, value, **({"above": 0} if name == "fps" else {}))
        if self.begin is not None and self.begin < self.earliest:
            stands = "the recording begins" if self.is_recording else "the simulation is already"
            msg = (
                f"the first moment would be {self.begin:.9g}, but {stands} at "
                f"{self.earliest:.9g}; begin later"
            )
            raise InputError(msg)
        last = self.until if self.until is not None else self.start
        if self.is_recording and last > self.source.end:
            msg = (
                f"the last moment would be {last:.9g}, but the recording ends at "
                f"{self.source.end:.9g}; end earlier"
            )
            raise InputError(msg)
        if not self.path.parent.is_dir():
            msg = f"there is no folder {self.path.parent}; make it first, or write elsewhere"
            raise FileError(msg)
        if self.path.is_dir():
            msg = f"{self.path} is a folder; write elsewhere"
            raise FileError(msg)

    @property
    def suffix(self) -> str:
        """What the name ends in."""
        return self.path.suffix.lower()

    def writer(self) -> "Callable[[_Job], None]":
        """What writes such a file."""
        if self.suffix not in WRITERS:
            named = f"ends in {self.suffix!r}" if self.suffix else "has no ending"
            msg = f"the name {self.path.name!r} {named}; give one that ends in {_listed(WRITERS)}"
            raise InputError(msg)
        return WRITERS[self.suffix]

    @property
    def start(self) -> float:
        """Time of the first picture."""
        if self.begin is not None:
            return self.begin
        return self.earliest

    @property
    def earliest(self) -> float:
        """The first moment that can be shown."""
        return float(self.source.start if self.is_recording else self.source.time)

    @property
    def is_recording(self) -> bool:
        """Whether the motion has an end already."""
        return hasattr(self.source, "end")

    def times(self, fps: float) -> Floats:
        """Moments of a film that lasts as long as it should.

        Raises
        ------
        InputError
            If it would have no picture, or far too many.
        """
        step = self.speed * self.source.pace / fps
        end = self.until
        if end is None:
            end = self.source.end if self.is_recording else self.start + SECONDS * fps * step
        if end <= self.start:
            msg = f"the film would begin at {self.start:.9g} and end at {end:.9g}; give a later end"
            raise InputError(msg)
        many = (end - self.start) / step
        if many > MOST:
            msg = (
                f"the film would have {many:,.0f} pictures, more than {MOST:,}; "
                f"show less time, or let it pass faster than speed {self.speed:g}"
            )
            raise InputError(msg)
        times: Floats = self.start + step * np.arange(max(1, round(many)))
        return times


def _listed(names: Iterable[str]) -> str:
    *most, last = names
    return f"{', '.join(most)} or {last}"


def _title(source: Source) -> str:
    return source.scene.title if source.scene is not None else ""


def _picture(job: _Job) -> None:
    moment = job.start if job.until is None else job.until
    for frame in job.source.frames(at=[moment]):
        title = _title(job.source)
        paint(frame.state, frame.world, job.style, title, job.caption).save(job.path)


def _film(job: _Job) -> None:
    fps = FPS[job.suffix] if job.fps is None else job.fps
    film.check(job.suffix, job.style.size, fps)
    times = job.times(fps)
    frames = iter(job.source.frames(at=times))
    first = next(frames)
    if len(first) == 0:
        msg = "there are no spheres to show; add some first"
        raise InputError(msg)
    artist = _Artist(job, first, float(np.diff(times[:2]).sum()))
    quality = job.style.quality
    with film.Film(job.path, job.style.size, fps, quality, lambda: artist.gamut(first)) as roll:
        for done, frame in enumerate(chain([first], frames), start=1):
            roll.add(artist.draw(frame))
            if job.progress is not None:
                job.progress(Progress(done, len(times), frame.time))


def _replay(job: _Job) -> None:
    from carom.view.replay import write_replay

    times = job.times(FPS[job.suffix] if job.fps is None else job.fps)
    times = np.append(times, 2 * times[-1] - times[-2] if len(times) > 1 else times[0] + 1)
    done = 0

    def show(time: float) -> None:
        nonlocal done
        done += 1
        if job.progress is not None:
            job.progress(Progress(done, 2 * len(times), time))

    write_replay(job.source, job.path, times, color=job.style.color, speed=job.speed, progress=show)


class _Artist:
    """Draws frames of one film: a painter and its words."""

    def __init__(self, job: _Job, first: Any, step: float) -> None:
        self._style = job.style
        self._words = None
        if job.caption:
            legend = Legend.of(first.state, job.style)
            self._words = Caption(_title(job.source), legend, job.style, step)
        self._begin(first)
        self._scales = self._painter.scales

    def _begin(self, frame: Any) -> None:
        self._walls = frame.walls
        self._painter = Painter(frame.state, frame.world, self._style)

    def draw(self, frame: Any) -> Pixels:
        """One picture."""
        if frame.walls != self._walls:  # changed by hand on the way
            self._begin(frame)
            self._painter.scales = self._scales
        self._scales.follow(frame.state, frame.world)
        return self._worded(self._painter.paint(frame.state), frame)

    def gamut(self, frame: Any) -> Pixels:
        """Pictures with all the colours that spheres may take."""
        return np.concatenate([self._worded(p, frame) for p in self._painter.gamut(frame.state)])

    def _worded(self, pixels: Pixels, frame: Any) -> Pixels:
        if self._words is None:
            return pixels
        return self._words.write(pixels, frame.time, self._painter.end_of_scale(frame.state))


#: What writes a file, by the ending of its name.
WRITERS: dict[str, Callable[[_Job], None]] = {
    ".mp4": _film,
    ".gif": _film,
    ".png": _picture,
    ".html": _replay,
}
