"""Attacks on the live view's server."""

import json
import os
import socket
import time
from contextlib import ExitStack, suppress

import pytest
from websockets.exceptions import ConnectionClosed, InvalidMessage, InvalidStatus
from websockets.sync.client import connect

import carom
from carom import scenes
from carom.view import LiveView, door
from carom.view.server import MAX_ANSWERS, MAX_CLIENTS, MAX_ORDERS, Server
from carom.view.wire import OPERATIONS, VERSION

from .pages import address, closed, hear, page, request, say, speechless


@pytest.fixture
def sim():
    return carom.Simulation(scenes.phase_3())


@pytest.fixture
def view(sim):
    with LiveView(sim) as opened:
        yield opened


def socket_url(view):
    base, _ = address(view)
    return base.replace("http", "ws") + "/live"


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


@pytest.mark.parametrize(
    "other",
    [
        "LOCALHOST:{}", "localhost.:{}", "127.0.0.1.:{}", "localhost", "127.0.0.1:0{}", "127.1:{}",
        "2130706433:{}", "0x7f.1:{}", "[::1]:{}", "[::ffff:127.0.0.1]:{}", "0.0.0.0:{}",
        "user@127.0.0.1:{}", "127.0.0.1:{} ", "evil.example:{}", "127.0.0.1:{}.evil.example",
        "127.0.0.1:{}, evil.example", "xn--localhost:{}", "127.0.0.1%3A{}",
    ],
)  # fmt: skip
def test_names_that_only_look_like_ours(view, other):
    """As Host and as Origin; a space at the end of a header is none, so it belongs to no name."""
    base, _ = address(view)
    name = other.format(base.rsplit(":", 1)[1])
    if name == name.strip():
        assert request(view, host=name)[0] in (400, 403)
    with (
        pytest.raises((InvalidStatus, InvalidMessage)),
        connect(
            socket_url(view), origin=f"http://{name}/" if name.endswith(" ") else f"http://{name}"
        ),
    ):
        pass


def test_at_port_80_the_names_stand_alone():
    """Browsers leave the port of http out of Host and Origin."""

    class Listening:
        def getsockname(self):
            return ("127.0.0.1", 80)

    server = Server(Listening(), ["127.0.0.1"], {}, {}, lambda *_: None, lambda: None)
    assert server._hosts == {"127.0.0.1"}
    assert server._origins == {"http://127.0.0.1"}
    server._loop.close()


def test_two_hosts(view):
    assert request(view, extra="Host: evil.example\r\n")[0] == 403


@pytest.mark.parametrize(
    "path",
    [
        "/../pyproject.toml", "/static/../server.py", "/%2e%2e/server.py", "//etc/passwd",
        "/..%2fserver.py", "/server.py", "/main.js/", "/main.js?x", "/.", "/\\..\\server.py",
        "/package.json", "http://evil.example/", "/gallery/", "/gallery", "/gallery/../main.js",
        "/gallery/..%2f..%2fserver.py", "/gallery//phase-0.webp", "/gallery/phase-0.webp%00",
        "/gallery/phase-0", "/gallery/PHASE-0.webp", "/gallery/.", "/%67allery/phase-0.webp",
        "/main%2ejs", "/main.js#x", "/sketch.html", "/index.html", "*",
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
    with ExitStack() as held:
        for _ in range(MAX_CLIENTS):
            hear(held.enter_context(page(view)), "role")
        ws = held.enter_context(page(view))
        assert closed(ws) == (1013, f"only {MAX_CLIENTS} pages can watch at once")
    time.sleep(0.1)
    with page(view) as ws:
        say(ws, op="credit", count=1)
        assert hear(ws)


# From any program in the network: sockets that hold on.


def half_open(view, first=b"GET / HTTP/1.1\r\nHost: "):
    raw = socket.create_connection(view._socket.getsockname(), timeout=5)
    raw.sendall(first)
    return raw


@pytest.mark.parametrize("first", [b"", b"GET / HTTP/1.1\r\nHost: ", b"\x16\x03\x01\x02\x00"])
def test_requests_that_never_end_keep_nobody_out(view, first):
    with ExitStack() as held:
        for _ in range(2 * door.MOST):
            held.enter_context(half_open(view, first))
        assert request(view)[0] == 200
        assert len(view._server._door) <= door.MOST
        with page(view) as ws:
            say(ws, op="credit", count=1)
            assert hear(ws)


def test_sockets_that_never_say_hello_keep_nobody_out(view):
    base, _ = address(view)
    with ExitStack() as held:
        for _ in range(door.MOST + 20):
            held.enter_context(connect(socket_url(view), origin=base, close_timeout=0.1))
        with page(view) as ws:
            say(ws, op="credit", count=1)
            assert hear(ws)
        assert len(view._server._door) <= door.MOST


def test_files_nobody_reads_keep_nobody_out(view):
    base, _ = address(view)
    host = base.removeprefix("http://")
    view._socket.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 4096)
    with ExitStack() as held:
        for _ in range(2 * door.MOST):
            held.enter_context(
                half_open(view, f"GET /main.js HTTP/1.1\r\nHost: {host}\r\n\r\n".encode())
            )
        assert request(view)[0] == 200
        assert len(view._server._door) <= door.MOST


def test_who_is_known_is_never_let_go_for_strangers(view):
    with page(view) as ws, ExitStack() as held:
        hear(ws, "role")
        for _ in range(door.MOST + 5):
            held.enter_context(half_open(view))
        say(ws, op="credit", count=1)
        assert hear(ws)


@pytest.mark.parametrize(
    "extra", ["X: " + "x" * 100_000 + "\r\n", "X: y\r\n" * 1000, "no colon\r\n", "\0: \0\r\n"]
)
def test_headers_without_measure(view, extra):
    with suppress(ConnectionError):  # hung up while it was still being sent
        assert request(view, extra=extra)[0] in (0, 400, 431)
    assert request(view)[0] == 200


def test_pongs_nobody_reads_do_not_pile_up(view):
    """Pings may come before hello, so anybody could make the server keep their answers."""
    raw, protocol = speechless(view)
    with raw:
        protocol.send_ping(b"x" * 125)
        pings = 50 * b"".join(protocol.data_to_send())

        def flood():
            for _ in range(20_000):
                raw.sendall(pings)

        with pytest.raises(ConnectionError):
            flood()
    assert request(view)[0] == 200


def test_pings_of_an_honest_page_are_answered(view):
    with page(view) as ws:
        for _ in range(5 * door.PINGS):
            assert ws.ping().wait(5)


def test_a_message_in_endless_pieces(view):
    def pieces():
        while True:
            yield "x" * 1000

    with page(view) as ws:
        with pytest.raises(ConnectionClosed):
            ws.send(pieces())
        assert closed(ws)[0] == 1009


def test_a_message_in_pieces_is_one_message(view, sim):
    with page(view) as ws:
        ws.send(['{"op": "re', 'move", ', '"index": 99}'])
        assert "no sphere 99" in hear(ws, "refused")


def test_tokens_are_not_found_by_guessing(view):
    _, token = address(view)
    near = [token[:-1], token + "A", token.swapcase(), token[::-1], " " + token, token[:16], "\0"]
    guesses = near + [os.urandom(24).hex()[:32] for _ in range(150)]
    for guess in guesses:
        with page(view, token=guess) as ws:
            assert closed(ws)[0] == 4001
    assert view._server._clients == ()
    assert len(view._server._door) == 0


@pytest.mark.parametrize("hello", [{"token": ["x"]}, {"token": None}, {"token": {}}, {}])
def test_hello_without_a_token(view, hello):
    base, _ = address(view)
    with connect(socket_url(view), origin=base) as ws:
        say(ws, op="hello", version=VERSION, **hello)
        assert closed(ws)[0] == 1008


# From a page that was let in.


VALUES = {
    "speed": {"value": 2},
    "rule": {"restitution": 0.5},
    "walls": {"restitution": 0.5},
    "gravity": {"value": [0, 0, -1]},
    "scene": {"name": "gas", "options": {}},
    "add": {"position": [0, 0, 0], "velocity": [0, 0, 0], "radius": 1, "mass": 1, "color": 0},
    "remove": {"index": 0},
    "push": {"index": 0, "velocity": [0, 0, 0]},
    "compare": {"on": True},
}


def test_who_watches_can_do_nothing(view, sim):
    token = view.watch_url.split("#token=")[1]
    before = (sim.rule, sim.walls, len(sim), sim.scene)
    with page(view, token=token) as ws:
        for op in OPERATIONS.keys() - {"hello", "credit", "source"}:
            say(ws, op=op, **VALUES.get(op, {}))
            assert hear(ws, "refused") == "This page may only watch."
    assert (sim.rule, sim.walls, len(sim), sim.scene) == before
    assert (view._driver._playing, view._driver._speed, view._driver._stage.epoch) == (True, 1, 0)


def test_who_watches_cannot_busy_the_simulation_with_writing_sources(view):
    token = view.watch_url.split("#token=")[1]
    with page(view, token=token) as ws, page(view, token=token) as other:
        say(ws, op="source")
        hear(ws, "source")
        for again in (ws, other):
            say(again, op="source")
            assert "in a few seconds" in hear(again, "refused")
    with page(view) as ws:
        for _ in range(3):
            say(ws, op="source")
            assert hear(ws, "source")


def test_a_flood_of_commands_is_left_on_the_line(view, sim):
    """It takes little memory, and other pages are served as if nothing was."""
    with page(view, close_timeout=0.1) as flood, page(view) as ws:
        flood.socket.settimeout(0.2)
        flooded = 0
        end = time.perf_counter() + 1.5
        say(ws, op="credit", count=1)
        frames, most = 0, 0
        while time.perf_counter() < end:
            try:
                for op in ("reverse", "restart", "source", "reverse"):
                    say(flood, op=op)
                    flooded += 1
            except (TimeoutError, ConnectionClosed, OSError):
                break
            most = max(most, len(view._driver._orders))
        assert flooded > 3 * MAX_ORDERS
        assert most <= 2 * MAX_ORDERS
        end = time.perf_counter() + 1
        while time.perf_counter() < end:
            hear(ws)
            say(ws, op="credit", count=1)
            frames += 1
        assert frames > 5
        asked = time.perf_counter()
        say(ws, op="remove", index=99)
        assert "no sphere 99" in hear(ws, "refused")
        assert time.perf_counter() - asked < 2


def test_answers_nobody_reads_are_not_kept(view):
    token = view.watch_url.split("#token=")[1]
    raw, protocol = speechless(view)
    with raw:
        hello = {"op": "hello", "token": token, "version": VERSION}
        protocol.send_text(json.dumps(hello).encode())
        for _ in range(5000):
            protocol.send_text(b'{"op": "restart"}')
        raw.sendall(b"".join(protocol.data_to_send()))
        time.sleep(0.5)
        assert [len(c.answers) <= MAX_ANSWERS for c in view._server._clients] == [True]


@pytest.mark.parametrize("message", [b"", b'{"op": "pause"}', bytes(4096)])
def test_binary_messages(view, message):
    with page(view) as ws:
        ws.send(message)
        assert closed(ws) == (1008, "a message must be text of at most 4096 characters")
