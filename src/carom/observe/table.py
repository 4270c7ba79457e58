"""`Table`: results with several rows; to pandas, to files, to a plot."""

import csv
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.errors import InputError, unwritable
from carom.markup import html_table
from carom.observe.estimate import Estimate

UNKNOWN = "(?): too few independent samples to know the error; run longer"
FORMATS = (".csv", ".json", ".npz")


@dataclass(frozen=True)
class Theory:
    """A theory's value, whose it is, and where it holds."""

    value: float
    label: str


@dataclass(frozen=True, eq=False)
class Table:
    """A small labelled table.

    Attributes
    ----------
    title : str
    columns : dict of str to (n,) array
        The standard error of column y is in ``y_error``, what theory says of it in ``y_theory``.
    units : dict of str to str
        Of columns that have one, as powers of mass, length, time and energy.
    theory : str
        Whose theory it is, and where it holds.
    notes : tuple of str
        What one should know before using it.
    """

    title: str
    columns: Mapping[str, NDArray[Any]]
    units: Mapping[str, str] = field(default_factory=dict)
    theory: str = ""
    notes: tuple[str, ...] = ()

    @classmethod
    def of_estimates(
        cls, title: str, rows: Mapping[str, tuple[Estimate, Theory | None]]
    ) -> "Table":
        """One row for each name; theory is nan where there is none."""
        estimates = [estimate for estimate, _ in rows.values()]
        theories = [theory for _, theory in rows.values()]
        labels = dict.fromkeys(theory.label for theory in theories if theory)
        return cls(
            title,
            {
                "quantity": np.array(list(rows)),
                "value": np.array([e.value for e in estimates]),
                "value_error": np.array([e.error for e in estimates]),
                "n_independent": np.array([e.n_independent for e in estimates]),
                "value_theory": np.array([t.value if t else math.nan for t in theories]),
            },
            theory="; ".join(labels),
            notes=tuple(dict.fromkeys(e.note for e in estimates if e.note)),
        )

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def __getitem__(self, column: str) -> NDArray[Any]:
        if column not in self.columns:
            msg = f"{self.title} has no column {column!r}; there are {', '.join(self.columns)}"
            raise InputError(msg)
        return self.columns[column]

    @property
    def measured(self) -> list[str]:
        """Names of the columns that have a standard error."""
        return [name for name in self.columns if f"{name}_error" in self.columns]

    def estimate(self, column: str, row: int) -> Estimate:
        """One measured number with its error.

        Raises
        ------
        InputError
            If the column does not exist or has no error.
        """
        n = float(self.columns["n_independent"][row]) if "n_independent" in self.columns else None
        error = float(self[f"{column}_error"][row])
        return Estimate(float(self[column][row]), error, math.nan if n is None else n)

    def rows(self) -> list[list[str]]:
        """All rows as text, errors in the last digits of their numbers, theory beside them."""
        return [[self._cell(name, row) for name in self._shown] for row in range(len(self))]

    def heading(self) -> list[str]:
        """What stands above the columns of `rows`."""
        words = [name.removesuffix("_theory").replace("_", " ") for name in self._shown]
        return [
            f"{word} (theory)" if name.endswith("_theory") else word
            for word, name in zip(words, self._shown, strict=True)
        ]

    @property
    def _shown(self) -> list[str]:
        """Columns that stand in the text: no errors, and no theory that says nothing."""
        return [
            name
            for name, column in self.columns.items()
            if not name.endswith("_error")
            and not (name.endswith("_theory") and np.isnan(column).all())
        ]

    def _cell(self, name: str, row: int) -> str:
        if name in self.measured:
            return str(self.estimate(name, row))
        value = self.columns[name][row]
        if isinstance(value, (float, np.floating)):
            return "" if math.isnan(value) else f"{value:.6g}"
        return str(value)

    def __str__(self) -> str:
        lines = [self.heading(), *self.rows()]
        widths = [max(len(line[k]) for line in lines) for k in range(len(lines[0]))]
        text = ["  ".join(c.rjust(w) for c, w in zip(line, widths, strict=True)) for line in lines]
        return "\n".join([self.title, *text, *self.footnotes()])

    __repr__ = __str__

    def _repr_html_(self) -> str:
        return html_table(self.title, self.rows(), heading=self.heading(), notes=self.footnotes())

    def footnotes(self) -> list[str]:
        """The theory's name, the notes, and what (?) means where it stands."""
        unknown = any(np.isnan(self.columns[f"{name}_error"]).any() for name in self.measured)
        return [*self._said(), *([UNKNOWN] if unknown else [])]

    def _said(self) -> list[str]:
        return [*([f"theory: {self.theory}"] if self.theory else []), *self.notes]

    def to_pandas(self) -> Any:
        """The same as a pandas DataFrame; title, units and notes are in its `attrs`.

        Raises
        ------
        InputError
            If pandas is not installed.
        """
        try:
            import pandas
        except ImportError as error:
            msg = 'to_pandas() needs pandas: pip install "carom[analysis]"'
            raise InputError(msg) from error
        frame = pandas.DataFrame({name: np.asarray(c) for name, c in self.columns.items()})
        frame.attrs.update(self._about())
        return frame

    def _about(self) -> dict[str, Any]:
        return {
            "title": self.title,
            "units": dict(self.units),
            "theory": self.theory,
            "notes": list(self.notes),
        }

    def as_data(self) -> dict[str, Any]:
        """The same as lists and text, for JSON; null where a number is not known."""
        columns = {
            name: [None if isinstance(x, float) and not math.isfinite(x) else x for x in c.tolist()]
            for name, c in self.columns.items()
        }
        return {**self._about(), "columns": columns}

    def save(self, path: str | Path) -> None:
        """Write it to a file.

        Parameters
        ----------
        path : str or Path
            ``.csv`` has all but the numbers in lines that begin with #, ``.json`` is `as_data`,
            ``.npz`` holds each column under its name and the rest as JSON under ``about``.

        Raises
        ------
        InputError
            If the file's name ends otherwise.
        FileError
            If it cannot be written.
        """
        file = Path(path)
        if file.suffix not in FORMATS:
            msg = f"{file.name} is none of {', '.join(FORMATS)}; give its name one of these ends"
            raise InputError(msg)
        try:
            if file.suffix == ".csv":
                self._write_csv(file)
            elif file.suffix == ".json":
                text = json.dumps(self.as_data(), allow_nan=False, indent=1)
                file.write_text(text + "\n", encoding="utf-8")
            else:
                arrays: dict[str, Any] = {**self.columns, "about": json.dumps(self._about())}
                np.savez(file, **arrays)
        except OSError as error:
            raise unwritable(file, error) from error

    def _write_csv(self, file: Path) -> None:
        units = [f"{name} in {unit}" for name, unit in self.units.items()]
        with file.open("w", newline="", encoding="utf-8") as out:
            out.writelines(f"# {line}\n" for line in [self.title, *units, *self._said()])
            writer = csv.writer(out)
            writer.writerow(self.columns)
            writer.writerows(zip(*(c.tolist() for c in self.columns.values()), strict=True))

    def plot(self, axes: Any = None) -> Any:
        """Draw the measured columns over the first one, and what theory says.

        All columns if none has errors.

        Parameters
        ----------
        axes : matplotlib Axes, optional
            A new figure's if left out.

        Returns
        -------
        matplotlib Axes

        Raises
        ------
        InputError
            If matplotlib is not installed.
        """
        from carom.observe.figure import draw

        return draw(self, axes)
