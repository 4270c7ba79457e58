"""The passwords of a view: random, and kept for a port that was asked for by number."""

import os
import secrets
import time
from pathlib import Path

KEPT = 7 * 24 * 3600.0  #: seconds for which a port keeps its token


def fresh() -> str:
    """A token nobody can guess."""
    return secrets.token_urlsafe(24)


def of_port(port: int, role: str) -> str:
    """The token of a role at a port, so that pages know a program that was started again.

    Port 0 is another one in every run and gets a fresh token. Others keep theirs for a week in a
    file that only its owner can read; where that cannot be written, the token is fresh.
    """
    if port == 0:
        return fresh()
    path = _folder() / f"{role}-{port}"
    try:
        about = path.stat()
        private = os.name != "posix" or (about.st_uid == os.getuid() and not about.st_mode & 0o077)
        if private and 0 <= time.time() - about.st_mtime < KEPT:
            token = path.read_text(encoding="ascii")
            if len(token) == len(fresh()) and token.isascii():
                return token
    except (OSError, ValueError):
        pass
    return _keep(path)


def _folder() -> Path:
    """Where programs of this user keep what they must remember."""
    home = os.environ.get("XDG_STATE_HOME") or Path.home() / ".local" / "state"
    return Path(home) / "carom"


def _keep(path: Path) -> str:
    """Write a fresh token where nobody else reads it."""
    token = fresh()
    try:
        path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        path.unlink(missing_ok=True)
        flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL  # never through somebody else's link
        with os.fdopen(os.open(path, flags, 0o600), "w", encoding="ascii") as file:
            file.write(token)
    except OSError:
        pass  # the token serves this run all the same
    return token
