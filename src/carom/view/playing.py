"""Shows a replay in the browser without writing a file."""

import threading
import webbrowser
from collections.abc import Callable

from carom.view import network, tokens
from carom.view.files import TYPES, StaticFile, replay_headers
from carom.view.server import Server


def play(
    page: str,
    *,
    host: str = "127.0.0.1",
    port: int = 0,
    open_browser: bool = True,
    on_ready: Callable[[str], object] | None = None,
) -> None:
    """Hand a replay's page to browsers until Ctrl-C.

    Parameters
    ----------
    page : str
        What `carom.view.replay.replay` has made.
    host, port
        See `carom.view.LiveView`.
    open_browser : bool
    on_ready : callable, optional
        Called with the address, which nobody can guess.

    Raises
    ------
    FileError
        If the port or the address cannot be used.
    InputError
        If the host or the port is none.
    """
    names, port = network.reached_as(host), network.checked_port(port)
    with network.listen(host, port) as listening:
        path = f"/{tokens.of_port(port, 'watch')}"
        files = {path: StaticFile(page.encode(), TYPES["html"])}
        server = Server(
            *(listening, names, {}, files),
            order=lambda command, reply: reply(""),
            poke=lambda: None,
            headers=replay_headers(),
        )
        server.start()
        try:
            address = f"http://{names[0]}:{listening.getsockname()[1]}{path}"
            if on_ready is not None:
                on_ready(address)
            if open_browser:
                webbrowser.open(address)
            while True:  # in slices, because on Windows Ctrl-C does not end an endless wait
                threading.Event().wait(0.2)
        except KeyboardInterrupt:
            return
        finally:
            server.stop()
