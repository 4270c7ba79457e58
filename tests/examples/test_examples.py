"""Every script of `examples/` runs, in seconds, and says what it should."""

import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parents[2] / "examples"

SAYS = {
    "two_balls": "energy 0.500000000000000   momentum [1. 0. 0.]",
    "gas": "Maxwell",
    "cradle": "[2.0, 2.0, 0.0, 0.0, 0.0] -> [0.0, 0.0, 0.0, 2.0, 2.0]",
    "ticks": "deepest overlap",
    "own_observable": "Maxwell 1.5958",
}


def test_all_are_here():
    assert {path.stem for path in HERE.glob("*.py")} == set(SAYS)


@pytest.mark.parametrize("name", sorted(SAYS))
def test_it_runs(name):
    done = subprocess.run(
        [sys.executable, "-W", "error", str(HERE / f"{name}.py")],
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    assert SAYS[name] in done.stdout
    assert done.stderr == ""
