"""Random numbers with the same bits on every machine.

NumPy promises the raw bits of PCG64 but not its transforms, and a processor's log or cos may
differ in the last bit from another's. So everything here comes from raw bits through
``+ - * /``, square roots and comparisons alone, which IEEE 754 fixes to the bit.
"""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.errors import InputError
from carom.state import Floats

LN2 = 0.6931471805599453  # ln 2, correctly rounded
SQRT_HALF = 0.7071067811865476
#: Terms of the atanh series: |s| <= 0.1716 makes the first one left out 2e-18 of the sum.
TERMS = 11


def log(x: Floats) -> Floats:
    """Natural logarithm, the same bits everywhere, to about 1e-15.

    With x = m 2^e, 1/sqrt(2) <= m < sqrt(2) and s = (m - 1)/(m + 1),
    ln x = e ln 2 + 2 (s + s^3/3 + s^5/5 + ...): the series of 2 atanh(s).

    Parameters
    ----------
    x : float64 array
        Positive and normal.

    Returns
    -------
    float64 array
    """
    mantissa, exponent = np.frexp(x)  # exact
    small = mantissa < SQRT_HALF
    mantissa = np.where(small, 2 * mantissa, mantissa)
    s = (mantissa - 1) / (mantissa + 1)
    square = s * s
    series = np.full_like(s, 1 / (2 * TERMS + 1))
    for k in range(TERMS - 1, -1, -1):
        series = series * square + 1 / (2 * k + 1)
    return np.asarray((exponent - small) * LN2 + 2 * s * series)


def total(values: Floats) -> Floats:
    """Sum over the first axis in a fixed order (pairwise: each half is halved again).

    Parameters
    ----------
    values : (N, ...) float64

    Returns
    -------
    (...) float64
    """
    while len(values) > 1:
        half = (len(values) + 1) // 2
        folded = values[:half].copy()
        folded[: len(values) - half] += values[half:]
        values = folded
    return np.asarray(values[0]) if len(values) else np.zeros(values.shape[1:])


class Random:
    """A stream of random numbers that depends on its seed and on nothing else.

    Parameters
    ----------
    seed : int
        Zero or a positive whole number.

    Raises
    ------
    InputError
        If the seed is negative or no whole number.

    References
    ----------
    PCG64: M. E. O'Neill, Harvey Mudd College HMC-CS-2014-0905 (2014), section 6.

    Examples
    --------
    >>> Random(1).uniform(2)
    array([0.51182162, 0.9504637 ])
    """

    def __init__(self, seed: int) -> None:
        if isinstance(seed, bool) or not isinstance(seed, (int, np.integer)) or seed < 0:
            msg = f"seed is {seed!r}; it must be a whole number, zero or more"
            raise InputError(msg)
        self._bits = np.random.PCG64(int(seed))

    def raw(self, n: int) -> NDArray[np.uint64]:
        """`n` times 64 random bits."""
        return np.asarray(self._bits.random_raw(n), np.uint64).reshape(n)

    def uniform(self, *shape: int, low: Any = 0.0, high: Any = 1.0) -> Floats:
        """Draw evenly between low and high: the top 53 bits of 64 as a fraction below 1.

        Parameters
        ----------
        *shape : int
        low, high : float or array
            Limits, one for all or one each.

        Returns
        -------
        shape float64
        """
        fraction = (self.raw(math.prod(shape)) >> np.uint64(11)) * 2.0**-53
        return np.asarray(low + (np.asarray(high) - low) * fraction.reshape(shape))

    def normal(self, *shape: int) -> Floats:
        """Draw from the normal distribution of mean 0 and variance 1.

        Points (u, v) in the unit square that fall in the unit circle, s = u^2 + v^2, give
        two independent values u, v times sqrt(-2 ln s / s).

        Returns
        -------
        shape float64

        References
        ----------
        G. Marsaglia, T. A. Bray, SIAM Review 6, 260 (1964), doi:10.1137/1006063.
        """
        n = math.prod(shape)
        parts, found = [np.empty((0, 2))], 0
        while 2 * found < n:
            # pi/4 of the points fall in the circle; a few more than needed on average.
            pairs = self.uniform(int((n / 2 - found) * 1.28) + 16, 2, low=-1.0)
            s = pairs[:, 0] * pairs[:, 0] + pairs[:, 1] * pairs[:, 1]
            inside = (s < 1) & (s > 0)
            pairs, s = pairs[inside], s[inside]
            parts.append(pairs * np.sqrt(-2 * log(s) / s)[:, np.newaxis])
            found += len(s)
        return np.concatenate(parts).reshape(-1)[:n].reshape(shape)

    def direction(self, n: int) -> Floats:
        """Draw `n` unit vectors, every direction as likely as any other.

        Returns
        -------
        (n, 3) float64
        """
        v = self.normal(n, 3)
        length = np.sqrt(v[:, 0] * v[:, 0] + v[:, 1] * v[:, 1] + v[:, 2] * v[:, 2])
        return np.asarray(v / length[:, np.newaxis])

    def choice(self, n: int, k: int) -> NDArray[np.intp]:
        """Choose `k` of `n` numbers 0 ... n - 1, each subset as likely; in rising order."""
        return np.sort(np.argsort(self.raw(n), kind="stable")[:k])
