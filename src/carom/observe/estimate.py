"""`Estimate`: a number with its standard error."""

import math
from dataclasses import dataclass

from carom.markup import html_table


@dataclass(frozen=True, repr=False)
class Estimate:
    """A measured number.

    Attributes
    ----------
    value : float
    error : float
        Standard error of the value; nan where there were too few samples to know it.
    n_independent : float
        To how many independent samples the correlated ones amount; nan where `error` is.
    note : str
        What one should know before using it, such as that the run had not settled.

    Examples
    --------
    >>> z = Estimate(9.3847, 0.0043, 1200)
    >>> z, str(z), f"{z:.5f}"
    (Estimate(9.385(4), 1200 independent), '9.385(4)', '9.38470 ± 0.00430')
    >>> round(z.deviation(9.4), 2)
    -3.56
    """

    value: float
    error: float
    n_independent: float
    note: str = ""

    def deviation(self, reference: float, reference_error: float = 0.0) -> float:
        """(value - reference) in standard errors of both together.

        Parameters
        ----------
        reference, reference_error : float

        Returns
        -------
        float
            Nan if neither has an error to compare with.
        """
        both = math.hypot(self.error, reference_error)
        difference = self.value - reference
        if both == 0:
            return 0.0 if difference == 0 else math.copysign(math.inf, difference)
        return difference / both

    def __str__(self) -> str:
        """Write the value with its error in units of its last digits: 9.385(4), or 9.385(?)."""
        if not math.isfinite(self.value):
            return str(self.value)
        if not math.isfinite(self.error):
            return f"{self.value:.6g}(?)"
        if self.error == 0:
            return f"{self.value:.6g}"
        power = math.floor(math.log10(self.error))
        if float(f"{self.error:.0e}") < 2 * 10.0**power:  # a 1 alone would be half as good
            power -= 1
        digits = round(self.error / 10.0**power)
        size = max(abs(self.value), self.error)
        if power <= 0 and 1e-4 <= size < 1e6:
            return f"{_plain(self.value, -power)}({digits})"
        scale = math.floor(math.log10(size))
        return f"{_plain(self.value / 10.0**scale, max(0, scale - power))}({digits})e{scale:+03d}"

    def __repr__(self) -> str:
        many = "" if math.isnan(self.n_independent) else f", {self.n_independent:.0f} independent"
        note = f"; {self.note}" if self.note else ""
        return f"Estimate({self}{many}{note})"

    def _repr_html_(self) -> str:
        many = "" if math.isnan(self.n_independent) else f"{self.n_independent:.0f}"
        row = (str(self), "" if math.isnan(self.error) else f"{self.error:.3g}", many)
        heading = ("value", "standard error", "independent")
        return html_table("", [row], heading=heading, notes=[self.note] if self.note else [])

    def __format__(self, spec: str) -> str:
        """With a format of numbers, write value ± error; without one, as `str`."""
        if not spec:
            return str(self)
        return f"{self.value:{spec}} ± {self.error:{spec}}"


def _plain(value: float, decimals: int) -> str:
    """The number with so many decimals, and no minus in front of nothing but zeros."""
    return f"{round(value, decimals) + 0.0:.{decimals}f}"
