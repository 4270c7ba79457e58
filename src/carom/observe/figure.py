"""Pictures of tables, with matplotlib."""

from typing import TYPE_CHECKING, Any

import numpy as np

from carom.errors import InputError

if TYPE_CHECKING:
    from carom.observe.table import Table


def draw(table: "Table", axes: Any = None) -> Any:
    """Points with error bars, lines where there are none; theory as a line, or crosses at names."""
    if axes is None:
        try:
            from matplotlib import pyplot
        except ImportError as missing:
            msg = "plot() needs matplotlib: pip install carom[plot]"
            raise InputError(msg) from missing
        axes = pyplot.figure().add_subplot()
    along, x = next(iter(table.columns.items()))
    named = not np.issubdtype(x.dtype, np.number)
    shown = table.measured or list(table.columns)[1:]
    for place, name in enumerate(shown):
        color = f"C{place}"
        if name not in table.measured:
            axes.plot(x, table[name], color=color, label=name)
            continue
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
    units = dict.fromkeys(table.units.get(name, "") for name in shown)
    axes.set_ylabel(" / ".join(unit for unit in units if unit))
    if not named and len(x) > 2 and x[0] > 0 and x[-1] / x[0] > 100:
        axes.set_xscale("log")
    axes.legend()
    return axes


def yerror(error: Any) -> Any:
    """Error bars; none where the error is not known."""
    return np.where(np.isfinite(error), error, 0.0)
