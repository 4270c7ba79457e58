"""Where ``carom bench`` keeps what it measured."""

from pathlib import Path

from carom.errors import FileError

#: Where results go in a checkout of carom, seen from its root. Elsewhere, and where only some cases
#: are chosen, -o alone keeps them.
CHECKOUT = Path("benchmarks", "results")


def where(output: str | None, name: str, *, chosen: bool) -> Path | None:
    """Where a result goes; that it cannot go there is said before a minute of work.

    Parameters
    ----------
    output : str or None
        What ``-o`` says.
    name : str
        Of the file in a checkout.
    chosen : bool
        Whether only some cases are measured.

    Raises
    ------
    FileError
        If there is no such folder.
    """
    if output is None:
        if chosen or not (CHECKOUT.is_dir() and Path("src", "carom").is_dir()):
            return None
        return CHECKOUT / name
    path = Path(output)
    if path.is_dir() or not path.parent.is_dir():
        why = "it is a folder" if path.is_dir() else f"there is no folder {path.parent}"
        msg = f"cannot write {path}: {why}; choose another file with -o"
        raise FileError(msg)
    return path
