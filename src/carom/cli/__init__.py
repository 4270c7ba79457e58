"""The command line: ``carom scenes``, ``show``, ``run``, ``compare``."""

from carom.cli.commands import main

__all__ = ["main"]
