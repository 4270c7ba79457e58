"""Turns what is on the stage into the messages that pages are sent."""

import math
import time
from dataclasses import dataclass
from typing import Any

from carom.errors import CaromError
from carom.pictures.look import is_paper
from carom.pictures.scales import Scales
from carom.view.portrait import portrait
from carom.view.protocol import Meters, encode_frame, encode_scene, encode_text
from carom.view.snapshot import Snapshot
from carom.view.stage import Stage
from carom.view.viewable import Viewable

METERS_EVERY = 0.1  #: seconds between readings of the energies, which read all spheres again
WALLS_EVERY = 0.25  #: seconds between readings of the pressures


@dataclass(frozen=True, slots=True)
class Reading:
    """Sums over the spheres of one simulation, which change slowly on a page."""

    kinetic: float = 0.0
    potential: float = 0.0
    dissipated: float = 0.0
    drift: float = 0.0
    momentum: tuple[float, float, float] = (0.0, 0.0, 0.0)
    temperature: float = 0.0
    missed: int = 0
    overlap: float = 0.0


class Announcer:
    """Makes snapshots of a stage; used by the driver's thread alone."""

    def __init__(self, stage: Stage) -> None:
        self._stage = stage
        self._number = self._scene_number = 0
        self._scene, self._described = b"", -1
        self._readings: tuple[Reading, ...] = ()
        self._read_at = self._walls_at = -math.inf
        self._read_epoch = -1
        self._scales, self._scales_of = Scales(paper=False), (-1, math.inf)
        self._notes: dict[str, tuple[int, str]] = {}

    def snapshot(self, *, playing: bool, speed: float, reached: float, failure: str) -> Snapshot:
        """Everything a page may be sent now."""
        stage, clock = self._stage, time.perf_counter()
        self._read(clock, playing)
        energy, speed_end = self._scales.ends
        if self._described != stage.epoch:
            self._described = stage.epoch
            self._scene_number += 1
            state = stage.sim.state
            about = portrait(stage.sim, state, stage.key, self._scales.ends)
            self._scene = encode_scene(state, self._scene_number, about)
        gx, gy, gz = stage.sim.world.gravity.tolist()
        frames = tuple(
            encode_frame(
                sim,
                Meters(
                    clock=clock,
                    gravity=(gx, gy, gz),
                    kinetic=reading.kinetic,
                    potential=reading.potential,
                    dissipated=reading.dissipated,
                    drift=reading.drift,
                    momentum=reading.momentum,
                    temperature=reading.temperature,
                    missed=reading.missed,
                    overlap=reading.overlap,
                    full_energy=energy,
                    full_speed=speed_end,
                    speed=speed,
                    reached=reached,
                    epoch=stage.epoch,
                    scene=self._scene_number,
                    playing=playing,
                    failed=bool(failure),
                    twin=bool(twin),
                    reversed=stage.reversed,
                ),
            )
            for twin, (sim, reading) in enumerate(zip(stage.shown, self._readings, strict=True))
        )
        self._note("failure", failure)
        self._note("settings", stage.settings())
        if stage.event is not None:
            self._note("event", stage.event)
        self._read_walls(clock, playing)
        self._number += 1
        return Snapshot(self._number, frames, self._scene_number, self._scene, dict(self._notes))

    def source(self) -> dict[str, str]:
        """The simulation as text, or the reason why not."""
        sim = self._stage.sim
        texts = {}
        for key, write in (
            ("python", sim.as_python),
            ("toml", sim.as_toml),
            ("command", sim.as_command),
        ):
            try:
                texts[key] = write()
            except CaromError as error:
                texts[key] = f"# {error}\n"
        return texts

    def _note(self, key: str, value: Any) -> None:
        text = encode_text(key, value)
        number, before = self._notes.get(key, (0, ""))
        if text != before:
            self._notes[key] = (number + 1, text)

    def _read(self, clock: float, playing: bool) -> None:
        """Read the sums again, if it is time to."""
        stage = self._stage
        fresh = playing and stage.epoch == self._read_epoch
        if fresh and clock - self._read_at < METERS_EVERY and self._readings:
            return
        self._read_at, self._read_epoch = clock, stage.epoch
        self._readings = tuple(_reading(sim, stage.twin is not None) for sim in stage.shown)
        self._follow()

    def _follow(self) -> None:
        """Let scales follow the motion; where it begins again, or another does, they do, too."""
        stage, sim = self._stage, self._stage.sim
        key, since = self._scales_of
        if stage.key != key or sim.time <= since:
            self._scales, self._scales_of = Scales(is_paper(sim.scene)), (stage.key, sim.time)
        self._scales.follow(sim.state, sim.world)

    def _read_walls(self, clock: float, playing: bool) -> None:
        stage = self._stage
        if playing and clock - self._walls_at < WALLS_EVERY:
            return
        self._walls_at = clock
        pressure = stage.pressure
        self._note(
            "walls",
            {
                "pressure": [p if math.isfinite(p) else None for p in pressure.pressure.tolist()],
                "theory": pressure.theory(self._readings[0].temperature),
                "duration": pressure.duration,
            },
        )


def _reading(sim: Viewable, compared: bool) -> Reading:
    px, py, pz = sim.momentum.tolist()
    return Reading(
        kinetic=sim.kinetic_energy,
        potential=sim.potential_energy,
        dissipated=sim.dissipated,
        drift=sim.energy_drift,
        momentum=(px, py, pz),
        temperature=sim.temperature,
        missed=sim.missed,
        # It looks at all neighbours, so only where it is shown.
        overlap=sim.max_overlap if compared else 0.0,
    )
