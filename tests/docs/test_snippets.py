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
RESULTS = ROOT / "docs/results.md"
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
    tests = re.findall(r"^def test_", block.text, re.M)
    if not tests:
        exec(compile(block.text, block.place, "exec"), {"__name__": block.place})
        return
    pytester.makepyfile(block.text)
    pytester.runpytest("-p", PLUGIN).assert_outcomes(passed=len(tests))


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
def test_command_lines_that_run_succeed(block: Block, capsys: pytest.CaptureFixture[str]) -> None:
    for words in command_lines(block):
        assert cli.run(words[1:]) == 0, words
    shown = output_shown(block)
    assert not shown or told(capsys.readouterr().err) == told(shown)


def test_the_output_of_the_first_walk_is_shown() -> None:
    assert any(output_shown(block) for block in SHELL if block.note == "run")


def output_shown(block: Block) -> str:
    """Return the text block that follows a block on its page; "" if another one does."""
    page, _, number = block.place.rpartition(":")
    following = blocks(ROOT / page)[int(number) :][:1]
    return following[0].text if following and following[0].language == "text" else ""


def told(output: str) -> str:
    """Return the output of a command in one line, without what differs between computers."""
    return re.sub(r", [\d.]+ x real time", "", " ".join(output.split()))


def test_the_default_walk_of_the_results_is_that_of_today(
    capsys: pytest.CaptureFixture[str],
) -> None:
    row = re.search(r"^\| OP3, by default \| (.*) \| `(.*)` \|$", read(RESULTS), re.M)
    assert row is not None
    assert cli.run(shlex.split(row[2])[1:]) == 0
    assert told(capsys.readouterr().err) == f"op3 walked {row[1]}"


def test_every_result_has_a_command_that_is_understood() -> None:
    lines = re.findall(r"`(windup [^`]+)`", read(RESULTS))
    assert len(lines) > 20
    for line in lines:
        cli.parse(shlex.split(line)[1:]).check()


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_no_command_line_hides_in_a_block_that_is_not_checked(page: Path) -> None:
    unchecked = [block for block in blocks(page) if block.language in ("", "text")]
    hidden = [block.place for block in unchecked if re.search(r"^windup ", block.text, re.M)]
    assert not hidden
