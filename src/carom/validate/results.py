"""The report as JSON and as Markdown, and how a new one is merged into an old one.

The JSON has the entries ``format`` ("carom validate"), ``format_version``, ``machine``
(`carom.bench.machine.description`) and ``checks``: for each what `carom.validate.suite.work`
returns, with ``date`` and ``carom``, the version that ran it. A row has the attributes of
`carom.validate.row.Row`, ``deviation`` and ``passed``; None stands for no number.
"""

import datetime
import json
import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from carom.bench import machine
from carom.bench.results import as_text
from carom.errors import FileError, InputError
from carom.observe import Estimate
from carom.validate.catalogue import FAMILIES, checks
from carom.validate.row import EXACT, REJECTED

FORMAT, VERSION = "carom validate", 1
FILE, PAGE = "validation.json", "validation.md"


def report(done: Sequence[dict[str, Any]], before: dict[str, Any] | None = None) -> dict[str, Any]:
    """All there is to keep; checks that were not run stay as they were before."""
    here = machine.description()
    today = datetime.datetime.now(datetime.UTC).date().isoformat()
    kept = {} if before is None else {check["check"]: check for check in before["checks"]}
    for check in done:
        kept[check["check"]] = {"date": today, "carom": here["carom"], **check}
    order = [check.name for check in checks()]
    known = sorted(
        (c for c in kept.values() if c["check"] in order), key=lambda c: order.index(c["check"])
    )
    return {"format": FORMAT, "format_version": VERSION, "machine": here, "checks": known}


def write(folder: Path, data: dict[str, Any]) -> None:
    """Write both files, each in one go, so that an end at any moment leaves whole ones.

    Raises
    ------
    FileError
        If they cannot be written.
    """
    try:
        for name, text in ((FILE, as_text(data, "checks")), (PAGE, markdown(data))):
            part = folder / (name + ".part")
            part.write_text(text, encoding="utf-8")
            part.replace(folder / name)
    except OSError as error:
        msg = f"cannot write to {folder}: {error.strerror}; choose another folder with -o"
        raise FileError(msg) from error


def read(path: Path) -> dict[str, Any]:
    """Read a report.

    Raises
    ------
    FileError
        If the file cannot be read.
    InputError
        If it is no report of this version.
    """
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        msg = f"cannot read {path}: {error.strerror}; choose another folder with -o"
        raise FileError(msg) from error
    except ValueError:
        data = None
    if (
        not isinstance(data, dict)
        or data.get("format") != FORMAT
        or data.get("format_version") != VERSION
    ):
        msg = f"{path} is no report of this carom validate; move it away, or choose another folder"
        raise InputError(msg)
    return data


def by_family(data: dict[str, Any]) -> dict[str, list[dict[str, Any]]]:
    """Checks of each family that has any, in the order of the report."""
    found: dict[str, list[dict[str, Any]]] = {}
    for check in data["checks"]:
        found.setdefault(check["family"], []).append(check)
    return {family: found[family] for family in FAMILIES if family in found}


def red(data: dict[str, Any]) -> list[str]:
    """Names of what is not as it should be."""
    bad = [check["check"] for check in data["checks"] if check["failure"]]
    return bad + [row["name"] for row in rows(data) if not row["passed"]]


def rows(data: dict[str, Any]) -> list[dict[str, Any]]:
    """All rows."""
    return [row for check in data["checks"] for row in check["rows"]]


def measured(row: dict[str, Any]) -> str:
    """The number with its error."""
    return _number(row["measured"], row["error"], row)


def reference(row: dict[str, Any]) -> str:
    """The same of the reference."""
    return _number(row["reference"], row["reference_error"], row)


def deviation(row: dict[str, Any]) -> str:
    """How far off, in standard errors, or in tolerances where the number is exact."""
    if row["deviation"] is None:
        return "?"
    off = row["deviation"]
    return f"{abs(off):.1g} tol" if row["kind"] == EXACT else f"{off:+.1f} σ"


def verdict(row: dict[str, Any]) -> str:
    """A word."""
    if row["passed"]:
        return "differs" if row["kind"] == REJECTED else "ok"
    return "RED"


def _number(value: float | None, error: float | None, row: dict[str, Any]) -> str:
    if value is None:
        return "?"
    if row["kind"] == EXACT:
        whole = value == round(value) and abs(value) < 1e15
        return f"{value:.0f}" if whole else f"{value:.{_digits(value, row['tolerance'])}g}"
    return str(Estimate(value, math.nan if error is None else error, math.nan))


def _digits(value: float, tolerance: float | None) -> int:
    """As many as the tolerance tells apart, 2 to 9."""
    if not tolerance or value == 0:
        return 2
    return min(9, max(2, 2 + math.floor(math.log10(max(1.0, abs(value) / tolerance)))))


def markdown(data: dict[str, Any]) -> str:
    """The report as a page."""
    found, bad = rows(data), red(data)
    lines = ["# What carom was held against", ""]
    lines += [f"{len(found)} rows, {len(found) - len(bad)} as they should be.", ""]
    lines += [f"Red: {', '.join(bad)}.", ""] if bad else []
    for family, checks_ in by_family(data).items():
        lines += [f"## {FAMILIES[family]}", "", sheet(checks_), ""]
    return "\n".join(lines)


def sheet(checks_: list[dict[str, Any]]) -> str:
    """Rows of some checks as a table in Markdown."""
    head = "| of | quantity | N | collisions | measured | reference | off | | source |"
    lines = [head, "|---|---|---:|---:|---:|---:|---:|---|---|"]
    for check in checks_:
        if check["failure"]:
            lines.append(f"| `{check['check']}` | {check['failure']} | | | | | | **RED** | |")
        for row in check["rows"]:
            word = verdict(row)
            source = row["source"] + (f" ({row['note']})" if row["note"] else "")
            cells = (
                row["state"],
                row["quantity"].replace("|", "\\|"),
                f"{row['n']}",
                f"{row['collisions']:,}".replace(",", " "),
                measured(row),
                reference(row) + (f" ± {row['tolerance']:.1g}" if row["kind"] == EXACT else ""),
                deviation(row),
                word if word != "RED" else "**RED**",
                source,
            )
            lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)
