"""The page's modules in node, and both sides of the protocol against one another."""

import json
import os
import re
import shutil
import subprocess
import zlib
from importlib import resources
from pathlib import Path

import numpy as np
import pytest

import carom
from carom import scenes, sketch
from carom.sketch.message import encode
from carom.sketch.recorder import CURRENT, Recorder
from carom.state import State
from carom.view.protocol import Meters, decode_command, encode_frame, encode_scene
from carom.view.reel import decode
from carom.view.replay import pack
from carom.view.wire import OPERATIONS, REEL_FORMAT, VERSION

HERE = Path(__file__).parent / "js"


def node(name, **environment):
    """Run one test file; its own report is the message if it fails."""
    program = shutil.which("node")
    assert program, "node is needed: apt install nodejs"
    done = subprocess.run(
        [program, "--test", "--test-reporter=spec", str(HERE / name)],
        env={
            **os.environ,
            "CAROM_STATIC": str(resources.files("carom.view") / "static"),
            **environment,
        },
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr


NAMES = sorted(
    {path.name.split(".")[0] for path in HERE.glob("*.test.mjs")} - {"protocol", "reel", "sketch"}
)


@pytest.mark.parametrize("name", NAMES)
def test_modules(name):
    node(f"{name}.test.mjs")


def test_the_page_asks_for_all_its_modules_at_once():
    """A module that is found only inside another comes one journey later."""
    static = resources.files("carom.view") / "static"
    found, waiting = set(), ["main.js"]
    while waiting:
        text = (static / (name := waiting.pop())).read_text(encoding="utf-8")
        new = set(re.findall(r'from "\./(\w+\.js)"', text)) - found - {name}
        found |= new
        waiting += new
    page = (static / "index.html").read_text(encoding="utf-8")
    assert set(re.findall(r'rel="modulepreload" href="/(\w+\.js)"', page)) == found
    for name in re.findall(r'(?:href|src)="/(\w+\.\w+)"', page):
        assert (static / name).is_file(), name


def test_protocol_on_both_sides(tmp_path):
    state = State.empty(2)
    state.position[:] = [(1, 2, 3), (-4, 5.5, 6)]
    state.velocity[:] = [(0.25, 0, -1), (0, 0, 0)]
    state.radius[:] = (0.5, 2)
    state.color[:] = (0x123456, 0xFEDCBA)
    state.species[:] = (0, 2**32 - 1)
    state.collision_count[:] = (129, 7)
    state.fixed[1] = True
    state.time, state.collisions, state.wall_collisions = 0.1, 2**50 + 1, 3
    meters = Meters(
        clock=12.5, gravity=(0.0, 0.5, -9.81), kinetic=1.0, potential=2.0, dissipated=-3.0,
        drift=1e-16, speed=0.125, reached=0.1, momentum=(7.0, -8.0, 9.5), temperature=1.5,
        full_energy=20.0, full_speed=5.0, epoch=4, scene=6, missed=11, overlap=0.25,
        playing=False, failed=True, twin=True, reversed=True,
    )  # fmt: skip
    about = {"title": "Σ “quoted”", "walls": [], "pace": 60}
    (tmp_path / "frame.bin").write_bytes(encode_frame(state, meters))
    (tmp_path / "scene.bin").write_bytes(encode_scene(state, 6, about))
    expected = {
        "frame": {
            "n": 2, "epoch": 4, "scene": 6, "playing": False, "failed": True,
            "twin": True, "reversed": True, "momentum": [7.0, -8.0, 9.5], "temperature": 1.5,
            "missed": 11, "overlap": 0.25, "kinetic": 1.0, "fullEnergy": 20.0, "fullSpeed": 5.0,
            "t": 0.1, "clock": 12.5, "gravity": [0.0, 0.5, -9.81],
            "potential": 2.0, "dissipated": -3.0, "drift": 1e-16, "collisions": 2**50 + 1,
            "wallCollisions": 3, "speed": 0.125, "reached": 0.1,
            "position": np.float32(state.position).ravel().tolist(),
            "velocity": np.float32(state.velocity).ravel().tolist(),
            "counts": [129, 2**31 + 7],
        },
        "scene": {
            "about": about, "radius": [0.5, 2.0], "color": [0x123456, 0xFEDCBA],
            "species": [0, 2**32 - 1],
        },
    }  # fmt: skip
    (tmp_path / "expected.json").write_text(json.dumps(expected))
    node("protocol.test.mjs", CAROM_EXCHANGE=str(tmp_path))
    said = [decode_command(text) for text in json.loads((tmp_path / "said.json").read_text())]
    assert {command.op for command in said} == set(OPERATIONS)
    values = {command.op: command.values for command in said}
    assert values["hello"] == {"token": "token", "version": VERSION}
    assert values["credit"] == {"count": 2}
    assert values["speed"] == {"value": 0.5}
    assert values["gravity"] == {"value": (0, -1, 2)}
    assert values["scene"] == {"name": "gas", "options": {"n": 50, "speed": 1.5}}
    assert values["push"] == {"index": 7, "velocity": (1, 2, 3)}
    assert values["add"] == {
        "position": (1, 2, 3), "velocity": (0, 0, 1), "radius": 0.5, "mass": 2, "color": 0xFF0000
    }  # fmt: skip


#: Free flight and walls; chains of collisions in a periodic box; gravity and lost energy.
REELS = {"gas": {"n": 60, "seed": 4}, "fluid": {"n": 60}, "bounce": {"n": 60}}


def test_reels_on_both_sides(tmp_path):
    """The page computes the same bits as Python from the same file."""
    reels = {}
    for name, options in REELS.items():
        sim = carom.Simulation(scenes.build(name, options))
        times = np.arange(60) / 30 * sim.pace
        reels[name], _ = pack(sim, times, color=None, title=None, speed=2.0, progress=None)
        (tmp_path / f"{name}.reel").write_bytes(reels[name])
    scene, data = scenes.build("gas", REELS["gas"]), reels["gas"]
    times = np.arange(60) / 30 * scene.pace
    body = zlib.decompress(data).replace(b'"format": %d' % REEL_FORMAT, b'"format":99')
    (tmp_path / "later.reel").write_bytes(zlib.compress(body))
    again = carom.Simulation(scene, keep_events=10_000)
    again.run(until=times[-1])
    events = [
        {"t": e["time"], "i": int(e["i"]), "j": int(e["j"]), "impulse": e["impulse"].tolist()}
        for e in again.events
        if e["j"] >= 0
    ]
    (tmp_path / "events.json").write_text(json.dumps({"collisions": events}))
    node("reel.test.mjs", CAROM_EXCHANGE=str(tmp_path))
    for name, packed in reels.items():
        reel = decode(packed)
        flat = np.fromfile(tmp_path / f"{name}.spheres", np.float32).reshape(60, -1)
        x, v, counts = np.split(flat, [180, 360], axis=1)
        for part, truth in ((x, reel.position), (v, reel.velocity)):
            there = part.reshape(60, 60, 3).transpose(0, 2, 1)
            assert np.array_equal(there, truth.astype(np.float32)), name
        assert np.array_equal(counts.view(np.uint32), reel.counts)
    reel = decode(data)
    back = decode((tmp_path / "javascript.reel").read_bytes())
    assert np.array_equal(back.columns, reel.columns)
    assert np.array_equal(back.counts, reel.counts)
    assert (back.scene, back.speed) == (reel.scene, 2.0)
    assert np.abs(back.position - reel.position).max() < 1e-5 * np.ptp(reel.position)


def test_sketches_on_both_sides(tmp_path):
    recorder = Recorder()
    token = CURRENT.set(recorder)
    try:
        sketch.size(800, 600)
        sketch.background(255, 0, 51)
        sketch.translate(400, 300, -300)
        sketch.no_fill()
        sketch.stroke(1, 2, 3, 4)
        sketch.sphere(50)
        sketch.translate(0, 0, 300)
        sketch.fill("red")
        sketch.sphere_detail(36)
        sketch.sphere(20)
        sketch.no_fill()
        sketch.translate(0, 0, 100)
        sketch.box(40)
        sketch.stroke_weight(2.5)
        sketch.line(0, 0, 100, 8, 16, 100)
    finally:
        CURRENT.reset(token)
    recorder.frame = 7
    message = encode(recorder.picture(), epoch=4, playing=True, failed=True, rate=50, reached=49.5)
    (tmp_path / "sketch.bin").write_bytes(message)
    expected = {
        "frame": {
            "n": 4, "epoch": 4, "playing": True, "failed": True, "width": 800, "height": 600,
            "background": [1, 0, 0.2], "frame": 7, "rate": 50, "reached": 49.5,
        },
        "shapes": [
            {"matrix": [50, 0, 0, 0, 50, 0, 0, 0, 50, 400, 300, -300],
             "fill": 0, "stroke": 0x04030201, "weight": 1, "kind": 0, "detail": 24},
            {"matrix": [20, 0, 0, 0, 20, 0, 0, 0, 20, 400, 300, 0],
             "fill": 0xFF0000FF, "stroke": 0x04030201, "weight": 1, "kind": 0, "detail": 36},
            {"matrix": [40, 0, 0, 0, 40, 0, 0, 0, 40, 400, 300, 100],
             "fill": 0, "stroke": 0x04030201, "weight": 1, "kind": 1, "detail": 36},
            {"matrix": [8, 16, 0, 0, 0, 0, 0, 0, 0, 400, 300, 200],
             "fill": 0, "stroke": 0x04030201, "weight": 2.5, "kind": 2, "detail": 36},
        ],
    }  # fmt: skip
    (tmp_path / "sketch.json").write_text(json.dumps(expected))
    node("sketch.test.mjs", CAROM_EXCHANGE=str(tmp_path))
