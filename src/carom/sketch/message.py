"""A sketch's frame as it goes to the page; `static/sketch_protocol.js` is the other side.

Binary, little-endian. It begins with the 24 bytes of `carom.view.wire.HEADER`, as every message
does: kind is SKETCH, n the number of shapes, the epoch counts restarts, the scene's number is 0.

====== ========= ===================================================================
offset type      meaning
====== ========= ===================================================================
24     u4        width of the sheet, pixels
28     u4        height
32     u4        colour of the sheet: bytes red, green, blue, 255
36     u4        frame: how often draw() has run
40     f4        frames per second asked for
44     f4        frames per second reached
48     64 n      shapes
====== ========= ===================================================================

A shape, its offsets from where it begins:

====== ========= ===================================================================
0      f4[12]    matrix, column by column: where the unit vectors x, y, z of the shape
                 go, and its origin. A sphere has radius 1, a box sides 1, both around
                 the origin; a line goes from the origin to (1, 0, 0)
48     u4        fill: bytes red, green, blue, alpha; alpha 0 is none
52     u4        stroke, likewise
56     f4        stroke weight, pixels of the sheet
60     u2        kind: 0 sphere, 1 box, 2 line
62     u2        meridians of a sphere's lines
====== ========= ===================================================================

Places are Processing's: origin at the top left, y downwards, z towards the viewer.

Text notes of a sketch: ``title`` (the file's name), ``printed`` (the last of what the program
printed), ``failure`` (a sentence, "" when all is well again).
"""

import struct

from carom.sketch.recorder import Picture
from carom.view import wire

SHEET = struct.Struct("<IIIIff")


def encode(
    picture: Picture,
    *,
    epoch: int,
    playing: bool,
    failed: bool,
    rate: float,
    reached: float,
) -> bytes:
    """Pack a frame, 48 + 64 n bytes."""
    flags = wire.PLAYING * playing | wire.FAILED * failed
    header = wire.SCENE_HEADER.pack(
        wire.MAGIC, wire.VERSION, wire.SKETCH, picture.n, epoch, flags, 0
    )
    sheet = SHEET.pack(
        picture.width, picture.height, picture.background.rgba, picture.frame, rate, reached
    )
    return header + sheet + picture.shapes
