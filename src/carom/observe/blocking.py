"""Standard errors of correlated numbers, and whether a series has settled."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from carom.errors import InputError
from carom.observe.estimate import Estimate
from carom.state import Floats

FEWEST_BLOCKS = 8  #: of fewer the spread itself is unknown by a quarter and more
ROUNDING = 1e-12  #: less, relative to the numbers themselves, is no change
CANDIDATES = 64  #: places at which a series is tried to be cut
COARSE = 512  #: means to which a series is shortened before it is tried


def blocking(values: ArrayLike) -> Estimate:
    """Mean of a series, with the standard error that its correlations leave.

    Neighbours are averaged in pairs, again and again, until what is left is independent. The
    spread of blocks of B values then gives the error. The smallest B for which ::

        B^3 > 2 n (s_B/s_0)^4

    (n values; s_B the error that blocks of B give) balances noise and bias of s_B; blocks of
    twice that size are taken, as an error too small does more harm. It is raised by Student's
    1 + 1/(2 nu) for the few blocks, so that one error covers 68 %. If fewer than 8 blocks are
    left, which is so below about a hundred independent values, the error is nan.

    Parameters
    ----------
    values : (n,) array_like
        In the order of time, at equal distances.

    Returns
    -------
    Estimate

    Raises
    ------
    InputError
        If `values` is not one row of finite numbers.

    References
    ----------
    H. Flyvbjerg, H. G. Petersen, J. Chem. Phys. 91, 461 (1989), doi:10.1063/1.457480; the
    choice of B: R. M. Lee et al., Phys. Rev. E 83, 066706 (2011),
    doi:10.1103/PhysRevE.83.066706, after U. Wolff, Comput. Phys. Commun. 156, 143 (2004).

    Examples
    --------
    >>> blocking([2.5] * 64)
    Estimate(2.5, 64 independent)
    """
    x = _row(values)
    n = len(x)
    if n == 0:
        return Estimate(math.nan, math.nan, math.nan)
    value = float(x.mean())
    if n < FEWEST_BLOCKS:
        return Estimate(value, math.nan, math.nan)
    spread = float(x.var(ddof=1))
    if spread <= (1e-14 * value) ** 2:  # all the same, but for rounding
        return Estimate(value, 0.0, float(n))
    first = spread / n
    block, reached = 1, False
    while len(x) >= FEWEST_BLOCKS:
        variance = float(x.var(ddof=1)) / len(x)
        if reached:
            student = 1 + 1 / (2 * (len(x) - 1))
            return Estimate(value, math.sqrt(variance) * student, min(float(n), spread / variance))
        reached = block**3 > 2 * n * (variance / first) ** 2
        half = len(x) // 2
        x = x[: 2 * half].reshape(half, 2).mean(axis=1)
        block *= 2
    return Estimate(value, math.nan, math.nan)


def ratio(sums: Floats, weights: Floats) -> Estimate:
    """Sum of `sums` over sum of `weights`, with its error by blocking.

    To first order the ratio errs as the mean of (sums - ratio weights) over the mean weight.

    Parameters
    ----------
    sums, weights : (n,) float64
        Of consecutive blocks, such as impulses and durations.
    """
    total = float(weights.sum())
    if len(sums) == 0 or total == 0:
        return Estimate(math.nan, math.nan, math.nan)
    value = float(sums.sum()) / total
    about = blocking((sums - value * weights) * (len(weights) / total))
    return Estimate(value, about.error, about.n_independent)


@dataclass(frozen=True)
class Settling:
    """How the beginning of a series compares with the rest.

    Attributes
    ----------
    fraction : float
        Share of the series after which the rest holds the most independent samples.
    shift : float
        Mean of that share minus mean of the rest, in standard errors of both.
    """

    fraction: float
    shift: float

    @property
    def settled(self) -> bool:
        """Whether nothing speaks against the beginning: it differs by less than 4 errors."""
        return self.fraction == 0 or not abs(self.shift) >= 4

    @property
    def note(self) -> str:
        """A sentence if it has not settled, or nothing."""
        if self.settled:
            return ""
        return (
            f"not settled: the first {100 * self.fraction:.0f} % differ from the rest by "
            f"{abs(self.shift):.1f} standard errors, and nothing was cut; run on before measuring"
        )


def settling(values: ArrayLike) -> Settling:
    """Find how much of the beginning of a series looks out of equilibrium.

    For each cut t0 the rest of n values holds n/g independent ones, g = 1 + 2 sum of the
    autocorrelation up to its first negative value. The cut that leaves the most is reported; it
    is for the reader to act on. At most half is tried, on means of the series.

    Parameters
    ----------
    values : (n,) array_like

    Returns
    -------
    Settling

    Raises
    ------
    InputError
        If `values` is not one row of finite numbers.

    References
    ----------
    J. D. Chodera, J. Chem. Theory Comput. 12, 1799 (2016), doi:10.1021/acs.jctc.5b00784.
    """
    x = _row(values)
    if len(x) > COARSE:
        size = len(x) // COARSE
        x = x[: len(x) // size * size].reshape(-1, size).mean(axis=1)
    n = len(x)
    if n < 4 * FEWEST_BLOCKS or np.ptp(x) <= ROUNDING * np.abs(x).max():
        return Settling(0.0, 0.0)
    cuts = np.unique(np.linspace(0, n // 2, CANDIDATES).astype(int))
    left = [(n - cut) / _inefficiency(x[cut:]) for cut in cuts]
    cut = int(cuts[int(np.argmax(left))])
    if cut == 0:
        return Settling(0.0, 0.0)
    before, after = x[:cut], x[cut:]
    variance = after.var() * _inefficiency(after)
    if variance == 0:
        shift = math.copysign(math.inf, before.mean() - after.mean())
    else:
        error = math.sqrt(variance / len(after) + variance / len(before))
        shift = float(before.mean() - after.mean()) / error
    return Settling(cut / n, shift)


def _row(values: ArrayLike) -> Floats:
    """One row of finite numbers."""
    try:
        x = np.asarray(values, np.float64)
    except (TypeError, ValueError):
        msg = f"values must be one row of finite numbers, not {values!r:.60}"
        raise InputError(msg) from None
    if x.ndim != 1:
        msg = f"values must be one row of finite numbers, not an array of shape {x.shape}"
        raise InputError(msg)
    if not np.isfinite(x).all():
        place = int(np.argmin(np.isfinite(x)))
        msg = f"values must be one row of finite numbers, and number {place} is {x[place]}"
        raise InputError(msg)
    return x


def _inefficiency(x: Floats) -> float:
    """1 + 2 sum of autocorrelations until they are lost in noise."""
    y = x - x.mean()
    power = float(y @ y)
    if power == 0:
        return 1.0
    size = 1 << (2 * len(y) - 1).bit_length()
    transform = np.fft.rfft(y, size)
    rho = np.fft.irfft(transform * transform.conj(), size)[: len(y)] / power
    negative = np.flatnonzero(rho <= 0)
    end = int(negative[0]) if len(negative) else len(y)
    return max(1.0, 1 + 2 * float(rho[1:end].sum()))
