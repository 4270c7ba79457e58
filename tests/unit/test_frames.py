"""Frames at exact times, and those who follow a motion through its runs."""

import itertools
import math

import numpy as np
import pytest

import carom
from carom.errors import InputError
from carom.state import State


class Diary:
    """A follower that writes down what it is told."""

    takes_events = True

    def __init__(self, every=math.inf):
        self.every, self.told, self.records = every, [], []

    @property
    def due(self):
        return (1 + sum(words[0] == "look" for words in self.told)) * self.every

    def begin(self, moment):
        self.told.append(("begin", moment.time))

    def events(self, records):
        self.records.append(records)

    def moment(self, moment):
        if moment.time >= self.due:
            self.told.append(("look", moment.time))

    def end(self, moment):
        self.told.append(("end", moment.time))

    def cut(self, moment):
        self.told.append(("cut", moment.time, len(moment.state)))

    def close(self, moment):
        self.told.append(("close", moment.time))


def test_frames_are_at_exactly_the_times_of_a_run_and_change_no_bit():
    sim, plain = (carom.Simulation(carom.scenes.gas(n=50, seed=3)) for _ in range(2))
    frames = list(sim.frames(every=0.1, until=1.0))
    assert [f.time for f in frames] == [min(k * 0.1, 1.0) for k in range(11)]
    for frame in frames:
        plain.run(until=frame.time)
        assert np.array_equal(frame.position, plain.position)
        assert np.array_equal(frame.velocity, plain.velocity)
        assert frame.collisions == plain.collisions
        assert frame.kinetic_energy == plain.kinetic_energy
        assert frame.energy_drift == plain.energy_drift
        assert frame.max_overlap == plain.max_overlap
    assert frames[-1].time == 1.0  # 10 * 0.1, not 0.9999...


def test_a_frame_says_what_the_simulation_says():
    scene = carom.scenes.bounce()
    sim = carom.Simulation(scene)
    (frame,) = sim.frames(at=[1.5])
    for name in (
        "position", "unwrapped_position", "velocity", "mass", "radius", "color", "species", "fixed",
        "resting", "collision_count", "time", "collisions", "wall_collisions", "walls", "rule",
        "gravity", "collide", "kinetic_energy", "potential_energy", "momentum", "temperature",
        "dissipated", "withheld", "max_overlap", "energy_drift", "missed", "packing_fraction",
    ):  # fmt: skip
        np.testing.assert_array_equal(getattr(frame, name), getattr(sim, name), err_msg=name)
    assert len(frame) == len(sim)
    assert isinstance(frame.state, State)
    assert frame.world.restitution == sim.world.restitution
    with pytest.raises(ValueError, match="read-only"):
        frame.position[0] = 0
    with pytest.raises(ValueError, match="read-only"):
        frame.state.velocity[0] = 0
    assert repr(frame).startswith(f"<Frame: {len(sim)} spheres, time 1.5")


def test_frames_go_on_from_now_without_end_and_see_changes_between_them():
    sim = carom.Simulation()
    ball = sim.add(velocity=(1, 0, 0))
    sim.run(until=1)
    times = []
    for frame in itertools.islice(sim.frames(every=0.5), 4):
        times.append(frame.position[0, 0])
        ball.velocity = (2, 0, 0)
    assert times == [1.0, 2.0, 3.0, 4.0]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "exactly one of them"),
        ({"every": 1, "at": [1]}, "exactly one of them"),
        ({"every": 0}, "every is 0; it must be more than 0"),
        (
            {"every": 1e-300, "until": 1},
            r"every=1e-300 makes 1.0e\+300 frames until 1, and at most",
        ),
        ({"every": 1, "until": math.nan}, "until is nan"),
        ({"at": [1, 0.5]}, "rising times, but 0.5 comes after 1"),
        ({"at": [math.inf]}, "a time of at is inf"),
    ],
)
def test_wrong_times_of_frames(options, message):
    sim = carom.Simulation(carom.scenes.two_balls())
    with pytest.raises(InputError, match=message):
        list(sim.frames(**options))


def test_given_times_end_at_until():
    sim = carom.Simulation(carom.scenes.two_balls())
    assert [f.time for f in sim.frames(at=itertools.count(), until=2.5)] == [0, 1, 2]


def test_a_follower_hears_of_all_runs_and_changes_and_leaves_no_trace():
    followed, plain = (
        carom.Simulation(carom.scenes.gas(n=40, seed=2), keep_events=0) for _ in range(2)
    )
    diary = Diary(every=0.25)
    followed._motion.followers.append(diary)
    for sim in (followed, plain):
        sim.run(until=0.6)
        sim.velocity = -sim.velocity
        sim.gravity = (0, 0, -1)
        sim.run(collisions=30)
    assert np.array_equal(followed.position, plain.position)
    end = followed.time
    followed.reset()
    followed.close()
    followed.run(until=0.1)  # nobody follows any more
    n = len(followed)
    looks = [("look", 0.25 * k) for k in range(1, 1 + int(end / 0.25))]
    assert diary.told == [
        ("begin", 0.0), *looks[:2], ("end", 0.6), ("cut", 0.6, n), ("cut", 0.6, n), ("begin", 0.6),
        *looks[2:], ("end", end), ("cut", end, n), ("close", 0.0),
    ]  # fmt: skip
    records = np.concatenate(diary.records)
    assert (np.diff(records["time"]) >= 0).all()
    assert (records["j"] >= 0).sum() == plain.collisions
    assert records["time"][-1] == end


def test_a_count_ends_where_nothing_will_ever_meet_again_though_somebody_looks():
    sim = carom.Simulation()
    sim.add(position=(-2, 0, 0), velocity=(1, 0, 0))
    sim.add(position=(2, 0, 0))
    sim._motion.followers.append(Diary(every=1.0))
    with pytest.raises(carom.RunError, match="only 1 of 5"):
        sim.run(collisions=5)


def test_bookmarks_cut_too():
    sim = carom.Simulation(carom.scenes.two_balls())
    diary = Diary()
    sim.run(until=1)
    mark = sim.bookmark()
    sim._motion.followers.append(diary)
    sim.run(until=2)
    sim.return_to(mark)
    assert diary.told[-1] == ("cut", 2.0, 2)
