"""The library of scenes, as a page's gallery needs it."""

from typing import Any

from carom import scenes


def catalogue() -> list[dict[str, Any]]:
    """Every scene: its name, a title, what it is in one line, and its options."""
    return [
        {
            "name": name,
            "title": name.replace("-", " ").capitalize(),
            "description": scenes.describe(name),
            "options": [
                {
                    "name": option.name,
                    "type": option.type.__name__,
                    "default": option.default,
                    "help": option.help,
                    "low": option.low,
                    "high": option.high,
                    "log": option.log,
                }
                for option in scenes.options(name)
            ],
        }
        for name in scenes.names()
    ]
