"""What pages can do to a simulation."""

import threading
import time

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
    counts = [mark.count for _, mark in history._marks]
    assert len(counts) == MOST
    assert counts[0] == 0
    assert counts[-8:] == list(range(10 * MOST - 8, 10 * MOST))
    assert max(np.diff(counts)) < 3 * MOST
    mark, further = history.before(10 * MOST - 3)
    assert (mark.count, further) == (10 * MOST - 4, 1)
    mark, further = history.before(0)
    assert (mark.count, further) == (0, 0)


def test_history_leads_to_the_end_of_a_stretch_before_a_change():
    history = History()
    history.keep(Mark(0, False, ()))
    history.keep(Mark(40, False, ()))
    history.turn(50)  # say one of two spheres was taken away: now hits of the wall are counted
    history.keep(Mark(7, False, ()))
    mark, further = history.before(9)
    assert (mark.count, further) == (7, 2)
    mark, further = history.before(7)
    assert (mark.count, further) == (40, 10)
    mark, further = history.before(49)
    assert (mark.count, further) == (40, 9)


def test_history_keeps_within_its_memory(monkeypatch):
    monkeypatch.setattr("carom.view.history.BYTES", 1000)

    class Bookmark:
        nbytes = 300

    history = History()
    for count in range(20):
        history.keep(Mark(count, False, (Bookmark(),)))
    assert [mark.count for _, mark in history._marks][::2] == [0, 19]
    assert len(history._marks) == 3


def test_back_does_not_replay_across_a_change():
    """The mark before a change leads only as far as the change; time never goes forward."""
    stage = opened(carom.Simulation(scenes.phase_3()))
    play(stage, 60)
    act(stage, "reverse")
    play(stage, 30)
    after = stage.sim.collisions
    moments = []
    for _ in range(3):
        act(stage, "step")
        moments.append(stage.sim.state)
    assert stage.sim.collisions == after + 3
    for moment in reversed(moments[:-1]):
        act(stage, "back")
        assert np.array_equal(stage.sim.position, moment.position)
    while stage.reversed:
        before = stage.sim.time
        act(stage, "back")
        assert stage.sim.time < before
    plain = carom.Simulation(scenes.phase_3())
    plain.run(collisions=stage.sim.collisions)
    assert np.array_equal(stage.sim.position, plain.position)


def test_back_where_one_of_two_balls_was_taken_away():
    """Of one ball alone, hits of walls are counted; the two counts are not mixed up."""
    sim = carom.Simulation(walls=carom.Box(4, 4, 4))
    sim.add((-1, 0, 0), velocity=(1, 0, 0))
    sim.add((1, 0, 0), velocity=(-1, 0.1, 0))
    stage = opened(sim)
    play(stage, 100)
    act(stage, "remove", index=0)
    play(stage, 20)
    times = [stage.sim.time]
    while times[-1] > 90:
        act(stage, "back")
        times.append(stage.sim.time)
        assert times[-1] < times[-2]
    assert len(stage.sim) == 2


def test_back_in_ticks_leaves_the_tick_whatever_it_holds():
    stage = opened(carom.Simulation(scenes.phase_4(n=40), method="tick"))
    play(stage, 30.5, slices=37)
    assert stage.sim.time == 30  # whole ticks only, however the time is cut
    act(stage, "back")  # to the collisions of the last tick that had some
    for _ in range(20):
        before = stage.sim.time
        act(stage, "back")
        assert stage.sim.time < before
    whole = carom.Simulation(scenes.phase_4(n=40), method="tick")
    whole.run(until=stage.sim.time)
    assert np.array_equal(whole.position, stage.sim.position)


def test_ticks_beside_do_not_hold_up_a_step_that_finds_nothing(monkeypatch):
    monkeypatch.setattr("carom.view.stage.SEARCH", 0.2)
    sim = carom.Simulation(walls=carom.Box(10, 10, 10))
    sim.add((0, 0, -3), velocity=(1, 0, 0))
    sim.add((0, 0, 3), velocity=(1, 0, 0))
    stage = opened(sim)
    act(stage, "compare", on=True)
    with pytest.raises(RunError, match="no collision came"):
        act(stage, "step")
    assert (stage.sim.time, stage.twin.time) == (0, 0)


def test_in_ticks_other_ticks_are_refused():
    stage = opened(carom.Simulation(scenes.phase_4(), method="tick"))
    act(stage, "scene", name="phase-3", options={})
    with pytest.raises(InputError, match=r"carom show bounce --method tick"):
        act(stage, "scene", name="bounce", options={})
    with pytest.raises(InputError, match="goes in ticks already"):
        act(stage, "compare", on=True)


def test_the_contact_time_of_a_bare_simulation_stays():
    sim = carom.Simulation(rule=carom.Smooth(0.9, contact_time=0.125))
    sim.add((0, 0, 0))
    stage = opened(sim)
    act(stage, "rule", restitution=1.0)
    act(stage, "rule", restitution=0.5)
    assert sim.rule == carom.Smooth(0.5, contact_time=0.125)


def test_no_gas_law_where_collisions_take_energy():
    stage = opened(carom.Simulation(scenes.gas(n=100)))
    assert stage.pressure.theory(1.0) > 0
    act(stage, "walls", restitution=0.5)
    assert stage.pressure.theory(1.0) is None
    act(stage, "walls", restitution=1.0)
    act(stage, "rule", restitution=0.5)
    assert stage.pressure.theory(1.0) is None


def test_a_scene_that_takes_too_long_is_given_up(monkeypatch):
    def slow(name, options):
        while True:
            time.sleep(0.01)

    monkeypatch.setattr("carom.view.builder.scenes.build", slow)
    monkeypatch.setattr("carom.view.builder.PATIENCE", 0.1)
    stopping = []
    stage = Stage(carom.Simulation(scenes.phase_3()), stopping=lambda: bool(stopping))
    with pytest.raises(InputError, match=r"gas takes longer than 0\.1 seconds to build"):
        act(stage, "scene", name="gas", options={})
    assert not stage._builder._thread.is_alive()
    stopping.append(True)
    with pytest.raises(RunError, match="closing"):
        act(stage, "scene", name="gas", options={})
    assert not stage._builder._thread.is_alive()
    assert len(stage.sim) == 12


def test_while_a_scene_cannot_be_given_up_no_other_is_built(monkeypatch):
    go = threading.Event()
    monkeypatch.setattr("carom.view.builder.scenes.build", lambda *_: go.wait(10))
    monkeypatch.setattr("carom.view.builder.PATIENCE", 0.1)
    stage = opened(carom.Simulation(scenes.phase_3()))
    with pytest.raises(InputError, match="takes longer"):
        act(stage, "scene", name="gas", options={})
    with pytest.raises(InputError, match="still being built"):
        act(stage, "scene", name="gas", options={})
    go.set()
    stage._builder._thread.join(5)
    assert len(stage.sim) == 12
