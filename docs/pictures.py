"""Makes the pictures: the live view itself, in a headless Chromium.

Run ``python docs/pictures.py`` for the pictures of README.md and of the gallery, or name scenes
to renew their pictures only; it needs the `dev` extra and Chromium.
"""

import base64
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
CLOSER = 0.95  #: than a fit, which leaves a margin for panels
LARGEST = 25_000  #: bytes of a picture of the gallery
#: Seconds until a scene looks most like itself.
MOMENTS = {"bounce": 1.0, "break-shot": 2.5, "newton-cradle": 1.2, "two-balls": 2.0}

#: Draws the scene alone, twice as large as needed, and makes it small: smooth edges.
SMALL = """async () => {
  const { camera, canvas, renderer, actions } = carom;
  camera.resize(canvas.clientWidth, canvas.clientHeight, { left: 0, right: 0, top: 0, bottom: 0 });
  actions.fit();
  camera.zoom(CLOSER);
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
    with LiveView(carom.Simulation(scenes.build(name))) as view:
        page = shown(browser, view, 640, 400)
        time.sleep(MOMENTS.get(name, 3.0))
        page.evaluate("carom.timeline.newest.playing && carom.actions.toggle()")
        for quality in (0.9, 0.8, 0.7, 0.5):
            script = SMALL.replace("QUALITY", str(quality)).replace("CLOSER", str(CLOSER))
            data = base64.b64decode(page.evaluate(script))
            if len(data) <= LARGEST:
                break
        page.close()
    GALLERY.joinpath(f"{name}.webp").write_bytes(data)
    print(f"{name}: {len(data)} bytes")


def readme(browser: Browser) -> None:
    """Phase 4 after some seconds."""
    with LiveView(carom.Simulation(scenes.phase_4())) as view:
        page = shown(browser, view, 1280, 720)
        time.sleep(8)
        page.screenshot(path=IMAGES / "phase-4.png")
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
