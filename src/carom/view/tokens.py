"""The passwords of a view: random, and kept for a port that was asked for by number."""

import os
import secrets
import stat
import time
from pathlib import Path

KEPT = 7 * 24 * 3600.0  #: seconds for which a port keeps its token
#: Follow no link, nor wait for somebody to write into a pipe; Windows knows neither.
NO_LINK = getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0)


def fresh() -> str:
    """A token nobody can guess."""
    return secrets.token_urlsafe(24)


def of_port(port: int, role: str) -> str:
    """The token of a role at a port, so that pages know a program that was started again.

    Port 0 is another one in every run and gets a fresh token. Others keep theirs for a week in a
    file that only its owner can read, in a folder that only he can write to; where there is no
    such place, the token is fresh.
    """
    if port == 0:
        return fresh()
    token = fresh()
    try:
        path = _folder() / f"{role}-{port}"
        kept = _read(path)
        if len(kept) == len(token) and kept.isascii():
            return kept
        path.unlink(missing_ok=True)
        flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL  # never through somebody else's link
        with os.fdopen(os.open(path, flags, 0o600), "w", encoding="ascii") as file:
            file.write(token)
    except (OSError, ValueError, RuntimeError):  # RuntimeError: there is no home
        pass  # the token serves this run all the same
    return token


def _folder() -> Path:
    """Where programs of this user keep what they must remember; refuses a folder others change."""
    home = os.environ.get("XDG_STATE_HOME", "")
    # The XDG rules: a relative path is to be ignored.
    state = Path(home) if Path(home).is_absolute() else Path.home() / ".local" / "state"
    folder = state / "carom"
    folder.mkdir(mode=0o700, parents=True, exist_ok=True)
    about = folder.lstat()
    if not stat.S_ISDIR(about.st_mode) or not _is_own(about, 0o022):
        msg = f"others can write to {folder}"
        raise OSError(msg)
    return folder


def _is_own(about: os.stat_result, forbidden: int) -> bool:
    """Whether a file is this user's, with none of these permissions. Windows knows neither."""
    return os.name != "posix" or (about.st_uid == os.getuid() and not about.st_mode & forbidden)


def _read(path: Path) -> str:
    """What was kept in the last week; "" if there is nothing, or others could read it."""
    try:
        # Asked of the open file: a name could mean another one by now.
        with os.fdopen(os.open(path, os.O_RDONLY | NO_LINK), encoding="ascii") as file:
            about = os.fstat(file.fileno())
            young = 0 <= time.time() - about.st_mtime < KEPT
            private = stat.S_ISREG(about.st_mode) and _is_own(about, 0o077)
            return file.read(100) if young and private else ""
    except (OSError, ValueError):
        return ""
