"""The live view: a simulation in the browser, on this machine only."""

from carom.view.live import LiveView, serve
from carom.view.replay import write_replay

__all__ = ["LiveView", "serve", "write_replay"]
