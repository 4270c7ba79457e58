"""Replays: what their files hold, how exactly, how many bytes, and what is refused."""

import base64
import errno
import hashlib
import html
import re
import zlib
from html.parser import HTMLParser
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import carom
from carom import scenes
from carom.errors import FileError, InputError
from carom.view import bundle, reel, replay, write_replay
from carom.view.files import FOLDER
from carom.view.protocol import encode_scene
from carom.view.wire import REEL_COLUMNS, STILL


def thirty(sim, frames):
    """Thirty frames a second."""
    return sim.time + np.arange(frames) / 30 * sim.pace


def packed(sim, frames, **options):
    options = {"color": None, "title": None, "speed": 1.0, "progress": None, **options}
    return replay.pack(sim, thirty(sim, frames), **options)[0]


def empty_scene(n, radius, period=(0, 0, 0)):
    state = carom.State.empty(n)
    state.radius[:] = radius
    floor = {"kind": 0, "normal": [0, 0, 1], "offset": 0.0, "restitution": 0.5}
    about = {"period": list(period), "walls": [floor], "collide": True, "restitution": 0.5}
    return encode_scene(state, 1, about)


class Parts(HTMLParser):
    """Tags with their attributes, and what scripts, styles and the title hold."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.tags, self.held, self._within = [], {}, None
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))
        self._within = tag
        if tag in ("script", "style", "title"):
            self.held.setdefault(tag, []).append("")

    def handle_endtag(self, tag):
        self._within = None

    def handle_data(self, data):
        if self._within in ("script", "style", "title"):
            self.held[self._within][-1] += data

    @property
    def policy(self):
        (content,) = (a["content"] for _, a in self.tags if "http-equiv" in a)
        return dict(part.strip().split(" ", 1) for part in content.split(";"))


# Reels.


@pytest.mark.parametrize("name", ["gas", "bounce", "giant", "phase-4", "newton-cradle"])
def test_what_is_read_back_is_what_was_written(name):
    sim, twin = (carom.Simulation(scenes.build(name)) for _ in range(2))
    back = reel.decode(packed(sim, 40))
    truth = list(twin.frames(at=thirty(twin, 40)))
    position = np.array([frame.position for frame in truth])
    across = np.ptp(position, axis=(0, 1)).max()
    assert np.abs(back.position.transpose(0, 2, 1) - position).max() < 1e-5 * across
    assert back.columns[:, 0].tolist() == [frame.time for frame in truth]
    counts = [f.collision_count | (f.fixed | f.resting) * np.uint32(STILL) for f in truth]
    assert np.array_equal(back.counts, counts)
    kinetic = [frame.kinetic_energy for frame in truth]
    assert back.columns[:, REEL_COLUMNS.index("kinetic")] == pytest.approx(kinetic, rel=1e-6)
    # A sphere that is off in its velocity by this much is off by a quarter of a quantum at the
    # next frame.
    velocity = np.array([frame.velocity for frame in truth])
    error = np.abs(back.velocity.transpose(0, 2, 1) - velocity).max()
    assert error * np.diff(back.columns[:, 0]).max() < 1e-5 * across


@settings(max_examples=40, deadline=None)
@given(
    seed=st.integers(0, 2**32),
    n=st.integers(1, 5),
    frames=st.integers(2, 6),
    periodic=st.booleans(),
    scale=st.sampled_from([1e-6, 1.0, 1e9]),
)
def test_any_motion_is_off_by_half_a_quantum_at_most(seed, n, frames, periodic, scale):
    """Even where nothing can be foreseen."""
    random = np.random.default_rng(seed)
    columns = np.zeros((frames, len(REEL_COLUMNS)))
    columns[:, 0] = np.cumsum(random.uniform(1e-3, 2, frames))
    columns[:, 1:4] = random.normal(size=3) * scale
    period = [2 * scale, 0, 0] if periodic else [0, 0, 0]
    written = reel.Reel(
        empty_scene(n, 0.01 * scale, period),
        columns,
        random.uniform(-1, 1, (frames, 3, n)) * scale,
        random.normal(size=(frames, 3, n)) * scale,
        random.integers(0, 2**32, (frames, n), dtype=np.uint32),
    )
    back = reel.decode(reel.encode(written))
    assert back.scene == written.scene
    assert np.array_equal(back.columns, columns)
    assert np.array_equal(back.counts, written.counts)
    across = max(np.ptp(written.position, axis=(0, 2)).max(), 0.02 * scale)
    miss = back.position - written.position
    if periodic:
        miss[:, 0] -= 2 * scale * np.round(miss[:, 0] / (2 * scale))
    assert np.abs(miss).max() <= 1e-5 * across


def test_free_flight_is_foreseen_and_nothing_is_written():
    scene = carom.Scene(
        carom.Spheres.of(np.eye(3) * 9, velocity=[(1, 2, 3)] * 3, radius=1), gravity=(0, 0, -2)
    )
    frames, numbers = 100, 9
    body = zlib.decompress(packed(carom.Simulation(scene), frames))
    planes = np.frombuffer(body[-2 * 4 * frames * numbers :], np.uint8)
    misses = planes.reshape(2, 4, frames, numbers)  # of velocities and of positions
    assert np.count_nonzero(misses[:, :, 0]) > 2 * numbers
    # But for roundings that have added up to half a quantum.
    assert np.count_nonzero(misses[:, :, 1:]) < 0.05 * 2 * frames * numbers


@pytest.mark.parametrize(("name", "most"), [("gas", 0.4e6), ("fluid", 0.6e6)])
def test_a_thousand_spheres_in_three_hundred_frames_stay_below_a_megabyte(name, most):
    sim = carom.Simulation(scenes.build(name, {"n": 1000}))
    sim.run(duration=sim.pace)  # no crystal any more, and Maxwell's velocities
    page, frames = len(bundle.page("replay.js")), 75
    size = len(replay.replay(sim, thirty(sim, frames)))
    assert page + 300 / frames * (size - page) < most


# The page.


@pytest.mark.parametrize("entry", ["replay.js", "widget.js"])
def test_the_page_holds_all_it_needs_and_may_load_nothing(entry):
    parts = Parts(bundle.page(entry, data="AAAA"))
    policy = parts.policy
    assert policy["default-src"] == "'none'"
    assert set(policy) == {
        *("default-src", "script-src", "style-src", "img-src", "base-uri", "form-action")
    }
    data, packed, starter = parts.held["script"]
    (style,) = parts.held["style"]
    assert data == "AAAA"
    program = zlib.decompress(base64.b64decode(packed)).decode()
    assert program == bundle.scripts(entry)
    for name, texts in (("script-src", (starter, program)), ("style-src", (style,))):
        digests = (hashlib.sha256(text.encode()).digest() for text in texts)
        allowed = [f"'sha256-{base64.b64encode(digest).decode()}'" for digest in digests]
        assert policy[name].split() == allowed
    for tag, attributes in parts.tags:
        assert "src" not in attributes, tag
        assert "style" not in attributes, tag  # which the policy would refuse
        assert not any(name.startswith("on") for name in attributes), tag
        assert attributes.get("href", "data:").startswith("data:"), tag


def test_every_import_is_resolved_in_an_order_that_works():
    text = bundle.scripts("replay.js")
    assert not re.search(r"^\s*(import|export)\b", text, re.MULTILINE)
    made = re.findall(r"^const \$(\w+) = \(\(\) => \{$", text, re.MULTILINE)
    assert len(made) == len(set(made)) > 60
    assert made[-1] == "replay"
    for name, used in _uses(text):
        assert made.index(used) < made.index(name), (name, used)


def _uses(text):
    for part in re.split(r"(?m)^const \$(?=\w+ = \(\(\))", text)[1:]:
        name = part.split(" ", 1)[0]
        for used in re.findall(r"^const \{[^}]*\} = \$(\w+);$", part, re.MULTILINE):
            yield name, used


def test_an_import_of_another_form_is_no_silent_gap():
    for line in ('import * as all from "./dom.js";', "export default 3;", "export let x = 1;"):
        with pytest.raises(ValueError, match="form that the bundle does not know"):
            bundle._wrapped("odd", f"{line}\n")


def test_all_files_of_the_page_are_in_the_folder():
    assert all((FOLDER / f"{name}.js").is_file() for name in ("replay", "widget", "notebook"))


def test_titles_are_text(tmp_path):
    title = '</title><script>alert("&")</script>'
    sim = carom.Simulation(scenes.build("two-balls"))
    text = replay.replay(sim, thirty(sim, 2), title=title)
    assert html.escape(title) in text
    parts = Parts(text)
    assert parts.held["title"] == [title]
    assert len(parts.held["script"]) == 3


def test_the_page_is_the_same_for_the_same_motion():
    texts = []
    for _ in range(2):
        sim = carom.Simulation(scenes.build("two-balls"))
        texts.append(replay.replay(sim, thirty(sim, 5)))
    assert texts[0] == texts[1]


# What is refused.


@pytest.mark.parametrize(
    ("path", "times", "options", "says"),
    [
        ("a.txt", [0, 1], {}, r"its name ends in \.html; 'a.txt' does not"),
        ("a.html", [0], {}, "at least two frames at different times; there are 1"),
        ("a.html", [1, 1], {}, "at least two frames at different times; there are 1"),
        ("a.html", [], {}, "there are 0"),
        ("a.html", [1, 0], {}, "rising times"),
        ("a.html", [0, 1], {"color": "mood"}, "color is 'mood'; it must be one of energy, speed"),
    ],
)
def test_bad_input(tmp_path, path, times, options, says):
    sim = carom.Simulation(scenes.build("two-balls"))
    with pytest.raises(InputError, match=says):
        write_replay(sim, tmp_path / path, times, **options)
    assert list(tmp_path.iterdir()) == []


def test_too_much_for_a_page(monkeypatch):
    monkeypatch.setattr(replay, "MOST", 20)
    sim = carom.Simulation(scenes.build("two-balls"))
    assert packed(sim, 10)
    before = sim.time
    with pytest.raises(InputError, match=r"2 spheres in more than 10 frames .* fewer frames"):
        packed(sim, 11)
    assert sim.time == before  # told before time has run in vain


def test_spheres_that_come_or_go():
    class Growing:
        scene, pace = None, 1.0

        def frames(self, at):
            sim = carom.Simulation(scenes.build("two-balls"))
            yield from sim.frames(at=[0])
            sim.add(position=(0, 1, 1), radius=0.1)
            yield from sim.frames(at=[1])

    with pytest.raises(InputError, match="3 spheres at time 1 and 2 before"):
        replay.replay(Growing(), [0, 1])


def test_a_place_that_cannot_be_written(tmp_path):
    sim = carom.Simulation(scenes.build("two-balls"))
    with pytest.raises(FileError, match=r"cannot write .*a\.html: .*; check the folder"):
        write_replay(sim, tmp_path / "no" / "a.html", [0, 1])


def test_what_cannot_be_written_is_said_before_the_work(tmp_path):
    sim = carom.Simulation(scenes.build("two-balls"))
    with pytest.raises(FileError, match="check the folder"):
        write_replay(sim, tmp_path / "no" / "a.html", [0, 1])
    assert sim.time == 0


def test_a_recording_that_is_damaged_is_not_taken_for_a_page_that_cannot_be_written(tmp_path):
    def frames(at):
        msg = "run.gsd is damaged"
        raise FileError(msg)

    source = SimpleNamespace(scene=None, pace=1.0, frames=frames)
    with pytest.raises(FileError, match=r"^run.gsd is damaged$"):
        write_replay(source, tmp_path / "a.html", [0, 1])
    assert not list(tmp_path.iterdir())


def test_a_full_disk_leaves_the_page_that_was_there(tmp_path, monkeypatch):
    def half(path, text, **options):
        path.write_bytes(text[:1000].encode())
        raise OSError(errno.ENOSPC, "No space left on device")

    page = tmp_path / "a.html"
    page.write_text("before")
    monkeypatch.setattr(Path, "write_text", half)
    sim = carom.Simulation(scenes.build("two-balls"))
    with pytest.raises(FileError, match=r"a\.html: No space left on device; make room there"):
        write_replay(sim, page, [0, 1])
    assert [(file.name, file.read_text()) for file in tmp_path.iterdir()] == [("a.html", "before")]


def test_progress_tells_every_frame_when_it_is_there_and_when_it_is_packed(tmp_path):
    sim, told = carom.Simulation(scenes.build("two-balls")), []
    write_replay(sim, tmp_path / "a.html", [0, 1, 2], progress=told.append)
    assert told == [0, 1, 2, 0, 1, 2]


def test_motion_too_wild_for_whole_numbers():
    columns = np.zeros((2, len(REEL_COLUMNS)))
    columns[1, 0] = 1e-9
    position = np.zeros((2, 3, 1))
    position[1] = 1e6
    odd = reel.Reel(
        empty_scene(1, 1e-9),
        *(columns, position, np.full((2, 3, 1), 1e30), np.zeros((2, 1), np.uint32)),
    )
    with pytest.raises(InputError, match="too far or too fast"):
        reel.encode(odd)


def test_a_long_recording_gets_fewer_frames():
    class Run:
        start, end, pace = 0.0, 10.0, 1.0

        def __getitem__(self, index):
            return [0] * self.n

    run = Run()
    run.n = 10
    assert replay.even_times(run) == pytest.approx(np.arange(301) / 30)
    run.end = 1e6
    assert len(replay.even_times(run)) == replay.MOST_FRAMES
    run.n = 1_000_000
    assert len(replay.even_times(run)) == 5
    assert replay.even_times(run)[[0, -1]].tolist() == [0, 1e6]
