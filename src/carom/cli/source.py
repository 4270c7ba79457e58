"""What is to be run: a scene by name with its options, or a scene file."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import typer

from carom import scenes
from carom.checks import nearest, number
from carom.errors import InputError, UnknownNameError
from carom.methods import METHODS, TICKS_PER_SECOND
from carom.scene import Scene
from carom.scene_file import load
from carom.simulation import Simulation


@dataclass(frozen=True)
class Source:
    """A scene and what it is called.

    Attributes
    ----------
    name : str
        As typed: a scene's name or a file.
    options : dict
        Options given to the scene.
    scene : Scene
    """

    name: str
    options: dict[str, Any]
    scene: Scene

    @property
    def text(self) -> str:
        """Name and options as one would type them."""
        given = [f"--{name.replace('_', '-')} {value}" for name, value in self.options.items()]
        return " ".join([self.name, *given])

    def simulation(self, method: str = "exact", tick: float | None = None) -> Simulation:
        """Build it; a tick left out is a sixtieth of what passes in a second at speed 1."""
        if method not in METHODS:
            msg = f"there is no method {method!r}{nearest(method, METHODS)}"
            raise UnknownNameError(msg)
        step = self.scene.pace / TICKS_PER_SECOND if tick is None else tick
        return Simulation(self.scene, method=method, tick=step)  # type: ignore[arg-type]


def own_options(context: typer.Context) -> list[str]:
    """Names of the options that a command has itself, without their dashes."""
    parts = context.command.params
    names = [name for part in parts for name in (*part.opts, *part.secondary_opts)]
    return [name.removeprefix("--") for name in names if name.startswith("--")]


def source(target: str, words: Sequence[str], seed: int | None, own: Sequence[str] = ()) -> Source:
    """Find what the command line names.

    Parameters
    ----------
    target : str
        A scene's name, or a file if it ends in ``.toml`` or contains a slash.
    words : sequence of str
        What is left of the command line: ``--name value`` or ``--name=value``.
    seed : int, optional
        Scenes without randomness do not need it.
    own : sequence of str
        The command's `own_options`, so that a misspelt one gets the right suggestion.

    Raises
    ------
    InputError
        For unknown scenes and options, wrong values, options to a file.
    FileError
        If the file cannot be read.
    """
    if not target or target.startswith("-"):
        msg = (
            "name a scene or a file first, as in 'carom run phase-4 --until 100'; "
            "'carom scenes' lists the scenes"
        )
        raise InputError(msg)
    if target.endswith(".toml") or "/" in target or Path(target).is_file():
        if words:
            msg = f"{words[0]} is an option of scenes, not of files; write it in {target}"
            raise InputError(msg)
        scene = load(target)
        return Source(target, {}, scene if seed is None else replace(scene, seed=seed))
    known = {option.name: option for option in scenes.options(target)}
    given = {
        name: known[name].parse(text) for name, text in _pairs(target, words, known, own).items()
    }
    if seed is not None and "seed" in known:
        given["seed"] = seed
    return Source(target, given, scenes.build(target, given))


def _pairs(
    target: str, words: Sequence[str], known: dict[str, scenes.Option], own: Sequence[str]
) -> dict[str, str]:
    """Sort loose words into names and values."""
    pairs: dict[str, str] = {}
    rest = list(words)
    while rest:
        word = rest.pop(0)
        if not word.startswith("--"):
            msg = f"{word!r} is one word too many; options are written --name value"
            raise InputError(msg)
        dashed, equals, value = word[2:].partition("=")
        name = dashed.replace("-", "_")
        if name not in known:
            names = [option.replace("_", "-") for option in known]
            msg = _unknown(target, dashed, names, own)
            raise UnknownNameError(msg)
        if not equals:
            if rest and not rest[0].startswith("--"):
                value = rest.pop(0)
            elif known[name].type is bool:
                value = "true"
            else:
                msg = f"option --{dashed} needs a value, as in --{dashed} {known[name].default}"
                raise InputError(msg)
        pairs[name] = value
    return pairs


def _unknown(target: str, name: str, names: list[str], own: Sequence[str]) -> str:
    hint = nearest(name, [*names, *own])
    if "did you mean" in hint:
        hint = hint.replace("'", "'--", 1)
    else:
        hint = f"; its options are {', '.join('--' + n for n in names)}"
    return f"the scene {target!r} has no option '--{name}'{hint}"


def parsed(name: str, text: str | None) -> float | None:
    """A number typed for an option, or None if there is none."""
    if text is None:
        return None
    try:
        value = float(text)
    except ValueError:
        msg = f"--{name} must be a number, not {text!r}"
        raise InputError(msg) from None
    return number(f"--{name}", value)


def whole(name: str, text: str | None) -> int | None:
    """A whole number typed for an option (1e6 is one), or None if there is none."""
    if text is None:
        return None
    try:
        return int(text)  # not by way of a float: beyond 2**53 that is another number
    except ValueError:
        value = parsed(name, text)
    if value is None or not value.is_integer():
        msg = f"--{name} must be a whole number, not {text}"
        raise InputError(msg)
    return int(value)
