"""The live view: a simulation in the browser, on this machine only."""

from carom.view.live import LiveView, serve

__all__ = ["LiveView", "serve"]
