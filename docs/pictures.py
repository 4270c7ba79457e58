"""Makes the pictures of README.md: the live view itself, in a headless Chromium.

Run ``python docs/pictures.py``; it needs the `dev` extra and Chromium.
"""

import shutil
import time
from pathlib import Path

from playwright.sync_api import sync_playwright

import carom
from carom import scenes
from carom.view import LiveView

IMAGES = Path(__file__).parent / "images"
SOFTWARE_GL = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


def main() -> None:
    """Show phase 4 for some seconds, then take its picture."""
    program = shutil.which("chromium") or shutil.which("chromium-browser")
    sim = carom.Simulation(scenes.phase_4())
    with LiveView(sim) as view, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=program, args=SOFTWARE_GL)
        page = browser.new_page(viewport={"width": 1280, "height": 720}, color_scheme="dark")
        page.goto(view.url)
        time.sleep(8)
        page.screenshot(path=IMAGES / "phase-4.png")
        browser.close()


if __name__ == "__main__":
    main()
