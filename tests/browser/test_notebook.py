"""The notebook's widget in a real browser: its front end, hosted as anywidget hosts it."""

import base64
import time

import pytest

import carom
from carom import scenes
from carom.view.files import FOLDER

#: As much of a notebook as a widget needs: models that send to the kernel and hear from it.
HOST = """async ([esm, models]) => {
  const address = URL.createObjectURL(new Blob([esm], { type: "text/javascript" }));
  const { default: widget } = await import(address);
  globalThis.ends = models.map((traits, k) => {
    const listeners = [];
    const model = {
      get: (name) => traits[name],
      on: (event, act) => listeners.push(act),
      off: (event, act) => listeners.splice(listeners.indexOf(act), 1),
      send: async (content) => {
        for (const [answer, buffers] of await toKernel(k, content)) {
          const views = buffers.map((text) =>
            new DataView(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)).buffer));
          for (const act of [...listeners]) act(answer, views);
        }
      },
    };
    const el = document.createElement("div");
    document.body.append(el);
    return widget.render({ model, el });
  });
}"""


@pytest.fixture
def notebook(chromium):
    """Show widgets in one page; gives their frames. Checks what the page did meanwhile."""
    complaints, calls = [], []
    context = chromium.new_context(viewport={"width": 900, "height": 900}, reduced_motion="reduce")
    page = context.new_page()
    page.on("console", lambda message: complaints.append(message.text))
    page.on("pageerror", lambda error: complaints.append(str(error)))
    context.on("request", lambda request: calls.append(request.url))

    def show(*widgets):
        sent = []
        for widget in widgets:
            widget.send = lambda content, buffers: sent.append((content, buffers))

        def to_kernel(k, content):
            sent.clear()
            widgets[k]._handle_custom_msg(content, [])
            return [(c, [base64.b64encode(b).decode() for b in buffers]) for c, buffers in sent]

        page.expose_function("toKernel", to_kernel)
        traits = [
            {"page": w.page, "title": w.title, "height": w.height, "live": w.live} for w in widgets
        ]
        page.evaluate(HOST, [(FOLDER / "notebook.js").read_text("utf-8"), traits])
        wait(lambda: len(page.frames) == 1 + len(widgets))
        return page.frames[1:]

    yield show
    context.close()
    assert complaints == []
    assert all(call.startswith(("blob:", "about:", "data:")) for call in calls), calls


def wait(condition, seconds=15.0):
    end = time.perf_counter() + seconds
    while not condition():
        assert time.perf_counter() < end
        time.sleep(0.05)


def until(frame, expression):
    """The page's policy lets no text become a program, so Playwright's own waiting fails."""
    end = time.perf_counter() + 15
    while not frame.evaluate(expression):
        assert time.perf_counter() < end, expression
        frame.page.wait_for_timeout(50)


def test_two_widgets_live_side_by_side(notebook):
    sims = [carom.Simulation(scenes.build(name)) for name in ("two-balls", "bounce")]
    first, second = notebook(sims[0].view(height=400), sims[1].view(color="speed", height=400))
    for frame in (first, second):
        until(frame, "globalThis.carom?.timeline.t > 0.1")
    assert first.evaluate("[carom.scene.n, carom.look.color]") == [2, "own"]
    assert second.evaluate("[carom.scene.n, carom.look.color]") == [25, "speed"]
    # What is done to one reaches its simulation and not the other's.
    first.get_by_role("button", name="Pause", exact=True).click()
    until(
        first,
        "carom.timeline.newest.playing === false && carom.timeline.t === carom.timeline.newest.t",
    )
    stood = sims[0].time
    first.evaluate("carom.laws.spheres.changed(0.25)")
    until(first, "carom.settings.restitution === 0.25")
    assert sims[0].rule.restitution == 0.25
    assert sims[1].rule.restitution != 0.25
    went = sims[1].time
    until(second, f"carom.timeline.t > {went}")
    assert sims[0].time == stood
    assert first.evaluate("document.body.dataset.theme") == second.evaluate(
        "document.body.dataset.theme"
    )
    hidden = "['gallery-button', 'film'].every((id) => document.getElementById(id).hidden)"
    assert first.evaluate(hidden)


def test_a_recording_plays_without_a_kernel(notebook, tmp_path):
    with carom.Simulation(scenes.build("two-balls")) as sim:
        sim.record(tmp_path / "run.gsd", every=1)
        sim.run(until=5)
    with carom.load(tmp_path / "run.gsd") as run:
        (frame,) = notebook(run.view(height=400))
    until(frame, "globalThis.carom?.timeline.t > 0.1")
    assert frame.evaluate("carom.timeline.end") == 5
    frame.get_by_role("slider", name="Place in the film").press("Home")
    assert frame.evaluate("carom.timeline.t") == 0
