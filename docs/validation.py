"""Renews validation.md, its tables and its pictures, from the report of ``carom validate``.

Run ``carom validate -o DIR`` and copy DIR/validation.json to benchmarks/results, then, in the root
of a checkout, ``python docs/validation.py``; it needs the `docs` extra. With ``--plants`` it also
plants the errors of tests/physics/plants.py again, which takes a minute, and renews their table.
"""

import re
import sys
from pathlib import Path

from carom.validate import figures, results
from carom.validate.catalogue import FAMILIES

DOCS = Path(__file__).parent
PAGE = DOCS / "validation.md"
IMAGES = DOCS / "images" / "validation"
RESULTS = DOCS.parent / "benchmarks" / "results" / results.FILE
BLOCK = re.compile(r"(<!-- (\w+): .*?-->\n).*?(<!-- end -->)", re.DOTALL)
GROUPS = ("planted in", "error", "rows that turn red")


def rows(data):
    """Everything of the report, a table and a picture for each family."""
    parts = [summary(data)]
    for family, checks in results.by_family(data).items():
        title = FAMILIES[family]
        picture = f"![{title}: how far off each row is](images/validation/{family}.svg)"
        parts.append(f"### {title}\n\n{results.sheet(checks)}\n\n{picture}\n")
    return "\n".join(parts)


def summary(data):
    """How many rows there are, and on what they were computed."""
    found, red = results.rows(data), results.red(data)
    seconds = sum(check["seconds"] for check in data["checks"])
    days = sorted({check["date"] for check in data["checks"]})
    squares = [row["deviation"] ** 2 for row in found if row["kind"] == "statistical"]
    spread = (sum(squares) / len(squares)) ** 0.5
    text = (
        f"carom {data['machine']['carom']}, {' and '.join(days)}, {data['machine']['cpu']}: "
        f"{len(found)} rows from {seconds:.0f} s of process time, "
        f"{len(found) - len(red)} as they should be. The {len(squares)} deviations counted in "
        f"standard errors have a root mean square of {spread:.2f}.\n"
    )
    return text + (f"\nRed: {', '.join(red)}.\n" if red else "")


def plants():
    """Plants each error, and says what caught it."""
    sys.path.insert(0, str(DOCS.parent))
    import pytest
    from tests.physics.plants import PLANTS
    from tests.physics.test_validate_plants import caught, green

    lines = ["| " + " | ".join(GROUPS) + " |", "|---|---|---|"]
    for group, errors in PLANTS.items():
        for plant in errors:
            for name in plant.checks:
                green(name)
            with pytest.MonkeyPatch.context() as patch:
                plant.plant(patch.setattr)
                names = [f"`{name}`" for name in caught(plant)]
            lines.append(f"| {group} | {plant.what} | {', '.join(names) or '**none**'} |")
            print(lines[-1], flush=True)
    return "\n".join(lines)


def main():
    """Renew all."""
    data = results.read(RESULTS)
    made = {"rows": rows(data)}
    if "--plants" in sys.argv:
        made["plants"] = plants()

    def renewed(match):
        return f"{match[1]}{made[match[2]]}\n{match[3]}" if match[2] in made else match[0]

    PAGE.write_text(BLOCK.sub(renewed, PAGE.read_text("utf-8")), "utf-8")
    IMAGES.mkdir(exist_ok=True)
    figures.draw(IMAGES, data, set(FAMILIES))
    print(f"{PAGE} and its pictures are those of {RESULTS}")


if __name__ == "__main__":
    main()
