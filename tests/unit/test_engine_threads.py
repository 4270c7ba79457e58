"""An engine may be looked at from one thread while it runs in another."""

import threading
import time

import numpy as np

from carom import Simulation, scenes
from carom.engine import FastEngine


def test_a_state_taken_while_it_runs_is_whole() -> None:
    state, world = scenes.fluid(n=500, packing_fraction=0.3, seed=1).build()
    engine = FastEngine(state, world, slice_seconds=0.002)
    start = np.sum(state.velocity**2)
    done = threading.Event()

    def run() -> None:
        while not done.is_set():
            engine.advance(np.inf)
            time.sleep(1e-4)  # a lock is not fair: let the other thread have its turn

    thread = threading.Thread(target=run)
    thread.start()
    try:
        end, looks = time.perf_counter() + 30, 0
        while looks < 100 or engine.collisions <= 1000:
            assert time.perf_counter() < end
            looks += 1
            seen = engine.state()
            assert abs(np.sum(seen.velocity**2) / start - 1) < 1e-12
            assert len(engine.take_events()) >= 0
            assert engine.max_overlap() < 1e-12
    finally:
        done.set()
        thread.join()


def test_far_outliers_do_not_slow_a_cluster() -> None:
    """One sphere a long way off says nothing of the density of the others."""
    cluster = scenes.fluid(n=500, packing_fraction=0.3, seed=1).spheres
    sim = Simulation(walls=scenes.gas(n=10, packing_fraction=0.1).walls[:0])
    sim.add_many(position=cluster.position, velocity=cluster.velocity)
    alone = FastEngine(sim.state, sim.world)
    sim.add(position=(1e5, 0, 0))
    outlier = FastEngine(sim.state, sim.world)
    assert outlier.memory < 1.5 * alone.memory
    alone.advance(0.5)
    outlier.advance(0.5)
    assert np.array_equal(outlier.state().position[:-1], alone.state().position)
