"""Whatever pages ask for, in whatever order: the simulation stays whole."""

from dataclasses import fields

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import carom
from carom import scenes
from carom.errors import CaromError, CollapseError
from carom.view.protocol import Command
from carom.view.stage import Stage


def bare():
    """Spheres without a scene, after they have run."""
    sim = carom.Simulation(walls=carom.Box(8, 8, 8), rule=carom.Smooth(0.9, contact_time=1e-3))
    sim.add((-2, 0, 0), velocity=(1, 0.1, 0))
    sim.add((2, 0, 0), velocity=(-1, 0, 0), mass=2)
    sim.add((0, 3, 0), fixed=True)
    sim.run(until=3)
    return sim


def falling():
    return carom.Simulation(scenes.bounce(n=4))


def periodic():
    return carom.Simulation(scenes.fluid(n=32, packing_fraction=0.2))


def reference():
    return carom.Simulation(scenes.gas(n=10), method="reference")


def alone():
    sim = carom.Simulation(walls=carom.Box(4, 4, 4))
    sim.add((0, 0, 0), velocity=(1, 0.7, 0.3))
    return sim


def all_fixed():
    sim = carom.Simulation(walls=carom.Box(8, 8, 8))
    sim.add((-2, 0, 0), fixed=True)
    sim.add((2, 0, 0), fixed=True)
    return sim


def empty():
    return carom.Simulation(walls=carom.Box(8, 8, 8))


def in_ticks():
    return carom.Simulation(scenes.phase_4(), method="tick")


class Plain:
    """An engine of one's own: the plainest contract, without checkpoints."""

    def __init__(self, state, world):
        self._engine = carom.engine.FastEngine(state, world)

    def __getattr__(self, name):
        if name in ("checkpoint", "restore"):
            raise AttributeError(name)
        return getattr(self._engine, name)


def own_engine():
    return carom.Simulation(scenes.phase_3(), method=Plain)


EXACT = (
    *(bare, falling, periodic, reference, alone, all_fixed, empty, own_engine),
    *(lambda: carom.Simulation(scenes.phase_3()), lambda: carom.Simulation(scenes.phase_0())),
    lambda: carom.Simulation(scenes.newton_cradle()),
)

place = st.tuples(*[st.one_of(st.integers(-4, 4).map(float), st.floats(-300, 300))] * 3)
motion = st.tuples(*[st.sampled_from([0.0, 1.0, -2.0, 30.0])] * 3)


def command(op, **values):
    return st.fixed_dictionaries(values).map(lambda found: Command(op, found))


index = st.integers(0, 40)
commands = st.one_of(
    st.just(Command("restart")),
    st.just(Command("step")),
    st.just(Command("back")),
    st.just(Command("back")),
    st.just(Command("reverse")),
    command("rule", restitution=st.sampled_from([0.0, 0.3, 0.9, 1.0])),
    command("walls", restitution=st.sampled_from([0.0, 0.5, 1.0])),
    command("gravity", value=motion),
    command("push", index=index, velocity=motion),
    command("remove", index=index),
    command(
        "add",
        position=place,
        velocity=motion,
        radius=st.sampled_from([0.1, 0.5, 20.0]),
        mass=st.sampled_from([1e-12, 1.0, 1e12]),
        color=st.just(0x336699),
    ),
    command("compare", on=st.booleans()),
    command(
        "scene",
        name=st.sampled_from(["two-balls", "phase-1", "gas", "bounce", "galperin", "gass"]),
        options=st.sampled_from([{}, {"n": 12}, {"n": 1e300}, {"n": "x"}, {"restitution": 0.5}]),
    ),
    command("run", duration=st.sampled_from([0.0, 0.01, 1.0, 20.0])),
)


def bits(stage):
    """Everything that a refused command must leave as it is."""
    parts = [stage.epoch, stage.key, stage.reversed, stage.twin is None]
    for sim in stage.shown:
        state = sim.state
        parts += [np.asarray(getattr(state, f.name)).tobytes() for f in fields(state)]
        parts += [sim.walls, sim.rule, sim.gravity.tobytes(), sim.pace]
    return parts


def obey(stage, order):
    if order.op != "run":
        stage.act(order)
    elif order["duration"] <= 1 or (len(stage.sim) < 50 and stage.sim.method != "reference"):
        stage.run(order["duration"], lambda sim: None)


def check(stage, orders, exact):
    for order in orders:
        before, epoch, now, last = bits(stage), stage.epoch, stage.sim.time, stage.sim
        try:
            obey(stage, order)
        except CollapseError:
            assert order.op in ("run", "step")
        except CaromError:
            assert bits(stage) == before
        sim = stage.sim
        assert sim is last
        assert stage.epoch >= epoch
        arrays = (sim.position, sim.velocity, sim.mass, sim.radius, sim.collision_count)
        assert {len(array) for array in arrays} == {len(sim)}
        assert np.isfinite(sim.position).all()
        if order.op == "back":
            assert sim.time <= now
        if exact:
            assert abs(sim.energy_drift) < 1e-9
        if stage.twin is not None:
            assert 0 <= sim.time - stage.twin.time <= stage.twin.tick * (1 + 1e-9)
        stage.settings()


quick = settings(
    max_examples=25,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)


@pytest.mark.parametrize("make", EXACT)
@quick
@given(orders=st.lists(commands, max_size=14))
def test_exact_motion(make, orders):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("carom.view.stage.SEARCH", 0.1)
        check(Stage(make(), stopping=lambda: False), orders, exact=True)


@quick
@given(orders=st.lists(commands, max_size=14))
def test_ticks(orders):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("carom.view.stage.SEARCH", 0.1)
        check(Stage(in_ticks(), stopping=lambda: False), orders, exact=False)
