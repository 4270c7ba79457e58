"""The thread that lets the simulation run for the view."""

import time
from itertools import pairwise

import numpy as np
import pytest

import carom
from carom import scenes
from carom.errors import CollapseError
from carom.view.driver import PATIENCE, Driver, Pacer
from carom.view.protocol import FRAME_HEADER


class Watcher:
    """A page that takes every snapshot."""

    def __init__(self, sim, watched=True):
        self.snapshots = []
        self.there = watched
        self.driver = Driver(
            sim, self.snapshots.append, hungry=lambda: self.there, watched=lambda: self.there
        )

    def __enter__(self):
        self.driver.start()
        return self

    def __exit__(self, *_):
        self.driver.stop()

    def wait_for(self, condition, seconds=5.0):
        end = time.perf_counter() + seconds
        while time.perf_counter() < end:
            if self.snapshots and condition(self.head()):
                return self.head()
            time.sleep(0.005)
        pytest.fail(f"it did not happen; the last frame was {self.snapshots and self.head()}")

    def head(self):
        fields = FRAME_HEADER.unpack_from(self.snapshots[-1].frame)
        names = [
            *("magic", "version", "kind", "n", "epoch", "flags", "scene", "t", "clock"),
            *("gx", "gy", "gz", "kinetic", "potential", "dissipated", "drift"),
            *("collisions", "wall_collisions", "speed", "reached"),
        ]
        return dict(zip(names, fields, strict=True))


class Stub:
    """Counts time only; `cost` seconds of sleep per simulated second."""

    def __init__(self, cost=0.0, error=None):
        real = carom.Simulation(scenes.two_balls())
        self.scene, self.state, self.world, self.pace = real.scene, real.state, real.world, 1.0
        self.kinetic_energy = self.potential_energy = self.dissipated = self.energy_drift = 0.0
        self.cost, self.error = cost, error
        self.time = 0.0

    def run(self, *, duration, progress):
        if self.error is not None and duration > 0:
            raise self.error
        end = self.time + duration
        while self.time < end:
            step = min(0.05 / self.cost if self.cost else duration, end - self.time)
            time.sleep(step * self.cost)
            self.time += step
            self.state.time = self.time
            progress(self)

    def reset(self):
        self.time = self.state.time = 0.0


def test_runs_at_the_pace_of_the_scene():
    sim = carom.Simulation(scenes.two_balls())
    with Watcher(sim) as page:
        page.wait_for(lambda head: head["t"] > 0.2)
        first = page.head()
        time.sleep(0.5)
        last = page.head()
    rate = (last["t"] - first["t"]) / (last["clock"] - first["clock"])
    assert rate == pytest.approx(sim.pace, rel=0.15)


def test_frames_hold_the_exact_state():
    sim = carom.Simulation(scenes.two_balls())
    with Watcher(sim) as page:
        page.wait_for(lambda head: head["t"] > 0.1)
        page.driver.order("playing", 0.0)
        head = page.wait_for(lambda head: head["flags"] == 0)
    assert head["t"] == sim.time
    assert head["kinetic"] == sim.kinetic_energy
    body = np.frombuffer(page.snapshots[-1].frame, "<f4", 6, FRAME_HEADER.size)
    assert body == pytest.approx(sim.position.ravel(), rel=1e-6)


def test_pause_and_play():
    sim = carom.Simulation(scenes.two_balls())
    with Watcher(sim) as page:
        page.wait_for(lambda head: head["t"] > 0)
        page.driver.order("playing", 0.0)
        page.wait_for(lambda head: head["flags"] == 0)
        before, frames = sim.time, len(page.snapshots)
        time.sleep(0.2)
        assert sim.time == before
        assert len(page.snapshots) == frames
        page.driver.order("playing", 1.0)
        page.wait_for(lambda head: head["t"] > before)


def test_restart_goes_back_to_the_same_start():
    sim = carom.Simulation(scenes.phase_3())
    start = sim.position.copy()
    with Watcher(sim) as page:
        page.wait_for(lambda head: head["collisions"] > 0)
        page.driver.order("playing", 0.0)
        page.driver.order("restart", 1.0)
        head = page.wait_for(lambda head: head["epoch"] == 1)
    assert (head["t"], head["collisions"], head["flags"]) == (0.0, 0.0, 0)
    assert np.array_equal(sim.position, start)


def test_speed():
    with Watcher(carom.Simulation(scenes.two_balls())) as page:
        page.driver.order("speed", 0.01)
        page.wait_for(lambda head: head["speed"] == 0.01)
        first = page.head()
        time.sleep(0.4)
        last = page.head()
    rate = (last["t"] - first["t"]) / (last["clock"] - first["clock"])
    assert rate == pytest.approx(0.015, rel=0.2)


def test_waits_while_nobody_watches():
    sim = carom.Simulation(scenes.two_balls())
    with Watcher(sim, watched=False) as page:
        time.sleep(0.15)
        assert sim.time == 0
        page.there = True
        page.driver.poke()
        page.wait_for(lambda head: head["t"] > 0)


def test_an_engine_that_cannot_keep_up_lags_and_still_obeys_at_once():
    sim = Stub(cost=20.0)
    with Watcher(sim) as page:
        time.sleep(0.8)
        assert page.head()["reached"] < 0.2
        asked = time.perf_counter()
        page.driver.order("playing", 0.0)
        page.wait_for(lambda head: head["flags"] == 0)
        assert time.perf_counter() - asked < 0.05 + 2 * PATIENCE


def test_a_collapse_is_told_and_a_restart_forgets_it():
    sim = Stub(error=CollapseError("spheres 0 and 1 collapse"))
    with Watcher(sim) as page:
        page.wait_for(lambda head: head["flags"] == 2)
        assert page.snapshots[-1].failure == "spheres 0 and 1 collapse"
        page.driver.order("playing", 1.0)
        time.sleep(0.05)
        assert page.head()["flags"] == 2
        sim.error = None
        page.driver.order("restart", 1.0)
        page.wait_for(lambda head: head["flags"] == 1)
        assert page.snapshots[-1].failure == ""


def test_other_errors_end_the_thread_and_are_kept():
    with Watcher(Stub(error=ZeroDivisionError("a bug"))) as page:
        page.driver._thread.join(5)
        assert isinstance(page.driver.error, ZeroDivisionError)


def test_pacer_approaches_its_goal_in_steps_and_keeps_the_budget():
    pacer = Pacer()
    steps = []
    for _ in range(20):
        steps.append(pacer.allow(1.0))
        pacer.learn(steps[-1], 1e-4 + 0.02 * steps[-1], budget=0.01)
    assert all(b <= 16 * a for a, b in pairwise(steps))
    assert max(steps) <= 1
    assert sum(steps[-4:]) / 4 == pytest.approx(0.5, abs=0.2)


def test_pacer_is_not_misled_by_what_a_call_costs_in_slow_motion():
    pacer = Pacer()
    for wanted in [1e-6] * 10 + [1.0] * 24:
        step = pacer.allow(wanted)
        assert step <= wanted
        pacer.learn(step, 1e-3, budget=0.01)
    assert step == 1.0
