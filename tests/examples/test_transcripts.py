"""The documents tell the truth: their Python is run, their transcripts are typed."""

import doctest
import re
from pathlib import Path

import pytest

from carom.cli import main

DOCS = Path(__file__).parents[2] / "docs"
FENCE = re.compile(r"^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


def blocks(name, language):
    text = (DOCS / name).read_text(encoding="utf-8")
    return [body for kind, body in FENCE.findall(text) if kind == language]


@pytest.mark.parametrize(
    ("page", "fewest"),
    [
        ("python.md", 30),
        ("theory.md", 6),
        ("observe.md", 9),
        ("record.md", 9),
        ("events.md", 10),
        ("replay.md", 3),
        ("render.md", 5),
    ],
)
def test_python(page, fewest, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # where an example may save its file
    parser, runner = doctest.DocTestParser(), doctest.DocTestRunner(optionflags=FLAGS)
    names: dict[str, object] = {}
    for number, body in enumerate(blocks(page, "python")):
        test = parser.get_doctest(body, names, f"{page} block {number}", page, 0)
        runner.run(test, clear_globs=False)
        names.update(test.globs)
    assert runner.summarize(verbose=False).failed == 0
    assert runner.tries > fewest


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Where commands leave files for those that come after them."""
    return tmp_path_factory.mktemp("transcripts")


@pytest.mark.parametrize(
    "body",
    [
        b
        for b in blocks("command-line.md", "console") + blocks("render.md", "console")
        if "carom show" not in b and "carom sketch" not in b
    ],
)
def test_command_line(capsys, body, folder, monkeypatch):
    monkeypatch.chdir(folder)
    command, expected = body.split("\n", 1)
    assert command.startswith("$ carom ")
    with pytest.raises(SystemExit):
        main(command.removeprefix("$ carom ").split())
    out, err = capsys.readouterr()
    got = out + err
    # Each written line is to be found, in this order; dots stand for anything.
    pattern = "".join(".*" + _as_pattern(line) for line in expected.strip().splitlines())
    assert re.search(pattern, " ".join(got.split()), re.DOTALL), got


def _as_pattern(line):
    words = " ".join(line.split())
    return re.escape(words).replace(re.escape("..."), ".*")
