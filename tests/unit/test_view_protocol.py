"""The wire protocol, on the server's side."""

import json
import math
import struct

import numpy as np
import pytest

from carom.errors import InputError
from carom.state import State
from carom.view.protocol import (
    FRAME_HEADER,
    MAX_MESSAGE,
    Meters,
    decode_command,
    encode_frame,
    encode_scene,
)


def meters(**changes):
    values = dict(
        clock=5.0, gravity=(0.0, 0.0, -1.0), kinetic=2.5, potential=1.5, dissipated=0.5,
        drift=3e-15, speed=0.25, reached=0.2, epoch=7, scene=3, playing=True, failed=False,
    )  # fmt: skip
    return Meters(**{**values, **changes})


@pytest.fixture
def state():
    made = State.empty(3)
    made.position[:] = [(1, 2, 3), (4, 5, 6), (7, 8, 9)]
    made.velocity[:] = -made.position
    made.collision_count[:] = (5, 128 + 5, 2)
    made.fixed[1], made.resting[2] = True, True
    made.time, made.collisions, made.wall_collisions = 0.1, 2**40, 9
    return made


def test_frame_has_the_bytes_of_the_table(state):
    frame = encode_frame(state, meters())
    assert len(frame) == 128 + 25 * 3
    assert frame[:4] == b"CARO"
    assert struct.unpack_from("<HHIIII", frame, 4) == (1, 1, 3, 7, 1, 3)
    numbers = struct.unpack_from("<13d", frame, 24)
    assert numbers == (0.1, 5.0, 0.0, 0.0, -1.0, 2.5, 1.5, 0.5, 3e-15, 2.0**40, 9.0, 0.25, 0.2)
    body = np.frombuffer(frame, "<f4", 18, 128)
    assert body[:9].tolist() == list(range(1, 10))
    assert body[9:].tolist() == [-value for value in range(1, 10)]
    assert list(frame[-3:]) == [5, 128 + 5, 128 + 2]


def test_flags_say_paused_and_failed(state):
    frame = encode_frame(state, meters(playing=False, failed=True))
    assert FRAME_HEADER.unpack_from(frame)[5] == 2


def test_scene_has_the_bytes_of_the_table(state):
    state.mass[1] = math.inf
    message = encode_scene(state, 4, {"title": "é"})
    size = struct.unpack_from("<I", message, 16)[0]
    assert struct.unpack_from("<HHII", message, 4) == (1, 2, 3, 0)
    assert struct.unpack_from("<I", message, 20)[0] == 4
    assert size % 4 == 0
    assert json.loads(message[24 : 24 + size]) == {"title": "é"}
    assert len(message) == 24 + size + 16 * 3
    mass = np.frombuffer(message, "<f4", 3, 24 + size + 12)
    assert mass.tolist() == [1.0, math.inf, 1.0]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ('{"op": "play"}', ("play", 0, 0.0)),
        ('{"op": "speed", "value": 0.001}', ("speed", 0, 0.001)),
        ('{"op": "speed", "value": 100}', ("speed", 0, 100.0)),
        ('{"op": "credit", "count": 4}', ("credit", 4, 0.0)),
    ],
)
def test_commands(text, expected):
    command = decode_command(text)
    assert (command.op, command.count, command.value) == expected


@pytest.mark.parametrize(
    "text",
    [
        "",
        "no json",
        "[]",
        "null",
        '"play"',
        "{}",
        '{"op": 1}',
        '{"op": ["play"]}',
        '{"op": "eval", "code": "1"}',
        '{"op": "play", "more": 1}',
        '{"op": "speed"}',
        '{"op": "speed", "value": "1"}',
        '{"op": "speed", "value": true}',
        '{"op": "speed", "value": null}',
        '{"op": "speed", "value": NaN}',
        '{"op": "speed", "value": Infinity}',
        '{"op": "speed", "value": 1e999}',
        '{"op": "speed", "value": 0}',
        '{"op": "speed", "value": 100.1}',
        '{"op": "speed", "value": 1' + "0" * 400 + "}",
        '{"op": "credit", "count": 5}',
        '{"op": "credit", "count": 0}',
        '{"op": "credit", "count": -1}',
        '{"op": "credit", "count": 1.5}',
        '{"op": "hello", "token": 5, "version": 1}',
        '{"op": "hello", "token": "x", "version": "1"}',
        "[" * MAX_MESSAGE,
        '{"op": "play"}' + " " * MAX_MESSAGE,
        b'{"op": "play"}',
    ],
)
def test_everything_else_is_refused(text):
    with pytest.raises(InputError, match=r"\w"):
        decode_command(text)
