"""Numbers from outside, checked once: each refusal names the value, the limit, the remedy."""

import difflib
import math
import os
from collections.abc import Iterable
from typing import Any, SupportsFloat

import numpy as np

from carom.errors import InputError

Triple = tuple[float, float, float]

#: Beyond this the products of four numbers in the contact times leave the range of a float.
LARGEST = 1e60

#: What placing and running a sphere takes at its peak (788 measured at 10^6 spheres).
BYTES_PER_SPHERE = 800


def number(
    name: str,
    value: Any,
    *,
    above: float = -math.inf,
    at_least: float = -math.inf,
    at_most: float = math.inf,
) -> float:
    """`value` as a finite float within its limits.

    Parameters
    ----------
    name : str
        What the number is, as the message shall call it.
    value : object
        Anything that is a real number; truth values and text are not.
    above, at_least, at_most : float
        Limits: value > above, at_least <= value <= at_most.

    Raises
    ------
    InputError
        If it is no finite number or outside its limits.
    """
    if isinstance(value, (bool, np.bool_, str, bytes)) or not isinstance(value, SupportsFloat):
        msg = f"{name} must be a number, not {value!r}"
        raise InputError(msg)
    try:
        x = float(value)
    except (TypeError, ValueError, OverflowError) as error:
        msg = f"{name} must be a number that fits a float, not {value!r}"
        raise InputError(msg) from error
    if not math.isfinite(x):
        msg = f"{name} is {x}; give a finite number"
        raise InputError(msg)
    if abs(x) > LARGEST:
        msg = f"{name} is {x:g}; beyond {LARGEST:g} the arithmetic overflows: choose other units"
        raise InputError(msg)
    if not (x > above and at_least <= x <= at_most):
        msg = f"{name} is {x:.15g}; it must be {_limits(above, at_least, at_most)}"
        raise InputError(msg)
    return x


def count(name: str, value: Any, *, at_least: int = 1) -> int:
    """`value` as a number of spheres that this machine has the memory for.

    Raises
    ------
    InputError
        If it is no number, too small, or too large for the memory or the engine's 32-bit indices.
    """
    n = int(number(name, value, at_least=at_least))
    most = 2**31 - 2
    try:
        memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
        most = min(most, memory // BYTES_PER_SPHERE)
    except (AttributeError, OSError, ValueError):
        pass  # a system that does not tell: only the indices limit
    if n > most:
        msg = (
            f"{name} is {n:,}, but this machine has room for about {most:,} spheres "
            f"({BYTES_PER_SPHERE} bytes each); ask for fewer"
        )
        raise InputError(msg)
    return n


def _limits(above: float, at_least: float, at_most: float) -> str:
    parts = []
    if math.isfinite(above):
        parts.append(f"more than {above:g}")
    if math.isfinite(at_least):
        parts.append(f"at least {at_least:g}")
    if math.isfinite(at_most):
        parts.append(f"at most {at_most:g}")
    return " and ".join(parts)


def triple(name: str, value: Any) -> Triple:
    """`value` as three finite floats (x, y, z).

    Raises
    ------
    InputError
        If it has not three components or one is not a finite number.
    """
    try:
        parts = list(value)
    except TypeError:
        parts = []
    if isinstance(value, (str, bytes)) or len(parts) != 3:
        msg = f"{name} must be three numbers (x, y, z), not {value!r}"
        raise InputError(msg)
    x, y, z = (number(f"{name}[{k}]", part) for k, part in enumerate(parts))
    return x, y, z


def nearest(name: str, known: Iterable[str]) -> str:
    """``"; did you mean 'x'?"`` for the known name nearest to `name`, or all of them if none is.

    Cost: one comparison per known name.
    """
    names = list(known)
    # Dashes and underscores, capitals and small letters are what people mix up most.
    plain = {n.lower().replace("_", "-"): n for n in names}
    close = difflib.get_close_matches(name.lower().replace("_", "-"), plain, 1, 0.6)
    if close:
        return f"; did you mean {plain[close[0]]!r}?"
    return f"; there are {', '.join(names)}" if names else "; there are none"
