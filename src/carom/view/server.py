"""Hands the page's files and the newest snapshot to browsers on this machine."""

import asyncio
import hmac
import json
import logging
import socket
import threading
from collections.abc import Callable
from http import HTTPStatus

from websockets.asyncio.server import ServerConnection
from websockets.asyncio.server import serve as serve_websocket
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response

from carom.errors import InputError
from carom.view.driver import Snapshot
from carom.view.files import load, security_headers
from carom.view.protocol import MAX_CREDITS, MAX_MESSAGE, VERSION, Command, decode_command

SOCKET_PATH = "/live"
MAX_CLIENTS = 16
HELLO_WITHIN = 5.0  #: seconds
#: Close codes; 1008 and 1013 are RFC 6455's, 4000 and up are for applications.
REFUSED, TOO_MANY, WRONG_TOKEN = 1008, 1013, 4001

#: websockets reports failed handshakes here; a program that wants to see them adds a handler.
logger = logging.getLogger("carom.view")
logger.addHandler(logging.NullHandler())


class Client:
    """One page: what it was sent, and how many frames it still takes."""

    def __init__(self, connection: ServerConnection) -> None:
        self.connection = connection
        self.credits = 0
        self.number = self.scene_number = 0
        self.failure = ""
        self.busy = False  # a message is still on its way out
        self.ready = asyncio.Event()


class Server:
    """HTTP and WebSocket on one loopback socket, in a thread with its own event loop.

    The newest snapshot lies in one slot; each page takes it when it has credit. A page that
    stops reading keeps nobody waiting: its own task waits, and newer snapshots replace older.

    Parameters
    ----------
    listening : socket
        Bound to a loopback address.
    token : str
        What a page must say first.
    order : callable
        Takes "playing", "speed" or "restart" with its value.
    poke : callable
        Told when a page can take a frame.
    """

    def __init__(
        self,
        listening: socket.socket,
        token: str,
        order: Callable[[str, float], None],
        poke: Callable[[], None],
    ) -> None:
        self._socket, self._token, self._order, self._poke = listening, token, order, poke
        self._port: int = listening.getsockname()[1]
        self._hosts = {f"{name}:{self._port}" for name in ("127.0.0.1", "localhost")}
        self._origins = {f"http://{host}" for host in self._hosts}
        self._headers = security_headers(self._port)
        self._files = load()
        self._connected = 0
        # Replaced, never changed in place: the driver's thread reads it without a lock.
        self._clients: tuple[Client, ...] = ()
        self._latest: Snapshot | None = None
        self._loop = asyncio.new_event_loop()
        self._end = asyncio.Event()
        self._listening = threading.Event()
        self._thread = threading.Thread(target=self._main, name="carom-view-web", daemon=True)

    # Called from other threads.

    def start(self) -> None:
        """Listen."""
        self._thread.start()
        self._listening.wait()

    def stop(self) -> None:
        """Close every connection and end the thread."""
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._end.set)
            self._thread.join()

    def publish(self, snapshot: Snapshot) -> None:
        """Put a snapshot into the slot."""
        self._loop.call_soon_threadsafe(self._take, snapshot)

    def watched(self) -> bool:
        """Whether a page is there."""
        return bool(self._clients)

    def hungry(self) -> bool:
        """Whether a page could take a newer snapshot than it was sent."""
        return any(client.credits > 0 and not client.busy for client in self._clients)

    # In the server's own thread.

    def _main(self) -> None:
        asyncio.set_event_loop(self._loop)
        try:
            self._loop.run_until_complete(self._serve())
        finally:
            self._loop.close()

    async def _serve(self) -> None:
        async with serve_websocket(
            self._talk,
            sock=self._socket,
            process_request=self._answer,
            compression=None,  # motion does not compress; deflate would cost more than it saves
            max_size=MAX_MESSAGE,
            server_header=None,
            close_timeout=1,
            logger=logger,
        ):
            self._listening.set()
            await self._end.wait()

    def _take(self, snapshot: Snapshot) -> None:
        self._latest = snapshot
        for client in self._clients:
            client.ready.set()

    def _answer(self, connection: ServerConnection, request: Request) -> Response | None:
        """Answer plain requests; None lets a WebSocket handshake go on.

        A page of another site can make a browser send requests here. It cannot choose Host
        (unless a name of its own resolves to this machine, which the check of Host stops)
        nor Origin.
        """
        if request.headers.get_all("Host") not in [[host] for host in self._hosts]:
            return self._reply(HTTPStatus.FORBIDDEN, b"This address is not served here.\n")
        # Older versions of websockets know no other method and refuse them themselves.
        if getattr(request, "method", "GET") != "GET":
            return self._reply(HTTPStatus.METHOD_NOT_ALLOWED, b"Only GET is served here.\n")
        if request.path == SOCKET_PATH:
            if request.headers.get_all("Origin") not in [[name] for name in self._origins]:
                return self._reply(HTTPStatus.FORBIDDEN, b"Other sites may not connect.\n")
            return None
        file = self._files.get(request.path)
        if file is None:
            return self._reply(HTTPStatus.NOT_FOUND, b"There is no such page.\n")
        return self._reply(HTTPStatus.OK, file.content, file.content_type)

    def _reply(
        self, status: HTTPStatus, body: bytes, kind: str = "text/plain; charset=utf-8"
    ) -> Response:
        headers = Headers(
            **{
                **self._headers,
                "Content-Type": kind,
                "Content-Length": str(len(body)),
                "Connection": "close",
            }
        )
        return Response(status.value, status.phrase, headers, body)

    async def _talk(self, connection: ServerConnection) -> None:
        if self._connected >= MAX_CLIENTS:
            await connection.close(TOO_MANY, f"only {MAX_CLIENTS} pages can watch at once")
            return
        self._connected += 1
        try:
            if await self._greet(connection):
                await self._attend(Client(connection))
        except InputError as error:
            await connection.close(REFUSED, str(error)[:120])
        except ConnectionClosed:
            pass
        finally:
            self._connected -= 1

    async def _greet(self, connection: ServerConnection) -> bool:
        """Wait for the token; nothing is said before it has come."""
        try:
            async with asyncio.timeout(HELLO_WITHIN):
                hello = decode_command(await connection.recv())
        except TimeoutError:
            await connection.close(REFUSED, "hello did not come in time")
            return False
        known = hmac.compare_digest(hello.token.encode(), self._token.encode())
        if hello.op != "hello" or not known:
            await connection.close(WRONG_TOKEN, "this page belongs to another run")
            return False
        if hello.version != VERSION:
            await connection.close(REFUSED, "this page belongs to another version")
            return False
        return True

    async def _attend(self, client: Client) -> None:
        """Read what a page says and send it snapshots, until it goes."""
        self._clients = (*self._clients, client)
        sending = asyncio.create_task(self._send(client))
        try:
            async for message in client.connection:
                self._obey(client, decode_command(message))
        finally:
            self._clients = tuple(other for other in self._clients if other is not client)
            sending.cancel()

    def _obey(self, client: Client, command: Command) -> None:
        if command.op == "credit":
            client.credits = min(client.credits + command.count, MAX_CREDITS)
            client.ready.set()
            self._poke()
        elif command.op == "speed":
            self._order("speed", command.value)
        elif command.op == "restart":
            self._order("restart", 1.0)
        elif command.op in ("play", "pause"):
            self._order("playing", float(command.op == "play"))
        else:
            msg = "hello was said already"
            raise InputError(msg)

    async def _send(self, client: Client) -> None:
        """Send the newest snapshot whenever the page has credit and has not seen it."""
        try:
            while True:
                await client.ready.wait()
                client.ready.clear()
                latest = self._latest
                if latest is None or client.credits == 0 or latest.number == client.number:
                    continue
                client.busy = True
                await self._deliver(client, latest)
                client.busy = False
                client.ready.set()  # a newer one may have come meanwhile
        except ConnectionClosed:
            return

    async def _deliver(self, client: Client, snapshot: Snapshot) -> None:
        send = client.connection.send
        if snapshot.scene_number != client.scene_number:
            client.scene_number = snapshot.scene_number
            await send(snapshot.scene)
        if snapshot.failure != client.failure:
            client.failure = snapshot.failure
            await send(json.dumps({"failure": snapshot.failure}))
        client.number = snapshot.number
        client.credits -= 1
        await send(snapshot.frame)
