"""A real Chromium, and pages in it that must neither complain nor call anybody."""

import shutil
import time
from contextlib import ExitStack

import pytest
from playwright.sync_api import sync_playwright

from carom.view import LiveView

ARGUMENTS = [
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]


class Shown:
    """A page that shows a simulation."""

    def __init__(self, sim, view, page):
        self.sim, self.view, self.page = sim, view, page

    def js(self, expression):
        return self.page.evaluate(expression)

    def wait(self, expression, seconds=10.0):
        """Until a JavaScript expression is true."""
        end = time.perf_counter() + seconds
        while not (value := self.js(expression)):
            assert time.perf_counter() < end, f"never true: {expression}"
            time.sleep(0.02)
        return value

    def settle(self):
        """Pause, and wait until the picture shows the last moment."""
        if self.js("carom.timeline.newest?.playing !== false"):
            self.page.get_by_role("button", name="Pause", exact=True).click()
        self.wait("carom.timeline.newest?.playing === false")
        self.wait("carom.timeline.t === carom.timeline.newest?.t")
        self.page.mouse.move(3, 300)
        # Two pictures later everything is on the screen, the ten-times-a-second numbers too.
        time.sleep(0.25)

    def text(self, name):
        return self.page.locator(f"#{name}").inner_text()


@pytest.fixture(scope="session")
def chromium():
    program = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
    assert program, "chromium is needed: apt install chromium"
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=ARGUMENTS)
        yield browser
        browser.close()


@pytest.fixture
def show(chromium):
    """Show a simulation in a new page. When all is done, checks what the page did meanwhile."""
    complaints, calls = [], []
    with ExitStack() as stack:

        def open_page(sim, width=1280, height=720, wait=True, **options):
            view = stack.enter_context(LiveView(sim))
            context = chromium.new_context(
                viewport={"width": width, "height": height},
                # Without gliding a picture is where it goes at once.
                **{"color_scheme": "dark", "reduced_motion": "reduce", **options},
            )
            stack.callback(context.close)
            page = context.new_page()
            page.on("console", lambda message: complaints.append(message.text))
            page.on("pageerror", lambda error: complaints.append(str(error)))
            context.on("request", lambda request: calls.append(request.url))
            page.on("websocket", lambda socket: calls.append(socket.url))
            page.goto(view.url)
            shown = Shown(sim, view, page)
            if wait:
                shown.wait("!!globalThis.carom?.timeline.newest")
            return shown

        yield open_page
    assert complaints == []
    assert calls
    assert all(url.split("/")[2].startswith("127.0.0.1:") for url in calls), calls
