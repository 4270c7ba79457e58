"""Opens and closes the page of a sketch."""

import webbrowser
from collections.abc import Callable
from types import TracebackType
from typing import Self

from carom.errors import CaromError
from carom.sketch.program import Program
from carom.sketch.runner import Runner
from carom.view import network, tokens
from carom.view.files import SKETCH, load
from carom.view.server import Server

HOST = "127.0.0.1"  #: a student's program is shown on its own machine only


class SketchView:
    """A sketch in the browser for as long as a ``with`` block lasts.

    Parameters
    ----------
    program : Program
        Loaded. `run` runs it, in the thread that calls it.
    port : int
        0 takes a free one.
    on_error : callable, optional
        Told of each error of the program, which then waits to be started again.

    Attributes
    ----------
    url : str
        Address of the page, once it is open; see `carom.view.LiveView`.

    Raises
    ------
    FileError
        If the port cannot be used.
    InputError
        If it is none.
    """

    url: str

    def __init__(
        self,
        program: Program,
        *,
        port: int = 0,
        on_error: Callable[[CaromError], None] = lambda error: None,
    ) -> None:
        self._program, self._on_error = program, on_error
        self._port = network.checked_port(port)

    def __enter__(self) -> Self:
        self._socket = network.listen(HOST, self._port)
        token = tokens.of_port(self._port, "control")
        self._server = Server(
            self._socket,
            network.reached_as(HOST),
            {token: "control"},
            load(SKETCH),
            order=lambda command, reply: self._runner.order(command, reply),
            poke=lambda: self._runner.poke(),
        )
        self._runner = Runner(
            self._program,
            self._server.publish,
            self._server.hungry,
            self._server.watched,
            self._on_error,
        )
        self.url = f"http://{HOST}:{self._socket.getsockname()[1]}/#token={token}"
        self._server.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._runner.stop()
        self._server.stop()
        self._socket.close()

    def run(self) -> None:
        """Run the program until Ctrl-C, `stop`, or until it leaves by itself."""
        self._runner.run()

    def stop(self) -> None:
        """Let `run` come back after the present frame; may be called from another thread."""
        self._runner.stop()

    @property
    def failed(self) -> bool:
        """Whether an error of the program stands in the way."""
        return self._runner.failed


def serve(
    program: Program,
    *,
    port: int = 0,
    open_browser: bool = True,
    on_ready: Callable[[str], object] = lambda url: None,
    on_error: Callable[[CaromError], None] = lambda error: None,
) -> bool:
    """Show a sketch in the browser until Ctrl-C.

    Parameters
    ----------
    program : Program
        Loaded.
    port : int
        0 takes a free one.
    open_browser : bool
    on_ready : callable, optional
        Called with the page's address once it can be opened.
    on_error : callable, optional
        Told of each error of the program.

    Returns
    -------
    bool
        Whether the program was well at the end.

    Raises
    ------
    FileError
        If the port cannot be used.
    InputError
        If it is none.
    """
    with SketchView(program, port=port, on_error=on_error) as view:
        try:
            on_ready(view.url)
            if open_browser:
                webbrowser.open(view.url)
            view.run()
        except KeyboardInterrupt:
            pass
        return not view.failed
