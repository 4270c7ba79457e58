"""Values as Python text that gives the same bits when it is run."""

import textwrap
from collections.abc import Iterable
from dataclasses import MISSING, fields
from typing import Any

import numpy as np

from carom.color import SPECIES
from carom.scene import Spheres

WIDTH = 88  #: columns; a row of numbers may be longer


def literal(value: Any) -> str:
    """A number, text, None, a tuple of them, or a description such as ``carom.Box(5, 5, 5)``.

    Examples
    --------
    >>> from carom.walls import Plane
    >>> literal(Plane((0, 0, 1), -0.1, restitution=0.5))
    'carom.Plane((0, 0, 1), -0.1, restitution=0.5)'
    """
    if isinstance(value, tuple):
        return f"({', '.join(map(literal, value))})"
    if isinstance(value, (float, np.floating)):
        # repr gives the same bits back; so does a whole number, but for the sign of a zero.
        text = repr(float(value))
        return text if text == "-0.0" else text.removesuffix(".0")
    if isinstance(value, str) and repr(value) == f"'{value}'" and '"' not in value:
        return f'"{value}"'
    if value is None or isinstance(value, (str, bool, int, np.generic)):
        return repr(value.item() if isinstance(value, np.generic) else value)
    given = [literal(getattr(value, f.name)) for f in fields(value) if f.default is MISSING]
    given += [f"{name}={literal(each)}" for name, each in changed(value).items()]
    return f"carom.{type(value).__name__}({', '.join(given)})"


def changed(description: Any) -> dict[str, Any]:
    """The fields of a dataclass that have a default and differ from it."""
    values = {f.name: (getattr(description, f.name), f.default) for f in fields(description)}
    return {k: v for k, (v, d) in values.items() if d is not MISSING and v != d}


def call(name: str, arguments: Iterable[str]) -> str:
    """Write a call, over several lines if it is long."""
    listed = list(arguments)
    line = f"{name}({', '.join(listed)})"
    if len(line) <= WIDTH and "\n" not in line:
        return line
    return f"{name}(\n{textwrap.indent(''.join(f'{a},' + chr(10) for a in listed), '    ')})"


def one_sphere(spheres: Spheres, index: int) -> list[str]:
    """Arguments of `Simulation.add` for one sphere."""
    row = slice(index, index + 1)
    return [f"position={literal(tuple(spheres.position[index]))}", *_others(spheres, row)]


def many_spheres(spheres: Spheres) -> list[str]:
    """Arguments of `Simulation.add_many` or `Spheres.of` for all."""
    if len(spheres) == 1:
        return [literal(tuple(spheres.position[0])), *_others(spheres, slice(None))]
    return [_rows(spheres.position), *_others(spheres, slice(None))]


def _others(spheres: Spheres, rows: slice) -> list[str]:
    """All but the places: one value where all share it, nothing where it is the default."""
    fixed, species, color = spheres.fixed[rows], spheres.species[rows], spheres.color[rows]
    arguments: list[str] = []
    columns: dict[str, tuple[Any, Any]] = {
        "velocity": (spheres.velocity[rows], (0.0, 0.0, 0.0)),
        "radius": (spheres.radius[rows], 0.5),
        "mass": (np.where(fixed, 1.0, spheres.mass[rows]), 1.0),  # of a fixed one: not used
        "species": (species, 0),
        "fixed": (fixed, False),
    }
    for name, (values, default) in columns.items():
        # A zero with a sign is equal to one without, but has other bits.
        shared = len({v.tobytes() for v in values}) == 1
        if not shared:
            text = _rows(values) if values.ndim == 2 else _row(map(literal, values))
        elif values[0].tobytes() == np.asarray(default, values.dtype).tobytes():
            continue
        else:
            text = literal(tuple(values[0]) if values.ndim == 2 else values[0])
        arguments.append(f"{name}={text}")
    if (color != SPECIES[species % len(SPECIES)]).any():
        names = [f'"#{c:06x}"' for c in color.tolist()]
        arguments.append(f"color={names[0] if len(set(names)) == 1 else _row(names)}")
    return arguments


def _rows(values: Any) -> str:
    lines = "".join(f"    {literal(tuple(row))},\n" for row in values)
    return f"[\n{lines}]"


def _row(texts: Iterable[str]) -> str:
    joined = ", ".join(texts)
    if len(joined) <= WIDTH - 20:
        return f"[{joined}]"
    return f"[\n{textwrap.indent(textwrap.fill(joined, WIDTH - 8), '    ')},\n]"
