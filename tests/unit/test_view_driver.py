"""The thread that lets the simulation run for the view."""

import json
import time
from itertools import pairwise

import numpy as np
import pytest

import carom
from carom import scenes
from carom.errors import CollapseError
from carom.view.driver import PATIENCE, Driver, Pacer
from carom.view.protocol import Command
from carom.view.wire import FRAME_HEADER, HEADER, METERS


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
        fields = FRAME_HEADER.unpack_from(self.snapshots[-1].frames[0])
        names = [*(name for name, _ in HEADER), *METERS]
        return dict(zip(names, fields, strict=True))

    def note(self, key):
        return json.loads(self.snapshots[-1].notes[key][1])[key]

    def order(self, op, **values):
        answers = []
        self.driver.order(Command(op, values), answers.append)
        return answers


class Stub:
    """Counts time only; `cost` seconds of sleep per simulated second."""

    def __init__(self, cost=0.0, error=None):
        self._real = carom.Simulation(scenes.two_balls())
        self.state, self.pace = self._real.state, 1.0
        self.cost, self.error = cost, error
        self.time = 0.0

    def __getattr__(self, name):
        return getattr(self._real, name)

    def __len__(self):
        return len(self._real)

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
        page.order("pause")
        head = page.wait_for(lambda head: head["flags"] == 0)
    assert head["t"] == sim.time
    assert head["kinetic"] == sim.kinetic_energy
    body = np.frombuffer(page.snapshots[-1].frames[0], "<f4", 6, FRAME_HEADER.size)
    assert body == pytest.approx(sim.position.ravel(), rel=1e-6)


def test_pause_and_play():
    sim = carom.Simulation(scenes.two_balls())
    with Watcher(sim) as page:
        page.wait_for(lambda head: head["t"] > 0)
        page.order("pause")
        page.wait_for(lambda head: head["flags"] == 0)
        before, frames = sim.time, len(page.snapshots)
        time.sleep(0.2)
        assert sim.time == before
        assert len(page.snapshots) == frames
        page.order("play")
        page.wait_for(lambda head: head["t"] > before)


def test_restart_goes_back_to_the_same_start():
    sim = carom.Simulation(scenes.phase_3())
    start = sim.position.copy()
    with Watcher(sim) as page:
        page.wait_for(lambda head: head["collisions"] > 0)
        page.order("restart")
        page.order("pause")
        head = page.wait_for(lambda head: head["epoch"] == 1)
    assert (head["t"], head["collisions"], head["flags"]) == (0.0, 0.0, 0)
    assert np.array_equal(sim.position, start)


def test_speed():
    with Watcher(carom.Simulation(scenes.two_balls())) as page:
        page.order("speed", value=0.01)
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
        page.order("pause")
        page.wait_for(lambda head: head["flags"] == 0)
        assert time.perf_counter() - asked < 0.05 + 2 * PATIENCE


def test_a_collapse_is_told_and_a_restart_forgets_it():
    sim = Stub(error=CollapseError("spheres 0 and 1 collapse"))
    with Watcher(sim) as page:
        page.wait_for(lambda head: head["flags"] == 2)
        assert page.note("failure") == "Spheres 0 and 1 collapse."
        page.order("play")
        time.sleep(0.05)
        assert page.head()["flags"] == 2
        sim.error = None
        page.order("restart")
        page.wait_for(lambda head: head["flags"] == 1)
        assert page.note("failure") == ""


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


def test_a_step_pauses_at_the_next_collision_and_says_which():
    sim = carom.Simulation(scenes.phase_3())
    with Watcher(sim) as page:
        page.wait_for(lambda head: head["t"] > 0)
        page.order("step")
        head = page.wait_for(lambda head: head["flags"] == 0)
        event = page.note("event")
        assert head["t"] == event["t"] == sim.time
        assert (event["i"], event["j"]) == tuple(sim.events[-1][["i", "j"]])
        assert np.allclose(event["impulse"], sim.events[-1]["impulse"])
        before = sim.collisions
        page.order("step")
        page.wait_for(lambda head: head["collisions"] == before + 1)
        assert page.note("event")["serial"] == event["serial"] + 1


def test_what_cannot_be_done_is_answered_in_a_sentence_and_time_runs_on():
    with Watcher(carom.Simulation(scenes.phase_3())) as page:
        page.wait_for(lambda head: head["t"] > 0)
        answers = page.order("remove", index=12)
        before = page.wait_for(lambda head: answers)["t"]
        assert json.loads(answers[0]) == {
            "refused": "There is no sphere 12; there are 12, counted from 0."
        }
        assert page.wait_for(lambda head: head["t"] > before)["flags"] == 1


def test_of_many_wishes_of_a_slider_the_last_counts():
    sim = carom.Simulation(scenes.phase_3())
    with Watcher(sim) as page:
        page.wait_for(lambda head: head["t"] > 0)
        for k in range(200):
            page.order("gravity", value=(0.0, 0.0, -k / 100))
        page.wait_for(lambda head: head["gravity_z"] == -1.99)
    assert page.note("settings")["gravity"] == [0, 0, -1.99]


def test_the_twin_follows_tick_by_tick():
    sim = carom.Simulation(scenes.phase_3())
    with Watcher(sim) as page:
        page.wait_for(lambda head: head["t"] > 20)
        page.order("compare", on=True)
        page.wait_for(lambda head: len(page.snapshots[-1].frames) == 2 and head["t"] > 100)
        exact, ticks = (FRAME_HEADER.unpack_from(f) for f in page.snapshots[-1].frames)
        names = [*(name for name, _ in HEADER), *METERS]
        exact, ticks = (dict(zip(names, frame, strict=True)) for frame in (exact, ticks))
        assert 0 <= exact["t"] - ticks["t"] <= 1  # the last whole tick
        assert (exact["flags"], ticks["flags"]) == (1, 5)
        assert exact["epoch"] == ticks["epoch"]
        page.wait_for(lambda head: head["collisions"] > 30)
        assert FRAME_HEADER.unpack_from(page.snapshots[-1].frames[1])[7 + METERS.index("missed")]
        page.order("compare", on=False)
        page.wait_for(lambda head: len(page.snapshots[-1].frames) == 1)


def test_what_cures_a_collapse_lets_time_be_played_on():
    sim = Stub(error=CollapseError("spheres 0 and 1 collapse"))
    with Watcher(sim) as page:
        page.wait_for(lambda head: head["flags"] == 2)
        sim.error = None
        page.order("gravity", value=(0.0, 0.0, 0.0))
        page.wait_for(lambda head: head["flags"] == 0)
        page.order("play")
        page.wait_for(lambda head: head["flags"] == 1)


@pytest.mark.parametrize("where", ["scenes.build", "Simulation.reset", "Simulation.run"])
def test_too_little_memory_is_told_and_ends_nothing(monkeypatch, where):
    sim = carom.Simulation(scenes.two_balls())
    with Watcher(sim) as page:
        page.wait_for(lambda head: head["t"] > 0)

        def full(*_, **__):
            raise MemoryError

        monkeypatch.setattr(f"carom.{where}", full)
        answers = page.order("scene", name="gas", options={})
        failed = where == "Simulation.run"
        page.wait_for(lambda head: page.note("failure") if failed else answers)
        said = page.note("failure") if failed else json.loads(answers[0])["refused"]
        assert said.startswith("There is not enough memory")
        monkeypatch.undo()
        page.order("restart")
        page.wait_for(lambda head: head["flags"] == 1)
        assert page.note("failure") == ""


def test_an_empty_simulation_waits_for_its_first_ball():
    with Watcher(carom.Simulation()) as page:
        page.wait_for(lambda head: head["n"] == 0 and head["flags"] == 1)
        ball = {"position": (0.0, 0.0, 0.0), "velocity": (1.0, 0.0, 0.0), "radius": 0.5}
        page.order("add", **ball, mass=1.0, color=0)
        page.wait_for(lambda head: head["t"] > 0)
        assert page.note("failure") == ""
