"""Hands the page's files and the newest snapshot to browsers."""

import asyncio
import hmac
import logging
import socket
import threading
from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from functools import partial
from http import HTTPStatus

from websockets.asyncio.server import ServerConnection
from websockets.asyncio.server import serve as serve_websocket
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response

from carom.errors import InputError
from carom.view.door import Door, Visitor
from carom.view.files import StaticFile, security_headers
from carom.view.protocol import Command, decode_command, encode_text
from carom.view.snapshot import Snapshot
from carom.view.wire import (
    MAX_CREDITS,
    MAX_MESSAGE,
    REFUSED,
    SOCKET_PATH,
    TOO_MANY,
    VERSION,
    WRONG_TOKEN,
)

MAX_CLIENTS = 64
MAX_ANSWERS = 64  #: that may wait for a page which does not read them
MAX_ORDERS = 16  #: of one page that may wait; what it says besides stays on the line
SOURCE_EVERY = 5.0  #: seconds between sources for pages that watch: writing one takes time
HELLO_WITHIN = 5.0  #: seconds
#: What a page without the right to control may do.
HARMLESS = frozenset({"credit", "source"})

Reply = Callable[[str], None]

#: websockets reports failed handshakes here; a program that wants to see them adds a handler.
logger = logging.getLogger("carom.view")
logger.addHandler(logging.NullHandler())


class Client:
    """One page: what it was sent, and how many frames it still takes."""

    def __init__(self, connection: ServerConnection, controls: bool) -> None:
        self.connection = connection
        self.controls = controls
        self.credits = 0
        self.number = self.scene_number = 0
        self.notes: dict[str, int] = {}  # number of each note it was sent
        self.answers: list[str] = []
        self.busy = False  # a message is still on its way out
        self.ready = asyncio.Event()
        self.room = asyncio.Semaphore(MAX_ORDERS)

    def answer(self, text: str) -> None:
        """Send a text, in the server's thread, when the page reads."""
        if len(self.answers) < MAX_ANSWERS:
            self.answers.append(text)
        self.ready.set()


class Server:
    """HTTP and WebSocket on one socket, in a thread with its own event loop.

    The newest snapshot lies in one slot; each page takes it when it has credit. A page that
    stops reading keeps nobody waiting: its own task waits, and newer snapshots replace older.

    Parameters
    ----------
    listening : socket
    hosts : collection of str
        Names and addresses under which this machine is reached, without the port.
    tokens : mapping
        What a page must say first, and its role: "control" or "watch".
    files : mapping
        Each file by its address, see `carom.view.files`.
    order : callable
        Takes each `Command` of a page, and a callable to be called once when it is done, with
        the answer to that page or "".
    poke : callable
        Told when a page can take a frame.
    welcome : collection of str
        Texts sent to every page after it has said hello.
    headers : mapping, optional
        Of every answer; those of `security_headers` if left out.
    """

    def __init__(
        self,
        listening: socket.socket,
        hosts: Collection[str],
        tokens: Mapping[str, str],
        files: Mapping[str, StaticFile],
        order: Callable[[Command, Reply], None],
        poke: Callable[[], None],
        welcome: Collection[str] = (),
        headers: Mapping[str, str] | None = None,
    ) -> None:
        self._socket, self._tokens, self._files = listening, tokens, files
        self._order, self._poke, self._welcome = order, poke, welcome
        port: int = listening.getsockname()[1]
        # Browsers leave out the port of http.
        self._hosts = {f"{name}:{port}" if port != 80 else name for name in hosts}
        self._origins = {f"http://{host}" for host in self._hosts}
        self._headers = security_headers(self._hosts) if headers is None else headers
        self._door = Door()
        self._source_at = -SOURCE_EVERY
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

    def close(self) -> None:
        """Close every connection, soon."""
        with suppress(RuntimeError):  # the loop has ended already
            self._loop.call_soon_threadsafe(self._end.set)

    def stop(self) -> None:
        """Close every connection and end the thread."""
        self.close()
        if self._thread.ident is not None:
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
            self._listening.set()  # or it has failed, and nobody need wait
            self._loop.close()

    async def _serve(self) -> None:
        async with serve_websocket(
            self._talk,
            sock=self._socket,
            process_request=self._answer,
            create_connection=partial(Visitor, self._door),  # type: ignore[arg-type]
            compression=None,  # motion does not compress; deflate would cost more than it saves
            max_size=MAX_MESSAGE,
            server_header=None,
            close_timeout=1,
            logger=logger,
        ):
            self._listening.set()
            await self._end.wait()
            for client in self._clients:  # nothing is done any more that it could wait for
                client.room.release()

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
        try:
            if not (role := await self._greet(connection)):
                return
            if len(self._clients) >= MAX_CLIENTS:
                await connection.close(TOO_MANY, f"only {MAX_CLIENTS} pages can watch at once")
                return
            client = Client(connection, controls=role == "control")
            for text in (encode_text("role", role), *self._welcome):
                client.answer(text)
            await self._attend(client)
        except InputError as error:
            await connection.close(REFUSED, str(error)[:120])
        except ConnectionClosed:
            pass

    async def _greet(self, connection: ServerConnection) -> str:
        """Wait for a token and return its role; nothing is said before it has come."""
        try:
            async with asyncio.timeout(HELLO_WITHIN):
                hello = decode_command(await connection.recv())
        except TimeoutError:
            await connection.close(REFUSED, "hello did not come in time")
            return ""
        said = hello["token"].encode() if hello.op == "hello" else b""
        role = ""
        for token, kind in self._tokens.items():  # all of them, so that the time tells nothing
            role = kind if hmac.compare_digest(said, token.encode()) else role
        if not role:
            await connection.close(WRONG_TOKEN, "this page belongs to another run")
        elif hello["version"] != VERSION:
            await connection.close(REFUSED, "this page belongs to another version")
            return ""
        else:
            self._door.leave(connection)  # type: ignore[arg-type]
        return role

    async def _attend(self, client: Client) -> None:
        """Read what a page says and send it snapshots, until it goes."""
        self._clients = (*self._clients, client)
        sending = asyncio.create_task(self._send(client))
        try:
            async for message in client.connection:
                await self._obey(client, decode_command(message))
        finally:
            self._clients = tuple(other for other in self._clients if other is not client)
            sending.cancel()

    async def _obey(self, client: Client, command: Command) -> None:
        if command.op == "hello":
            msg = "hello was said already"
            raise InputError(msg)
        if command.op == "credit":
            client.credits = min(client.credits + command["count"], MAX_CREDITS)
            if self._latest is not None and self._latest.number != client.number:
                client.ready.set()
            self._poke()
        elif why := self._refusal(client, command.op):
            client.answer(encode_text("refused", why))
        elif not self._end.is_set():
            await client.room.acquire()
            self._order(command, partial(self._done_from_afar, client))

    def _refusal(self, client: Client, op: str) -> str:
        """Why a page may not do something; "" if it may."""
        if client.controls:
            return ""
        if op not in HARMLESS:
            return "This page may only watch."
        if self._loop.time() - self._source_at < SOURCE_EVERY:
            return "A page has asked for this just now; try again in a few seconds."
        self._source_at = self._loop.time()
        return ""

    def _done_from_afar(self, client: Client, answer: str) -> None:
        """Tell a page from another thread that something is done."""
        with suppress(RuntimeError):  # the loop has ended, and the page with it
            self._loop.call_soon_threadsafe(self._done, client, answer)

    def _done(self, client: Client, answer: str) -> None:
        client.room.release()
        if answer:
            client.answer(answer)

    async def _send(self, client: Client) -> None:
        """Send answers, and the newest snapshot when the page has credit and has not seen it."""
        try:
            while True:
                await client.ready.wait()
                client.ready.clear()
                while client.answers:
                    await client.connection.send(client.answers.pop(0))
                latest = self._latest
                if latest is None or client.credits == 0 or latest.number == client.number:
                    continue
                client.busy = True
                await self._deliver(client, latest)
                client.busy = False
                if self._latest is not latest:  # a newer one has come meanwhile
                    client.ready.set()
        except ConnectionClosed:
            return

    async def _deliver(self, client: Client, snapshot: Snapshot) -> None:
        send = client.connection.send
        if snapshot.scene_number != client.scene_number:
            client.scene_number = snapshot.scene_number
            await send(snapshot.scene)
        for key, (number, text) in snapshot.notes.items():
            if client.notes.get(key) != number:
                client.notes[key] = number
                await send(text)
        client.number = snapshot.number
        client.credits -= 1
        for frame in snapshot.frames:
            await send(frame)
