"""Who may stand at the door: connections that have not said yet who they are."""

from typing import Any

from websockets.asyncio.server import ServerConnection
from websockets.frames import Frame, Opcode

MOST = 160  #: with pages and files, fewer than the 256 files some systems let a program open
PINGS = 64  #: in a row that may go unread; browsers send none


class Door:
    """Connections without a token, oldest first. Beyond `MOST` the oldest has to go.

    So neither requests that never end nor sockets that never speak keep a page out, and an
    honest one, which is done in milliseconds, is never the oldest.
    """

    def __init__(self) -> None:
        self._waiting: dict[Visitor, None] = {}

    def __len__(self) -> int:
        return len(self._waiting)

    def enter(self, visitor: "Visitor") -> None:
        """Take note of a new connection."""
        if len(self._waiting) >= MOST:
            oldest = next(iter(self._waiting))
            self.leave(oldest)
            oldest.transport.abort()
        self._waiting[visitor] = None

    def leave(self, visitor: "Visitor") -> None:
        """It has gone, or has said the token."""
        self._waiting.pop(visitor, None)


class Visitor(ServerConnection):
    """A connection that stands at a `Door` from its first byte on."""

    def __init__(self, door: Door, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self.door = door
        self._unread = 0

    def connection_made(self, transport: Any) -> None:
        """Stand at the door."""
        super().connection_made(transport)
        self.door.enter(self)

    def connection_lost(self, exc: Exception | None) -> None:
        """Leave it."""
        self.door.leave(self)
        super().connection_lost(exc)

    def process_event(self, event: Any) -> None:
        """Let nobody pile up answers to pings that he does not read."""
        super().process_event(event)
        if isinstance(event, Frame) and event.opcode is Opcode.PING:
            self._unread = self._unread + 1 if self.transport.get_write_buffer_size() else 0
            if self._unread > PINGS:
                self.transport.abort()
