"""Event files: every collision of a run as data (docs/events.md)."""

from carom.event_file.reader import Events, load_events
from carom.event_file.recorder import EventRecorder

__all__ = ["EventRecorder", "Events", "load_events"]
