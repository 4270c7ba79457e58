"""Pictures of tables, with matplotlib."""

from typing import TYPE_CHECKING, Any

import numpy as np

from carom.errors import InputError

if TYPE_CHECKING:
    from carom.observe.table import Table


def draw(table: "Table", axes: Any = None) -> Any:
    """Points with error bars, and theory as a line or as crosses where names are on the axis."""
    if axes is None:
        try:
            from matplotlib import pyplot
        except ImportError as missing:
            msg = "plot() needs matplotlib: pip install carom[plot]"
            raise InputError(msg) from missing
        axes = pyplot.figure().add_subplot()
    along, x = next(iter(table.columns.items()))
    named = not np.issubdtype(x.dtype, np.number)
    for place, name in enumerate(table.measured):
        color = f"C{place}"
        y, error = table[name], table[f"{name}_error"]
        axes.errorbar(x, y, yerror(error), fmt="o", markersize=3, color=color, label=name)
        if f"{name}_theory" in table.columns:
            line = table[f"{name}_theory"]
            if np.isfinite(line).any():
                style = {"linestyle": "", "marker": "x"} if named else {"linewidth": 1}
                axes.plot(x, line, color=color, label=table.theory, **style)
    axes.set_title(table.title)
    unit = table.units.get(along, "")
    axes.set_xlabel(f"{along} ({unit})" if unit else along)
    units = dict.fromkeys(table.units.get(name, "") for name in table.measured)
    axes.set_ylabel(" / ".join(unit for unit in units if unit))
    if not named and len(x) > 2 and x[0] > 0 and x[-1] / x[0] > 100:
        axes.set_xscale("log")
    axes.legend()
    return axes


def yerror(error: Any) -> Any:
    """Error bars; none where the error is not known."""
    return np.where(np.isfinite(error), error, 0.0)
