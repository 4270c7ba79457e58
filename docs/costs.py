"""Renews the table of costs in observe.md from the results of ``carom bench --observables``.

Run ``carom bench --observables`` in the root of a checkout, then ``python docs/costs.py``.
"""

import json
import re
from pathlib import Path

DOCS = Path(__file__).parent
PAGE = DOCS / "observe.md"
RESULTS = DOCS.parent / "benchmarks" / "results" / "observables.json"
BLOCK = re.compile(r"(<!-- costs: .*?-->\n).*?(<!-- end -->)", re.DOTALL)


def table(data):
    """Costs as a table in Markdown."""
    n, phi = data["n"], data["packing_fraction"]
    millions = data["collisions"] / 1e6
    times = len(data["rows"][0]["ratios"])
    lines = [
        f"{millions:g} million collisions of {n} spheres at packing fraction {phi:g}, alone and",
        f"observed in turn, process time, medians of {times} and the lowest and highest of them",
        f"({data['machine']['cpu']}, {data['date']}). The bound is {100 * data['bound']:.0f} %.",
        "",
        "| | slower by | from – to |",
        "|---|---:|---:|",
    ]
    for row in data["rows"]:
        slower = f"{100 * row['slower']:.0f} %"
        low, high = (100 * (each(row["ratios"]) - 1) for each in (min, max))
        mark = f"**{slower}, over the bound**" if row["over"] else slower
        lines.append(f"| `{row['name']}` | {mark} | {low:.0f} – {high:.0f} % |")
    return "\n".join(lines)


def page(text, data):
    """The page with its table made anew."""
    return BLOCK.sub(lambda block: block[1] + table(data) + "\n" + block[2], text)


def main():
    """Renew it."""
    data = json.loads(RESULTS.read_text("utf-8"))
    PAGE.write_text(page(PAGE.read_text("utf-8"), data), "utf-8")
    print(f"The costs in {PAGE} are those of {RESULTS}")


if __name__ == "__main__":
    main()
