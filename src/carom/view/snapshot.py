"""What pages may be sent."""

from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class Snapshot:
    """The newest frames, the scene they belong to, and what there is to say.

    Attributes
    ----------
    number : int
        Counts snapshots.
    frames : tuple of bytes
        Binary messages; a page spends one credit for all of them.
    scene_number : int
        0: there is no scene message.
    scene : bytes
    notes : dict
        Text messages by key, each with a number that counts its changes.
    """

    number: int
    frames: tuple[bytes, ...]
    scene_number: int = 0
    scene: bytes = b""
    notes: dict[str, tuple[int, str]] = field(default_factory=dict)
