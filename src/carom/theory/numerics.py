"""The error function, Gauss's quadrature and a root finder: all the numerics there is here."""

import math
from collections.abc import Callable

import numpy as np

from carom.state import Floats

#: math.erf, number by number: NumPy has none, and this is exact to the last bit but one.
_erf = np.frompyfunc(math.erf, 1, 1)


def erf(x: Floats) -> Floats:
    """Error function of each number."""
    return np.asarray(_erf(x), np.float64)


def gauss(nodes: int, high: float) -> tuple[Floats, Floats]:
    """Nodes and weights of Gauss and Legendre's quadrature from 0 to `high`."""
    x, weight = np.polynomial.legendre.leggauss(nodes)
    return high / 2 * (x + 1), high / 2 * weight


def root(rising: Callable[[float], float], high: float, low: float = 0.0) -> float:
    """Where a function that rises from below 0 at `low` to above it at `high` is 0; by halving."""
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if rising(middle) < 0 else (low, middle)
    return high
