"""Python of the pages runs, and command lines are understood; those that are said to run do."""

import os
import re
import shlex
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.docs.pages import PAGES, ROOT, Block, all_blocks, blocks, command_lines, name_of, read
from windup.tools import cli

PYTHON = [block for block in all_blocks("python") if not block.text.startswith("--8<--")]
RUNS = [block for block in PYTHON if not block.note.startswith("not run")]
SHELL = all_blocks("sh")
PLUGIN = "windup.tools.testing.pytest_plugin"


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder to write into, with those of the checkout that pages name, and `windup` to call."""
    for name in ("docs", "examples", "robots"):
        (tmp_path / name).symlink_to(ROOT / name)
    monkeypatch.chdir(tmp_path)
    programs = str(Path(sys.executable).parent)
    monkeypatch.setenv("PATH", f"{programs}{os.pathsep}{os.environ['PATH']}")
    yield tmp_path


@pytest.mark.parametrize("block", RUNS, ids=lambda block: block.place)
def test_python_runs(block: Block, pytester: pytest.Pytester) -> None:
    if "\ndef test_" not in block.text:
        exec(compile(block.text, block.place, "exec"), {"__name__": block.place})
        return
    pytester.makepyfile(block.text)
    pytester.runpytest("-p", PLUGIN).assert_outcomes(passed=block.text.count("\ndef test_"))


def test_python_that_does_not_run_says_why() -> None:
    for block in set(PYTHON) - set(RUNS):
        assert len(block.note.removeprefix("not run:").split()) > 3, block.place


@pytest.mark.parametrize("block", SHELL, ids=lambda block: block.place)
def test_command_lines_are_understood(
    block: Block, capsys: pytest.CaptureFixture[str], folder: Path
) -> None:
    lines = command_lines(block)
    assert lines
    for words in lines:
        if words[-1] == "--help":
            assert cli.run(words[1:]) == 0, words
        else:
            cli.parse(words[1:]).check()
    capsys.readouterr()


@pytest.mark.parametrize(
    "block", [block for block in SHELL if block.note == "run"], ids=lambda block: block.place
)
def test_command_lines_that_run_succeed(block: Block) -> None:
    for words in command_lines(block):
        assert cli.run(words[1:]) == 0, words


def test_every_result_has_a_command_that_is_understood() -> None:
    lines = re.findall(r"`(windup [^`]+)`", read(ROOT / "docs/results.md"))
    assert len(lines) > 20
    for line in lines:
        cli.parse(shlex.split(line)[1:]).check()


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_no_command_line_hides_in_a_block_that_is_not_checked(page: Path) -> None:
    hidden = [b.place for b in blocks(page) if b.language in ("", "text") and "\nwindup " in b.text]
    assert not hidden
