"""Views in notebooks: the kernel's half, spoken to as the page's half speaks."""

import builtins
import gc
import json
import time
import weakref

import numpy as np
import pytest

import carom
from carom import scenes
from carom.errors import InputError
from carom.markup import html_table
from carom.view import notebook
from carom.view.wire import FRAME_HEADER, HEADER, METERS, VERSION


class Cell:
    """A page in a cell, which says what it is told to and keeps what it hears."""

    def __init__(self, host, name="a"):
        self.host, self.name = host, name
        self.texts, self.scenes, self.frames = [], 0, []
        self.say("hello", token="", version=VERSION)
        self.say("credit", count=2)

    def say(self, op, **values):
        self.host.hear(self.name, json.dumps({"op": op, **values}), self.take)

    def take(self, more, data):
        if "text" in more:
            self.texts.append(json.loads(more["text"]))
        for message in data:
            if int.from_bytes(message[6:8], "little") == 2:
                self.scenes += 1
                continue
            fields = FRAME_HEADER.unpack_from(message)
            names = [*(name for name, _ in HEADER), *METERS]
            self.frames.append(dict(zip(names, fields, strict=True)))

    def play(self, seconds):
        end = time.perf_counter() + seconds
        while time.perf_counter() < end:
            self.say("credit", count=1)
            time.sleep(0.01)

    def notes(self, key):
        return [text[key] for text in self.texts if key in text]


@pytest.fixture
def sim():
    return carom.Simulation(scenes.build("gas", {"n": 20}))


def test_time_runs_with_the_page_and_stands_without_it(sim):
    cell = Cell(notebook.Host(sim))
    assert cell.notes("role") == ["control"]
    cell.play(0.5)
    assert cell.scenes == 1
    times = [frame["t"] for frame in cell.frames]
    assert times == sorted(times)
    assert len(times) > 5
    assert 0.2 < sim.time / sim.pace < 0.8
    before = sim.time
    time.sleep(0.1)
    assert sim.time == before


def test_what_the_page_asks_for_reaches_the_simulation(sim):
    cell = Cell(notebook.Host(sim))
    cell.say("rule", restitution=0.5)
    assert sim.rule.restitution == 0.5
    cell.say("pause")
    before = sim.time
    cell.play(0.05)
    assert sim.time == before
    cell.say("step")
    assert sim.time > before
    cell.say("push", index=99, velocity=[0, 0, 0])
    assert "There is no sphere 99" in cell.notes("refused")[0]
    assert cell.notes("settings")[-1]["restitution"] == 0.5


def test_what_a_cell_does_is_seen(sim):
    host = notebook.Host(sim)
    cell = Cell(host)
    cell.say("pause")
    cell.say("credit", count=3)
    sim.run(duration=7)
    host.look()
    assert cell.frames[-1]["t"] == sim.time
    scenes_before, epoch = cell.scenes, cell.frames[-1]["epoch"]
    sim.remove(3)
    host.look()
    assert cell.frames[-1]["n"] == 19
    assert cell.scenes == scenes_before + 1
    assert cell.frames[-1]["epoch"] > epoch
    sim.velocity = np.zeros((19, 3))
    host.look()
    assert cell.frames[-1]["kinetic"] == 0
    frames = len(cell.frames)
    host.look()
    assert len(cell.frames) == frames


def test_two_views_of_one_simulation_share_its_time(sim):
    host = notebook.Host(sim)
    one, two = Cell(host), Cell(host, "b")
    one.say("pause")
    one.say("credit", count=1)
    two.say("credit", count=1)
    assert two.frames[-1]["flags"] & 1 == 0
    assert one.frames[-1]["t"] == two.frames[-1]["t"]


def test_a_view_that_opens_while_time_stands_shows_where_it_stands(sim):
    host = notebook.Host(sim)
    Cell(host).say("pause")
    two = Cell(host, "b")
    assert two.scenes == 1
    assert two.frames[-1]["t"] == sim.time
    again = Cell(host, "b")  # a page that the notebook has loaded anew
    assert again.scenes == 1
    assert again.frames[-1]["t"] == sim.time


def test_a_page_that_has_gone_costs_nothing_and_one_that_talks_nonsense_is_told(sim):
    host = notebook.Host(sim)
    gone, here = Cell(host), Cell(host, "b")
    many = len(gone.frames)
    here.play(0.3)
    assert len(gone.frames) <= many + 2
    host.hear("b", '{"op": "destroy"}', here.take)
    assert here.notes("refused") == ["the operation is unknown"]
    host.hear("stranger", '{"op": "restart"}', here.take)
    assert sim.time > 0


def test_widgets_of_one_simulation_share_a_host_and_let_it_go():
    sim = carom.Simulation(scenes.build("two-balls"))
    first, second = sim.view(height=300), sim.view(color="speed")
    assert (first.height, first.title, first.live) == (300, "Two balls", True)
    assert ">speed</script>" in second.page
    host = weakref.ref(notebook._HOSTS[id(sim)])
    assert host() is not None
    for widget in (first, second):
        widget.close()
    del first, second, widget
    gc.collect()
    assert host() is None


def test_a_recording_plays_in_a_widget(tmp_path):
    with carom.Simulation(scenes.build("two-balls")) as sim:
        sim.record(tmp_path / "run.gsd", every=1)
        sim.run(until=3)
    with carom.load(tmp_path / "run.gsd") as run:
        widget = run.view(color="own", height=333)
    assert (widget.live, widget.height) == (False, 333)
    assert "<title>Two balls</title>" in widget.page


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"height": 10}, "height"),
        ({"height": "tall"}, "height must be a number"),
        ({"color": "mood"}, "color is 'mood'; it must be one of energy"),
    ],
)
def test_bad_input(sim, options, says):
    with pytest.raises(InputError, match=says):
        sim.view(**options)


def test_without_anywidget_a_sentence_says_what_to_install(sim, monkeypatch):
    real = builtins.__import__

    def without(name, *rest, **more):
        if name == "anywidget":
            raise ImportError(name)
        return real(name, *rest, **more)

    notebook._widget_class.cache_clear()
    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(InputError, match=r"pip install .carom\[notebook\]"):
        sim.view()


# What else notebooks show.


def test_tables_hold_text_and_no_html():
    text = html_table("<b>", [["a", "<i>x</i>"]], heading=["&", "'"], notes=["1 < 2"])
    for raw in ("<b>", "<i>", "1 < 2"):
        assert raw not in text
    for safe in ("&lt;b&gt;", "&lt;i&gt;x&lt;/i&gt;", "<th>&amp;</th>", "1 &lt; 2"):
        assert safe in text


def test_things_show_themselves(sim):
    sim.run(until=2)
    shown = sim._repr_html_()
    assert "Gas in a box" in shown
    assert f"<th>time</th><td>{sim.time:g}</td>" in shown
    assert f"{sim.collisions}, {sim.wall_collisions} with walls" in shown
    scene = carom.Scene(
        carom.Spheres.of([(0, 0, 0)], radius=1), gravity=(0, 0, -1), title="<script>"
    )
    assert "&lt;script&gt;" in scene._repr_html_()
    assert "<th>spheres</th><td>1</td>" in scene._repr_html_()
    estimate = carom.observe.Estimate(9.3847, 0.0043, 1200, "of few")
    assert "<td>9.385(4)</td><td>0.0043</td><td>1200</td>" in estimate._repr_html_()
    assert "of few" in estimate._repr_html_()
    rate = carom.observe.CollisionRate()
    sim.run(collisions=200, observe=rate)
    table = rate.result()
    for cell in (*table.heading(), *table.rows()[0]):
        assert cell in table._repr_html_()
