"""The live view's server, and attacks on it."""

import ipaddress
import json
import re
import signal
import socket
import subprocess
import sys
import time
from contextlib import ExitStack, contextmanager

import pytest
from websockets.client import ClientProtocol
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.protocol import State
from websockets.sync.client import connect
from websockets.uri import parse_uri

import carom
from carom import scenes
from carom.errors import FileError, InputError
from carom.view import LiveView, network, serve
from carom.view.files import SKETCH, VIEW, load
from carom.view.protocol import Command
from carom.view.server import MAX_CLIENTS
from carom.view.wire import VERSION


@pytest.fixture
def sim():
    return carom.Simulation(scenes.phase_3())


@pytest.fixture
def view(sim):
    with LiveView(sim) as opened:
        yield opened


def address(view):
    base, token = view.url.split("/#token=")
    return base, token


@contextmanager
def page(view, *, token=None, version=VERSION, **options):
    """A connection that said hello."""
    base, right = address(view)
    ws = connect(
        base.replace("http", "ws") + "/live",
        **{"origin": base, "compression": None, "max_size": None, **options},
    )
    with ws:
        say(ws, op="hello", token=right if token is None else token, version=version)
        yield ws


def say(ws, **message):
    ws.send(json.dumps(message))


def hear(ws, kind=bytes, timeout=5):
    """The next message that is binary, or else the value of the next text with this key."""
    while True:
        message = ws.recv(timeout=timeout)
        if kind is bytes and isinstance(message, bytes):
            return message
        if isinstance(message, str) and kind in (said := json.loads(message)):
            return said[kind]


def closed(ws):
    """Close code and reason that a connection ends with, whatever comes before."""
    try:
        while True:
            ws.recv(timeout=10)
    except ConnectionClosed as end:
        return end.rcvd.code, end.rcvd.reason


def request(view, path="/", host=None, method="GET", extra=""):
    """Send a plain request as an attacker would type it; (status, headers, body)."""
    base, _ = address(view)
    host = base.removeprefix("http://") if host is None else host
    with socket.create_connection(("127.0.0.1", int(base.rsplit(":", 1)[1])), timeout=5) as raw:
        raw.sendall(f"{method} {path} HTTP/1.1\r\nHost: {host}\r\n{extra}\r\n".encode())
        answer = b""
        while part := raw.recv(65536):
            answer += part
    head, _, body = answer.partition(b"\r\n\r\n")
    lines = head.decode().split("\r\n")
    status = int(lines[0].split()[1]) if answer else 0
    return status, dict(line.split(": ", 1) for line in lines[1:]), body


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
    for page in (VIEW, SKETCH):
        files = load(page)
        for address, file in files.items():
            text = file.content.decode("utf-8", "replace")
            if address == "/":
                named = re.findall(r'(?:href|src)="(/[^"]*)"', text)
            elif address.endswith(".js"):
                named = ["/" + name for name in re.findall(r'from "\./([^"]*)"', text)]
            else:
                named = []
            assert set(named) <= files.keys(), address
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


# Attacks.


def test_foreign_origin(view):
    base, _ = address(view)
    for origin in ("http://evil.example", "null", base.replace("http", "https"), None):
        url = base.replace("http", "ws") + "/live"
        with pytest.raises(InvalidStatus) as caught, connect(url, origin=origin):
            pass
        assert caught.value.response.status_code == 403


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1", "localhost:1", "", "[::1]"])
def test_bad_host_as_in_dns_rebinding(view, host):
    assert request(view, host=host)[0] == 403
    assert request(view, path="/live", host=host, extra="Upgrade: websocket\r\n")[0] == 403


def test_two_hosts(view):
    assert request(view, extra="Host: evil.example\r\n")[0] == 403


@pytest.mark.parametrize(
    "path",
    [
        "/../pyproject.toml", "/static/../server.py", "/%2e%2e/server.py", "//etc/passwd",
        "/..%2fserver.py", "/server.py", "/main.js/", "/main.js?x", "/.", "/\\..\\server.py",
        "/package.json", "http://evil.example/",
    ],
)  # fmt: skip
def test_traversal(view, path):
    assert request(view, path)[0] == 404


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "HEAD", "TRACE", "GARBAGE"])
def test_only_get(view, method):
    status, _, body = request(view, method=method)
    assert status != 200
    assert b"<html" not in body


def test_plain_request_for_the_socket(view):
    base, _ = address(view)
    assert request(view, "/live", extra=f"Origin: {base}\r\n")[0] == 426


def test_wrong_or_no_token(view, sim):
    for token in ("", "wrong", "ü"):
        with page(view, token=token) as ws:
            code, reason = closed(ws)
            assert code == 4001
            assert "another run" in reason
    assert sim.time == 0  # nobody was counted as watching


def test_commands_before_hello(view):
    base, _ = address(view)
    with connect(base.replace("http", "ws") + "/live", origin=base) as ws:
        say(ws, op="restart")
        assert closed(ws)[0] == 4001


def test_silence_is_ended(view, monkeypatch):
    monkeypatch.setattr("carom.view.server.HELLO_WITHIN", 0.1)
    base, _ = address(view)
    with connect(base.replace("http", "ws") + "/live", origin=base) as ws:
        assert closed(ws) == (1008, "hello did not come in time")


def test_other_version(view):
    with page(view, version=99) as ws:
        assert closed(ws) == (1008, "this page belongs to another version")


@pytest.mark.parametrize(
    "message",
    [
        "no json", b"\x00\x01", '{"op": "exec"}', '{"op": "speed", "value": 1e9}',
        '{"op": "speed", "value": NaN}', '{"op": "credit", "count": 1000000}',
        '{"op": "hello", "token": "again", "version": 1}', "[" * 1000,
    ],
)  # fmt: skip
def test_malformed_messages(view, message):
    with page(view) as ws:
        ws.send(message)
        code, reason = closed(ws)
        assert code == 1008
        assert reason


def test_oversized_message(view):
    with page(view) as ws:
        ws.send("x" * 100_000)
        assert closed(ws)[0] == 1009


def test_too_many_pages(view):
    base, token = address(view)
    url = base.replace("http", "ws") + "/live"
    with ExitStack() as held:
        for _ in range(MAX_CLIENTS):
            held.enter_context(connect(url, origin=base, compression=None))
        ws = held.enter_context(connect(url, origin=base))
        assert closed(ws) == (1013, f"only {MAX_CLIENTS} pages can watch at once")
    time.sleep(0.1)
    with page(view, token=token) as ws:
        say(ws, op="credit", count=1)
        assert hear(ws)


def dead_page(view):
    """A page that gives credit and then never reads, with little room in between."""
    base, token = address(view)
    raw = socket.socket()
    raw.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 16384)
    raw.connect(view._socket.getsockname())
    protocol = ClientProtocol(parse_uri(base.replace("http", "ws") + "/live"), origin=base)
    protocol.send_request(protocol.connect())
    raw.sendall(b"".join(protocol.data_to_send()))
    while protocol.state is not State.OPEN:
        protocol.receive_data(raw.recv(1))
    for message in (
        {"op": "hello", "token": token, "version": VERSION},
        {"op": "credit", "count": 4},
    ):
        protocol.send_text(json.dumps(message).encode())
    raw.sendall(b"".join(protocol.data_to_send()))
    return raw


def test_dead_pages_slow_nobody():
    sim = carom.Simulation(scenes.fluid(n=10_000))
    with LiveView(sim) as view, ExitStack() as dead:
        view._socket.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 16384)
        for _ in range(3):
            dead.enter_context(dead_page(view))
        with page(view) as ws:
            say(ws, op="credit", count=1)
            hear(ws)
            assert sum(client.busy for client in view._server._clients) >= 3
            before, clock = sim.time, time.perf_counter()
            for _ in range(30):
                say(ws, op="credit", count=1)
                hear(ws)
            rate = (sim.time - before) / (time.perf_counter() - clock)
            assert sum(client.busy for client in view._server._clients) >= 3
    assert rate > 0.7 * sim.pace


# Opening and closing.


def test_port_in_use(sim, view):
    port = int(address(view)[0].rsplit(":", 1)[1])
    with pytest.raises(FileError, match=f"port {port} is in use; choose another"):
        serve(sim, port=port, open_browser=False)


@pytest.mark.parametrize("port", [-1, 65536, 1.5, "80", True])
def test_ports_that_do_not_exist(sim, port):
    with pytest.raises(InputError, match="whole number"):
        serve(sim, port=port, open_browser=False)


@pytest.mark.parametrize("host", ["", "example.org", "256.0.0.1", "::1", "0.0.0.0.0"])
def test_hosts_that_are_no_addresses_are_refused(sim, host):
    with pytest.raises(InputError, match=r"give an address of this machine such as \d"):
        serve(sim, host=host, open_browser=False)


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
    for address in network.own_addresses():
        assert ipaddress.IPv4Address(address) is not None


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
