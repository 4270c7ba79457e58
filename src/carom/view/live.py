"""Opens and closes the live view."""

import errno
import secrets
import socket
import threading
import webbrowser
from collections.abc import Callable
from types import TracebackType
from typing import Self

from carom.errors import FileError, InputError
from carom.view.driver import Driver
from carom.view.portrait import Viewable
from carom.view.server import Server

LOOPBACK = ("127.0.0.1", "localhost")


class LiveView:
    """A simulation shown on this machine for as long as a ``with`` block lasts.

    Parameters
    ----------
    sim : Simulation
        Used only by the view until it is closed.
    host : {"127.0.0.1", "localhost"}
    port : int
        0 takes a free one.

    Attributes
    ----------
    url : str
        Address of the page, once it is open. The part after ``#`` is a password of this run:
        browsers send it to nobody, and the page removes it from the address bar.

    Raises
    ------
    FileError
        If the port cannot be used.
    InputError
        If the host is not this machine.
    """

    url: str

    def __init__(self, sim: Viewable, *, host: str = "127.0.0.1", port: int = 0) -> None:
        if host not in LOOPBACK:
            msg = f"host is {host!r}; the live view is shown on this machine only: 127.0.0.1"
            raise InputError(msg)
        if isinstance(port, bool) or not isinstance(port, int) or not 0 <= port <= 65535:
            msg = f"port is {port!r}; it must be a whole number from 0 (any free one) to 65535"
            raise InputError(msg)
        self._sim, self._host, self._port = sim, host, port
        self._ended = threading.Event()

    def __enter__(self) -> Self:
        token = secrets.token_urlsafe(24)
        self._socket = _listen(self._port)
        self._server = Server(
            self._socket,
            token,
            order=lambda what, value: self._driver.order(what, value),
            poke=lambda: self._driver.poke(),
        )
        self._driver = Driver(
            self._sim, self._server.publish, self._server.hungry, self._server.watched
        )
        self._driver.on_end = self._ended.set
        self.url = f"http://{self._host}:{self._socket.getsockname()[1]}/#token={token}"
        self._server.start()
        self._driver.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._driver.stop()
        self._server.stop()
        self._socket.close()

    def wait(self) -> None:
        """Wait until Ctrl-C, or until the simulation's thread fails, whose error is raised."""
        # In slices, because on Windows Ctrl-C does not end an endless wait.
        while not self._ended.wait(0.2):
            pass
        if self._driver.error is not None:
            raise self._driver.error


def serve(
    sim: Viewable,
    *,
    host: str = "127.0.0.1",
    port: int = 0,
    open_browser: bool = True,
    on_ready: Callable[[str], object] | None = None,
) -> None:
    """Show a simulation live in the browser until Ctrl-C.

    The simulation runs while a page is open. Afterwards it is whole and may be used again.

    Parameters
    ----------
    sim : Simulation
    host : {"127.0.0.1", "localhost"}
    port : int
        0 takes a free one.
    open_browser : bool
    on_ready : callable, optional
        Called with the page's address once it can be opened.

    Raises
    ------
    FileError
        If the port cannot be used.
    InputError
        If the host is not this machine.
    """
    with LiveView(sim, host=host, port=port) as view:
        try:
            if on_ready is not None:
                on_ready(view.url)
            if open_browser:
                webbrowser.open(view.url)
            view.wait()
        except KeyboardInterrupt:
            return


def _listen(port: int) -> socket.socket:
    """Return a socket on the loopback address of this machine."""
    try:
        return socket.create_server(("127.0.0.1", port))
    except OSError as error:
        why = "is in use" if error.errno == errno.EADDRINUSE else f"cannot be used ({error})"
        msg = f"port {port} {why}; choose another, or 0 for any free one"
        raise FileError(msg) from error
