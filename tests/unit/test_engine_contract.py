"""What `advance`, the records and the state of every engine promise."""

import math

import numpy as np
import pytest

from carom.engine import FastEngine, Stop
from carom.errors import InputError
from carom.reference.exact import ExactEngine
from carom.world import World

from .worlds import (
    DOWN,
    UP,
    bits,
    box,
    energy,
    every_kind,
    gas,
    plane,
    replayed,
    run,
    spheres,
    two,
    unwrapped,
    walls,
)

each_engine = pytest.mark.parametrize("engine", [FastEngine, ExactEngine])
KINDS = every_kind()
each_kind = pytest.mark.parametrize("kind", KINDS)


class TestAdvance:
    @each_engine
    def test_stops_exactly_at_a_time(self, engine):
        engine = engine(gas(2), World(walls=box(4.0)))
        for until in (0.1, 0.3, 1 / 3, 0.7, 0.7, 2.1, math.nextafter(2.1, 3.0), 5.0):
            assert run(engine, until) is Stop.TIME
            assert engine.time == until == engine.state().time

    @each_engine
    def test_refuses_the_past(self, engine):
        engine = engine(gas(2), World(walls=box(4.0)))
        run(engine, 2.0)
        for until in (1.0, -math.inf, math.nan):
            with pytest.raises(InputError, match=r"cannot advance to .* later"):
                engine.advance(until)
        assert engine.time == 2.0

    @each_engine
    def test_stops_right_after_a_count(self, engine):
        world = World(walls=box(5.0))
        engine = engine(gas(3), world)
        for number in (1, 2, 7):
            before = engine.collisions
            assert run(engine, max_collisions=number) is Stop.COUNT
            assert engine.collisions == before + number
            last = engine.take_events()[-1]
            i, j = last["i"], last["j"]
            assert i < j
            assert engine.time == pytest.approx(last["time"], rel=1e-15)
            state = engine.state()
            r = state.position[i] - state.position[j]
            assert np.linalg.norm(r) == pytest.approx(1.0, rel=1e-13)
            assert r @ (state.velocity[i] - state.velocity[j]) > 0.0
        total = engine.collisions + engine.wall_collisions
        assert run(engine, max_events=11) is Stop.COUNT
        assert engine.collisions + engine.wall_collisions == total + 11
        assert len(engine.take_events()) == 11

    @each_engine
    def test_a_count_of_nothing(self, engine):
        engine = engine(gas(2), World(walls=box(4.0)))
        assert engine.advance(9.0, max_collisions=0) is Stop.COUNT
        assert engine.advance(9.0, max_events=0) is Stop.COUNT
        assert engine.time == 0.0

    @each_engine
    def test_idle_when_nothing_will_happen(self, engine):
        engine = engine(spheres([(0, 0, 0), (3, 0, 0)], [(0, 0, 0), (-1, 0, 0)]), World())
        assert run(engine) is Stop.IDLE
        assert engine.collisions == 1
        assert engine.time <= 2.0 * (1 + 1e-15)
        assert run(engine, 7.0) is Stop.TIME
        assert engine.state().position[:, 0] == pytest.approx([-5.0, 1.0], rel=1e-15)
        assert engine.advance(math.inf) is Stop.IDLE

    def test_slices_return_early_and_lose_nothing(self):
        state, world, until = KINDS["box"]
        whole = FastEngine(state, world)
        run(whole, until)
        sliced = FastEngine(state, world, slice_seconds=1e-9)
        stops, times = [Stop.SLICE], [0.0]
        while stops[-1] is Stop.SLICE:
            stops.append(sliced.advance(until))
            times.append(sliced.time)
        assert stops.count(Stop.SLICE) > 10
        assert np.all(np.diff(times) >= 0.0)
        assert bits(sliced.state()) == bits(whole.state())

    def test_records_that_nobody_takes_do_not_stop_it(self):
        engine = FastEngine(gas(3), World(period=np.full(3, 4.6)), slice_seconds=9.0)
        assert run(engine, max_collisions=140_000) is Stop.COUNT
        assert engine.advance(math.inf, max_collisions=1000) is Stop.COUNT
        assert len(engine.take_events()) == 141_000


class TestRecords:
    @each_kind
    def test_replay_the_run(self, kind):
        state, world, until = KINDS[kind]
        engine = FastEngine(state, world)
        run(engine, until)
        events, end = engine.take_events(), engine.state()
        x, v = replayed(state, world, events, end.time)
        assert np.abs(x - unwrapped(end, world)).max() < 1e-9
        assert np.abs(v - end.velocity).max() < 1e-9
        assert np.all(np.diff(events["time"]) >= -1e-14 * end.time)

    def test_replay_after_a_hundred_collisions_per_sphere(self):
        world = World(period=np.full(3, 4.6))
        engine = FastEngine(gas(3), world)
        run(engine, max_collisions=50 * 27)
        x, v = replayed(gas(3), world, engine.take_events(), engine.time)
        assert np.abs(x - unwrapped(engine.state(), world)).max() < 1e-9
        assert np.abs(v - engine.state().velocity).max() < 1e-9

    @each_kind
    def test_count_what_the_engine_counts(self, kind):
        state, world, until = KINDS[kind]
        engine = FastEngine(state, world)
        run(engine, until)
        events, end = engine.take_events(), engine.state()
        pairs = events["j"] >= 0
        woke = events["j"] == -(2**21)
        assert pairs.sum() == engine.collisions
        assert (~pairs & ~woke).sum() == engine.wall_collisions
        met = np.bincount(events["i"][~woke], minlength=len(state))
        met += np.bincount(events["j"][pairs], minlength=len(state))
        assert np.array_equal(met, end.collision_count)
        assert np.all(events["i"][pairs] < events["j"][pairs])

    @each_kind
    def test_energy_is_kept_or_accounted_for(self, kind):
        state, world, until = KINDS[kind]
        engine = FastEngine(state, world)
        run(engine, until)
        lost = energy(state, world) - energy(engine.state(), world)
        assert lost == pytest.approx(engine.dissipated, abs=1e-9)
        assert engine.max_overlap() < 1e-12


class TestWorlds:
    @each_engine
    def test_one_sphere_between_two_walls(self, engine):
        engine = engine(spheres((0.3, 0, 0), (1.7, 0, 0)), World(walls=box(4.0)))
        for until in np.arange(1, 40) * 0.77:
            run(engine, until)
            turn = (0.3 + 1.5 + 1.7 * until) % 6.0  # there and back again, 2 x 3
            place = (turn if turn <= 3.0 else 6.0 - turn) - 1.5
            assert engine.state().position[0] == pytest.approx((place, 0, 0), abs=1e-12)

    def test_an_ideal_gas_is_many_lonely_spheres(self):
        state, world = gas(3), World(walls=box(4.0), collide=False, gravity=DOWN)
        engine = FastEngine(state, world)
        run(engine, 20.0)
        assert engine.collisions == 0
        assert engine.wall_collisions > 400
        for i in (0, 13, 26):
            alone = FastEngine(spheres(state.position[i], state.velocity[i]), world)
            run(alone, 20.0)
            assert alone.state().position[0] == pytest.approx(engine.state().position[i], abs=1e-9)

    def test_fixed_spheres_stay(self):
        state, world, until = KINDS["fixed ones under gravity"]
        engine = FastEngine(state, world)
        run(engine, until)
        end = engine.state()
        assert np.array_equal(end.position[:4], state.position[:4])
        assert not end.velocity[:4].any()
        assert end.collision_count[:4].min() > 0

    def test_open_space_for_very_long(self):
        state = gas(4, 1.1)
        engine = FastEngine(state, World())
        assert run(engine) is Stop.IDLE
        assert engine.collisions > 64
        x, v, start = *_place(engine), engine.time
        assert run(engine, 1e12) is Stop.TIME
        assert engine.time == 1e12
        assert _place(engine)[0] == pytest.approx(x + v * (1e12 - start), rel=1e-14, abs=1e-3)

    def test_every_image_is_seen(self):
        """First meetings in a cube of side 2.5 against a search over all images."""
        draw = np.random.default_rng(4)
        m = np.stack(np.meshgrid(*[np.arange(-20, 21)] * 3), -1).reshape(-1, 3) * 2.5
        met = 0
        for _ in range(60):
            x, v = draw.uniform(-1.25, 1.25, (2, 3)), draw.normal(size=(2, 3))
            r, w = x[0] - x[1] + m, v[0] - v[1]
            if (r**2).sum(1).min() < 1.0:
                continue
            b, c = r @ w, (r**2).sum(1) - 1.0
            d = b**2 - w @ w * c
            meet = (b < 0) & (d > 0)
            times = c[meet] / (-b[meet] + np.sqrt(d[meet]))
            engine = FastEngine(spheres(x, v), World(period=np.full(3, 2.5)))
            expected = times.min(initial=math.inf)
            stop = run(engine, 40 / np.linalg.norm(w), max_collisions=1)
            assert (stop is Stop.COUNT) == (expected < 40 / np.linalg.norm(w))
            if stop is Stop.COUNT:
                assert engine.time == pytest.approx(expected, rel=1e-9)
                met += 1
        assert met > 20

    def test_two_in_a_periodic_cube_meet_at_the_sinai_rate(self):
        """Mean time (L^3 - 4 pi/3 sigma^3) / (pi sigma^2 v): 3.640259/v for L = 2.5."""
        engine = FastEngine(two(), World(period=np.full(3, 2.5)), log=False)
        speed = np.linalg.norm(np.subtract(*two().velocity))
        run(engine, max_collisions=60_000)
        assert engine.time / 60_000 * speed == pytest.approx(3.640259, rel=0.02)

    def test_a_giant_among_small_ones(self):
        state, world, until = KINDS["giant"]
        engine = FastEngine(state, world)
        run(engine, until)
        giant = np.argmax(state.radius)
        assert engine.state().collision_count[giant] > 100
        momentum = state.mass @ (engine.state().velocity - state.velocity)
        assert np.abs(momentum).max() < 1e-11


class TestEpochs:
    def test_a_late_start_changes_no_bit(self):
        state, world, until = KINDS["periodic"]
        early = FastEngine(state, world)
        run(early, until)
        state = state.copy()
        state.time = 2.0**30
        late = FastEngine(state, world)
        run(late, 2.0**30 + until)
        assert late.time == 2.0**30 + until
        assert bits(late.state()) == bits(early.state())

    @pytest.mark.parametrize(("start", "unit"), [(1e9, 1e-9), (1e9, 1.0), (-1e6, 1e-3)])
    def test_times_that_an_epoch_cannot_resolve(self, start, unit):
        state = gas(2, 1.5 * unit, radius=0.5 * unit, time=start)
        engine = FastEngine(state, World(period=np.full(3, 3.2 * unit)))
        run(engine, max_collisions=6000)
        assert engine.time > start
        assert engine.max_overlap() < 1e-12
        assert run(engine, max(engine.time + unit, math.nextafter(engine.time, 1e99))) is Stop.TIME

    def test_empty_epochs_are_skipped(self):
        """A wide box: all epochs but one in millions are silent."""
        side = 1e6
        state = spheres([(0, 0, 0), (0, 3, 0)], [(1.7, 0, 0), (0, 0, 2.3)])
        engine = FastEngine(state, World(walls=box(side)))
        assert run(engine, 1e9, max_events=10_000) is Stop.TIME
        for k, axis, speed in ((0, 0, 1.7), (1, 2, 2.3)):
            half = side / 2 - 0.5
            turn = (half + speed * 1e9) % (4 * half)
            place = (turn if turn <= 2 * half else 4 * half - turn) - half
            assert engine.state().position[k, axis] == pytest.approx(place, abs=1e-5)

    def test_precision_does_not_decay(self):
        """Energy and contact distance after ten thousand collisions per sphere."""
        state, world = gas(2), World(walls=box(4.0))
        engine = FastEngine(state, world, log=False)
        run(engine, max_collisions=80_000)
        assert energy(engine.state(), world) == pytest.approx(energy(state, world), rel=1e-12)
        assert engine.max_overlap() < 1e-13

    @pytest.mark.parametrize("restitution", [1.0, 0.8])
    @pytest.mark.parametrize("height", [1.7, 2.3, 3.1])
    def test_a_ball_on_a_fixed_one_never_falls_through(self, height, restitution):
        world = World(gravity=DOWN, restitution=restitution)
        engine = FastEngine(spheres([(0, 0, 0), (0, 0, height)], fixed=[True, False]), world)
        run(engine, 2000.0, max_events=2000)
        assert engine.state().position[1, 2] >= 1.0 - 1e-12
        assert engine.max_overlap() < 1e-12

    def test_endless_collisions_at_one_time_spoil_nothing(self):
        """Three elastic spheres that fill a periodic axis pass one blow round for ever."""
        state = spheres([(-1, 0, 0), (0, 0, 0), (1, 0, 0)], [(1, 0, 0), (0.5, 0, 0), (-2, 0, 0)])
        engine = FastEngine(state, World(period=np.array([3.0, 9.0, 9.0])), log=False)
        assert run(engine, 1.0, max_collisions=300_000) is Stop.COUNT
        assert engine.time == 0.0
        assert np.sort(engine.state().velocity[:, 0]) == pytest.approx([-2, 0.5, 1])


def _place(engine):
    state = engine.state()
    return state.position, state.velocity


def test_a_floor_and_a_lid_take_the_weight():
    """Impulses on floor and lid differ by weight times time, and the change of momentum."""
    state = gas(3, 1.3)
    world = World(
        period=np.array([4.0, 4.0, 0.0]),
        walls=walls(plane(UP, -2.5, 0.9), plane(DOWN, -2.5, 0.9)),
        gravity=2 * DOWN,
        restitution=0.95,
    )
    engine = FastEngine(state, world)
    run(engine, 10.0)
    events = engine.take_events()
    from_walls = events["impulse"][events["j"] < 0, 2].sum()
    gained = (engine.state().velocity - state.velocity)[:, 2].sum()
    assert from_walls == pytest.approx(27 * 2 * 10.0 + gained, rel=1e-12)
