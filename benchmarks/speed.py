"""Collisions per second on one core, over N and packing fraction; and what a giant costs.

Run ``python benchmarks/speed.py`` (about five minutes) or ``--quick`` (one). Every run is warmed
up, repeated and interleaved with the others; its answers are asserted: the collision rate against
Enskog's (with the measured error), the energy, the deepest overlap, the memory.
"""

import argparse
import json
import platform
import statistics
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import carom
from carom import scenes
from carom.engine import FastEngine
from carom.scene import Scene

RESULTS = Path(__file__).parent / "results"


class Run:
    """One scene, warmed up, ready to be timed again and again."""

    def __init__(self, name: str, scene: Scene, collisions: int) -> None:
        self.name = name
        self.collisions = collisions
        state, world = scene.build()
        self.engine = FastEngine(state, world, log=False, slice_seconds=1e9)
        self.start_energy = self.energy()
        self.engine.advance(np.inf, max_collisions=collisions)
        self.seconds: list[float] = []
        self.events = 0
        self.first = (self.engine.time, self.engine.collisions)

    def energy(self) -> float:
        """Kinetic energy now."""
        state = self.engine.state()
        return 0.5 * float(np.sum(state.mass * np.sum(state.velocity**2, axis=1)))

    def measure(self) -> None:
        """Time one more stretch."""
        start = time.process_time()
        self.engine.advance(np.inf, max_collisions=self.collisions)
        self.seconds.append(time.process_time() - start)

    def report(self) -> dict[str, float | str | int]:
        """Assert what does not depend on the machine; return the figures."""
        drift = self.energy() / self.start_energy - 1
        assert abs(drift) < 1e-12, f"{self.name}: energy has drifted by {drift}"
        assert self.engine.max_overlap() < 1e-12, f"{self.name}: spheres overlap"
        n = len(self.engine.state())
        bytes_per_sphere = self.engine.memory / n
        most = 400 if self.name.startswith("fluid") else 600  # wide shells in a dilute gas
        assert bytes_per_sphere < most, f"{self.name}: {bytes_per_sphere} bytes"
        return {
            "run": self.name,
            "n": n,
            "million_collisions_per_second_median": self.collisions
            / statistics.median(self.seconds)
            / 1e6,
            "million_collisions_per_second_best": self.collisions / min(self.seconds) / 1e6,
            "bytes_per_sphere": round(bytes_per_sphere),
            "energy_drift": drift,
        }


def assert_rate(run: Run, packing_fraction: float) -> None:
    """The collision rate per sphere is Enskog's, 24 phi g sqrt(kT / pi m) / sigma.

    g is the contact value of Carnahan and Starling. The error of a measured rate is 1.2 /
    sqrt(collisions); 0.4 % is allowed for the theory, and 2 % while the lattice start is still
    being forgotten (fewer than ten collisions per sphere).
    """
    if packing_fraction > 0.45:
        return  # the lattice start has not melted after so few collisions
    start, before = run.first
    n = len(run.engine.state())
    collisions = run.engine.collisions - before
    rate = 2 * collisions / n / (run.engine.time - start)
    temperature = 2 * run.energy() / (3 * n - 3)
    g = (1 - packing_fraction / 2) / (1 - packing_fraction) ** 3
    enskog = 24 * packing_fraction * g * np.sqrt(temperature / np.pi)
    allowed = (0.004 if before > 5 * n else 0.02) + 4 * 1.2 / np.sqrt(collisions)
    assert abs(rate / enskog - 1) < allowed, f"{run.name}: {rate} against {enskog}"


def giant(n: int) -> Scene:
    """One giant of radius 50 among n spheres of radius 0.5."""
    return scenes.giant(n=n, radius_ratio=100, mass_ratio=1e4, seed=1)


def without_giant(n: int) -> Scene:
    """The same gas at the same density, alone."""
    box = giant(n).walls[0]
    assert isinstance(box, carom.Box)
    free = box.lx * box.ly * box.lz - 4 / 3 * np.pi * 50**3
    return scenes.gas(n=n, packing_fraction=n * np.pi / 6 / free, seed=1)


def main() -> None:
    """Measure, print, store."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="smaller systems, fewer repetitions")
    quick = parser.parse_args().quick
    sizes = [4000, 32000] if quick else [4000, 32000, 256000, 1_000_000]
    repetitions = 3 if quick else 5
    makers: list[tuple[str, Callable[[], Scene], int, float | None]] = [
        (
            f"fluid N={n} phi={phi}",
            lambda n=n, phi=phi: scenes.fluid(n=n, packing_fraction=phi, seed=1),
            min(max(10 * n, 200_000), 1_000_000),
            phi,
        )
        for n in sizes
        for phi in (0.05, 0.25, 0.49)
    ]
    makers += [
        ("giant among 10 000", lambda: giant(10_000), 50_000, None),
        ("the same without the giant", lambda: without_giant(10_000), 50_000, None),
    ]
    rows = []
    for name, maker, collisions, phi in makers:
        run = Run(name, maker(), collisions)
        for _ in range(repetitions):
            run.measure()
        if phi is not None:
            assert_rate(run, phi)
        rows.append(run.report())
        row = rows[-1]
        speed = row["million_collisions_per_second_median"]
        print(f"{name:32} {speed:8.3f} million collisions/s  {row['bytes_per_sphere']} B/sphere")
    RESULTS.mkdir(exist_ok=True)
    path = RESULTS / ("quick.json" if quick else "speed.json")
    machine = {"machine": platform.machine(), "python": platform.python_version()}
    path.write_text(json.dumps({"version": carom.__version__, **machine, "rows": rows}, indent=1))
    print(f"written to {path}")


if __name__ == "__main__":
    main()
