"""A wrong factor of 2 anywhere turns a row of ``carom validate`` red, and nothing else does."""

import math
from functools import cache

import pytest

from carom.errors import CaromError
from carom.validate import catalogue
from carom.validate.row import REJECTED, Row

from .plants import PLANTS

#: Sizes at which rows are still sharp enough, where the quick report's is more than is needed.
SIZES = {
    "diffusion-size": 0.5, "fluid-structure": 1.0, "mixture-half": 1.0, "few": 0.3,
    "two-kinds-0.25-0.8": 1.0, "cooling-0.9": 1.0, "transport-0.5": 1.0,
}  # fmt: skip
SIZE = 0.25

ALL = [plant for group in PLANTS.values() for plant in group]


def rows(name: str) -> list[Row]:
    found = catalogue.named(name).run(SIZES.get(name, SIZE))
    return [row for one in found for row in one.rows]


clean = cache(rows)  #: without any error; called before one is planted


def green(name: str) -> frozenset[str]:
    """Rows that are as they should be without any error."""
    return frozenset(row.name for row in clean(name) if row.passed)


def caught(plant) -> list[str]:
    """Rows that were green and turn red, and are far off: not for want of an error bar."""
    found = []
    for name in plant.checks:
        try:
            now = rows(name)
        except CaromError:  # the run itself comes to an end
            found.append(name)
            continue
        for row in now:
            off = row.kind != REJECTED and math.isfinite(row.measured)
            if row.name in green(name) and not row.passed and off and not math.isnan(row.deviation):
                found.append(row.name)
    return found


#: Checks that take seconds; errors that they alone show are planted with ``-m validate``.
LONG = {"cooling-0.9", "diffusion-size", "fluid-structure", "mixture-half", "transport-0.5"}


def marked(value, names):
    return pytest.param(value, marks=pytest.mark.validate) if LONG & set(names) else value


CHECKS = sorted({name for plant in ALL for name in plant.checks})


@pytest.mark.parametrize("name", [marked(name, [name]) for name in CHECKS])
def test_rows_are_green_without_an_error(name):
    bad = [(row.name, row.measured, row.reference) for row in clean(name) if not row.passed]
    assert not bad


@pytest.mark.parametrize(
    "plant", [marked(plant, plant.checks) for plant in ALL], ids=lambda plant: plant.what
)
def test_a_planted_error_turns_a_row_red(plant, monkeypatch):
    for name in plant.checks:
        green(name)
    plant.plant(monkeypatch.setattr)
    assert caught(plant)
