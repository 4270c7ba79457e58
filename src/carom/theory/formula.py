"""What every formula of this package has: a range it holds in, and a source.

A range is written down once, in the line above the function. The function refuses numbers outside
it, and `about` shows it, so the two cannot disagree.
"""

import functools
import inspect
import math
from collections.abc import Callable
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, ParamSpec, TypeVar

import numpy as np

from carom.checks import LARGEST, nearest
from carom.errors import InputError, UnknownNameError
from carom.state import Floats

#: A number, or numbers in an array or list. What comes out has the shape that goes in: a float
#: for floats, otherwise a float64 array. (Typed like NumPy's own functions of both.)
Numbers = Any

#: Packing fraction at which a fluid of equal hard spheres begins to freeze: W. G. Hoover,
#: F. H. Ree, J. Chem. Phys. 49, 3609 (1968), doi:10.1063/1.1670641. Formulas of the fluid end here.
FREEZING = 0.494

P = ParamSpec("P")
R = TypeVar("R")


@dataclass(frozen=True)
class Range:
    """The numbers for which a formula holds.

    Attributes
    ----------
    low, high : float
        Both belong to the range, where `open_low` and `open_high` do not say otherwise.
    open_low, open_high : bool
    below, above : str
        Why it ends there, as a part of a sentence.
    far : (float, float) or None
        How far `extrapolate=True` may go; None: nowhere.
    """

    low: float = -math.inf
    high: float = math.inf
    open_low: bool = False
    open_high: bool = False
    below: str = ""
    above: str = ""
    far: tuple[float, float] | None = None

    def __str__(self) -> str:
        if self.high == math.inf:
            if self.low == -math.inf:
                return "any number"
            return f"above {self.low:g}" if self.open_low else f"at least {self.low:g}"
        low = f"{self.low:g}{' (excluded)' if self.open_low else ''}"
        return f"{low} to {self.high:g}{' (excluded)' if self.open_high else ''}"

    def check(self, name: str, value: Any, extrapolate: bool = False) -> Floats:
        """`value` as float64, refused where one of its numbers is outside.

        Raises
        ------
        InputError
            Naming the first such number, the limit, and what to do.
        """
        x = _floats(name, value)
        far = self.far if extrapolate else None
        low, high = far or (self.low, self.high)
        inside = (x > low if self.open_low else x >= low) & (
            x < high if self.open_high else x <= high
        )
        if not inside.all():
            where, which = _first(name, x, ~inside)
            reason = self.below if which <= low else self.above
            remedy = f"it must be {Range(low, high, self.open_low, self.open_high)}"
            if self.far and not extrapolate and self.far[0] <= which <= self.far[1]:
                remedy += f", or with extrapolate=True {self.far[0]:g} to {self.far[1]:g}"
            short = f"{which:.6g}"
            shown = f"{which:.17g}" if low <= float(short) <= high else short
            msg = "; ".join(filter(None, [f"{where} is {shown}", reason, remedy]))
            raise InputError(msg)
        return x


POSITIVE = Range(0, open_low=True)
NOT_NEGATIVE = Range(0)
ANY = Range()
#: Of a fluid of hard spheres.
FREEZES = f"above {FREEZING} hard spheres freeze and this formula of the fluid ends"
FLUID = Range(0, FREEZING, above=FREEZES)


@dataclass(frozen=True)
class Formula:
    """What is known about one formula.

    Attributes
    ----------
    name : str
    summary : str
        What it is, in one sentence.
    ranges : mapping of str to Range
        Where it holds, by argument, or by what follows from the arguments.
    source : str
        Where it comes from.
    """

    name: str
    summary: str
    ranges: MappingProxyType[str, Range]
    source: str


_FORMULAS: dict[str, Formula] = {}


def formula(source: str, **ranges: Range) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Make a function of numbers one of arrays, refused outside its ranges, known to `about`.

    An argument named in `ranges` reaches the function as a float64 array within its range, and
    all of them fit together. A range of anything else is only shown: the function itself must
    `Range.check` it. A function with an argument `extrapolate` hands it to its ranges. Results
    without dimensions become floats.
    """

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        signature = inspect.signature(function)
        own = [name for name in ranges if name in signature.parameters]
        summary = (function.__doc__ or "").partition("\n")[0]
        _FORMULAS[function.__name__] = Formula(
            function.__name__, summary, MappingProxyType(ranges), source
        )

        @functools.wraps(function)
        def checked(*args: P.args, **kwargs: P.kwargs) -> R:
            given = signature.bind(*args, **kwargs)
            given.apply_defaults()
            values = given.arguments
            extrapolate = bool(values.get("extrapolate", False))
            for name in own:
                values[name] = ranges[name].check(name, values[name], extrapolate)
            _fit_together({name: values[name].shape for name in own})
            result: R = _plain(function(*given.args, **given.kwargs))
            return result

        return checked

    return decorate


def about(which: str | Callable[..., Any]) -> Formula:
    """Range and source of a formula.

    Parameters
    ----------
    which : str or function
        A formula of `carom.theory`, or its name.

    Raises
    ------
    UnknownNameError
        If there is no such formula.

    Examples
    --------
    >>> about("carnahan_starling").source
    'N. F. Carnahan, K. E. Starling, J. Chem. Phys. 51, 635 (1969), doi:10.1063/1.1672048'
    >>> print(about("carnahan_starling").ranges["packing_fraction"])
    0 to 0.494
    """
    name = which if isinstance(which, str) else getattr(which, "__name__", repr(which))
    if name not in _FORMULAS:
        msg = f"there is no formula {name!r} in carom.theory{nearest(name, _FORMULAS)}"
        raise UnknownNameError(msg)
    return _FORMULAS[name]


def formulas() -> list[str]:
    """Names of all formulas, in alphabetical order."""
    return sorted(_FORMULAS)


def _floats(name: str, value: Any) -> Floats:
    try:
        given = np.asarray(value)
        if given.dtype.kind not in "iuf":
            raise TypeError
        x = np.asarray(given, np.float64)
    except (TypeError, ValueError, OverflowError) as error:
        msg = f"{name} must be a number or an array of numbers, not {value!r}"
        raise InputError(msg) from error
    bad = ~(np.abs(x) <= LARGEST)
    if bad.any():
        where, which = _first(name, x, bad)
        if math.isfinite(which):
            trouble = f"beyond {LARGEST:g} the arithmetic overflows: choose other units"
        else:
            trouble = "give a finite number"
        msg = f"{where} is {which:g}; {trouble}"
        raise InputError(msg)
    return x


def _first(name: str, x: Floats, bad: Any) -> tuple[str, float]:
    """Name with index, and value, of the first number that is bad."""
    if x.ndim == 0:
        return name, float(x)
    index = tuple(int(k) for k in np.argwhere(bad)[0])
    return f"{name}[{', '.join(map(str, index))}]", float(x[index])


def _fit_together(shapes: dict[str, tuple[int, ...]]) -> None:
    try:
        np.broadcast_shapes(*shapes.values())
    except ValueError as error:
        arrays = ", ".join(f"{name} {shape}" for name, shape in shapes.items() if shape)
        msg = f"these arrays do not fit together: {arrays}; give them one shape, or single numbers"
        raise InputError(msg) from error


def _plain(result: Any) -> Any:
    if isinstance(result, tuple):
        return tuple(_plain(part) for part in result)
    return float(result) if np.ndim(result) == 0 else result
