"""What a run shows to those who observe it, and that they leave no trace."""

import math
from dataclasses import fields
from itertools import pairwise

import numpy as np
import pytest

import carom
from carom import observe
from carom.engine import FastEngine
from carom.observe import Observable, sampled
from carom.observe.feed import BATCH

from .gases import each_method


class Diary(Observable):
    """Writes down all it is told."""

    def __init__(self, schedule=None):
        self.schedule = schedule
        self.told = []

    def begin(self, moment):
        self.told.append(("begin", moment.time))

    def events(self, batch):
        assert (np.diff(batch.time, prepend=batch.start, append=batch.end) >= 0).all()
        assert len(batch.spheres.mass) > 0
        self.told.append(("events", batch.start, batch.end, batch.records.copy()))

    def sample(self, moment):
        assert moment.state.time == moment.time
        self.told.append(("sample", moment.time))

    def end(self, moment):
        self.told.append(("end", moment.time))

    def of(self, what):
        return [words[1:] for words in self.told if words[0] == what]

    @property
    def records(self):
        return np.concatenate([records for _, _, records in self.of("events")])


@observe.observable
def heights(state):
    """Mean height."""
    return state.position[:, 2].mean()


@observe.observable
def virial(batch):
    """Sum of |J| sigma."""
    return batch.size * 2 * batch.spheres.radius[batch.i]


def gas(n=300, **options):
    return carom.Simulation(carom.scenes.gas(n=n), **options)


def same(a, b):
    for field in fields(a):
        one, other = getattr(a, field.name), getattr(b, field.name)
        assert np.array_equal(one, other), field.name


@each_method
@pytest.mark.parametrize("keep", [0, 1_000_000])
def test_observing_changes_no_bit(method, keep):
    options = {"method": method, "keep_events": keep, "tick": 0.01}
    n = 20 if method == "reference" else 300
    alone, seen = gas(n, **options), gas(n, **options)
    for sim in (alone, seen):
        sim.run(events=100)  # an engine without a log is under way
    whole = [virial(), heights(every=0.013), Diary(), heights(at=[0.0, 0.05])]
    alone.run(duration=0.5)
    seen.run(duration=0.5, observe=whole)
    same(alone.state, seen.state)
    assert (alone.events == seen.events).all()
    for sim in (alone, seen):
        sim.run(events=200)
    same(alone.state, seen.state)
    assert alone.dissipated == seen.dissipated
    assert whole[1].samples == math.floor(0.5 / 0.013)


def test_all_events_come_once_in_batches_of_a_fixed_size():
    sim, diary = gas(), Diary()
    sim.run(events=3 * BATCH + 7, observe=diary)
    assert (diary.records == sim.events).all()
    stretches = [(start, end) for start, end, _ in diary.of("events")]
    assert [len(records) for _, _, records in diary.of("events")] == [BATCH] * 3 + [7]
    assert stretches[0][0] == 0
    assert stretches[-1][1] == sim.time
    assert all(a[1] == b[0] for a, b in pairwise(stretches))
    assert diary.told[-1] == ("end", sim.time)


def test_samples_come_exactly_at_their_times_after_the_events_before_them():
    sim = gas()
    sim.run(until=0.7)
    diary = Diary(sampled.every(0.3))
    sim.run(duration=2, observe=diary)
    begun = diary.begun
    assert begun == 0.7
    assert [time for (time,) in diary.of("sample")] == [begun + k * 0.3 for k in range(1, 7)]
    before = 0.0
    for words in diary.told:
        if words[0] == "sample":
            assert before == words[1]
        before = words[2] if words[0] == "events" else words[1]
    assert (diary.records == sim.events).all()


def test_a_schedule_of_given_times():
    sim, diary = gas(), Diary(sampled.once([0, 0.1, 0.25]))
    sim.run(until=0.1, observe=diary)  # it goes on in the next run
    assert [time for (time,) in diary.of("sample")] == [0, 0.1]
    sim.run(collisions=2000, observe=diary)
    assert [time for (time,) in diary.of("sample")] == [0, 0.1, 0.25]
    assert diary.next_sample == math.inf


def test_results_do_not_depend_on_slices():
    def results(seconds):
        sim = gas(method=lambda s, w: FastEngine(s, w, slice_seconds=seconds))
        one = virial()
        sim.run(collisions=30_000, observe=[one, heights(every=2)])
        return one.result(), sim.events

    first, events = results(1e-4)
    again, same_events = results(0.05)
    assert first == again
    assert first.error > 0
    assert np.array_equal(events, same_events)


def test_no_events_are_kept_when_only_observed():
    sim, diary = gas(keep_events=0), Diary()
    sim.run(events=1000)
    sim.run(events=1000, observe=diary)
    assert len(diary.records) == 1000
    assert len(sim.events) == 0


def test_several_runs_are_one_measurement():
    parts, whole = virial(), virial()
    sim, twin = gas(), gas()
    for _ in range(4):
        sim.run(collisions=5000, observe=parts)
    twin.run(collisions=20_000, observe=whole)
    assert parts.duration == whole.duration
    assert parts.result().value == pytest.approx(whole.result().value, rel=1e-13)
    assert parts.result().error == pytest.approx(whole.result().error, rel=1e-9)


@pytest.mark.parametrize("change", ["run", "velocity", "gravity", "sphere", "other"])
def test_a_measurement_cannot_go_on_elsewhere(change):
    sim, one = gas(), virial()
    sim.run(collisions=100, observe=one)
    if change == "run":
        sim.run(collisions=1)
    elif change == "velocity":
        sim.velocity = -sim.velocity
    elif change == "gravity":
        sim.gravity = (0, 0, -1)
    elif change == "sphere":
        sim.remove(3)
    else:
        sim = gas()
    with pytest.raises(carom.InputError, match=r"this virial has measured up to time .* new one"):
        sim.run(collisions=1, observe=one)


def test_two_runs_of_no_length_are_no_change():
    sim, one = gas(), virial()
    sim.run(collisions=100, observe=one)
    sim.run(duration=0)
    sim.run(collisions=100, observe=one)
    assert one.duration == sim.time


@pytest.mark.parametrize(
    ("what", "message"),
    [
        (virial, "takes observables such as"),
        (["virial"], "takes observables such as"),
        ("virial", "takes observables such as"),
        (3, "takes observables such as"),
    ],
)
def test_what_is_no_observable_is_refused(what, message):
    with pytest.raises(carom.InputError, match=message):
        gas().run(collisions=1, observe=what)
    one = virial()
    with pytest.raises(carom.InputError, match="one observable twice"):
        gas().run(collisions=1, observe=[one, one])


def test_nothing_to_observe_is_fine():
    sim = gas()
    sim.run(collisions=5, observe=[])
    assert sim.collisions == 5


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"every": 0}, "every is 0; it must be more than 0"),
        ({"every": 1, "at": [1]}, "every= and at= are both given"),
        ({"at": [2, 1]}, "rising times"),
        ({"at": [-1, 1]}, "rising times"),
        ({"at": []}, "a row of times"),
        ({"at": [[1, 2]]}, "at must"),
        ({"at": [math.nan]}, "a row of times"),
        ({"at": "soon"}, "at must be"),
    ],
)
def test_bad_schedules(options, message):
    with pytest.raises(carom.InputError, match=message):
        heights(**options)


def test_a_function_of_the_state_cannot_change_it():
    @observe.observable
    def freezes(state):
        state.velocity[:] = 0
        return 0.0

    sim = gas()
    with pytest.raises(ValueError, match="read-only"):
        sim.run(duration=1, observe=freezes(every=0.5))
    assert sim.kinetic_energy > 0


@pytest.mark.parametrize("value", [math.nan, math.inf, None, "x", 1j])
def test_a_function_of_events_gives_numbers(value):
    @observe.observable
    def odd(batch):
        return np.full(len(batch), value)

    with pytest.raises(carom.InputError, match="odd returned what is no finite number"):
        gas().run(collisions=5, observe=odd())


def test_samples_alone_do_not_keep_a_run_alive_for_ever():
    sim = carom.Simulation()
    sim.add_many([(0, 0, 0), (3, 0, 0)], velocity=[(1, 0, 0), (0, 0, 0)])
    seen = heights(every=0.5)
    with pytest.raises(carom.RunError, match="only 1 of 5 collisions happened"):
        sim.run(collisions=5, observe=seen)
    assert seen.samples > 10


def test_a_long_silence_is_no_end():
    sim = carom.Simulation()
    sim.add_many([(0, 0, 0), (3000, 0, 0)], velocity=[(1, 0, 0), (0, 0, 0)])
    sim.run(collisions=1, observe=heights(every=1))
    assert sim.time == 2999


def test_what_was_measured_before_ctrl_c_stays():
    sim, diary = gas(), Diary()

    def stop(now):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sim.run(collisions=10**9, observe=diary, progress=stop)
    assert (diary.records == sim.events).all()
    assert diary.duration == sim.time > 0
    sim.run(collisions=10, observe=diary)


class TestYourOwn:
    def test_of_states(self):
        sim, seen, values = gas(), heights(every=4), []

        @observe.observable
        def copy(state):
            values.append(state.position[:, 2].mean())
            return 0

        sim.run(until=3000, observe=[seen, copy(every=4)])
        assert seen.result().value == pytest.approx(np.mean(values), rel=1e-12)
        assert seen.result().error == observe.blocking(values).error
        assert (seen.name, heights.__doc__) == ("heights", "Mean height.")

    def test_samples_come_by_themselves(self):
        sim, seen = gas(), heights()
        sim.run(collisions=40 * 300, observe=seen)
        # Each sphere has two partners: 80 collisions each, three between samples.
        assert 13 < seen.samples < 54

    def test_of_events(self):
        sim, seen = gas(), virial()
        sim.run(collisions=20_000, observe=seen)
        events = sim.events
        size = np.linalg.norm(events["impulse"], axis=1)
        each = 2 * sim.radius[events["i"]] * size
        assert seen.result().value == pytest.approx(each.sum() / sim.time, rel=1e-12)
        scatter = []
        for seed in range(30):
            other, one = carom.Simulation(carom.scenes.gas(n=100, seed=seed)), virial()
            other.run(collisions=2000)
            other.run(collisions=8000, observe=one)
            scatter.append(one.result())
        # Energies differ from seed to seed by nothing: all start at one speed.
        errors = [e.error for e in scatter]
        assert np.std([e.value for e in scatter]) == pytest.approx(np.mean(errors), rel=0.45)

    def test_mistakes_are_named(self):
        with pytest.raises(carom.InputError, match="one parameter, state or batch"):
            observe.observable(lambda x: 1)

        @observe.observable
        def wrong_shape(batch):
            return 1

        @observe.observable
        def wrong_number(state):
            return "tall"

        with pytest.raises(carom.InputError, match="wrong_shape returned an array of shape"):
            gas().run(collisions=10, observe=wrong_shape())
        with pytest.raises(carom.InputError, match="what wrong_number returns must be a number"):
            gas().run(collisions=10, observe=wrong_number(at=0))

    def test_nothing_measured_yet(self):
        with pytest.raises(carom.InputError, match="virial has measured nothing yet"):
            virial().result()
        sim, seen, counted = gas(), heights(every=50), virial()
        sim.run(duration=0, observe=[seen, counted])
        with pytest.raises(carom.InputError, match="no sample in 0: the first is due after 50"):
            seen.result()
        with pytest.raises(carom.InputError, match="no time has passed; run longer"):
            counted.result()
