"""Recordings: everything that happens, in a file that can be read back and gone on with."""

from pathlib import Path

from carom.record.recording import Recording

__all__ = ["Recording", "load"]


def load(path: str | Path) -> Recording:
    """Open a recording.

    Parameters
    ----------
    path : str or Path
        A file that ``carom run -o``, ``Simulation(record=...)`` or `Simulation.record` wrote.

    Raises
    ------
    FileError
        If it cannot be read, is cut short or damaged.
    InputError
        If it is no recording, or of a later format.
    """
    return Recording(path)
