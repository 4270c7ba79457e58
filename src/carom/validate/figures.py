"""One picture of each family: how far off each row is, and the curves of its checks."""

from pathlib import Path
from typing import Any

from carom.errors import FileError, RunError
from carom.validate.catalogue import FAMILIES
from carom.validate.results import by_family
from carom.validate.row import EXACT, REJECTED, SIGMAS

GOOD, BAD, LINE = "#3b7dd8", "#c0392b", "#888888"
#: The number in the file of a picture is not the machine's: same rows, same bytes.
SALT = "carom"


def draw(folder: Path, data: dict[str, Any], families: set[str], kind: str = "svg") -> list[Path]:
    """Write a picture of each of these families.

    Raises
    ------
    RunError
        If matplotlib is missing.
    FileError
        If a file cannot be written.
    """
    try:
        import matplotlib
        from matplotlib.figure import Figure
    except ImportError as error:
        msg = "the pictures need matplotlib: python -m pip install 'carom[plot]'"
        raise RunError(msg) from error
    written = []
    with matplotlib.rc_context({"svg.hashsalt": SALT, "svg.fonttype": "none", "font.size": 8}):
        for family, checks in by_family(data).items():
            if family not in families:
                continue
            rows = [row for check in checks for row in check["rows"]]
            panels = _joined([panel for check in checks for panel in check["panels"]])
            tall = 0.9 + 0.19 * len(rows)
            figure = Figure((7, tall + 2.0 * len(panels)), layout="constrained")
            axes = figure.subplots(
                1 + len(panels), 1, squeeze=False, height_ratios=[tall, *[2.0] * len(panels)]
            )[:, 0]
            _deviations(axes[0], rows, FAMILIES[family])
            for place, panel in enumerate(panels):
                _curve(axes[1 + place], panel)
            path = folder / f"{family}.{kind}"
            try:
                figure.savefig(path, metadata={"Date": None} if kind == "svg" else None)
            except OSError as error:
                msg = f"cannot write {path}: {error.strerror}; choose another folder with -o"
                raise FileError(msg) from error
            written.append(path)
    return written


def _joined(panels: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Panels of one title as one."""
    found: dict[str, dict[str, Any]] = {}
    for panel in panels:
        if panel["title"] not in found:
            found[panel["title"]] = {**panel}
            continue
        one = found[panel["title"]]
        for name in ("x", "y", "error", "line_x", "line_y"):
            one[name] = one[name] + panel[name]
    return list(found.values())


def _deviations(axes: Any, rows: list[dict[str, Any]], title: str) -> None:
    """A point for each row; those of exact numbers in units of a quarter of their tolerance."""
    limit = 1.5 * SIGMAS
    axes.axvspan(-SIGMAS, SIGMAS, color=GOOD, alpha=0.1, lw=0)
    axes.axvline(0, color=LINE, lw=0.8)
    for place, row in enumerate(rows):
        off = row["deviation"] if row["deviation"] is not None else limit
        off *= SIGMAS if row["kind"] == EXACT else 1
        shown = max(-limit, min(limit, off))
        marker = "o" if shown == off else ("<" if off < 0 else ">")
        color = GOOD if row["passed"] else BAD
        filled = color if row["kind"] != EXACT else "white"
        axes.plot(shown, place, marker, color=color, mfc=filled, ms=4.5)
    names = [row["name"] + (" (must differ)" if row["kind"] == REJECTED else "") for row in rows]
    axes.set_yticks(range(len(rows)), names)
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.set_xlim(-limit - 0.3, limit + 0.3)
    axes.set_xlabel("off, in standard errors (○ exact: in quarters of the tolerance)")
    axes.set_title(title, loc="left", fontweight="bold")


def _curve(axes: Any, panel: dict[str, Any]) -> None:
    order = sorted(range(len(panel["line_x"])), key=lambda k: panel["line_x"][k])
    line_x, line_y = ([panel[name][k] for k in order] for name in ("line_x", "line_y"))
    axes.plot(line_x, line_y, color=LINE, lw=0.8)
    axes.errorbar(panel["x"], panel["y"], panel["error"], fmt="o", color=GOOD, ms=3, lw=0.8)
    axes.set_title(panel["title"], loc="left")
    axes.set_xlabel(panel["x_label"])
    axes.set_ylabel(panel["y_label"])
    axes.ticklabel_format(useOffset=False)
