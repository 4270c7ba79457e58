"""Ctrl-C stops a run soon, between two collisions."""

import os
import signal
import threading
import time

import numpy as np
import pytest

from .gases import each_method, gas


class TestInterrupt:
    @each_method
    def test_ctrl_c_stops_soon_with_the_state_whole(self, method):
        sim, whole = gas(method, n=4), gas(method, n=4)
        energy = sim.kinetic_energy
        pressed = []

        def press():
            pressed.append(time.perf_counter())
            os.kill(os.getpid(), signal.SIGINT)

        threading.Timer(0.4, press).start()
        with pytest.raises(KeyboardInterrupt):
            sim.run(until=1e9)
        assert time.perf_counter() - pressed[0] < 0.2
        assert 0 < sim.time < 1e9
        assert sim.kinetic_energy == pytest.approx(energy, rel=1e-10)
        assert len(sim.events) == min(sim.collisions + sim.wall_collisions, 10**6)
        # It goes on as if nothing had been.
        hits = sim.collisions + sim.wall_collisions
        sim.run(events=10)
        whole.run(events=hits + 10)
        assert np.array_equal(sim.position, whole.position)

    def test_a_handler_that_does_not_raise_lets_the_run_go_on(self):
        sim, seen = gas(), []
        old = signal.signal(signal.SIGINT, lambda *_: seen.append(1))
        try:
            sim.run(until=1, progress=lambda _: signal.raise_signal(signal.SIGINT))
        finally:
            signal.signal(signal.SIGINT, old)
        assert seen
        assert sim.time == 1

    def test_a_second_ctrl_c_does_not_wait(self):
        def press_twice(_):
            signal.raise_signal(signal.SIGINT)
            with pytest.raises(KeyboardInterrupt):
                signal.raise_signal(signal.SIGINT)

        with pytest.raises(KeyboardInterrupt):
            gas().run(until=1, progress=press_twice)
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler

    def test_other_threads_are_left_alone(self):
        sim = gas()
        thread = threading.Thread(target=lambda: sim.run(until=1))
        thread.start()
        thread.join()
        assert sim.time == 1
