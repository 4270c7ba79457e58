"""The bits of a trajectory depend on the scene alone."""

import numpy as np
import pytest

from carom.engine import FastEngine, Stop
from carom.world import World

from .worlds import bits, box, digest, every_kind, grid, run, spheres

KINDS = every_kind()
each_kind = pytest.mark.parametrize("kind", KINDS)


def story(records):
    """Digest of who met whom with what impulse. (A time is a sum: batch start and offset.)"""
    records = np.concatenate(records)
    return digest(records["i"], records["j"], records["impulse"])


@pytest.fixture(scope="module")
def plain():
    """Runs in one go: {kind: (bits at the end, story, times)}."""
    told = {}
    for kind, (state, world, until) in KINDS.items():
        engine = FastEngine(state, world)
        run(engine, until)
        records = engine.take_events()
        told[kind] = bits(engine.state()), story([records]), records["time"]
    return told


@each_kind
@pytest.mark.parametrize(
    "bookkeeping",
    [
        {"margin": 0.03},
        {"margin": 0.5, "cell": 7.0},
        {"margin": 2.0, "cell": 0.6},
        {"slice_seconds": 1e-9},
    ],
    ids=str,
)
def test_margins_cells_and_slices(plain, kind, bookkeeping):
    state, world, until = KINDS[kind]
    engine = FastEngine(state, world, **bookkeeping)
    run(engine, until)
    records = engine.take_events()
    assert (bits(engine.state()), story([records])) == plain[kind][:2]


@each_kind
def test_without_records(plain, kind):
    state, world, until = KINDS[kind]
    engine = FastEngine(state, world, log=False)
    run(engine, until)
    assert len(engine.take_events()) == 0
    assert bits(engine.state()) == plain[kind][0]


@each_kind
def test_batches_and_samples(plain, kind):
    """Many calls of every kind, looking at the state between them."""
    state, world, until = KINDS[kind]
    draw = np.random.default_rng(5)
    engine = FastEngine(state, world, margin=float(draw.uniform(0.05, 0.6)))
    records = []
    while engine.time < until:
        choice = draw.integers(3)
        if choice == 0:
            engine.advance(min(until, engine.time + draw.exponential(until / 40)))
        elif choice == 1:
            engine.advance(until, max_events=int(draw.integers(1, 40)))
        else:
            engine.advance(until, max_collisions=int(draw.integers(1, 20)))
        if draw.random() < 0.5:
            records.append(engine.take_events())
        engine.state()
        engine.max_overlap()
    records.append(engine.take_events())
    assert (bits(engine.state()), story(records)) == plain[kind][:2]
    times = np.concatenate(records)["time"]
    assert np.abs(times - plain[kind][2]).max() <= 1e-15 * until


@each_kind
def test_checkpoints(plain, kind):
    """Stopped and taken up again in fresh engines, some with other bookkeeping."""
    state, world, until = KINDS[kind]
    engine, records, lost = FastEngine(state, world), [], 0.0
    for k in range(1, 5):
        if k == 3:
            run(engine, max_events=3)
        else:
            run(engine, until * k / 5)
        records.append(engine.take_events())
        saved, lost, before = engine.checkpoint(), engine.dissipated, engine.state()
        engine = FastEngine(state, world, margin=0.1 * k)
        engine.restore(saved)
        assert engine.dissipated == lost
        assert (engine.time, bits(engine.state())) == (before.time, bits(before))
        assert (engine.collisions, engine.wall_collisions) == (
            before.collisions,
            before.wall_collisions,
        )
    run(engine, until)
    records.append(engine.take_events())
    assert (bits(engine.state()), story(records)) == plain[kind][:2]


def test_a_refused_checkpoint_changes_nothing():
    state, world, until = KINDS["coming to rest"]
    engine = FastEngine(state, world)
    run(engine, until / 4)
    saved, before = engine.checkpoint(), bits(engine.state())
    other = FastEngine(*KINDS["box"][:2]).checkpoint()
    for bad in (b"", b"nonsense", saved[:-1], saved + b"x", saved[:200], other):
        with pytest.raises(ValueError, match="checkpoint"):
            engine.restore(bad)
        assert bits(engine.state()) == before
    assert run(engine, until) is Stop.TIME


@pytest.mark.parametrize("seed", [0, 1, 2, 3, 4, 5, 33, 111, 300, 336, 381, 395])
def test_many_collisions_at_one_time(seed):
    """On a grid with whole velocities events coincide by the dozen; their order is fixed."""
    draw = np.random.default_rng(seed)
    places = grid(4, (1.0, 1.25, 1.5)[seed % 3])
    places = places[draw.random(len(places)) < 0.8]
    state = spheres(places, draw.integers(-2, 3, places.shape))
    period = np.full(3, 5.0 + seed % 3) if seed % 2 else np.zeros(3)
    faces = box(9.0) if not seed % 2 else box(9.0)[:0]
    world = World(period=period, walls=faces, restitution=(1.0, 1.0, 0.5)[seed % 3])
    ends = set()
    for margin, cell in ((0.0, 0.0), (0.25, 0.0), (0.5, 4.0), (1.0, 0.0), (0.125, 2.0)):
        engine = FastEngine(state, world, margin=margin, cell=cell)
        stop = run(engine, 8.0, max_events=20_000)
        ends.add((stop, bits(engine.state()), story([engine.take_events()])))
        assert engine.max_overlap() < 1e-12
    assert len(ends) == 1
