"""Looks at pictures as eyes do: coarsely, and at how bright they are."""

import numpy as np


def luminance(pixels):
    """(height, width) float64 from 0 to 255 (ITU-R BT.709)."""
    return np.asarray(pixels, float) @ [0.2126, 0.7152, 0.0722]


def coarse(pixels, block=4):
    """Mean luminance of blocks of pixels."""
    bright = luminance(pixels)
    height, width = (side // block * block for side in bright.shape)
    blocks = bright[:height, :width].reshape(height // block, block, width // block, block)
    return blocks.mean(axis=(1, 3))


def distance(a, b, block=4):
    """Root mean square difference of blocks, from 0 to 255."""
    return float(np.sqrt(np.mean((coarse(a, block) - coarse(b, block)) ** 2)))
