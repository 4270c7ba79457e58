"""Scenes as TOML files: `load`, `save`, `dump`. The keys mirror the names in Python."""

import re
import tomllib
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import tomli_w
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from carom import scenes
from carom.checks import nearest
from carom.errors import FileError, InputError, UnknownNameError, unwritable
from carom.rules import Smooth
from carom.scene import Camera, Scene, Spheres
from carom.walls import Box, Cylinder, Open, Periodic, Plane, Sphere, Wall

NUMBER = "a number"
TRIPLE = "three numbers [x, y, z]"


def _is(expected: str, *default: Any) -> Any:
    """A field that says what it expects; required if it has no default."""
    return Field(*default, description=expected)


class _Table(BaseModel):
    """A table of the file: wrong keys and types are refused, and only ints turn into floats."""

    model_config = ConfigDict(extra="forbid", strict=True)


class _Hard(_Table):
    restitution: float = _is(NUMBER, 1.0)
    reflection: str = _is("'specular' or 'bounce-back'", "specular")


class _Box(_Hard):
    kind: Literal["box"]
    lx: float = _is(NUMBER)
    ly: float = _is(NUMBER)
    lz: float = _is(NUMBER)


class _Periodic(_Table):
    kind: Literal["periodic"]
    lx: float | None = _is("a number, or nothing where the axis is not periodic", None)
    ly: float | None = _is("a number, or nothing where the axis is not periodic", None)
    lz: float | None = _is("a number, or nothing where the axis is not periodic", None)


class _Sphere(_Hard):
    kind: Literal["sphere"]
    radius: float = _is(NUMBER)


class _Cylinder(_Hard):
    kind: Literal["cylinder"]
    radius: float = _is(NUMBER)
    length: float = _is(NUMBER)


class _Plane(_Hard):
    kind: Literal["plane"]
    normal: list[Any] = _is(TRIPLE)
    offset: float = _is(NUMBER)


class _Open(_Table):
    kind: Literal["open"]


class _Spheres(_Table):
    # `Spheres.of` checks these: each may be one value, or a list with one for each sphere.
    position: Any = _is("three numbers [x, y, z], or a list of such triples")
    velocity: Any = 0.0
    radius: Any = 0.5
    mass: Any = 1.0
    color: Any = None
    species: Any = 0
    fixed: Any = False


class _Camera(_Table):
    position: list[Any] = _is(TRIPLE)
    target: list[Any] = _is(TRIPLE, [0.0, 0.0, 0.0])


class _Rule(_Table):
    restitution: float = _is(NUMBER, 1.0)
    contact_time: float | None = _is(NUMBER, None)


_AnyWall = Annotated[
    _Box | _Periodic | _Sphere | _Cylinder | _Plane | _Open, Field(discriminator="kind")
]


class _File(_Table):
    title: str = _is("text in quotes", "")
    gravity: list[Any] = _is(TRIPLE, [0.0, 0.0, 0.0])
    collide: bool = _is("true or false", True)
    seed: int | None = _is("a whole number", None)
    pace: float = _is(NUMBER, 1.0)
    color: str = _is("'energy', 'own', 'speed' or 'species'", "energy")
    wire: bool = _is("true or false", False)
    camera: _Camera | None = _is("a [camera] table", None)
    rule: _Rule = _is("a [rule] table", _Rule())
    walls: list[_AnyWall] = _is("[[walls]] tables", [])
    spheres: list[_Spheres] = _is("[[spheres]] tables")


class _Named(_Table):
    scene: str = _is("the name of a scene, see `carom scenes`")
    options: dict[str, Any] = _is("an [options] table", {})


#: The models whose keys a misspelt key is compared with, by the table it stands in.
_WALLS: dict[str, tuple[type[_Table], type[Wall]]] = {
    "box": (_Box, Box),
    "periodic": (_Periodic, Periodic),
    "sphere": (_Sphere, Sphere),
    "cylinder": (_Cylinder, Cylinder),
    "plane": (_Plane, Plane),
    "open": (_Open, Open),
}
_TABLES: dict[str, type[_Table]] = {"camera": _Camera, "rule": _Rule, "spheres": _Spheres}

#: An innermost list of three over five lines; text holds no line feeds, so only lists match.
_TRIPLE_LINES = re.compile(r"\[\s*\n" + r"\s+([^\[\]\n]+),\n" * 3 + r"\s*\]")


def load(path: str | Path) -> Scene:
    """Read a scene from a TOML file.

    Parameters
    ----------
    path : str or Path

    Raises
    ------
    FileError
        If the file cannot be read.
    InputError
        If it is not TOML, or a key, type or value is wrong: names file, key and what was
        expected.
    """
    try:
        text = Path(path).read_text(encoding="utf-8")
    except OSError as error:
        msg = f"cannot read {path}: {error.strerror or error}; check the name and its permissions"
        raise FileError(msg) from error
    except UnicodeDecodeError as error:
        msg = f"{path} is not a text file in UTF-8 (byte {error.start}); give a TOML scene file"
        raise InputError(msg) from error
    return parse(text, str(path))


def parse(text: str, name: str = "scene") -> Scene:
    """Make a scene from the text of a TOML file; `name` is what messages call it.

    Raises
    ------
    InputError
        As `load`.

    Examples
    --------
    >>> scene = parse('''
    ... gravity = [0, 0, -1]
    ... [[walls]]
    ... kind = "box"
    ... lx = 10
    ... ly = 10
    ... lz = 10
    ... [[spheres]]
    ... position = [0, 0, 0]
    ... ''')
    >>> scene.gravity, len(scene.spheres)
    ((0.0, 0.0, -1.0), 1)
    """
    try:
        data = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        reason = "it is nested too deeply" if isinstance(error, RecursionError) else error
        msg = f"{name} is not valid TOML: {reason}"
        raise InputError(msg) from error
    model: type[_Table] = _Named if "scene" in data else _File
    try:
        table = model.model_validate(data)
    except ValidationError as error:
        found = error.errors(include_url=False)
        # A misspelt key also makes the right one missing: speak of the cause.
        details = min(found, key=lambda d: d["type"] != "extra_forbidden")
        kind = UnknownNameError if details["type"] == "extra_forbidden" else InputError
        msg = f"{name}: {_sentence(details, model)}"
        raise kind(msg) from None
    try:
        if isinstance(table, _Named):
            return scenes.build(table.scene, table.options)
        assert isinstance(table, _File)
        return _scene(table)
    except InputError as error:
        msg = f"{name}: {error}"
        raise type(error)(msg) from error


def _sentence(error: Any, model: type[_Table]) -> str:
    """One sentence about the first thing pydantic found wrong."""
    keys: list[str | int] = list(error["loc"])
    top = str(keys[0])
    if top == "walls" and len(keys) > 2:
        model = _WALLS[str(keys.pop(2))][0]  # pydantic's path holds the kind, which is no key
    elif top in _TABLES and isinstance(keys[-1], str) and len(keys) > 1:
        model = _TABLES[top]
    field = model.model_fields.get(keys[-1] if isinstance(keys[-1], str) else top)
    path = _path(keys)
    if error["type"] == "extra_forbidden":
        where = _path(keys[:-1])
        inside = f" in {where}" if where else ""
        return f"there is no key {keys[-1]!r}{inside}{nearest(str(keys[-1]), model.model_fields)}"
    if error["type"].startswith("union_tag"):
        kinds = ", ".join(_WALLS)
        given = error["input"].get("kind") if isinstance(error["input"], dict) else None
        if given is None:
            return f"{path}.kind is missing; give one of {kinds}"
        return f"{path}.kind is {given!r}; expected one of {kinds}"
    expected = (field.description if field is not None else None) or "a table"
    if error["type"] == "missing":
        return f"{path} is missing; give {expected}"
    return f"{path} is {error['input']!r:.60}; expected {expected}"


def _path(keys: list[str | int]) -> str:
    """Keys as people write them: walls[0].lx."""
    parts = (f"[{key}]" if isinstance(key, int) else f".{key}" for key in keys)
    return "".join(parts).removeprefix(".")


def _scene(table: _File) -> Scene:
    parts: dict[str, Any] = {
        key: getattr(table, key)
        for key in ("title", "gravity", "collide", "seed", "pace", "color", "wire")
    }
    if table.camera is not None:
        parts["camera"] = _at("camera", Camera, table.camera)
    walls = tuple(
        _at(f"walls[{k}]", _WALLS[wall.kind][1], wall) for k, wall in enumerate(table.walls)
    )
    spheres = Spheres.of(np.zeros((0, 3)))
    for k, row in enumerate(table.spheres):
        spheres += _at(f"spheres[{k}]", Spheres.of, row)
    return Scene(spheres, walls=walls, rule=_at("rule", Smooth, table.rule), **parts)


def _at(path: str, make: Any, table: _Table) -> Any:
    """Make a part of the scene; what is wrong with it is said with its place in the file."""
    try:
        return make(**table.model_dump(exclude={"kind"}))
    except InputError as error:
        msg = f"{path}: {error}"
        raise type(error)(msg) from error


def dump(scene: Scene) -> str:
    """Write a scene as the text of a TOML file.

    Every number comes back to the same bits. What has its default value is left out.

    Examples
    --------
    >>> print(dump(Scene(Spheres.of((0, 0, 0)), title="One")), end="")
    title = "One"
    <BLANKLINE>
    [[spheres]]
    position = [
        [0.0, 0.0, 0.0],
    ]
    color = "#4c9be8"
    """
    data: dict[str, Any] = {}
    for f in fields(Scene):
        if f.name in ("title", "gravity", "collide", "seed", "pace", "color", "wire"):
            value = getattr(scene, f.name)
            if value != f.default:
                data[f.name] = value
    if scene.seed is not None:
        data["seed"] = int(scene.seed)
    if scene.camera is not None:
        data["camera"] = _changed(scene.camera)
    if scene.rule != Smooth():
        data["rule"] = _changed(scene.rule)
    if scene.walls != (Open(),):
        kinds = {wall: kind for kind, (_, wall) in _WALLS.items()}
        data["walls"] = [{"kind": kinds[type(w)], **_changed(w)} for w in scene.walls]
    data["spheres"] = [_spheres(scene.spheres)] if len(scene.spheres) else []
    # The writer gives each number a line of its own; three in a row are easier to read.
    return _TRIPLE_LINES.sub(r"[\1, \2, \3]", tomli_w.dumps(data))


def _changed(part: Any) -> dict[str, Any]:
    """The fields of a dataclass that differ from their defaults."""
    values = {f.name: (getattr(part, f.name), f.default) for f in fields(part)}
    return {
        name: value
        for name, (value, default) in values.items()
        if value is not None and (default is MISSING or value != default)
    }


def _spheres(spheres: Spheres) -> dict[str, Any]:
    """One [[spheres]] table; a value that all share is written once, a default not at all."""
    table: dict[str, Any] = {"position": spheres.position.tolist()}
    defaults = {"velocity": [0.0, 0.0, 0.0], "radius": 0.5, "mass": 1.0, "species": 0}
    for name, default in {**defaults, "fixed": False}.items():
        values = getattr(spheres, name)
        same = bool((values == values[0]).all()) and not np.signbit(values.astype(float)).any()
        shared = values[0].tolist() if same else values.tolist()
        if shared != default:
            table[name] = shared
    colors = [f"#{color:06x}" for color in spheres.color.tolist()]
    table["color"] = colors[0] if len(set(colors)) == 1 else colors
    return table


def save(scene: Scene, path: str | Path) -> None:
    """Write a scene to a TOML file.

    Raises
    ------
    FileError
        If the file cannot be written.
    """
    try:
        Path(path).write_text(dump(scene), encoding="utf-8")
    except OSError as error:
        raise unwritable(path, error) from error
