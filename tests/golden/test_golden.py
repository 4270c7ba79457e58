"""Both exact engines follow event sequences computed with 400-bit arithmetic."""

import csv
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from carom.engine import Engine, FastEngine, Stop
from carom.reference.exact import ExactEngine
from carom.state import State
from carom.world import PLANE, SPHERE, WALL, World

DATA = Path(__file__).parent / "data"
ENGINES = [FastEngine, ExactEngine]


def rows(name):
    with (DATA / f"{name}.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def columns(table, *names):
    return np.array([[float(row[name]) for name in names] for row in table])


def cube(side, restitution):
    """The six planes of a box, in the order of a hard box's walls."""
    normals = [[s * (k == axis) for k in range(3)] for axis in range(3) for s in (1, -1)]
    return np.array([(PLANE, 0, n, -side / 2, restitution) for n in normals], WALL)


def container(radius):
    return np.array([(SPHERE, 0, (0, 0, 0), radius, 1.0)], WALL)


DOWN = np.array([0.0, 0.0, -1.0])


@dataclass(frozen=True)
class Case:
    """A golden system: its files, its world, and the events a double program must follow."""

    name: str
    world: World
    least: int
    corner: float = 0.0  #: golden boxes begin at 0, those of carom are centred on it

    def state(self):
        table = rows(f"{self.name}_init")
        state = State.empty(len(table))
        state.position[:] = columns(table, "x", "y", "z") - self.corner
        state.velocity[:] = columns(table, "vx", "vy", "vz")
        state.radius[:] = columns(table, "radius")[:, 0]
        state.mass[:] = columns(table, "mass")[:, 0]
        return state

    def events(self):
        """(i, j as in carom's records, time, error of plain doubles there) of each event."""
        return [
            (
                int(row["i"]),
                int(row["j_or_wall"]) if row["type"] == "P" else -1 - int(row["j_or_wall"]),
                float(row["time"]),
                float(row["err_double"]),
            )
            for row in rows(f"{self.name}_events")
        ]


L1, L2 = 4.238790704456325, 3.4363714981989077
CASES = [
    Case("G1_pbc_mono", World(period=np.full(3, L1)), 450, L1 / 2),
    Case("G2_pbc_binary_inelastic", World(period=np.full(3, L2), restitution=0.9), 330, L2 / 2),
    Case(
        "G3_box_gravity",
        World(walls=cube(6.0, 0.9), restitution=0.95, gravity=DOWN),
        370,
        3.0,
    ),
    Case("G4_sphere", World(walls=container(2.5)), 380),
    Case("G5_sphere_gravity", World(walls=container(2.5), gravity=DOWN), 205),
]


def run_events(engine: Engine, count: int):
    """Exactly `count` events more."""
    done = engine.collisions + engine.wall_collisions + count
    while (left := done - engine.collisions - engine.wall_collisions) > 0:
        assert engine.advance(math.inf, max_events=left) in (Stop.COUNT, Stop.SLICE)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
@pytest.mark.parametrize("make", ENGINES)
def test_events_are_those_of_400_bit_arithmetic(make, case):
    expected = case.events()
    engine = make(case.state(), case.world)
    run_events(engine, len(expected))
    followed = 0
    for record, (i, j, time, error) in zip(engine.take_events(), expected, strict=True):
        if (record["i"], record["j"]) != (i, j):
            break
        if abs(record["time"] - time) > 1e3 * error + 1e-12:
            break
        followed += 1
    assert followed >= case.least


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
@pytest.mark.parametrize("make", ENGINES)
def test_states_between_are_those_of_400_bit_arithmetic(make, case):
    errors = [error for _, _, _, error in case.events()]
    table = rows(f"{case.name}_snap")
    engine = make(case.state(), case.world)
    done = 0
    for event in sorted({int(row["event"]) for row in table}):
        run_events(engine, event - done)
        done = event
        snapshot = [row for row in table if int(row["event"]) == event]
        state = engine.state()
        # The error doubles every few events; a sphere's is larger than that of the event times.
        tolerance = 1e3 * max(errors[:event]) + 1e-12
        unwrapped = state.position + state.image * case.world.period + case.corner
        assert state.time == pytest.approx(float(snapshot[0]["time"]), abs=tolerance)
        assert np.abs(unwrapped - columns(snapshot, "x", "y", "z")).max() < tolerance
        assert np.abs(state.velocity - columns(snapshot, "vx", "vy", "vz")).max() < tolerance
