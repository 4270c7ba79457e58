"""Makes the pictures: the live view itself, in a headless Chromium.

Run ``python docs/pictures.py`` for the pictures of README.md and of the gallery, or name scenes
to renew their pictures only; it needs the `dev` extra and Chromium.
"""

import base64
import json
import shutil
import sys
import time
from pathlib import Path

from playwright.sync_api import Browser, Page, sync_playwright

import carom
from carom import scenes
from carom.view import LiveView

IMAGES = Path(__file__).parent / "images"
GALLERY = Path(carom.__file__).parent / "view" / "static" / "gallery"
SOFTWARE_GL = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
LARGEST = 25_000  #: bytes of a picture of the gallery
#: Simulated time at which a scene looks most like itself.
MOMENTS = {
    "bounce": 0.9,
    "break-shot": 1.35,
    "galperin": 2.6,
    "newton-cradle": 2.6,
    "two-balls": 3.0,
}
#: Nearer than a fit, and what is in the middle then, where most of a scene is empty.
NEARER = {"break-shot": (0.6, (1, 0, -1)), "two-balls": (0.75, (0.8, 0, -0.5))}

#: Draws the scene alone, twice as large as needed, and makes it small: smooth edges.
SMALL = """async () => {
  const { camera, canvas, renderer, actions } = carom;
  camera.resize(canvas.clientWidth, canvas.clientHeight, { left: 0, right: 0, top: 0, bottom: 0 });
  actions.fit();
  if (NEARER) {
    camera.zoom(NEARER[0]);
    camera.target = NEARER[1];
  }
  camera.finish();
  const wait = () => new Promise((done) => requestAnimationFrame(done));
  for (let k = 0; k < 3; k++) {
    carom.stale = true;
    await wait();
  }
  const picture = await createImageBitmap(await renderer.toBlob());
  const small = Object.assign(document.createElement("canvas"), { width: 320, height: 200 });
  const context = small.getContext("2d");
  context.imageSmoothingQuality = "high";
  context.drawImage(picture, 0, 0, 320, 200);
  return small.toDataURL("image/webp", QUALITY).split(",")[1];
}"""


def shown(browser: Browser, view: LiveView, width: int, height: int) -> Page:
    """A page that shows a scene in the dark."""
    page = browser.new_page(viewport={"width": width, "height": height}, color_scheme="dark")
    page.goto(view.url)
    while not page.evaluate("globalThis.carom?.drawn.t >= 0"):
        time.sleep(0.05)
    return page


def card(browser: Browser, name: str) -> None:
    """The picture of a scene in the gallery."""
    sim = carom.Simulation(scenes.build(name))
    sim.run(until=MOMENTS.get(name, 3.0 * sim.scene.pace))
    with LiveView(sim) as view:
        page = shown(browser, view, 960, 600)
        page.evaluate("carom.timeline.newest.playing && carom.actions.toggle()")
        for quality in (0.97, 0.9, 0.8, 0.6):
            near = json.dumps(NEARER.get(name))
            script = SMALL.replace("QUALITY", str(quality)).replace("NEARER", near)
            data = base64.b64decode(page.evaluate(script))
            if len(data) <= LARGEST:
                break
        page.close()
    GALLERY.joinpath(f"{name}.webp").write_bytes(data)
    print(f"{name}: {len(data)} bytes")


#: The most telling parts of the panel, and the spheres at their best.
TELLING = """() => {
  for (const name of ["section-scene", "section-settings"]) document.getElementById(name).open = false;
  carom.renderer.governor.force(3);
  carom.stale = true;
}"""


def readme(browser: Browser) -> None:
    """A gas that has found Maxwell's speeds."""
    sim = carom.Simulation(scenes.gas(n=400, packing_fraction=0.08))
    sim.run(until=30.0)
    with LiveView(sim) as view:
        page = shown(browser, view, 1440, 900)
        time.sleep(4)
        page.evaluate(TELLING)
        time.sleep(3)
        page.screenshot(path=IMAGES / "live-view.png")
        page.close()


def main() -> None:
    """Make the pictures that were asked for, or all."""
    program = shutil.which("chromium") or shutil.which("chromium-browser")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=SOFTWARE_GL)
        GALLERY.mkdir(exist_ok=True)
        for name in sys.argv[1:] or scenes.names():
            card(browser, name)
        if not sys.argv[1:]:
            readme(browser)
        browser.close()


if __name__ == "__main__":
    main()
