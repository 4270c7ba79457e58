"""The library of scenes, as a page's gallery needs it."""

from typing import Any

from carom import scenes

#: Titles of the library's scenes, in the order in which newcomers best look at them.
TITLES = {
    "two-balls": "Two balls",
    "newton-cradle": "Newton's cradle",
    "break-shot": "Break shot",
    "bounce": "Bouncing balls",
    "gas": "Gas in a box",
    "fluid": "Hard-sphere fluid",
    "giant": "Brownian motion",
    "galperin": "Galperin's billiard",
    "phase-0": "Phase 0: a sphere",
    "phase-1": "Phase 1: a cube",
    "phase-2": "Phase 2: two balls",
    "phase-3": "Phase 3: equal balls",
    "phase-4": "Phase 4: different balls",
}


def catalogue() -> list[dict[str, Any]]:
    """Every scene: its name, a title, what it is in one line, and its options.

    Scenes that somebody wrote come first, by name, then those of the library.
    """
    order = {name: k for k, name in enumerate(TITLES)}
    return [
        {
            "name": name,
            "title": TITLES.get(name, name.replace("-", " ").capitalize()),
            "description": _plain(scenes.describe(name)),
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
        for name in sorted(scenes.names(), key=lambda name: (order.get(name, -1), name))
    ]


def _plain(line: str) -> str:
    """What comes after "Newton's cradle: ", as a sentence: a card's title says that already."""
    text = line.split(": ", 1)[-1]
    return text[:1].upper() + text[1:] + "."
