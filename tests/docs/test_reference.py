"""The reference of the commands has all of them, with all of their options."""

import pytest

from windup.tools.command_line.reference import command_reference
from windup.tools.command_line.table import COMMANDS


def test_every_command_has_a_section_with_its_help(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "92")
    text = command_reference({name: COMMANDS[name] for name in ("walk", "stop")})
    assert [line for line in text.splitlines() if line.startswith("## ")] == ["## walk", "## stop"]
    assert "usage: windup walk" in text and "--speed" in text
    assert max(len(line) for line in text.splitlines()) <= 92
    assert "\x1b" not in text
