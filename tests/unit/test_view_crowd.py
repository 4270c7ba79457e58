"""Many pages at once."""

import socket
import threading
import time
from contextlib import ExitStack

import carom
from carom import scenes
from carom.view import LiveView

from .pages import dead_page, hear, page, say

PAGES = 10


def watch(view, seconds, delay, counts, k):
    """Take frames as they come, one at a time, and count them."""
    with page(view) as ws:
        say(ws, op="credit", count=1)
        hear(ws)
        end = time.perf_counter() + seconds
        while time.perf_counter() < end:
            say(ws, op="credit", count=1)
            hear(ws)
            counts[k] += 1
            time.sleep(delay)


def test_ten_pages_are_served_and_a_slow_one_holds_up_nobody():
    sim = carom.Simulation(scenes.gas(n=500))
    counts, seconds = [0] * PAGES, 2.0
    with LiveView(sim) as view:
        slow = [0.01] * (PAGES - 1) + [0.5]
        pages = [
            threading.Thread(target=watch, args=(view, seconds, delay, counts, k))
            for k, delay in enumerate(slow)
        ]
        for each in pages:
            each.start()
        time.sleep(0.5)
        before, clock = sim.time, time.perf_counter()
        time.sleep(1.0)
        rate = (sim.time - before) / (time.perf_counter() - clock)
        for each in pages:
            each.join()
    assert rate > 0.7 * sim.pace
    assert min(counts[:-1]) > 5
    assert max(counts[:-1]) < 2 * min(counts[:-1])  # nobody is favoured
    assert 2 <= counts[-1] <= 6


def test_dead_pages_slow_nobody():
    sim = carom.Simulation(scenes.fluid(n=10_000))
    with LiveView(sim) as view, ExitStack() as dead:
        view._socket.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 16384)
        for _ in range(3):
            dead.enter_context(dead_page(view))
        with page(view) as ws:
            say(ws, op="credit", count=1)
            hear(ws)
            assert sum(client.busy for client in view._server._clients) >= 3
            before, clock = sim.time, time.perf_counter()
            for _ in range(30):
                say(ws, op="credit", count=1)
                hear(ws)
            rate = (sim.time - before) / (time.perf_counter() - clock)
            assert sum(client.busy for client in view._server._clients) >= 3
    assert rate > 0.7 * sim.pace
