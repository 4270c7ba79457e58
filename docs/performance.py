"""Renews performance.md, its tables and its pictures, from the results of ``carom bench``.

Run ``carom bench --full --profile`` in the root of a checkout, then
``python docs/performance.py``; it needs the `docs` extra.
"""

import json
import re
from pathlib import Path

DOCS = Path(__file__).parent
PAGE = DOCS / "performance.md"
IMAGES = DOCS / "images"
RESULTS = DOCS.parent / "benchmarks" / "results" / "speed.json"

SCALING = "0.25"  #: packing fraction of the law of scaling
#: The physical floor: cycles of a collision whose data are in the nearest caches, and
#: nanoseconds of one whose data are in none.
FLOOR_CYCLES, FLOOR_FAR = (600, 700), (170, 250)
BLOCK = re.compile(r"(<!-- (\w+): .*?-->\n).*?(<!-- end -->)", re.DOTALL)
COLORS = ("#3b7dd8", "#d8703b", "#3f9e5a")


def fluids(data):
    """Rows of the uniform fluids as {packing fraction: rows by rising N}."""
    found = {}
    for row in sorted(data["rows"], key=lambda row: row["n"]):
        if row["name"].startswith("fluid-"):
            found.setdefault(f"{row['packing_fraction']:g}", []).append(row)
    return dict(sorted(found.items(), key=lambda item: float(item[0])))


def sheet(head, rows, texts=1):
    """A table in Markdown; the first columns are text, the others numbers."""
    lines = ["| " + " | ".join(head) + " |"]
    lines.append("|---" * texts + "|---:" * (len(head) - texts) + "|")
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines)


def count(n):
    """A count as this page writes it."""
    return f"{n:,}".replace(",", " ")


def size(number):
    """Bytes of a cache."""
    kib = number / 1024
    return f"{kib / 1024:g} MiB" if kib >= 1024 else f"{kib:g} KiB"


def machine(data):
    """On what it was measured."""
    it = data["machine"]
    caches = ", ".join(f"{level} {size(each)}" for level, each in it["caches"].items())
    clock = f", nominally {it['clock_ghz']:g} GHz" if it["clock_ghz"] else ""
    compiler = f", {it['compiler']}" if it["compiler"] else ""
    return (
        f"carom {it['carom']} on {data['date']}: {it['cpu']}{clock}; {caches} for one core, of "
        f"{it['cores']}; instruction set in use: {it['simd']}; {it['system']}, Python "
        f"{it['python']}, NumPy {it['numpy']}{compiler}. One core works."
    )


def series(data):
    """Fluids of three sizes or more at one packing fraction; others only are held against."""
    return {phi: rows for phi, rows in fluids(data).items() if len(rows) > 2}


def speed(data):
    """Million collisions per second over N and packing fraction."""
    grid = series(data)
    sizes = sorted({row["n"] for rows in grid.values() for row in rows})
    lines = []
    for n in sizes:
        cells = [next((row for row in rows if row["n"] == n), None) for rows in grid.values()]
        if sum(cell is not None for cell in cells) > 1:
            lines.append([count(n), *(speeds(cell) for cell in cells)])
    return sheet(["N", *(f"φ = {phi}" for phi in grid)], lines)


def speeds(row):
    """Median and best of a row."""
    if row is None:
        return ""
    return f"{1e3 / row['median_nanoseconds']:.2f} ({1e3 / row['best_nanoseconds']:.2f})"


def scaling(data):
    """Cost per collision from two spheres to ten million."""
    clock = data["machine"]["clock_ghz"]
    lines = []
    for row in fluids(data)[SCALING]:
        best = row["best_nanoseconds"]
        cells = [count(row["n"]), f"{row['median_nanoseconds']:.0f}", f"{best:.0f}"]
        lines.append([*cells, f"{clock * best:.0f}"] if clock else cells)
    head = ["N", "ns, median", "ns, best", "cycles, best"]
    return sheet(head if clock else head[:3], lines)


def caches(data):
    """How many spheres fill each cache, and what a collision costs below and beyond."""
    rows = [row for row in fluids(data)[SCALING] if row["n"] >= 1000]
    lines = []
    for level, each in data["machine"]["caches"].items():
        full = int(each / (rows[-1]["engine_bytes"] / rows[-1]["n"]))
        below = [row for row in rows if row["n"] <= full]
        above = [row for row in rows if row["n"] > full]
        lines.append(
            [
                f"{level}, {size(each)}",
                count(round(full, 2 - len(str(full)))),
                *(cost(side[k]) if side else "" for side, k in ((below, -1), (above, 0))),
            ]
        )
    return sheet(["cache", "full at N =", "nearest below, ns", "nearest above, ns"], lines)


def cost(row):
    """Cost of a row and its size."""
    return f"{row['best_nanoseconds']:.0f} ({count(row['n'])})"


def memory(data):
    """Bytes per sphere, of the engine and of the whole process."""
    lines = []
    for row in fluids(data)[SCALING]:
        if row["n"] >= 1000:
            peak = row["peak_bytes"]
            whole = [f"{peak / row['n']:.0f}", f"{peak / 1e6:.0f}"] if peak else ["", ""]
            lines.append([count(row["n"]), f"{row['engine_bytes'] / row['n']:.0f}", *whole])
    return sheet(["N", "engine, bytes/sphere", "process, bytes/sphere", "process, MB"], lines)


def cliffs(data):
    """What could be slow, and what it costs."""
    lines = [
        [
            f"`{row['name']}`",
            row["why"],
            f"`{row['uniform']}`",
            f"{row['ratio']:.2f}",
            f"{row['bound']:g}",
        ]
        for row in data["rows"]
        if "bound" in row
    ]
    return sheet(
        ["case", "what could make it slow", "held against", "times", "bound"], lines, texts=3
    )


def profile(data):
    """Where the time goes."""
    rows = [row for row in data["rows"] if "profile" in row]
    if not rows:
        return "These results were made without `--profile`."
    shares, work = (list(rows[0]["profile"][key]) for key in ("shares", "work"))
    lines = [
        [
            f"`{row['name']}`",
            *(f"{100 * row['profile']['shares'][name]:.0f} %" for name in shares),
            *(f"{row['profile']['work'][name]:.2f}" for name in work),
        ]
        for row in rows
    ]
    return sheet(["case", *shares, *work], lines)


TABLES = {
    each.__name__: each for each in (machine, speed, scaling, caches, memory, cliffs, profile)
}


def page(text, data):
    """The page with all that comes from results made anew."""
    return BLOCK.sub(lambda block: block[1] + TABLES[block[2]](data) + "\n" + block[3], text)


def plot(name, ylabel, draw):
    """One picture over the number of spheres."""
    import matplotlib as mpl

    mpl.use("svg")
    mpl.rcParams.update({"svg.hashsalt": "carom", "font.size": 10, "svg.fonttype": "none"})
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7, 4), layout="constrained")
    draw(axes)
    axes.set(xscale="log", xlabel="spheres N", ylabel=ylabel)
    axes.set_ylim(bottom=0)
    axes.grid(alpha=0.25)
    axes.legend(frameon=False)
    figure.savefig(IMAGES / f"performance-{name}.svg", metadata={"Date": None})
    pyplot.close(figure)


def line(axes, rows, values, label, color):
    """Numbers of some rows over N."""
    axes.plot([row["n"] for row in rows], values, "o-", color=color, label=label, markersize=4)


def pictures(data):
    """Draw all."""
    by_phi = series(data)
    rows = [row for row in by_phi[SCALING] if row["n"] >= 1000]
    it = data["machine"]

    def draw_speed(axes):
        for (phi, some), color in zip(by_phi.items(), COLORS, strict=True):
            some = [row for row in some if row["n"] >= 1000]
            speeds = [1e3 / row["median_nanoseconds"] for row in some]
            line(axes, some, speeds, f"φ = {phi}", color)

    def draw_scaling(axes):
        costs = [row["best_nanoseconds"] for row in rows]
        line(axes, rows, costs, f"cost of a collision, φ = {SCALING}", COLORS[0])
        least, most = rows[0]["n"], rows[-1]["n"]
        each = rows[-1]["engine_bytes"] / most
        full = {level: capacity / each for level, capacity in it["caches"].items()}
        full = {level: n for level, n in full.items() if least < n < most}
        near, far = min(full.values(), default=most), max(full.values(), default=least)
        if it["clock_ghz"]:
            ends = [cycles / it["clock_ghz"] for cycles in FLOOR_CYCLES]
            label = f"floor in cache: {FLOOR_CYCLES[0]}–{FLOOR_CYCLES[1]} cycles"
            axes.fill_between([least, near], *ends, alpha=0.4, color=COLORS[2], lw=0, label=label)
        label = f"floor without: {FLOOR_FAR[0]}–{FLOOR_FAR[1]} ns"
        axes.fill_between([far, most], *FLOOR_FAR, alpha=0.4, color=COLORS[1], lw=0, label=label)
        for level, n in full.items():
            axes.axvline(n, color="gray", ls=":", lw=1)
            axes.text(n, 0, f" {level} full", rotation=90, va="bottom", ha="right", color="gray")

    def draw_memory(axes):
        line(axes, rows, [row["engine_bytes"] / row["n"] for row in rows], "engine", COLORS[0])
        whole = [row for row in rows if row["peak_bytes"] and row["n"] >= 100_000]
        peaks = [row["peak_bytes"] / row["n"] for row in whole]
        line(axes, whole, peaks, "process at its peak", COLORS[1])

    plot("speed", "million collisions per second", draw_speed)
    plot("scaling", "nanoseconds per collision", draw_scaling)
    plot("memory", "bytes per sphere", draw_memory)


def main():
    """Renew all."""
    data = json.loads(RESULTS.read_text("utf-8"))
    PAGE.write_text(page(PAGE.read_text("utf-8"), data), "utf-8")
    pictures(data)
    print(f"{PAGE} and its pictures are those of {RESULTS}")


if __name__ == "__main__":
    main()
