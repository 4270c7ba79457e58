"""The wire protocol, on the server's side."""

import json
import math
import struct
from importlib import resources

import numpy as np
import pytest

from carom.errors import InputError
from carom.state import State
from carom.view import wire
from carom.view.protocol import Meters, decode_command, encode_frame, encode_scene
from carom.view.wire import FRAME_HEADER, MAX_MESSAGE


def meters(**changes):
    values = dict(
        clock=5.0, gravity=(0.0, 0.0, -1.0), kinetic=2.5, potential=1.5, dissipated=0.5,
        drift=3e-15, speed=0.25, reached=0.2, momentum=(7.0, 8.0, 9.0), temperature=1.25,
        missed=4, overlap=0.125, full_energy=20.0, full_speed=5.0, epoch=7, scene=3,
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
    start = 24 + 8 * 21
    assert len(frame) == start + 28 * 3
    assert frame[:4] == b"CARO"
    assert struct.unpack_from("<HHIIII", frame, 4) == (3, 1, 3, 7, 1, 3)
    assert struct.unpack_from("<19d", frame, 24) == (
        *(0.1, 5.0, 0.0, 0.0, -1.0, 2.5, 1.5, 0.5, 3e-15, 2.0**40, 9.0, 0.25, 0.2),
        *(7.0, 8.0, 9.0, 1.25, 4.0, 0.125),
    )
    body = np.frombuffer(frame, "<f4", 18, start)
    assert body[:9].tolist() == list(range(1, 10))
    assert body[9:].tolist() == [-value for value in range(1, 10)]
    counts = np.frombuffer(frame, "<u4", 3, start + 72)
    assert counts.tolist() == [5, 2**31 + 133, 2**31 + 2]


@pytest.mark.parametrize(
    ("changes", "flags"),
    [
        ({}, 1), ({"playing": False}, 0), ({"failed": True}, 3), ({"twin": True}, 5),
        ({"reversed": True}, 9),
    ],
)  # fmt: skip
def test_flags(state, changes, flags):
    assert FRAME_HEADER.unpack_from(encode_frame(state, meters(**changes)))[5] == flags


def test_scene_has_the_bytes_of_the_table(state):
    state.mass[1] = math.inf
    message = encode_scene(state, 4, {"title": "é"})
    size = struct.unpack_from("<I", message, 16)[0]
    assert struct.unpack_from("<HHII", message, 4) == (3, 2, 3, 0)
    assert struct.unpack_from("<I", message, 20)[0] == 4
    assert size % 4 == 0
    assert json.loads(message[24 : 24 + size]) == {"title": "é"}
    assert len(message) == 24 + size + 16 * 3
    mass = np.frombuffer(message, "<f4", 3, 24 + size + 12)
    assert mass.tolist() == [1.0, math.inf, 1.0]


def test_the_pages_tables_are_these():
    page = resources.files("carom.view") / "static" / "wire.js"
    assert page.read_text(encoding="utf-8") == wire.javascript()


@pytest.mark.parametrize(
    ("text", "op", "values"),
    [
        ('{"op": "play"}', "play", {}),
        ('{"op": "speed", "value": 0.001}', "speed", {"value": 0.001}),
        ('{"op": "speed", "value": 100}', "speed", {"value": 100.0}),
        ('{"op": "credit", "count": 4}', "credit", {"count": 4}),
        ('{"op": "gravity", "value": [0, -1, 2.5]}', "gravity", {"value": (0, -1, 2.5)}),
        ('{"op": "compare", "on": true}', "compare", {"on": True}),
        ('{"op": "push", "index": 3, "velocity": [1, 2, 3]}', "push",
         {"index": 3, "velocity": (1, 2, 3)}),
        ('{"op": "scene", "name": "gas", "options": {"n": 5, "a": "b", "c": true}}', "scene",
         {"name": "gas", "options": {"n": 5, "a": "b", "c": True}}),
    ],
)  # fmt: skip
def test_commands(text, op, values):
    command = decode_command(text)
    assert (command.op, command.values) == (op, values)


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
        '{"op": "gravity", "value": [0, 0]}',
        '{"op": "gravity", "value": [0, 0, "1"]}',
        '{"op": "gravity", "value": [0, 0, 1e7]}',
        '{"op": "gravity", "value": 1}',
        '{"op": "rule", "restitution": 1.01}',
        '{"op": "walls", "restitution": -0.01}',
        '{"op": "compare", "on": 1}',
        '{"op": "remove", "index": -1}',
        '{"op": "remove", "index": 0.5}',
        '{"op": "push", "index": 0, "velocity": [0, 0, 1e10]}',
        '{"op": "scene", "name": 5, "options": {}}',
        '{"op": "scene", "name": "gas", "options": []}',
        '{"op": "scene", "name": "gas", "options": {"n": [1]}}',
        '{"op": "scene", "name": "gas", "options": {"n": null}}',
        '{"op": "scene", "name": "' + "x" * 101 + '", "options": {}}',
        json.dumps({"op": "scene", "name": "gas", "options": {str(k): 1 for k in range(41)}}),
        '{"op": "add", "position": [0, 0, 0], "velocity": [0, 0, 0], "radius": 0, "mass": 1, '
        '"color": 1}',
        '{"op": "add", "position": [0, 0, 0], "velocity": [0, 0, 0], "radius": 1, "mass": 1, '
        '"color": 16777216}',
        "[" * MAX_MESSAGE,
        '{"op": "play"}' + " " * MAX_MESSAGE,
        b'{"op": "play"}',
    ],
)
def test_everything_else_is_refused(text):
    with pytest.raises(InputError, match=r"\w"):
        decode_command(text)
