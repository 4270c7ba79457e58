"""Pictures look as they did: as eyes see them, not bit by bit, since compilers round differently.

``python -m tests.golden.test_pictures`` renews them; look at what has changed before keeping it.
"""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from tests.unit.seen import coarse, distance

import carom
from carom import scenes

PICTURES = Path(__file__).parent / "pictures"
SIZE = (192, 108)
#: Root mean square difference of blocks, and the largest, from 0 to 255. The gas without shadows
#: differs by 5.6 and 37; shifted by a pixel by 6.2; drawn with one sample per pixel by 1.7.
CLOSE, CLOSEST = 0.25, 4.0


def crowd(walls, **options):
    """A small lattice of spheres of three kinds."""
    places = np.array([(x, y, z) for x in (-2, 0, 2) for y in (-2, 0, 2) for z in (-2, 0, 2)])
    spheres = carom.Spheres.of(
        places * 0.9, (0.1, 0.2, 0.3) * places, 0.7, species=np.arange(27) % 3
    )
    return carom.Scene(spheres, walls, color="species", **options)


SHOWN = {
    "gas": (scenes.gas(n=300, seed=1), {}),
    "gas-light": (scenes.gas(n=300, seed=1), {"theme": "light"}),
    "gas-draft": (scenes.gas(n=300, seed=1), {"quality": "draft", "shadows": False}),
    "phase-4": (scenes.phase_4(), {}),
    "phase-0-light": (scenes.phase_0(), {"theme": "light"}),
    "fluid": (scenes.fluid(n=1000, seed=1), {}),
    "newton-cradle": (scenes.newton_cradle(), {}),
    "galperin": (scenes.galperin(), {}),
    "sphere": (crowd(carom.Sphere(5)), {}),
    "cylinder": (crowd(carom.Cylinder(4, 8)), {}),
    "periodic": (crowd(carom.Periodic(5, 5, 5)), {}),
    "plane-speed": (crowd(carom.Plane((0, 0, 1), -3)), {"color": "speed"}),
    "camera": (crowd(carom.Box(8, 8, 8)), {"camera": carom.Camera((1, -9, 3), (0, 0, 1))}),
}


def drawn(name):
    scene, options = SHOWN[name]
    return carom.Simulation(scene).picture(size=SIZE, caption=False, **options).pixels


@pytest.mark.parametrize("name", SHOWN)
def test_pictures_look_as_they_did(name):
    golden = np.asarray(Image.open(PICTURES / f"{name}.png"))
    shown = drawn(name)
    assert distance(shown, golden) < CLOSE
    assert np.abs(coarse(shown) - coarse(golden)).max() < CLOSEST


def test_the_limits_tell_pictures_apart():
    gas = np.asarray(Image.open(PICTURES / "gas.png"))
    bare = np.asarray(Image.open(PICTURES / "gas-draft.png"))
    assert distance(gas, bare) > 3 * CLOSE
    assert distance(gas, np.roll(gas, 1, axis=1)) > 3 * CLOSE


def main():
    PICTURES.mkdir(exist_ok=True)
    for name in SHOWN:
        scene, options = SHOWN[name]
        picture = carom.Simulation(scene).picture(size=SIZE, caption=False, **options)
        picture.save(PICTURES / f"{name}.png")


if __name__ == "__main__":
    main()
