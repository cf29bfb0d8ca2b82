"""The README is one screen and says what matters first; its snippets are run with the pages'."""

import re
from pathlib import Path

from windup.tools.command_line.table import COMMANDS

README = (Path(__file__).parent.parent / "README.md").read_text(encoding="utf-8")


def test_it_fits_one_screen() -> None:
    assert len(README.splitlines()) <= 60


def test_its_first_lines_say_that_no_physical_robot_has_tried_it() -> None:
    assert "Not yet tried on a physical robot" in "\n".join(README.splitlines()[:5])


def test_every_command_of_it_exists() -> None:
    named = set(re.findall(r"^windup (\w+)", README, flags=re.MULTILINE))
    assert {"walk", "push", "emulate"} <= named <= set(COMMANDS)
