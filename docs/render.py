"""Makes the pictures of docs/render.md: ``python docs/render.py``, with the `video` extra."""

from pathlib import Path

import carom
from carom import scenes

IMAGES = Path(__file__).parent / "images"


def main() -> None:
    """Draw them."""
    gas = carom.Simulation(scenes.gas(n=400, packing_fraction=0.08))
    carom.render(gas, IMAGES / "render-gas.png", until=30.0, size=(960, 540))
    cradle = carom.Simulation(scenes.newton_cradle())
    carom.render(cradle, IMAGES / "render-cradle.png", until=2.6, size=(960, 400), theme="light")


if __name__ == "__main__":
    main()
