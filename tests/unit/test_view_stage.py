"""What pages can do to a simulation."""

import numpy as np
import pytest

import carom
from carom import scenes
from carom.errors import InputError, OverlapError, RunError
from carom.view.history import MOST, History, Mark
from carom.view.protocol import Command
from carom.view.stage import MOST_COMPARED, MOST_SPHERES, Stage


def opened(sim):
    return Stage(sim, stopping=lambda: False)


def act(stage, op, **values):
    stage.act(Command(op, values))


def play(stage, duration, slices=10):
    for _ in range(slices):
        stage.run(duration / slices, lambda sim: None)


def test_steps_back_show_the_moments_that_steps_showed():
    stage = opened(carom.Simulation(scenes.phase_4()))
    play(stage, 50)
    moments = []
    for _ in range(12):
        act(stage, "step")
        moments.append(stage.sim.state)
    for moment in reversed(moments[:-1]):
        act(stage, "back")
        now = stage.sim.state
        assert (now.time, now.collisions) == (moment.time, moment.collisions)
        assert np.array_equal(now.position, moment.position)
        assert np.array_equal(now.velocity, moment.velocity)


def test_back_ends_at_the_start():
    stage = opened(carom.Simulation(scenes.phase_3()))
    start = stage.sim.state
    play(stage, 60)
    assert stage.sim.collisions > 3
    for _ in range(stage.sim.collisions + 2):
        act(stage, "back")
    assert stage.sim.time == 0
    assert np.array_equal(stage.sim.position, start.position)


def test_back_from_between_two_collisions_goes_to_the_last_one():
    stage = opened(carom.Simulation(scenes.phase_3()))
    play(stage, 60)
    count = stage.sim.collisions
    act(stage, "back")
    assert stage.sim.collisions == count
    assert stage.sim.time == stage.sim.events[-1]["time"]


def test_back_undoes_changes_and_time_goes_on_as_before():
    stage = opened(carom.Simulation(scenes.phase_3()))
    play(stage, 40)
    act(stage, "step")
    act(stage, "reverse")
    act(stage, "gravity", value=(0.0, 0.0, -0.1))
    act(stage, "step")
    assert stage.reversed
    for _ in range(3):
        act(stage, "back")
    assert not stage.reversed
    assert stage.sim.gravity.tolist() == [0, 0, 0]
    plain = carom.Simulation(scenes.phase_3())
    plain.run(until=90)
    stage.sim.run(until=90)
    assert np.array_equal(stage.sim.position, plain.position)


def test_nothing_to_step_back_to():
    with pytest.raises(RunError, match="let time run first"):
        act(opened(carom.Simulation(scenes.phase_3())), "back")


def test_a_step_that_finds_nothing_ends():
    sim = carom.Simulation()
    sim.add((0, 0, 0), velocity=(-1, 0, 0))
    sim.add((5, 0, 0), velocity=(1, 0, 0))
    with pytest.raises(RunError, match="nothing will ever meet"):
        act(opened(sim), "step")


def test_a_step_that_searches_too_long_ends(monkeypatch):
    monkeypatch.setattr("carom.view.stage.SEARCH", 0.2)
    sim = carom.Simulation(walls=carom.Box(10, 10, 10))
    sim.add((0, 0, -3), velocity=(1, 0, 0))
    sim.add((0, 0, 3), velocity=(1, 0, 0))
    with pytest.raises(RunError, match=r"no collision came within 0\.2 seconds"):
        act(opened(sim), "step")


def test_where_spheres_pass_through_one_another_steps_go_to_walls():
    stage = opened(carom.Simulation(scenes.phase_0()))
    act(stage, "step")
    assert (stage.sim.wall_collisions, stage.event["j"]) == (1, -1)
    act(stage, "step")
    act(stage, "back")
    assert stage.sim.wall_collisions == 1


def test_reversed_time_leads_back_to_the_start():
    stage = opened(carom.Simulation(scenes.phase_4()))
    start = stage.sim.state
    play(stage, 40)
    act(stage, "reverse")
    assert stage.reversed
    play(stage, 40)
    assert np.allclose(stage.sim.position, start.position, atol=1e-9)


def test_restart_keeps_what_was_set():
    stage = opened(carom.Simulation(scenes.bounce()))
    act(stage, "gravity", value=(0.0, 1.0, -2.0))
    act(stage, "rule", restitution=0.25)
    act(stage, "walls", restitution=0.75)
    play(stage, 1)
    act(stage, "restart")
    assert stage.sim.time == 0
    settings = stage.settings()
    assert settings["gravity"] == [0, 1, -2]
    assert (settings["restitution"], settings["wall_restitution"]) == (0.25, 0.75)
    assert stage.epoch == 1


def test_inelastic_spheres_are_given_the_cure_of_collapse():
    stage = opened(carom.Simulation(scenes.gas(n=100)))
    act(stage, "rule", restitution=0.5)
    assert 0 < stage.sim.rule.contact_time < 0.1
    act(stage, "rule", restitution=1.0)
    assert stage.sim.rule == carom.Smooth()


def test_another_scene():
    stage = opened(carom.Simulation(scenes.phase_3()))
    act(stage, "scene", name="gas", options={"n": 50, "seed": 4})
    assert np.array_equal(stage.sim.position, scenes.gas(n=50, seed=4).spheres.position)
    assert (stage.key, stage.epoch) == (1, 1)
    act(stage, "scene", name="gas", options={"n": 60})
    assert (stage.key, len(stage.sim)) == (1, 60)  # the same scene: a page keeps its camera


@pytest.mark.parametrize(
    ("name", "options", "sentence"),
    [
        ("gass", {}, "did you mean 'gas'"),
        ("gas", {"m": 5}, "no option 'm'"),
        ("gas", {"n": "five"}, "n must be a number"),
        ("gas", {"n": -1}, "n is -1"),
        ("gas", {"n": MOST_SPHERES + 1}, "a page may ask for up to 200,000 spheres"),
        ("gas", {"packing_fraction": 5.0}, "packing_fraction is 5"),
    ],
)
def test_scenes_that_cannot_be_changes_nothing(name, options, sentence):
    stage = opened(carom.Simulation(scenes.phase_3()))
    before = stage.sim.state
    with pytest.raises(InputError, match=sentence):
        act(stage, "scene", name=name, options=options)
    assert np.array_equal(stage.sim.position, before.position)
    assert stage.epoch == 0


def test_balls_come_are_pushed_and_go():
    stage = opened(carom.Simulation(scenes.phase_3()))
    place = {"position": (240.0, 240.0, 240.0), "velocity": (-5.0, 0.0, 0.0), "radius": 5.0}
    act(stage, "add", **place, mass=2.0, color=0x123456)
    assert len(stage.sim) == 13
    assert stage.sim[12].velocity.tolist() == [-5, 0, 0]
    act(stage, "push", index=12, velocity=(0.0, -7.0, 0.0))
    assert stage.sim[12].velocity.tolist() == [0, -7, 0]
    act(stage, "remove", index=0)
    assert (len(stage.sim), stage.sim[11].color) == (12, 0x123456)
    assert stage.epoch == 3
    with pytest.raises(OverlapError, match="wall"):
        act(stage, "add", **{**place, "radius": 50.0}, mass=1.0, color=0)
    with pytest.raises(InputError, match="there is no sphere 12"):
        act(stage, "push", index=12, velocity=(0.0, 0.0, 0.0))
    assert (len(stage.sim), stage.epoch) == (12, 3)


def test_the_last_ball_stays():
    sim = carom.Simulation()
    sim.add((0, 0, 0))
    with pytest.raises(InputError, match="last sphere"):
        act(opened(sim), "remove", index=0)


def test_the_ticks_start_where_the_exact_motion_starts():
    stage = opened(carom.Simulation(scenes.phase_4()))
    start = stage.sim.state
    play(stage, 30)
    act(stage, "compare", on=True)
    exact, ticks = stage.shown
    assert np.array_equal(exact.position, start.position)
    assert np.array_equal(ticks.position, start.position)
    assert stage.settings()["tick"] == 1
    play(stage, 400, slices=333)
    assert 0 <= exact.time - ticks.time <= ticks.tick
    whole = carom.Simulation(scenes.phase_4()).in_ticks()
    whole.run(until=400)
    assert np.array_equal(ticks.position, whole.position)
    assert abs(exact.energy_drift) < 1e-13
    assert ticks.missed > 0
    act(stage, "step")
    act(stage, "back")
    assert 0 <= stage.sim.time - stage.twin.time <= 1
    with pytest.raises(InputError, match="leave the comparison"):
        act(stage, "remove", index=0)
    act(stage, "compare", on=False)
    assert stage.shown == (stage.sim,)


def test_too_many_spheres_to_compare():
    stage = opened(carom.Simulation(scenes.gas(n=MOST_COMPARED + 1)))
    with pytest.raises(InputError, match="up to 500: take fewer"):
        act(stage, "compare", on=True)


def test_history_keeps_the_first_and_the_newest_densest():
    history = History()
    for count in range(10 * MOST):
        history.keep(Mark(count, False, ()))
    counts = [mark.count for mark in history._marks]
    assert len(counts) == MOST
    assert counts[0] == 0
    assert counts[-8:] == list(range(10 * MOST - 8, 10 * MOST))
    assert max(np.diff(counts)) < 3 * MOST
    assert history.before(10 * MOST - 3).count == 10 * MOST - 4
    assert history.before(0).count == 0


def test_history_keeps_within_its_memory(monkeypatch):
    monkeypatch.setattr("carom.view.history.BYTES", 1000)

    class Bookmark:
        nbytes = 300

    history = History()
    for count in range(20):
        history.keep(Mark(count, False, (Bookmark(),)))
    assert [mark.count for mark in history._marks][::2] == [0, 19]
    assert len(history._marks) == 3
