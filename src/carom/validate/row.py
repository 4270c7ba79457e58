"""`Row`: a measured number beside its reference, and whether they agree."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

from carom.observe import Estimate
from carom.state import Floats

#: Standard errors that a number may be off: of a hundred rows, one report in 150 by chance.
SIGMAS = 4.0

Numbers = Sequence[float] | Floats

STATISTICAL, EXACT, REJECTED = "statistical", "exact", "rejected"


@dataclass(frozen=True)
class Row:
    """One line of the report.

    Attributes
    ----------
    name : str
        Unique among all rows.
    quantity, state : str
        What was measured, and of what.
    n, collisions : int
        Spheres, and collisions (walls included) that it was measured from.
    measured, reference : float
    error, reference_error : float
        Standard errors; 0 where a number is exact.
    source : str
        Where the reference comes from.
    kind : str
        ``statistical``: within `SIGMAS` standard errors of both together; ``exact``: within
        `tolerance`; ``rejected``: a law that must not hold, so more than `SIGMAS` away.
    tolerance : float
    note : str
        What limits the reference.
    """

    name: str
    quantity: str
    state: str
    n: int
    collisions: int
    measured: float
    error: float
    reference: float
    reference_error: float
    source: str
    kind: str = STATISTICAL
    tolerance: float = math.nan
    note: str = ""

    @property
    def deviation(self) -> float:
        """Distance from the reference, in standard errors of both; in tolerances if exact."""
        difference = self.measured - self.reference
        unit = self.tolerance
        if self.kind != EXACT:
            unit = math.hypot(self.error, self.reference_error)
        if unit == 0:
            return 0.0 if difference == 0 else math.copysign(math.inf, difference)
        return difference / unit

    @property
    def passed(self) -> bool:
        """Whether it is as it should be; a number without an error is not."""
        off = abs(self.deviation)
        if self.kind == REJECTED:
            return off > SIGMAS
        return off <= 1 if self.kind == EXACT else off < SIGMAS

    def as_data(self) -> dict[str, Any]:
        """For JSON, which has no nan and no infinity: None."""
        values = dict(vars(self), deviation=self.deviation, passed=self.passed)
        return {key: _finite(value) for key, value in values.items()}


def _finite(value: Any) -> Any:
    return None if isinstance(value, float) and not math.isfinite(value) else value


@dataclass(frozen=True)
class Panel:
    """Points with errors and a line, to draw beside the rows; those of one title are joined."""

    title: str
    x_label: str
    y_label: str
    x: Numbers
    y: Numbers
    error: Numbers
    line_x: Numbers = ()
    line_y: Numbers = ()

    def as_data(self) -> dict[str, Any]:
        """For JSON."""
        texts = {name: getattr(self, name) for name in ("title", "x_label", "y_label")}
        lists = ("x", "y", "error", "line_x", "line_y")
        return {**texts, **{name: [float(v) for v in getattr(self, name)] for name in lists}}


@dataclass
class Found:
    """What a check found: its rows, all of one system, and what to draw.

    Parameters
    ----------
    state : str
        What is measured, for a reader.
    n, collisions : int
        As of `Row`.
    """

    state: str
    n: int
    collisions: int
    rows: list[Row] = field(default_factory=list)
    panels: list[Panel] = field(default_factory=list)

    def against(
        self,
        name: str,
        quantity: str,
        measured: Estimate,
        reference: float,
        source: str,
        uncertainty: float = 0.0,
        note: str = "",
    ) -> None:
        """Hold an average against a number, which is known to `uncertainty`."""
        self._add(name, quantity, measured, reference, source, uncertainty, STATISTICAL, note)

    def unlike(
        self, name: str, quantity: str, measured: Estimate, reference: float, source: str
    ) -> None:
        """Hold an average against a law that does not hold."""
        note = "must not agree"
        self._add(name, quantity, measured, reference, source, 0.0, REJECTED, note)

    def _add(
        self,
        name: str,
        quantity: str,
        measured: Estimate,
        reference: float,
        source: str,
        uncertainty: float,
        kind: str,
        note: str,
    ) -> None:
        self.rows.append(
            Row(
                name,
                quantity,
                self.state,
                self.n,
                self.collisions,
                float(measured.value),
                float(measured.error),
                float(reference),
                float(uncertainty),
                source,
                kind,
                note=note,
            )
        )

    def exact(
        self,
        name: str,
        quantity: str,
        value: float,
        reference: float,
        tolerance: float,
        source: str,
        note: str = "",
    ) -> None:
        """Hold a number without statistical error against one that is known."""
        self.rows.append(
            Row(
                name,
                quantity,
                self.state,
                self.n,
                self.collisions,
                float(value),
                0.0,
                float(reference),
                0.0,
                source,
                EXACT,
                float(tolerance),
                note,
            )
        )


#: Runs at a size, 1 for the quick report and more for the full one.
Runner = Callable[[float], list[Found]]


@dataclass(frozen=True)
class Check:
    """A run that gives some rows.

    Attributes
    ----------
    name, family : str
        Names of all rows begin with that of their check.
    run : callable
    seconds : float
        What it takes at size 1, about, for the progress bar and the order.
    full : float
        Its size in the full report.
    """

    name: str
    family: str
    run: Runner
    seconds: float
    full: float = 1.0
