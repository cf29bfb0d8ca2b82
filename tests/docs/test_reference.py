"""The reference of the commands has all of them, with all of their options."""

import re

import pytest

from windup.tools.command_line.parse_errors import options
from windup.tools.command_line.reference import command_reference
from windup.tools.command_line.table import COMMANDS


def test_every_command_has_a_section_with_its_help(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "92")
    text = command_reference({name: COMMANDS[name] for name in ("walk", "stop")})
    assert [line for line in text.splitlines() if line.startswith("## ")] == ["## walk", "## stop"]
    assert "usage: windup walk" in text and "--speed" in text
    assert max(len(line) for line in text.splitlines()) <= 92
    assert "\x1b" not in text


@pytest.mark.parametrize("name", COMMANDS)
def test_the_help_of_a_command_has_all_of_its_options(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "92")
    text = command_reference({name: COMMANDS[name]})
    known = options(COMMANDS[name].load())
    wanted = {option for option in known if not option.startswith("--no-")}
    assert wanted <= set(re.findall(r"--[\w-]+", text))
