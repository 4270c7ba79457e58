"""Do the documents tell the truth? Their commands, examples, links and lists are checked here."""

import doctest
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

import carom
from carom import scene_file, scenes

ROOT = Path(__file__).parents[2]
PACKAGE = Path(carom.__file__).parent
DOCUMENTS = sorted([*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")])
README = (ROOT / "README.md").read_text(encoding="utf-8")


def carom_lines() -> list[list[str]]:
    """The README's `carom ...` lines, as arguments."""
    blocks = re.findall(r"^```sh\n(.*?)^```", README, flags=re.MULTILINE | re.DOTALL)
    lines = re.findall(r"^carom (.*)$", "".join(blocks), flags=re.MULTILINE)
    return [shlex.split(line, comments=True) for line in lines]


def run_cli(arguments: list[str], folder: Path) -> tuple[int, str]:
    """Exit status and standard output of `carom ARGUMENTS`."""
    program = "from carom.cli import main; main()"
    done = subprocess.run(
        [sys.executable, "-c", program, *arguments],
        capture_output=True, text=True, timeout=120, cwd=folder,
    )  # fmt: skip
    return done.returncode, done.stdout


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda p: p.name)
def test_relative_links_lead_somewhere(document: Path) -> None:
    text = document.read_text(encoding="utf-8")
    links = re.findall(r"\]\((?!https?:)([^)#]+)", text)
    missing = [link for link in links if not (document.parent / link).exists()]
    assert missing == []


@pytest.mark.parametrize("name", ["README.md", "docs/index.md"])
def test_examples_run_as_printed(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)  # where an example may save its file
    failures, tried = doctest.testfile(str(ROOT / name), module_relative=False)
    assert tried >= 4
    assert failures == 0


def test_scene_files_in_the_documents_can_be_used() -> None:
    files = [
        block
        for document in DOCUMENTS
        for block in re.findall(
            r"^```toml\n(.*?)^```", document.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL
        )
    ]
    assert files
    for text in files:
        scene_file.parse(text).build()


def test_the_readme_has_exactly_two_set_up_lines_and_ci_finds_the_tests() -> None:
    lines = re.findall(r"^python3 -m venv .*$", README, flags=re.MULTILINE)
    assert len(lines) == 2
    assert lines[0].endswith(".venv/bin/carom show")
    assert lines[1].endswith(".venv/bin/python -m pytest")
    pattern = re.search(r"grep -E '([^']+)' README", (ROOT / ".ci/run").read_text("utf-8"))
    assert pattern is not None
    assert re.findall(pattern[1], README, flags=re.MULTILINE) == [lines[1]]


@pytest.mark.parametrize("arguments", carom_lines(), ids=" ".join)
def test_the_readme_commands_work(arguments: list[str], tmp_path: Path) -> None:
    # `show` and `sketch` serve until Ctrl-C, `bench` and `validate` take a minute or two: here they
    # explain themselves.
    extra = ["--help"] if arguments[0] in ("show", "sketch", "bench", "validate") else []
    status, output = run_cli([*arguments, *extra], tmp_path)
    assert status == 0
    assert output


def test_the_readme_names_every_scene_and_no_other() -> None:
    row = next(line for line in README.splitlines() if line.startswith("| **Scenes**"))
    named = {*re.findall(r"`([^`]+)`", row), *(f"phase-{i}" for i in range(5))}
    assert named == set(scenes.names())
    watched = {line[1] for line in carom_lines() if line[0] in ("show", "run", "compare")}
    assert watched <= named


def test_the_architecture_lists_every_file_and_no_other() -> None:
    text = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    listing = text.split("## Where things live")[1].split("## Layers")[0]
    core, rest = listing.split("src/carom/\n")
    package = rest.split("\ntests/")[0]

    def first_words(block: str, suffixes: str) -> set[str]:
        entries = [line.strip() for line in block.splitlines() if re.match(r" {2,4}\S", line)]
        lines = [re.split(" {2,}", entry)[0] for entry in entries]
        return set(re.findall(rf"[\w]+\.(?:{suffixes})\b", " ".join(lines)))

    files = {p for p in (ROOT / "core").rglob("*.[hc]pp") if p.parent.name != "tests"}
    assert first_words(core, "hpp|cpp") == {p.name for p in files}
    assert first_words(package, "py") == {p.name for p in PACKAGE.glob("*.py")}


def test_the_architecture_names_every_part_of_the_live_view() -> None:
    text = (ROOT / "ARCHITECTURE.md").read_text(encoding="utf-8")
    listing = text.split("### The live view")[1].split("```")[1]
    named = set(re.findall(r"[\w*]+", listing))
    view = PACKAGE / "view"
    scripts = {p.stem for p in view.glob("static/*.js") if not p.stem.startswith("sketch")}
    modules = {p.stem for p in view.glob("*.py")} - {"__init__"}
    assert scripts | modules <= named
