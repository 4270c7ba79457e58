"""Pages of other sites, in the same browser, are kept out."""

import time

from carom.view import LiveView

from .test_page import still_life


def test_other_sites_cannot_listen(chromium, show):
    """Pages of another origin, in the same browser, get no connection."""
    shown = show(still_life())
    address = shown.view.url.split("/#")[0].removeprefix("http://")
    knock = """(address) => new Promise((done) => {
      const socket = new WebSocket(`ws://${address}/live`);
      socket.onopen = () => done("open");
      socket.onerror = () => done("refused");
    })"""
    with LiveView(still_life()) as other:
        for place in (other.url.split("#")[0], "about:blank"):
            page = chromium.new_page()
            page.goto(place)
            assert page.evaluate(knock, address) == "refused"
            page.close()


def test_other_sites_cannot_frame_it(chromium, show):
    shown = show(still_life())
    page = chromium.new_page()
    complaints = []
    page.on("console", lambda message: complaints.append(message.text))
    page.set_content(f"<iframe src='{shown.view.url.split('#')[0]}'></iframe>")
    end = time.perf_counter() + 5
    while not complaints and time.perf_counter() < end:
        page.wait_for_timeout(50)
    assert "frame-ancestors" in complaints[0]
    page.close()
