"""`@scene` turns a function into a scene that every part of carom knows by name."""

import functools
import inspect
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any, ParamSpec, get_args, get_origin

import numpy as np

from carom.checks import nearest, number
from carom.errors import InputError, UnknownNameError
from carom.scene import Origin, Scene

P = ParamSpec("P")
SceneFunction = Callable[..., Scene]


@dataclass(frozen=True, slots=True)
class Slider:
    """What a slider for an option spans: ``n: Annotated[int, Slider(1, 2000, log=True)] = 10``.

    It says where values are worth trying, not what is allowed.

    Parameters
    ----------
    low, high : float
    log : bool
        Equal ways on the slider are equal factors.

    Raises
    ------
    InputError
        If it spans nothing, or `log` asks for a factor from 0 or below.
    """

    low: float
    high: float
    log: bool = False

    def __post_init__(self) -> None:
        number("low of the Slider", self.low)
        number("high of the Slider", self.high)
        if not self.low < self.high or (self.log and self.low <= 0):
            limit = "; with log it must start above 0" if self.log else ""
            msg = f"a Slider cannot go from {self.low:g} to {self.high:g}{limit}"
            raise InputError(msg)


@dataclass(frozen=True, slots=True)
class Option:
    """One option of a scene, from its function's signature and docstring.

    Attributes
    ----------
    name : str
        As in Python, with underscores.
    type : type
        int, float, bool or str.
    default : object
    help : str
        One line.
    low, high : float or None
        What a slider for it spans; None where it has none.
    log : bool
        The slider is logarithmic.
    """

    name: str
    type: type[Any]
    default: Any
    help: str
    low: float | None = None
    high: float | None = None
    log: bool = False

    def checked(self, value: Any) -> Any:
        """`value` in this option's type; a whole number may come as 1e6.

        Raises
        ------
        InputError
            If it is of another type.
        """
        if self.type in (int, float):
            x = number(self.name, value)
            if self.type is float:
                return x
            if x.is_integer():
                # Not int(x): a whole number beyond 2**53 must stay as it is.
                return int(value)
        elif isinstance(value, self.type) or (self.type is bool and isinstance(value, np.bool_)):
            return self.type(value)
        names = {int: "a whole number", bool: "true or false", str: "text"}
        msg = f"{self.name} must be {names[self.type]}, not {value!r}"
        raise InputError(msg)

    def parse(self, text: str) -> Any:
        """`text`, as typed on a command line, in this option's type.

        Raises
        ------
        InputError
            If it does not read as one.

        Examples
        --------
        >>> Option("n", int, 10, "Number of spheres.").parse("1e6")
        1000000
        """
        if self.type is str:
            return text
        if self.type is bool:
            if text.lower() in ("true", "yes", "1", "false", "no", "0"):
                return text.lower() in ("true", "yes", "1")
            return self.checked(text)
        try:
            return self.checked(int(text))
        except ValueError:
            try:
                value = float(text)
            except ValueError:
                what = "a whole number" if self.type is int else "a number"
                msg = f"{self.name} must be {what}, not {text!r}"
                raise InputError(msg) from None
            return self.checked(value)


@dataclass(frozen=True, slots=True)
class _Entry:
    line: str
    options: tuple[Option, ...]
    make: SceneFunction


_SCENES: dict[str, _Entry] = {}


def scene(function: Callable[P, Scene]) -> Callable[P, Scene]:
    """Register a function that returns a `Scene`, under its name with dashes.

    Its parameters are the scene's options: they need a type (int, float, bool or str) and a
    default, and may have a `Slider` annotated to the type; their help comes from the
    docstring's numpydoc section *Parameters*. The docstring's first line describes the scene
    in lists. Values are checked before the function sees them.

    Raises
    ------
    InputError
        If a parameter has no such type or no default.

    Notes
    -----
    ``docs/scenes.md`` has an example that runs.
    """
    doc = inspect.getdoc(function) or ""
    helps = dict(re.findall(r"^(\w+) : .*\n((?:    .*\n?)+)", doc, re.MULTILINE))
    signature = inspect.signature(function, eval_str=True)
    name = function.__name__.replace("_", "-")
    options = tuple(_option(p, helps.get(p.name, "")) for p in signature.parameters.values())

    @functools.wraps(function)
    def make(*args: P.args, **kwargs: P.kwargs) -> Scene:
        bound = signature.bind(*args, **kwargs)
        given = {o.name: o for o in options}
        for key, value in bound.arguments.items():
            bound.arguments[key] = given[key].checked(value)
        bound.apply_defaults()
        made = function(*bound.args, **bound.kwargs)
        return replace(made, origin=Origin(name, dict(bound.arguments), made))

    _SCENES[name] = _Entry(doc.split("\n")[0].rstrip("."), options, make)
    return make


def _option(parameter: inspect.Parameter, text: str) -> Option:
    """Check one parameter of a scene function."""
    annotated = get_origin(parameter.annotation) is Annotated
    kind, *notes = get_args(parameter.annotation) if annotated else (parameter.annotation,)
    if kind not in (int, float, bool, str) or parameter.default is parameter.empty:
        msg = (
            f"option {parameter.name!r} of a scene needs a type (int, float, bool or str) "
            "and a default value"
        )
        raise InputError(msg)
    option = Option(parameter.name, kind, parameter.default, " ".join(text.split()))
    for slider in (note for note in notes if isinstance(note, Slider)):
        if kind not in (int, float):
            msg = f"option {parameter.name!r} of a scene is no number, so it has no Slider"
            raise InputError(msg)
        ends = {"low": option.checked(slider.low), "high": option.checked(slider.high)}
        option = replace(option, **ends, log=slider.log)
    return option


def names() -> list[str]:
    """All scenes, as the command line calls them."""
    return sorted(_SCENES)


def _entry(name: str) -> _Entry:
    if name not in _SCENES:
        msg = f"there is no scene {name!r}{nearest(name, names())}"
        raise UnknownNameError(msg)
    return _SCENES[name]


def find(name: str) -> SceneFunction:
    """The function behind a scene's name.

    Raises
    ------
    UnknownNameError
        If there is none; suggests the nearest.
    """
    return _entry(name).make


def describe(name: str) -> str:
    """One line about a scene; `UnknownNameError` if there is none of this name."""
    return _entry(name).line


def options(name: str) -> tuple[Option, ...]:
    """The options of a scene; `UnknownNameError` if there is none of this name."""
    return _entry(name).options


def build(name: str, values: Mapping[str, Any] | None = None) -> Scene:
    """Make a scene by name, with options by name (dashes or underscores).

    Raises
    ------
    UnknownNameError
        If the scene or an option does not exist; suggests the nearest.
    InputError
        If a value cannot be used.

    Examples
    --------
    >>> from carom import scenes
    >>> len(scenes.build("fluid", {"n": 1e3, "packing-fraction": 0.2}).spheres)
    1000
    """
    known = [o.name for o in options(name)]
    given: dict[str, Any] = {}
    for key, value in (values or {}).items():
        plain = key.replace("-", "_")
        if plain not in known:
            msg = f"the scene {name!r} has no option {key!r}{nearest(key, known)}"
            raise UnknownNameError(msg)
        given[plain] = value
    return find(name)(**given)
