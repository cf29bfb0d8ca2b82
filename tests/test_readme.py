"""The README's snippets run, and its commands exist."""

import re
from pathlib import Path

import pytest

from windup.tools import cli

README = (Path(__file__).parent.parent / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"```(\w*)\n(.*?)```", README, flags=re.DOTALL)


def test_the_python_of_the_readme_runs(capsys: pytest.CaptureFixture[str]) -> None:
    snippets = [text for language, text in BLOCKS if language == "python"]
    assert snippets
    for snippet in snippets:
        exec(compile(snippet, "README.md", "exec"), {})
    assert "False" in capsys.readouterr().out, "it walked and did not fall"


def test_every_command_of_the_readme_exists(capsys: pytest.CaptureFixture[str]) -> None:
    named = set(re.findall(r"^windup (\w+)", README, flags=re.MULTILINE))
    assert {"walk", "play", "robots", "bench"} <= named
    for command in named:
        assert cli.run([command, "--help"]) == 0
    assert "usage: windup walk" in capsys.readouterr().out
