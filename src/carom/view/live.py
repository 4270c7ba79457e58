"""Opens and closes the live view."""

import threading
import webbrowser
from collections.abc import Callable
from types import TracebackType
from typing import Self

from carom.view import network, tokens
from carom.view.bundle import template
from carom.view.catalogue import catalogue
from carom.view.driver import Driver
from carom.view.files import VIEW, load
from carom.view.protocol import encode_text
from carom.view.server import Server
from carom.view.viewable import Viewable


class LiveView:
    """A simulation shown in browsers for as long as a ``with`` block lasts.

    Parameters
    ----------
    sim : Simulation
        Used only by the view until it is closed.
    host : str
        "127.0.0.1" shows it on this machine only. An address of this machine in a network, or
        "0.0.0.0" for all of them, shows it to everybody there who has an address of the page;
        the connection is not encrypted.
    port : int
        0 takes a free one. Another keeps its token for a week, so that pages that are open
        go on when the program is started again.

    Attributes
    ----------
    url : str
        Address of the page, once it is open. The part after ``#`` is a password:
        browsers send it to nobody, and the page removes it from the address bar.
    watch_url : str
        The same for pages that may watch but not control.

    Raises
    ------
    FileError
        If the port or the address cannot be used.
    InputError
        If the host or the port is none.
    """

    url: str
    watch_url: str

    def __init__(self, sim: Viewable, *, host: str = "127.0.0.1", port: int = 0) -> None:
        self._names = network.reached_as(host)
        self._sim, self._host, self._port = sim, host, network.checked_port(port)
        self._ended = threading.Event()

    @property
    def is_public(self) -> bool:
        """Whether other machines can reach it."""
        return not network.is_loopback(self._host)

    def __enter__(self) -> Self:
        self._socket = network.listen(self._host, self._port)
        token, watch = (tokens.of_port(self._port, role) for role in ("control", "watch"))
        self._server = Server(
            self._socket,
            self._names,
            {token: "control", watch: "watch"},
            load(VIEW) | template(),
            order=lambda command, reply: self._driver.order(command, reply),
            poke=lambda: self._driver.poke(),
            welcome=(encode_text("catalogue", catalogue()),),
        )
        self._driver = Driver(
            self._sim, self._server.publish, self._server.hungry, self._server.watched
        )
        self._driver.on_end = self._over
        page = f"http://{self._names[0]}:{self._socket.getsockname()[1]}/#token="
        self.url, self.watch_url = page + token, page + watch
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

    def _over(self) -> None:
        """The simulation's thread has ended: so do the pages, which would wait in vain."""
        self._ended.set()
        self._server.close()

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
    on_ready: Callable[[LiveView], object] | None = None,
) -> None:
    """Show a simulation live in the browser until Ctrl-C.

    The simulation runs while a page is open. Afterwards it is whole and may be used again.

    Parameters
    ----------
    sim : Simulation
    host : str
        See `LiveView`.
    port : int
        0 takes a free one.
    open_browser : bool
    on_ready : callable, optional
        Called with the view, whose `url` can be opened then.

    Raises
    ------
    FileError
        If the port or the address cannot be used.
    InputError
        If the host or the port is none.
    """
    with LiveView(sim, host=host, port=port) as view:
        try:
            if on_ready is not None:
                on_ready(view)
            if open_browser:
                webbrowser.open(view.url)
            view.wait()
        except KeyboardInterrupt:
            return
