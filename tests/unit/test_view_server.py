"""The live view's server: what pages are served, how it is opened and closed."""

import ipaddress
import json
import re
import signal
import subprocess
import sys
import time

import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

import carom
from carom import scenes
from carom.errors import FileError, InputError
from carom.view import LiveView, network, serve
from carom.view.files import SKETCH, VIEW, load
from carom.view.protocol import Command

from .pages import address, closed, hear, page, request, say


@pytest.fixture
def sim():
    return carom.Simulation(scenes.phase_3())


@pytest.fixture
def view(sim):
    with LiveView(sim) as opened:
        yield opened


# What it should do.


def test_every_file_of_the_table_is_served(view):
    for path, file in load(VIEW).items():
        status, headers, body = request(view, path)
        assert (status, body) == (200, file.content)
        assert headers["Content-Type"] == file.content_type
        assert headers["X-Content-Type-Options"] == "nosniff"
        policy = headers["Content-Security-Policy"]
        assert "default-src 'none'" in policy
        assert "frame-ancestors 'none'" in policy
        assert "unsafe" not in policy


def test_the_pages_have_what_they_ask_for():
    """Every module, style and picture that a page or a module names."""
    for name in (VIEW, SKETCH):
        files = load(name)
        for path, file in files.items():
            text = file.content.decode("utf-8", "replace")
            if path == "/":
                named = re.findall(r'(?:href|src)="(/[^"]*)"', text)
            elif path.endswith(".js"):
                named = ["/" + name for name in re.findall(r'from "\./([^"]*)"', text)]
            else:
                named = []
            assert set(named) <= files.keys(), path
    assert json.loads(load(VIEW)["/gallery.json"].content) == scenes.names()


def test_scene_comes_first_then_frames_as_credit_allows(view):
    with page(view) as ws:
        say(ws, op="credit", count=2)
        kinds = [hear(ws)[6] for _ in range(3)]
        assert kinds == [2, 1, 1]
        with pytest.raises(TimeoutError):
            hear(ws, timeout=0.2)
        say(ws, op="credit", count=1)
        assert hear(ws)[6] == 1


def test_every_page_is_told_its_role_and_the_library(view):
    with page(view) as ws:
        assert hear(ws, "role") == "control"
        names = [scene["name"] for scene in hear(ws, "catalogue")]
        assert sorted(names) == scenes.names()
        phases = [f"phase-{k}" for k in range(5)]
        assert (names[:2], names[-5:]) == (["two-balls", "newton-cradle"], phases)


def test_notes_come_with_the_first_frame_and_when_they_change(view):
    with page(view) as ws:
        say(ws, op="credit", count=1)
        assert hear(ws, "settings")["restitution"] == 1
        hear(ws)
        say(ws, op="rule", restitution=0.5)
        say(ws, op="credit", count=4)
        assert hear(ws, "settings")["restitution"] == 0.5


def test_only_the_page_that_asked_is_told_why_not(view):
    with page(view) as ws, page(view) as other:
        say(ws, op="remove", index=99)
        assert hear(ws, "refused") == "There is no sphere 99; there are 12, counted from 0."
        with pytest.raises(TimeoutError):
            hear(other, "refused", timeout=0.2)


def test_a_page_that_only_watches(view, sim):
    token = view.watch_url.split("#token=")[1]
    assert token not in view.url
    with page(view, token=token) as ws:
        assert hear(ws, "role") == "watch"
        say(ws, op="credit", count=4)
        hear(ws)
        for op in ("pause", "restart", "reverse"):
            say(ws, op=op)
            assert hear(ws, "refused") == "This page may only watch."
        say(ws, op="source")
        assert "phase_3" in hear(ws, "source")["python"]
    assert view._driver._playing


def test_credit_is_capped(view):
    with page(view) as ws:
        for _ in range(5):
            say(ws, op="credit", count=4)
        view._driver.order(Command("pause"))
        time.sleep(0.2)
        assert view._server._clients[0].credits <= 4


def test_commands_reach_the_engine(view, sim):
    with page(view) as ws:
        say(ws, op="pause")
        time.sleep(0.15)
        stopped = sim.time
        time.sleep(0.1)
        assert sim.time == stopped
        say(ws, op="play")
        time.sleep(0.15)
        assert sim.time > stopped
        say(ws, op="pause")
        say(ws, op="restart")
        time.sleep(0.15)
        assert sim.time < 15


# Opening and closing.


def test_port_in_use(sim, view):
    port = int(address(view)[0].rsplit(":", 1)[1])
    with pytest.raises(FileError, match=f"port {port} is in use; choose another"):
        serve(sim, port=port, open_browser=False)


@pytest.mark.parametrize("port", [-1, 65536, 1.5, "80", True])
def test_ports_that_do_not_exist(sim, port):
    with pytest.raises(InputError, match="whole number"):
        serve(sim, port=port, open_browser=False)


@pytest.mark.parametrize("host", ["", "example.org", "256.0.0.1", "::1", "0.0.0.0.0", "224.0.0.1"])
def test_hosts_that_are_no_addresses_are_refused(sim, host):
    with pytest.raises(InputError, match=r"give an address of this machine such as \d"):
        serve(sim, host=host, open_browser=False)


def test_who_listens_to_himself_is_not_warned_of_others(sim):
    assert not LiveView(sim, host="127.0.0.2").is_public
    assert LiveView(sim, host="192.0.2.7").is_public


def test_addresses_of_other_machines_are_refused(sim):
    with pytest.raises(FileError, match=r"192.0.2.1 is no address of this machine; give one of"):
        serve(sim, host="192.0.2.1", open_browser=False)


def test_a_classroom_is_let_in_by_address_alone(sim, monkeypatch):
    """0.0.0.0 answers under the machine's own addresses and under no other name."""
    monkeypatch.setattr("carom.view.network.own_addresses", lambda: ["127.0.0.2"])
    with LiveView(sim, host="0.0.0.0") as view:
        assert view.is_public
        assert view.url.startswith("http://127.0.0.2:")
        port = view._socket.getsockname()[1]
        assert request(view, host=f"127.0.0.2:{port}")[0] == 200
        assert request(view, host=f"127.0.0.1:{port}")[0] == 200
        for host in ("evil.example", f"evil.example:{port}", f"0.0.0.0:{port}"):
            assert request(view, host=host)[0] == 403
        url = f"ws://127.0.0.1:{port}/live"
        with pytest.raises(InvalidStatus), connect(url, origin="http://evil.example"):
            pass
        with page(view) as ws:
            assert hear(ws, "role") == "control"


def test_own_addresses_are_addresses():
    for own in network.own_addresses():
        assert ipaddress.IPv4Address(own) is not None


def test_only_this_machine_is_listened_to(view):
    assert view._socket.getsockname()[0] == "127.0.0.1"


def test_the_token_is_long_and_never_the_same(sim):
    tokens = []
    for _ in range(3):
        with LiveView(sim) as view:
            tokens.append(address(view)[1])
    assert len(set(tokens)) == 3
    assert min(len(token) for token in tokens) >= 32


def test_the_simulation_is_whole_afterwards(sim):
    with LiveView(sim) as view, page(view) as ws:
        say(ws, op="credit", count=4)
        for _ in range(4):
            hear(ws)
    before = sim.time
    sim.run(duration=10)
    assert sim.time == before + 10


def test_ctrl_c_ends_it_without_a_word():
    program = (
        "import carom; from carom import scenes; from carom.view import serve;"
        "serve(carom.Simulation(scenes.phase_3()), open_browser=False,"
        " on_ready=lambda view: print(view.url, flush=True)); print('ended')"
    )
    with subprocess.Popen(
        [sys.executable, "-c", program],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdout.readline().startswith("http://127.0.0.1:")
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=10)
    assert (out, err, process.returncode) == ("ended\n", "", 0)


def test_a_bug_in_the_engine_is_raised(monkeypatch, sim):
    def broken(**_):
        raise ZeroDivisionError

    monkeypatch.setattr(sim, "run", broken)
    with pytest.raises(ZeroDivisionError):
        serve(sim, open_browser=False)


def test_a_bug_in_the_engine_ends_the_pages(monkeypatch, sim):
    """They say so and call again, though nobody waits for the view in this program."""
    with LiveView(sim) as view, page(view) as ws:
        hear(ws, "role")

        def broken(**_):
            raise ZeroDivisionError

        monkeypatch.setattr(sim, "run", broken)
        assert closed(ws)[0] == 1001
        with pytest.raises(ZeroDivisionError):
            view.wait()


@pytest.mark.parametrize("order", ["", "scene", "step"])
def test_ctrl_c_ends_it_whatever_it_is_about(order):
    """While it starts, while a scene is built that takes minutes, while a step is searched."""
    program = (
        "import carom, time; from carom.view import serve\n"
        "from carom.view.protocol import Command as C; from carom.view.builder import scenes\n"
        "scenes.build = lambda *_: [time.sleep(0.01) for _ in range(6000)]\n"
        "sim = carom.Simulation(walls=carom.Box(9, 9, 9))\n"
        "sim.add((0, 0, -3), velocity=(1, 0, 0)); sim.add((0, 0, 3), velocity=(1, 0, 0))\n"
        "def ready(view):\n"
        f"    view._driver.order(C({order!r} or 'pause', "
        f"{dict(name='gas', options={}) if order == 'scene' else {}!r}))\n"
        "    time.sleep(0.2); print('ready', flush=True)\n"
        "serve(sim, open_browser=False, on_ready=ready)\n"
        "sim.run(duration=1); print(len(sim), 'ended')"
    )
    with subprocess.Popen(
        [sys.executable, "-c", program],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stdout.readline() == "ready\n"
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=10)
    assert (out, err, process.returncode) == ("2 ended\n", "", 0)
