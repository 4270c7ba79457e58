"""The page over time: nothing piles up, and it comes back after a loss."""

import gc
import socket
import time
from pathlib import Path

import pytest

import carom
from carom import scenes
from carom.view import LiveView

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
    assert shown.js("carom.timeline.newest.playing")
    page.close()
