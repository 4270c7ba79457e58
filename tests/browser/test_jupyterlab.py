"""Views in a real JupyterLab: a server, a kernel, and cells that a person runs."""

import json
import os
import subprocess
import sys
import time

import numpy as np
import pytest

from .png import pixels
from .test_notebook import until, wait

CELLS = [
    "import carom\nsim = carom.Simulation(carom.scenes.gas(n=60))\nsim.view(height=240)",
    "sim.view(height=240, color='energy')",
    "with carom.Simulation(carom.scenes.two_balls()) as other:\n"
    "    other.record('run.gsd', every=0.5)\n"
    "    other.run(until=60)\n"
    "carom.load('run.gsd').view(height=240)",
]


@pytest.fixture
def lab(tmp_path):
    """Addresses of a notebook in a JupyterLab that knows of no other, and asks nobody."""
    cells = [
        {
            **{"cell_type": "code", "id": f"cell-{k}", "source": source},
            **{"execution_count": None, "metadata": {}, "outputs": []},
        }
        for k, source in enumerate(CELLS)
    ]
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    book = {"cells": cells, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}
    work, own = tmp_path / "work", tmp_path / "jupyter"
    work.mkdir()
    (work / "views.ipynb").write_text(json.dumps(book))
    places = ("JUPYTER_CONFIG_DIR", "JUPYTER_DATA_DIR", "JUPYTER_RUNTIME_DIR", "IPYTHONDIR")
    places += ("JUPYTERLAB_SETTINGS_DIR", "JUPYTERLAB_WORKSPACES_DIR")
    command = [
        *(sys.executable, "-m", "jupyterlab", "--no-browser", "--allow-root"),
        *("--ServerApp.ip=127.0.0.1", "--ServerApp.port=0", f"--ServerApp.root_dir={work}"),
        "--LabApp.check_for_updates_class=jupyterlab.NeverCheckForUpdate",
        "--LabApp.extension_manager=readonly",
    ]
    with (tmp_path / "log").open("w") as log:
        server = subprocess.Popen(
            command,
            env={**os.environ, **{place: str(own / place) for place in places}},
            stdout=log,
            stderr=subprocess.STDOUT,
        )
        try:
            wait(lambda: server.poll() is not None or _told(own), seconds=60)
            assert server.poll() is None, (tmp_path / "log").read_text()
            told = _told(own)
            yield told["url"], f"{told['url']}lab/tree/views.ipynb?token={told['token']}"
        finally:
            server.terminate()  # it ends its kernels first
            server.wait(30)


def _told(own):
    """What the server says of itself, once it listens."""
    for path in (own / "JUPYTER_RUNTIME_DIR").glob("jpserver-*.json"):
        if (text := path.read_text()).endswith("}"):
            return json.loads(text)
    return None


@pytest.fixture
def book(chromium, lab):
    """The notebook in a browser. When all is done, checks what the page did meanwhile."""
    complaints, calls = [], []
    context = chromium.new_context(viewport={"width": 960, "height": 1080}, reduced_motion="reduce")
    page = context.new_page()
    page.on(
        "console",
        lambda message: (
            complaints.append(message.text) if message.type in ("error", "warning") else None
        ),
    )
    page.on("pageerror", lambda error: complaints.append(str(error)))
    context.on("request", lambda request: calls.append(request.url))
    root, address = lab
    page.goto(address, timeout=60_000)
    page.get_by_text("| Idle").wait_for(timeout=60_000)
    yield page
    context.close()
    assert complaints == []
    assert all(call.startswith((root, "blob:", "data:", "about:")) for call in calls), calls


def views(page):
    """The frames of all views, in the order of their cells."""
    places = page.locator(".jp-OutputArea-output iframe")
    return [place.element_handle().content_frame() for place in places.all()]


def picture(frame):
    time.sleep(0.3)  # numbers are written ten times a second
    return pixels(frame.frame_element().screenshot())


def test_views_in_jupyterlab(book):
    for entry in ("Run", "Run All Cells"):
        book.get_by_role("menuitem", name=entry, exact=True).click()
    wait(lambda: len(views(book)) == 3, seconds=60)
    first, second, recorded = views(book)
    for frame in (first, second, recorded):
        until(frame, "globalThis.carom?.timeline.t > 0.1")
        assert np.ptp(picture(frame)[90:150, 200:400], axis=(0, 1)).min() > 50
    assert [f.evaluate("carom.scene.n") for f in (first, second, recorded)] == [60, 60, 2]
    assert [f.evaluate("carom.look.color") for f in (first, second)] == ["speed", "energy"]
    # Both views are of one simulation, so a pause in one is one for both.
    second.get_by_role("button", name="Pause", exact=True).click()
    for frame in (first, second):
        until(frame, "carom.timeline.newest.playing === false")
        until(frame, "carom.timeline.t === carom.timeline.newest.t")
    book.mouse.move(5, 5)
    assert first.evaluate("carom.timeline.t") == second.evaluate("carom.timeline.t")
    still = picture(first)
    assert np.array_equal(picture(first), still)
    recorded.get_by_role("button", name="Pause", exact=True).click()
    recorded.get_by_role("slider", name="Place in the film").press("End")
    assert recorded.evaluate("carom.timeline.t") == 60
    # A cell that is moved loads its view anew, which shows where time stands, and goes on.
    stood = first.evaluate("carom.timeline.t")
    first.evaluate("globalThis.before = true")
    cells = book.locator(".jp-InputArea-editor")
    cells.first.click()
    book.keyboard.press("Escape")
    book.keyboard.press("Control+Shift+ArrowDown")
    wait(lambda: "energy" in cells.first.inner_text())
    moved = views(book)[1]
    until(moved, f"globalThis.before === undefined && globalThis.carom?.timeline.t === {stood}")
    moved.get_by_role("button", name="Play", exact=True).click()
    until(moved, f"carom.timeline.t > {stood}")
