"""Keeping what happens: files that are written while time runs."""

from types import TracebackType
from typing import Self

from carom.methods import Method
from carom.running import Running
from carom.scene import Scene


class Keeping(Running):
    """The part of `carom.Simulation` that writes files while time runs."""

    _scene: Scene | None
    _method: Method

    def close(self) -> None:
        """Finish all files that are being written; the simulation may go on without them.

        A simulation used with ``with`` does so at the end of the block.

        Raises
        ------
        FileError
            If something could not be written.
        """
        followers, self._motion.followers = self._motion.followers, []
        errors = []
        for follower in followers:
            try:
                follower.close(self._motion)
            except OSError as error:  # the others still finish theirs
                errors.append(error)
        if errors:
            raise errors[0]

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.close()
