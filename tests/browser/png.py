"""Reads the screenshots a browser makes, and the pixels at places in the world."""

import struct
import zlib

import numpy as np


def pixels(data):
    """(height, width, 3) uint8 of an 8-bit RGB or RGBA picture (PNG specification, section 9)."""
    place, chunks = 8, {}
    while place < len(data):
        size, name = struct.unpack_from(">I4s", data, place)
        chunks[name] = chunks.get(name, b"") + data[place + 8 : place + 8 + size]
        place += 12 + size
    width, height, depth, kind = struct.unpack_from(">IIBB", chunks[b"IHDR"])
    channels = {2: 3, 6: 4}[kind]
    assert depth == 8
    rows = np.frombuffer(zlib.decompress(chunks[b"IDAT"]), np.uint8).reshape(height, -1)
    picture = np.zeros((height, width, channels), np.uint8)
    above = np.zeros((width, channels), np.int64)
    for row, line in enumerate(rows):
        above = unfilter(int(line[0]), line[1:].reshape(width, channels).astype(np.int64), above)
        picture[row] = above
    return picture[:, :, :3]


def unfilter(kind, line, above):
    if kind == 0:
        return line
    if kind == 1:
        return np.cumsum(line, axis=0) % 256
    if kind == 2:
        return (line + above) % 256
    left = corner = np.zeros(line.shape[1], np.int64)
    for x in range(len(line)):
        guess = (left + above[x]) // 2 if kind == 3 else paeth(left, above[x], corner)
        corner = above[x]
        left = line[x] = (line[x] + guess) % 256
    return line


def paeth(left, above, corner):
    guess = left + above - corner
    a, b, c = abs(guess - left), abs(guess - above), abs(guess - corner)
    return np.where((a <= b) & (a <= c), left, np.where(b <= c, above, corner))
