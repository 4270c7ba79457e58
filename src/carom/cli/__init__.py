"""The command line: ``carom scenes``, ``show``, ``run``, ``compare``, ``sketch``, ``bench``."""

from carom.cli.commands import main

__all__ = ["main"]
