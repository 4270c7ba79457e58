"""The pages about scenes: their examples run, and their tables are complete."""

import doctest
import re
from pathlib import Path

import pytest

from carom import scenes
from carom.scenes import registry

DOCS = Path(__file__).parents[2] / "docs"


@pytest.mark.parametrize("name", ["scenes.md", "scene-files.md"])
def test_examples_run_as_printed(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # where an example may save its file
    monkeypatch.setattr(registry, "_SCENES", dict(registry._SCENES))
    failures, tried = doctest.testfile(str(DOCS / name), module_relative=False)
    assert tried >= 4
    assert failures == 0


def test_the_table_lists_every_scene_with_its_options():
    text = (DOCS / "scenes.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `([a-z0-9-]+)` \|.*\| ([^|]*) \|$", text, flags=re.MULTILINE)
    listed = {name: tuple(re.findall(r"`(\w+)`", options)) for name, options in rows}
    assert listed == {
        name: tuple(option.name for option in scenes.options(name)) for name in scenes.names()
    }
