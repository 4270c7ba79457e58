"""Recordings in other formats: extended XYZ, H5MD, and their events as event files."""

from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import numpy as np

from carom.checks import nearest
from carom.errors import FileError, InputError, UnknownNameError, unwritable
from carom.event_file.layout import carom_version, packed
from carom.event_file.recorder import OpenFile, about_file
from carom.event_file.source import ENDINGS
from carom.frame import Frame
from carom.record import hoomd, layout
from carom.record.recording import Recording
from carom.walls import wall_names

Progress = Callable[[int, int], object]  #: frames done, frames in all


def convert(run: Recording, path: str | Path, progress: Progress | None = None) -> tuple[int, str]:
    """Write a recording in another format, by the end of the name.

    Parameters
    ----------
    run : Recording
    path : str or Path
        ``.xyz`` is extended XYZ, ``.h5`` is H5MD (by way of h5py). ``.parquet`` and ``.npz``
        hold the events, see `carom.load_events`.
    progress : callable, optional
        ``(done, all)``, called after each frame.

    Returns
    -------
    many : int
    what : str
        What was written: "frames" or "events".

    Raises
    ------
    InputError
        If the name ends otherwise, h5py or pyarrow is missing, or H5MD cannot hold the recording.
    FileError
        If the file cannot be written.
    """
    target = Path(path)
    write = FORMATS.get(target.suffix.lower())
    if write is None:
        msg = f"{target} has no known ending{nearest(target.suffix, FORMATS)}"
        raise UnknownNameError(msg)
    part = target.with_stem(f"{target.stem}.part")  # no file is cut short, or lost for a bad one
    try:
        done = write(run, part, progress or (lambda done, total: None))
        part.replace(target)
        return done
    except FileError as error:  # of the events' writer, which knows the other name only
        raise FileError(str(error).replace(str(part), str(target))) from error
    except OSError as error:
        raise unwritable(target, error) from error
    finally:
        part.unlink(missing_ok=True)


def _counted(run: Recording, progress: Progress) -> Iterator[Frame]:
    for k, frame in enumerate(run):
        yield frame
        progress(k + 1, len(run))


# Extended XYZ.

COLUMNS = "type:I:1:pos:R:3:velo:R:3:radius:R:1:mass:R:1:id:I:1"


def _xyz(run: Recording, path: Path, progress: Progress) -> tuple[int, str]:
    with path.open("w", encoding="ascii") as file:
        for frame in _counted(run, progress):
            file.write(_xyz_frame(frame))
    return len(run), "frames"


def _xyz_frame(frame: Frame) -> str:
    """One frame: how many, what there is, a line for each sphere; numbers keep all their bits."""
    lx, ly, lz = hoomd.lengths(frame.state, frame.world)
    periodic = " ".join("T" if length > 0 else "F" for length in frame.world.period)
    head = (
        f'Lattice="{lx!r} 0 0 0 {ly!r} 0 0 0 {lz!r}" Origin="{-lx / 2!r} {-ly / 2!r} {-lz / 2!r}" '
        f'Properties={COLUMNS} pbc="{periodic}" Time={frame.time!r}'
    )
    numbers = np.column_stack([frame.position, frame.velocity, frame.radius, frame.mass]).tolist()
    lines = [
        f"{kind} {' '.join(map(repr, row))} {i}"
        for i, (kind, row) in enumerate(zip(frame.species.tolist(), numbers, strict=True), 1)
    ]
    return "\n".join([str(len(frame)), head, *lines, ""])


# H5MD 1.1, de Buyl et al., Comput. Phys. Commun. 185, 1546 (2014), doi:10.1016/j.cpc.2014.01.018.


def _h5md(run: Recording, path: Path, progress: Progress) -> tuple[int, str]:
    try:
        import h5py
    except ImportError as error:
        msg = '.h5 needs h5py: pip install "carom[analysis]"; a name in .xyz does without'
        raise InputError(msg) from error
    counts = {len(frame) for frame in run}
    if len(counts) > 1:
        msg = (
            f"H5MD holds one number of spheres, and in {run.path} it changes from {min(counts)} to "
            f"{max(counts)}; convert it to .xyz"
        )
        raise InputError(msg)
    with h5py.File(path, "w") as file:
        _h5md_head(file)
        group = file.create_group("particles/all")
        first = run[0]
        for name, values in (
            ("mass", first.mass),
            ("radius", first.radius),
            ("species", first.species.astype(np.int32)),
            ("id", np.arange(1, len(first) + 1)),
        ):
            group[name] = values
        _h5md_frames(group, run, progress)
    return len(run), "frames"


def _h5md_head(file: Any) -> None:
    head = file.create_group("h5md")
    head.attrs["version"] = np.array([1, 1], np.int32)
    head.create_group("author").attrs["name"] = np.bytes_("unknown")
    creator = head.create_group("creator")
    creator.attrs["name"] = np.bytes_("carom")
    creator.attrs["version"] = np.bytes_(carom_version())


def _h5md_frames(group: Any, run: Recording, progress: Progress) -> None:
    n, frames = len(run[0]), len(run)
    box = group.create_group("box")
    box.attrs["dimension"] = 3
    periodic = run[0].world.period > 0
    box.attrs["boundary"] = np.array([b"periodic" if p else b"none" for p in periodic])
    group["step"], group["time"] = np.arange(frames), run.times
    series = {
        "position": group.create_dataset("position/value", (frames, n, 3), "f8"),
        "velocity": group.create_dataset("velocity/value", (frames, n, 3), "f8"),
        "image": group.create_dataset("image/value", (frames, n, 3), "i4"),
        "edges": box.create_dataset("edges/value", (frames, 3), "f8"),
    }
    for each in (group["position"], group["velocity"], group["image"], box["edges"]):
        each["step"], each["time"] = group["step"], group["time"]  # the same, not copies
    for k, frame in enumerate(_counted(run, progress)):
        for name in ("position", "velocity", "image"):
            series[name][k] = getattr(frame.state, name)
        series["edges"][k] = hoomd.lengths(frame.state, frame.world)


# Event files, docs/events.md.


def _events(run: Recording, path: Path, progress: Progress) -> tuple[int, str]:
    with closing(OpenFile(path)) as file:
        _start(file, run)
        for k in range(1, len(run)):
            if run.changed(k - 1):
                file.about.setdefault("changed", file.about["end"])
            file.add(run.told(k - 1))
            file.about["end"] = _so_far(file, run[k])
            progress(k + 1, len(run))
    return file.count, "events"


def _start(file: OpenFile, run: Recording) -> None:
    """Put into an event file what it replays from."""
    first = run[0]
    file.about = about_file() | {
        "carom": run.manifest["carom"],
        "scene": run.manifest["scene"]
        and {"name": run.manifest["scene"], "options": run.manifest["options"]},
        "seed": run.manifest["seed"],
        "method": run.manifest["method"],
        "tick": 1.0,
        "n": len(first),
        "walls": list(wall_names(first.walls)),
        "before": _before(run),
    }
    file.arrays = packed(first.state, first.world)
    checkpoint = run.file.read(run.place(0), layout.CHECKPOINT)
    if len(checkpoint) and first.time > run.segment(run.place(0)).built.time:
        file.arrays["engine"] = checkpoint  # it was under way
    file.about["end"] = _so_far(file, first)


def _before(run: Recording) -> dict[str, Any]:
    """What had been counted when the first engine was built."""
    account, built = run.heads[run.place(0)]["account"], run.segment(run.place(0)).built
    counts = {"collisions": built.collisions, "wall_collisions": built.wall_collisions}
    return counts | {name: account[name] for name in ("dissipated", "withheld", "overlap")}


def _so_far(file: OpenFile, frame: Frame) -> dict[str, Any]:
    counts = {"collisions": frame.collisions, "wall_collisions": frame.wall_collisions}
    return {"events": file.count, "time": frame.time, **counts}


FORMATS: dict[str, Callable[[Recording, Path, Progress], tuple[int, str]]] = {
    ".xyz": _xyz,
    ".h5": _h5md,
    **dict.fromkeys(ENDINGS, _events),
}
