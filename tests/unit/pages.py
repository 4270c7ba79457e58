"""Pages without a browser, for tests of the live view's server."""

import json
import socket
from contextlib import contextmanager

from websockets.client import ClientProtocol
from websockets.exceptions import ConnectionClosed
from websockets.protocol import State
from websockets.sync.client import connect
from websockets.uri import parse_uri

from carom.view.wire import VERSION


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


def speechless(view, room=4096):
    """An open WebSocket that has said nothing yet and reads nothing, and what writes for it."""
    base, _ = address(view)
    raw = socket.socket()
    raw.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, room)
    raw.settimeout(5)
    raw.connect(view._socket.getsockname())
    protocol = ClientProtocol(parse_uri(base.replace("http", "ws") + "/live"), origin=base)
    protocol.send_request(protocol.connect())
    raw.sendall(b"".join(protocol.data_to_send()))
    while protocol.state is not State.OPEN:
        protocol.receive_data(raw.recv(1))
    return raw, protocol


def dead_page(view):
    """A page that gives credit and then never reads, with little room in between."""
    raw, protocol = speechless(view, room=16384)
    for message in (
        {"op": "hello", "token": address(view)[1], "version": VERSION},
        {"op": "credit", "count": 4},
    ):
        protocol.send_text(json.dumps(message).encode())
    raw.sendall(b"".join(protocol.data_to_send()))
    return raw
