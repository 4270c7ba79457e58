"""`carom render` draws what the page shows."""

import base64
import io

import numpy as np
import pytest
from PIL import Image
from tests.unit.seen import coarse, distance

import carom
from carom import scenes

#: The page's picture without its panels, in its best quality, in the size of the viewport.
DRAWN = """async () => {
  const { camera, renderer, actions } = carom;
  const [width, height] = [640, 360];
  const bare = () => camera.resize(width, height, { left: 0, right: 0, top: 0, bottom: 0 });
  bare();
  actions.fit();
  camera.finish();
  bare();
  renderer.picture.sides[0].viewport = { x: 0, y: 0, width, height };
  const bitmap = await createImageBitmap(await renderer.toBlob());
  const small = Object.assign(document.createElement("canvas"), { width, height });
  const context = small.getContext("2d");
  context.imageSmoothingQuality = "high";
  context.drawImage(bitmap, 0, 0, width, height);
  return [small.toDataURL("image/png").split(",")[1], carom.drawn.t];
}"""


@pytest.mark.parametrize(
    "scene", [scenes.gas(n=150), scenes.fluid(n=600), scenes.newton_cradle()], ids=lambda s: s.title
)
@pytest.mark.parametrize("theme", ["dark", "light"])
def test_pictures_are_those_of_the_page(show, scene, theme):
    page = show(carom.Simulation(scene), width=640, height=360, color_scheme=theme)
    page.settle()
    data, time = page.js(DRAWN)
    theirs = np.asarray(Image.open(io.BytesIO(base64.b64decode(data))).convert("RGB"))
    sim = carom.Simulation(scene)
    sim.run(until=time)
    ours = sim.picture(size=(640, 360), theme=theme, caption=False).pixels
    assert distance(ours, theirs, block=8) < 4
    assert np.abs(coarse(ours, 8) - coarse(theirs, 8)).mean() < 1.5
