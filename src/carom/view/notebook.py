"""Simulations and replays in a notebook's cell, by anywidget; `static/notebook.js` is its half.

The kernel does one thing after another: while a cell runs, the view waits; while none does, each
message from the page lets time run for one slice and is answered with a frame. So nobody moves a
simulation while a cell uses it, no thread outlives anything, and a page that is gone costs nothing.
"""

from collections.abc import Callable
from functools import cache
from typing import Any
from weakref import WeakValueDictionary

import numpy as np

from carom.checks import number
from carom.errors import InputError
from carom.view import bundle
from carom.view.driver import Driver
from carom.view.files import FOLDER
from carom.view.protocol import Command, decode_command, encode_text
from carom.view.replay import COLORS, Recorded, even_times, replay
from carom.view.snapshot import Snapshot
from carom.view.viewable import Viewable
from carom.view.wire import MAX_CREDITS

HEIGHT = 480  #: pixels
LOWEST, HIGHEST = 200, 4000
MISSING = 'view() needs anywidget: pip install "carom[notebook]"'

Send = Callable[[dict[str, str], list[bytes]], None]


def live(sim: Viewable, *, color: str | None = None, height: int = HEIGHT) -> Any:
    """Make a widget that shows a simulation live; see `carom.Simulation.view`."""
    if color is not None and color not in COLORS:
        msg = f"color is {color!r}; it must be one of {', '.join(COLORS)}"
        raise InputError(msg)
    title = sim.scene.title if sim.scene is not None else ""
    page = bundle.page("widget.js", title or "carom", color or "")
    widget = _make(page, title, height, live=True)
    host = _HOSTS.get(id(sim))
    if host is None:
        host = _HOSTS[id(sim)] = Host(sim)

    _look_after_cells()

    def hear(_: Any, content: Any, buffers: Any) -> None:
        view, text = content.get("view"), content.get("text")
        host.hear(f"{widget.model_id} {view}", text, lambda more, data: send(view, more, data))

    def send(view: str, more: dict[str, str], data: list[bytes]) -> None:
        widget.send({"view": view, **more}, data)

    widget.on_msg(hear)
    return widget


def recorded(run: Recorded, *, color: str | None = None, height: int = HEIGHT) -> Any:
    """Make a widget that plays a recording; it needs no kernel any more."""
    _widget_class()  # what is missing is told before work is done
    title = run.scene.title if run.scene is not None else ""
    return _make(replay(run, even_times(run), color=color), title, height, live=False)


class Host:
    """What all views of one simulation share: the motion, and who looks at it."""

    def __init__(self, sim: Viewable) -> None:
        self._sim = sim
        self._pages: dict[str, Page] = {}
        self._latest: Snapshot | None = None
        self._driver = Driver(sim, self._publish, self._hungry, lambda: bool(self._pages))
        self._driver.prepare()
        self._left = self._seen()

    def hear(self, name: str, text: object, send: Send) -> None:
        """Take a message of a page, and answer it with what there is to see."""
        try:
            command = decode_command(text)
        except InputError as error:
            send({"text": encode_text("refused", str(error))}, [])
            return
        if command.op == "hello":
            self._pages[name] = Page(send, self._latest)
            send({"text": encode_text("role", "control")}, [])
        page = self._pages.get(name)
        if page is not None:
            self._obey(page, command)
            self.look()

    def look(self) -> None:
        """Let time run up to now, and notice what cells have done meanwhile."""
        if self._changed():
            self._driver.catch_up()
        self._driver.turn()
        self._left = self._seen()

    def _obey(self, page: "Page", command: Command) -> None:
        if command.op == "credit":
            page.credits = min(page.credits + command["count"], MAX_CREDITS)
            page.deliver()
        elif command.op != "hello":
            self._driver.order(
                command, lambda answer: page.send({"text": answer}, []) if answer else None
            )

    def _publish(self, snapshot: Snapshot) -> None:
        self._latest = snapshot
        # A page that has not come back for long is closed: its credit is used up, it gets no more.
        for page in self._pages.values():
            page.latest = snapshot
            page.deliver()

    def _hungry(self) -> bool:
        return any(page.credits > 0 for page in self._pages.values())

    def _seen(self) -> tuple[Any, ...]:
        sim = self._sim
        return sim.time, sim.collisions, id(sim.scene), sim.rule, np.array(sim.velocity)

    def _changed(self) -> bool:
        """Whether a cell has done something to the simulation since the last message."""
        *before, old = self._left
        *now, new = self._seen()
        return before != now or not np.array_equal(old, new)


class Page:
    """One picture of a simulation in a notebook."""

    def __init__(self, send: Send, latest: Snapshot | None) -> None:
        self.send = send
        self.credits = 0
        self.latest = latest
        self._number = self._scene_number = 0
        self._notes: dict[str, int] = {}

    def deliver(self) -> None:
        """Send the newest snapshot, if the page has credit and has not seen it."""
        snapshot = self.latest
        if snapshot is None or self.credits == 0 or snapshot.number == self._number:
            return
        self.credits -= 1
        self._number = snapshot.number
        data = list(snapshot.frames)
        if snapshot.scene_number != self._scene_number:
            self._scene_number = snapshot.scene_number
            data.insert(0, snapshot.scene)
        for key, (version, text) in snapshot.notes.items():
            if self._notes.get(key) != version:
                self._notes[key] = version
                self.send({"text": text}, [])
        self.send({}, data)


#: By id of their simulations, which they keep alive; widgets keep them.
_HOSTS: WeakValueDictionary[int, Host] = WeakValueDictionary()


def _look_after_cells() -> None:
    """Let views show what each cell has done, also while their time stands."""
    try:
        from IPython import get_ipython
    except ImportError:
        return
    if (shell := get_ipython()) is not None:
        shell.events.register("post_run_cell", _look)


def _look(*_: object) -> None:
    for host in list(_HOSTS.values()):
        host.look()


def _make(page: str, title: str, height: int, *, live: bool) -> Any:
    pixels = round(number("height", height, at_least=LOWEST, at_most=HIGHEST))
    return _widget_class()(page=page, title=title or "carom", height=pixels, live=live)


@cache
def _widget_class() -> Any:
    try:
        import anywidget
        import traitlets
    except ImportError as missing:
        raise InputError(MISSING) from missing

    class View(anywidget.AnyWidget):  # type: ignore[misc]
        """A page in a frame of its own."""

        _esm = (FOLDER / "notebook.js").read_text(encoding="utf-8")
        page = traitlets.Unicode().tag(sync=True)
        title = traitlets.Unicode().tag(sync=True)
        height = traitlets.Int().tag(sync=True)
        live = traitlets.Bool().tag(sync=True)

        def __repr__(self) -> str:
            return f"<view of {self.title}>"

    return View
