"""Pictures of tables, with matplotlib."""

import textwrap
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.errors import InputError

if TYPE_CHECKING:
    from carom.observe.table import Table

WIDTH = 32  #: letters in a line of the legend: more would cover the points


def draw(table: "Table", axes: Any = None) -> Any:
    """Points with error bars, lines where there are none; theory as a line, or crosses at names."""
    if axes is None:
        try:
            from matplotlib import pyplot
        except ImportError as missing:
            msg = 'plot() needs matplotlib: pip install "carom[plot]"'
            raise InputError(msg) from missing
        axes = pyplot.figure(layout="constrained").add_subplot()
    along, x = next(iter(table.columns.items()))
    named = not np.issubdtype(x.dtype, np.number)
    others = list(table.columns)[1:]
    # Of what has no error bars only that is drawn which is not 0 throughout.
    shown = table.measured or [name for name in others if table[name].any()] or others
    said = textwrap.fill(f"theory: {table.theory}", WIDTH) if table.theory else ""
    for place, name in enumerate(shown):
        color = f"C{place}"
        words = name.replace("_", " ")
        if name not in table.measured:
            axes.plot(x, table[name], color=color, label=words)
            continue
        y, error = table[name], table[f"{name}_error"]
        axes.errorbar(x, y, yerror(error), fmt="o", markersize=3, color=color, label=words)
        line = table.columns.get(f"{name}_theory")
        if line is not None and said:
            look = {"linestyle": "", "marker": "x"} if named else {"linewidth": 1}
            if not np.isfinite(line).any():
                look = {"linestyle": ""}  # only the reason stands in the legend
            axes.plot(x, line, color=color, label=said, **look)
    axes.set_title(table.title, fontsize="medium", wrap=True)
    axes.set_xlabel(_label([along], table))
    axes.set_ylabel(_label(shown, table))
    if not named and _widens(x):
        axes.set_xscale("log")
        y = table[shown[0]]
        if (y > 0).all() and y.max() > 100 * y.min():
            axes.set_yscale("log")
    axes.legend(fontsize="small")
    return axes


def _label(names: list[str], table: "Table") -> str:
    """Name and unit of an axis; of several columns the units alone."""
    units = " / ".join(dict.fromkeys(filter(None, (table.units.get(name) for name in names))))
    units = units.replace("^2", "²").replace("^3", "³")
    words = names[0].replace("_", " ") if len(names) == 1 else ""
    if not units or units == words:
        return words
    return f"{words} ({units})" if words else units


def _widens(x: Any) -> bool:
    """Whether numbers lie evenly on a logarithmic axis rather than on a plain one."""
    return bool(len(x) > 2 and x[0] > 0 and x[-1] - x[-2] > 10 * (x[1] - x[0]))


def yerror(error: Any) -> Any:
    """Error bars; none where the error is not known."""
    return np.where(np.isfinite(error), error, 0.0)
