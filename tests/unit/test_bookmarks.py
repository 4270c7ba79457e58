"""Bookmarks: back to a moment, with the same bits as if it had never been left."""

import contextlib
import dataclasses
import pickle

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import carom
from carom.engine import Stop
from carom.reference.exact import ExactEngine
from carom.reference.tick import TickEngine

from .gases import gas

FLOOR = carom.Plane((0, 0, 1), -4, restitution=0.6)
WORLDS = {
    "box": {"walls": carom.Box(8, 8, 8)},
    "periodic": {"walls": carom.Periodic(7, 7, 7)},
    "falling in a box": {"walls": carom.Box(8, 8, 8), "gravity": (0.1, 0, -1)},
    "inelastic": {"walls": carom.Periodic(7, 7, 7), "rule": carom.Smooth(0.8)},
    "contact time": {"walls": carom.Box(8, 8, 8, 0.7), "rule": carom.Smooth(0.3, 0.05)},
    "coming to rest": {
        "walls": [carom.Periodic(8, 8, None), FLOOR],
        "gravity": (0, 0, -3),
        "rule": carom.Smooth(0.7, 1e-3),
    },
    "round": {"walls": carom.Sphere(5.5), "gravity": (0, 0, -0.5)},
    "open": {},
    "ideal": {"walls": carom.Cylinder(6, 9), "collide": False},
}
METHODS = {
    "exact": "exact",
    "reference": "reference",
    "tick": "tick",
    "your own, resumable": lambda state, world: ExactEngine(state, world),
}


def start(world, method, seed, n=8):
    """Some spheres on a grid, one of them fixed, the rest with random velocities and masses."""
    rng = np.random.default_rng(seed)
    sim = carom.Simulation(**WORLDS[world], method=METHODS[method], tick=0.05)
    grid = 2.2 * (np.stack(np.meshgrid(*[np.arange(2)] * 3), -1).reshape(-1, 3) - 0.5)
    velocity = rng.normal(size=(n, 3))
    fixed = np.arange(n) == 3
    velocity[fixed] = 0
    mass = rng.uniform(0.5, 2, n)
    sim.add_many(grid, velocity=velocity, mass=mass, radius=rng.uniform(0.4, 1, n), fixed=fixed)
    return sim


CHANGES = {
    "run": lambda sim: sim.run(duration=0.37),
    "push": lambda sim: setattr(sim[0], "velocity", (1, 2, 3)),
    "remove": lambda sim: sim.remove(1) if len(sim) > 4 else None,
    "add": lambda sim: sim.add(position=(0, 0, 0), radius=0.05, velocity=(1, 0, 0)),
    "rule": lambda sim: setattr(sim, "rule", carom.Smooth(0.5, 0.01)),
    "gravity": lambda sim: setattr(sim, "gravity", 2 * sim.gravity),
    "reverse": lambda sim: setattr(sim, "velocity", -sim.velocity),
    "collisions": lambda sim: sim.run(events=5) if sim.walls != (carom.Open(),) else None,
    "reset": lambda sim: sim.reset(),
    "scene": lambda sim: sim.reset(carom.scenes.two_balls()),
}
changes = st.lists(st.sampled_from(sorted(CHANGES)), max_size=4)


def change(sim, names):
    for name in names:
        # Such a change is refused, in every simulation alike.
        with contextlib.suppress(carom.OverlapError, carom.CollapseError):
            CHANGES[name](sim)


def everything(sim):
    """All bits there are to see."""
    state = sim.state
    arrays = [getattr(state, f.name) for f in dataclasses.fields(state)]
    bits = [a.tobytes() if isinstance(a, np.ndarray) else a for a in arrays]
    counted = sim.time, sim.collisions, sim.wall_collisions, sim.max_overlap
    energies = sim.dissipated, sim.withheld, sim.energy_drift
    around = sim.walls, sim.rule, tuple(sim.gravity), sim.collide, sim.scene
    return bits, counted, energies, around, [sim[i]._serial for i in range(len(sim))]


@settings(max_examples=150, deadline=None)
@given(
    world=st.sampled_from(sorted(WORLDS)),
    method=st.sampled_from(["exact", *METHODS]),
    seed=st.integers(0, 1000),
    before=changes,
    after=changes,
    rest=st.lists(st.sampled_from(["run", "collisions", "remove", "reverse"]), max_size=3),
)
def test_as_if_it_had_never_been_left(world, method, seed, before, after, rest):
    sim, never_left = start(world, method, seed), start(world, method, seed)
    for each in (sim, never_left):
        change(each, before)
    mark = sim.bookmark()
    here = everything(sim)
    assert everything(never_left) == here
    assert (mark.time, mark.collisions, mark.wall_collisions) == here[1][:3]
    change(never_left, ["run", *rest])
    there = everything(never_left)
    for names in (["run", *rest], after):
        change(sim, names)
        sim.return_to(mark)
        assert everything(sim) == here
        assert len(sim.events) == 0
    change(sim, ["run", *rest])
    assert everything(sim) == there
    for each in (sim, never_left):
        each.reset()
    assert everything(sim)[:4] == everything(never_left)[:4]


@pytest.mark.parametrize("method", ["exact", "reference", "tick"])
def test_something_happens_between_and_comes_again(method):
    sim = gas(method, rule=carom.Smooth(0.9), tick=0.01)
    sim.run(until=2)
    mark = sim.bookmark()
    hits = sim.collisions
    assert hits > 3
    assert len(sim.events) > 0
    sim.run(duration=2)
    once, events = everything(sim), sim.events
    assert sim.collisions > hits + 3
    sim.return_to(mark)
    sim.run(duration=2)
    assert everything(sim) == once
    for name in ("i", "j", "impulse"):
        assert np.array_equal(sim.events[name], events[name])
    assert sim.events["time"] == pytest.approx(events["time"], rel=1e-15)


def test_a_resting_sphere_goes_on_resting():
    sim = carom.Simulation(walls=FLOOR, gravity=(0, 0, -1))
    ball = sim.add(velocity=(1, 0, 0))
    sim.run(until=30)
    mark = sim.bookmark()
    assert sim.state.resting.tolist() == [True]
    ball.velocity = (0, 0, 5)
    sim.run(duration=1)
    sim.return_to(mark)
    assert sim.state.resting.tolist() == [True]
    sim.run(duration=1)
    assert ball.position == pytest.approx([31, 0, -3.5])


def test_balls_come_back():
    sim = gas()
    sim.run(until=0.1)
    ball, mark = sim[5], sim.bookmark()
    sim.remove(5)
    with pytest.raises(carom.InputError, match="ball 5 is gone"):
        ball.mass  # noqa: B018
    late = sim.add(position=(2.9, 2.9, 2.9), radius=0.05)
    sim.return_to(mark)
    assert ball.index == 5
    with pytest.raises(carom.InputError, match="ball 26 is gone"):
        late.mass  # noqa: B018
    assert len(sim) == 27


def test_a_step_back_uses_the_engine_that_is_there():
    made = []

    def engine(state, world):
        made.append(ExactEngine(state, world))
        return made[-1]

    sim = gas(engine)
    sim.run(until=0.5)
    mark = sim.bookmark()
    sim.run(until=0.7)
    sim.return_to(mark)
    assert len(made) == 1
    sim.rule = carom.Smooth(0.5)
    sim.run(until=0.7)
    sim.return_to(mark)
    sim.run(until=0.7)
    assert len(made) == 3
    assert made[0].collisions < sim.collisions == made[2].collisions


def test_an_engine_without_checkpoints_is_built_from_its_state():
    class Plain:
        """Passes everything on but has no checkpoint."""

        def __init__(self, state, world):
            self._inner = ExactEngine(state, world)

        def __getattr__(self, name):
            if name in ("checkpoint", "restore"):
                raise AttributeError(name)
            return getattr(self._inner, name)

    sim = gas(Plain, rule=carom.Smooth(0.9))
    sim.run(until=0.5)
    mark, here = sim.bookmark(), everything(sim)
    sim.run(until=1)
    once = sim.position
    sim.return_to(mark)
    assert everything(sim) == here
    sim.run(until=1)
    assert sim.position == pytest.approx(once, abs=1e-9)
    assert abs(sim.energy_drift) < 1e-13


def test_what_a_bookmark_says_of_itself():
    sim = gas(n=4)
    sim.run(until=1)
    mark = sim.bookmark()
    assert repr(mark).startswith(f"Bookmark(time=1.0, collisions={sim.collisions}, wall_coll")
    assert "scene" not in repr(mark)
    assert 64 * 100 < mark.nbytes < 64 * 500
    with pytest.raises(dataclasses.FrozenInstanceError):
        mark.time = 0


def test_a_bookmark_of_another_simulation_is_refused():
    sim, other = gas(), gas()
    mark = other.bookmark()
    sim.run(until=0.1)
    with pytest.raises(carom.InputError, match="of another simulation"):
        sim.return_to(mark)
    for nonsense in (None, 0.1, "start"):
        with pytest.raises(carom.InputError, match=r"what bookmark\(\) returns, not"):
            sim.return_to(nonsense)
    assert sim.time == 0.1


def reach(engine, time):
    """Advance through as many slices as it takes."""
    while engine.advance(time) is Stop.SLICE:
        pass


@pytest.mark.parametrize("kind", [ExactEngine, TickEngine])
def test_checkpoints_of_the_python_engines_share_nothing(kind):
    state, world = carom.scenes.phase_4(n=6).build()
    engine = kind(state, world)
    reach(engine, 50)
    saved = engine.checkpoint()
    other = kind(state, world)
    other.restore(saved)
    reach(engine, 100)
    assert other.time == 50
    reach(other, 100)
    assert np.array_equal(engine.state().position, other.state().position)
    assert engine.collisions == other.collisions
    assert pickle.dumps(vars(engine)) == engine.checkpoint()
