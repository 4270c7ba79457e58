"""The results of ``carom bench`` as JSON, and what two of them say of one another.

The file has the entries ``format`` ("carom bench"), ``format_version``, ``date``, ``machine``
(`carom.bench.machine.description`), ``left_out`` (names of cases the machine has no memory for)
and ``rows``. A row has

====================  ===========================================================================
name, n               of the case, and its number of spheres
packing_fraction      or null
collisions            in one repetition, those with walls included
nanoseconds           process time per collision, of each repetition
median_nanoseconds    of these, and
best_nanoseconds      the least of them
engine_bytes          memory of the engine
peak_bytes            most memory of the process, Python included; null if the system does not tell
building_seconds      process time of building the engine
answer                collisions and time after the warm-up (or a repetition, if there is none):
                      the same on every machine
energy_drift          relative
max_overlap           in contact distances
rate                  measured and expected, collisions per sphere and time, with the relative
                      standard error and what is allowed; null where theory knows nothing
wrong                 a sentence, "" if all answers are right
uniform, bound        the case it is held against, and how many times its cost is allowed
ratio, why            how many times its cost it has, by the best repetitions; why it could be more
most_bytes            bound of peak_bytes
profile               shares of the time, and work per collision, with ``--profile``
====================  ===========================================================================
"""

import datetime
import json
import math
from pathlib import Path
from typing import Any, NamedTuple

from carom.bench import machine
from carom.errors import FileError, InputError

FORMAT, VERSION = "carom bench", 1
#: Without these a row cannot be compared.
NEEDED = {"name", "median_nanoseconds", "best_nanoseconds", "answer"}


def result(rows: list[dict[str, Any]], left_out: list[str]) -> dict[str, Any]:
    """All there is to keep of a benchmark."""
    return {
        "format": FORMAT,
        "format_version": VERSION,
        "date": datetime.datetime.now(datetime.UTC).date().isoformat(),
        "machine": machine.description(),
        "left_out": left_out,
        "rows": rows,
    }


def as_text(data: dict[str, Any], rows: str) -> str:
    """JSON in which each of the rows, the last entry of the data, has a line of its own."""
    lines = ",\n".join("  " + json.dumps(row, allow_nan=False) for row in data[rows])
    head = json.dumps({**data, rows: []}, indent=1, allow_nan=False).removesuffix("[]\n}")
    return f"{head}[\n{lines}\n ]\n}}\n"


def write(path: Path, data: dict[str, Any]) -> None:
    """Write a result, a row a line.

    Raises
    ------
    FileError
        If the file cannot be written.
    """
    try:
        path.write_text(as_text(data, "rows"), encoding="utf-8")
    except OSError as error:
        msg = f"cannot write {path}: {error.strerror}; choose another file with -o"
        raise FileError(msg) from error


def read(path: Path) -> dict[str, Any]:
    """Read a result.

    Raises
    ------
    FileError
        If the file cannot be read.
    InputError
        If it is no result of ``carom bench``, or of a version this one does not know.
    """
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        msg = f"cannot read {path}: {error.strerror}; give a file that carom bench wrote"
        raise FileError(msg) from error
    except ValueError:
        data = None
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        msg = f"{path} is no result of carom bench; give a file that carom bench -o wrote"
        raise InputError(msg)
    if data.get("format_version") != VERSION:
        msg = (
            f"{path} has version {data.get('format_version')} of the format, and this carom reads "
            f"version {VERSION}; measure again"
        )
        raise InputError(msg)
    try:
        whole = all(row.keys() >= NEEDED for row in data["rows"]) and data["machine"].keys()
    except (KeyError, TypeError, AttributeError):
        whole = False
    if not whole:
        msg = f"{path} is a result of carom bench of which something is missing; measure again"
        raise InputError(msg)
    return data


class Compared(NamedTuple):
    """One case in two results: how many times as fast as before it is now."""

    name: str
    median: float
    best: float
    same_answer: bool


def compare(now: dict[str, Any], before: dict[str, Any]) -> list[Compared]:
    """Hold the rows that both have against one another."""
    old = {row["name"]: row for row in before["rows"]}
    return [
        Compared(
            row["name"],
            old[row["name"]]["median_nanoseconds"] / row["median_nanoseconds"],
            old[row["name"]]["best_nanoseconds"] / row["best_nanoseconds"],
            old[row["name"]]["answer"] == row["answer"],
        )
        for row in now["rows"]
        if row["name"] in old
    ]


def geometric_mean(ratios: list[float]) -> float:
    """The mean of ratios that does not depend on which side is divided by which."""
    return math.exp(sum(math.log(ratio) for ratio in ratios) / len(ratios))


def differences(now: dict[str, Any], before: dict[str, Any]) -> list[str]:
    """What differs between the machines of two results, so that speeds say less."""
    names = ("cpu", "clock_ghz", "cores", "caches", "system", "python", "compiler", "simd")
    return [
        f"{name} {before['machine'].get(name)} before, {now['machine'].get(name)} now"
        for name in names
        if now["machine"].get(name) != before["machine"].get(name)
    ]
