"""The page over time: nothing piles up, and it comes back after a loss."""

import gc
import socket
import time
from contextlib import ExitStack
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import carom
from carom import scenes
from carom.view import LiveView

from .conftest import Shown
from .test_page import still_life


def metrics(shown, cdp):
    """Listeners and nodes that are alive after the garbage was collected."""
    for _ in range(2):
        cdp.send("HeapProfiler.collectGarbage")
        time.sleep(0.1)
    found = {m["name"]: m["value"] for m in cdp.send("Performance.getMetrics")["metrics"]}
    return found["JSEventListeners"], found["Nodes"]


def round_trip(shown, k):
    """Scenes, dialogs, panel, toasts, colours, the split screen: once each."""
    name = ["gas", "bounce"][k % 2]
    shown.js(f"carom.gallery.load('{name}')")
    shown.wait(f"carom.scene.about.origin?.name === '{name}'")
    for key in ("g", "Escape", "?", "Escape", "p", "p", "c", "w", "k", "x"):
        shown.page.keyboard.press(key)
    shown.wait("carom.settings.comparing")
    shown.page.keyboard.press("x")
    shown.wait("!carom.settings.comparing")
    shown.js("document.querySelectorAll('.toast button').forEach((button) => button.click())")


def test_nothing_piles_up(show):
    shown = show(carom.Simulation(scenes.gas(n=20)))
    cdp = shown.page.context.new_cdp_session(shown.page)
    cdp.send("Performance.enable")
    for k in range(2):
        round_trip(shown, k)
    listeners, nodes = metrics(shown, cdp)
    for k in range(6):
        round_trip(shown, k)
    more_listeners, more_nodes = metrics(shown, cdp)
    # Each round makes some fifty of either; a leak of one in ten would show.
    assert more_listeners <= listeners + 25
    assert more_nodes <= nodes + 60
    assert shown.js("carom.twin.keyframes.length") <= 12


@pytest.mark.validate
def test_ten_minutes_leave_no_trace(show):
    """Memory of the page and of the program, minute by minute, while a class plays with it."""
    shown = show(carom.Simulation(scenes.gas(n=200)))
    cdp = shown.page.context.new_cdp_session(shown.page)
    cdp.send("Performance.enable")
    page_bytes, program_bytes, counts = [], [], []
    end = time.perf_counter() + 600
    k = 0
    while time.perf_counter() < end:
        minute = time.perf_counter() + 60
        while time.perf_counter() < minute:
            round_trip(shown, 2 * k)  # an even number: the same scene at every reading
            time.sleep(3)
            k += 1
        counts.append(metrics(shown, cdp))
        found = cdp.send("Performance.getMetrics")["metrics"]
        page_bytes.append(next(m["value"] for m in found if m["name"] == "JSHeapUsedSize"))
        gc.collect()
        program_bytes.append(int(Path("/proc/self/statm").read_text().split()[1]) * 4096)
    report = f"{k} rounds; page {page_bytes}; program {program_bytes}; {counts}"
    print(report)  # noqa: T201
    # The first minutes fill caches and histories, which have a largest size.
    assert page_bytes[-1] < page_bytes[1] + 2e6, report
    assert program_bytes[-1] < program_bytes[1] + 40e6, report
    assert counts[-1][0] <= counts[1][0] + 25, report
    assert counts[-1][1] <= counts[1][1] + 60, report


def test_a_lost_graphics_context_is_replaced(show):
    shown = show(still_life())
    shown.settle()
    with shown.page.expect_navigation():
        shown.js(
            """(() => {
                 const losing = carom.renderer.gl.getExtension("WEBGL_lose_context");
                 losing.loseContext();
                 setTimeout(() => losing.restoreContext(), 300);
               })()"""
        )
    shown.wait("!!globalThis.carom?.timeline.newest")
    shown.wait("carom.drawn.t >= 0")


def test_the_page_outlives_the_program(chromium):
    """The program ends and another starts at the same port: the page goes on with it."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    page = chromium.new_page()
    try:
        with LiveView(carom.Simulation(scenes.gas(n=20)), port=port) as view:
            page.goto(view.url)
            page.locator("#title").get_by_text("Gas").wait_for()
        page.locator("#connection").get_by_text("Waiting").wait_for()
        with LiveView(carom.Simulation(scenes.phase_3()), port=port):
            page.locator("#title").get_by_text("Phase 3").wait_for()
            assert page.locator("#connection").is_hidden()
            assert page.get_by_role("radio", name="Wire").is_checked()
    finally:
        page.close()


def test_who_only_watches_is_told(show, chromium):
    shown = show(carom.Simulation(scenes.phase_3()))
    page = chromium.new_page()
    page.goto(shown.view.watch_url)
    page.locator("#watching").wait_for(state="visible")
    page.keyboard.press("Space")
    page.locator(".toast").get_by_text("may only watch").wait_for()
    assert shown.js("carom.timeline.newest?.playing")
    page.close()


def test_an_error_is_said_and_stops_nothing(chromium):
    """Whatever goes wrong in the page, its clock runs on, and people are told."""
    page = chromium.new_page()
    errors = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    try:
        with LiveView(carom.Simulation(scenes.gas(n=20))) as view:
            page.goto(view.url)
            shown = Shown(None, view, page)
            shown.wait("globalThis.carom?.drawn.t > 0")
            shown.js("() => { carom.renderer.draw = () => { throw new Error('no more paint'); }; }")
            page.locator("#failure").get_by_text("no more paint").wait_for()
            before = shown.js("carom.readout.shown")
            shown.wait(f"carom.readout.shown > {before + 500}")
            assert len(errors) == 1, errors  # not one in every picture
            shown.js("delete carom.renderer.draw")
            moment = shown.js("carom.timeline.t")
            shown.wait(f"carom.drawn.t > {moment}")
            assert page.locator("#failure").is_visible()
            shown.js("carom.gallery.load('bounce')")
            page.locator("#failure").wait_for(state="hidden")
    finally:
        page.close()


def test_a_page_without_a_line_can_still_be_looked_at(chromium):
    page = chromium.new_page(reduced_motion="reduce")
    try:
        with LiveView(carom.Simulation(scenes.gas(n=20))) as view:
            page.goto(view.url)
            shown = Shown(None, view, page)
            shown.wait("globalThis.carom?.drawn.t > 0")
        page.locator("#connection").get_by_text("Waiting").wait_for()
        version = shown.js("carom.drawn.camera")
        page.keyboard.press("ArrowLeft")
        shown.wait(f"carom.drawn.camera > {version}")
        shown.js("carom.hands.select(3)")
        page.locator(".sphere-title").get_by_text("Sphere 3").wait_for()
    finally:
        page.close()


def sleep(page, during):
    """Nothing of the page runs meanwhile, as under a closed lid: no picture, clock or message."""
    cdp = page.context.new_cdp_session(page)
    asleep = []
    cdp.on("Debugger.paused", lambda event: asleep.append(event))
    cdp.send("Debugger.enable")
    cdp.send("Debugger.pause")  # at the next line that runs
    end = time.perf_counter() + 10
    while not asleep:
        assert time.perf_counter() < end, "the page does not sleep"
        page.wait_for_timeout(20)
    during()
    cdp.send("Debugger.resume")
    cdp.detach()


def test_it_wakes_up_in_the_present(show):
    shown = show(carom.Simulation(scenes.gas(n=20)))
    shown.js("carom.hands.select(0)")
    shown.js(
        """() => {
             carom.moments = [];
             const { timeline } = carom;
             const advance = timeline.advance.bind(timeline);
             timeline.advance = (seconds) => {
               const pair = advance(seconds);
               if (pair !== null) carom.moments.push(timeline.t);
               return pair;
             };
           }"""
    )
    shown.wait("carom.moments.length > 20")
    times = {}

    def during():
        time.sleep(0.5)
        times["asleep"] = shown.sim.time
        time.sleep(3)
        times["awake"] = shown.sim.time

    before = time.perf_counter()
    sleep(shown.page, during)
    assert times["awake"] > times["asleep"]  # a sleeping page does not stop the simulation
    shown.wait(f"carom.moments.at(-1) > {times['awake']}", 5)
    moments = shown.js("carom.moments")
    assert min(np.diff(moments)) >= 0
    steps = [b - a for a, b in pairwise(moments) if b > times["asleep"]]
    # A jump or two, not a film of what was missed; then it flows again as before.
    missed = times["awake"] - times["asleep"]
    assert sum(sorted(steps)[-2:]) > 0.5 * missed
    assert sum(sorted(steps)[:-2]) < 0.6 * missed
    start = len(moments)
    shown.wait(f"carom.moments.length > {start + 15}")
    later = shown.js(f"carom.moments.slice({start})")
    assert np.median(np.diff(later)) < 0.1 * missed
    assert later[-1] <= shown.sim.time
    assert shown.js("carom.timeline.newest?.t - carom.timeline.t") < 1
    assert shown.page.locator("#connection").is_hidden()
    assert time.perf_counter() - before < 30
    # The trail is not drawn across the night.
    points = shown.js("[...carom.hands.trails[0].points]")
    assert None in points or any(p != p for p in points)


def test_it_wakes_up_to_another_program(chromium):
    """While the page slept the program ended, and was started again at the same port."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    page = chromium.new_page()
    with ExitStack() as program:
        view = program.enter_context(LiveView(carom.Simulation(scenes.gas(n=20)), port=port))
        page.goto(view.url)
        shown = Shown(None, view, page)
        shown.wait("globalThis.carom?.drawn.t > 0.2")

        def during():
            time.sleep(0.3)
            program.close()
            program.enter_context(LiveView(carom.Simulation(scenes.phase_3()), port=port))
            time.sleep(3)

        sleep(page, during)
        page.locator("#title").get_by_text("Phase 3").wait_for(timeout=10_000)
        assert page.locator("#connection").is_hidden()
        moment = shown.js("carom.drawn.t")
        shown.wait(f"carom.drawn.t > {moment}")
    page.close()


def alone():
    sim = carom.Simulation()
    sim.add((0, 0, 0), velocity=(1, 0, 0), radius=1)
    return sim


def at_rest():
    places = [(0, 0, 0), (3, 0, 0)]
    return carom.Simulation(carom.Scene(carom.Spheres.of(places, radius=1), walls=()))


def fixed():
    spheres = carom.Spheres.of([(0, 0, 0), (3, 0, 0)], radius=1, fixed=True)
    return carom.Simulation(carom.Scene(spheres, walls=(carom.Periodic(9, 9, 9),)))


@pytest.mark.parametrize(
    "world", [lambda: carom.Simulation(walls=carom.Box(4, 4, 4)), alone, at_rest, fixed]
)
def test_odd_worlds_are_shown(show, world):
    """None, one, at rest, all fixed: nothing is divided by zero, and every tool is harmless."""
    shown = show(world())
    shown.wait("carom.drawn.t >= 0")
    shown.js("document.querySelectorAll('#panel details').forEach((part) => (part.open = true))")
    keys = ("j", "d", "t", "o", "c", "c", "c", "w", "w", "n", "b", "v", "v", "f", "a")
    for key in (*keys, "Escape", "Space", "r", "x"):
        shown.page.keyboard.press(key)
    shown.wait("carom.settings.comparing")
    time.sleep(1.5)
    numbers = (
        "[...carom.camera.view, ...carom.camera.projection, carom.hands.time, carom.look.full]"
    )
    assert shown.js(f"{numbers}.every(Number.isFinite)")
    text = shown.page.locator("#panel").inner_text()
    assert "NaN" not in text
    assert "Infinity" not in text
    assert "undefined" not in text
    assert shown.js("carom.banners.failures.page") == ""
    shown.page.keyboard.press("x")
    shown.wait("!carom.settings.comparing")
    for n in range(shown.js("carom.scene.n") - 1, -1, -1):
        shown.js("carom.hands.select(0)")
        shown.page.keyboard.press("Delete")
        if n > 0:
            shown.wait(f"carom.scene.n === {n}")
        else:
            shown.page.locator(".toast").filter(has_text="the last sphere").wait_for()
    n = shown.js("carom.scene.n")
    shown.js("carom.camera.look([-30, 5, 9], [1, 1.2, -1.5])")  # there is room
    shown.js("carom.hands.next.radius = 0.2")
    shown.page.keyboard.press("a")
    shown.page.locator("#view").press("Enter")
    shown.wait(f"carom.scene.n === {n + 1} && carom.drawn.t >= 0")
