"""Numbers that a sketch hands over, checked where they come in."""

from typing import Any

from carom.errors import InputError


def number(where: str, value: Any) -> float:
    """Return a finite float.

    Parameters
    ----------
    where : str
        Function and argument, for the message: "translate(): x".
    value : number

    Raises
    ------
    InputError
        If it is no number, or not finite.
    """
    if type(value) is float and value - value == 0.0:
        return value  # the way of nearly all of them
    if callable(value):
        name = getattr(value, "__name__", "f")
        msg = f"{where} is the function {name}; write {name}() with brackets to have its number"
        raise InputError(msg)
    try:
        # float() would read "3" as well, where another string is likely to follow.
        found = None if isinstance(value, str | bytes) else float(value)
    except (TypeError, ValueError):
        found = None
    except OverflowError:
        found = float("inf")
    if found is None:
        msg = f"{where} is {value!r}; give a number"
        raise InputError(msg)
    if found - found != 0.0:  # infinite or not a number
        msg = f"{where} is {found}; give a finite number (was something divided by 0?)"
        raise InputError(msg)
    return found


def whole(where: str, value: Any, low: int, high: int) -> int:
    """Return a whole number from `low` to `high`.

    Raises
    ------
    InputError
        If it is none.
    """
    found = number(where, value)
    if found != int(found) or not low <= found <= high:
        msg = f"{where} is {value}; give a whole number from {low} to {high}"
        raise InputError(msg)
    return int(found)
