"""What can go wrong, each with one sentence: the value, the limit, the remedy."""

import errno
from pathlib import Path

#: What the system says where there is no more room.
FULL = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EFBIG})


class CaromError(Exception):
    """Base of every error carom raises on purpose."""


class InputError(CaromError, ValueError):
    """A value, option or scene that cannot be used (exit status 2 on the command line)."""


class OverlapError(InputError):
    """Spheres placed into one another, or into a wall."""


class UnknownNameError(InputError, LookupError):
    """A name that does not exist; the message suggests the nearest one."""


class RunError(CaromError, RuntimeError):
    """A run that cannot go on (exit status 1 on the command line)."""


class CollapseError(RunError):
    """Inelastic collapse: infinitely many collisions in finite time."""


class FileError(CaromError, OSError):
    """A file or port that cannot be used (exit status 1 on the command line)."""


def unwritable(path: str | Path, error: OSError) -> FileError:
    """The sentence about a file that the system does not let one write."""
    remedy = "make room there" if error.errno in FULL else "check the folder and its permissions"
    return FileError(
        f"cannot write {path}: {error.strerror or error}; {remedy}, or choose another place"
    )
