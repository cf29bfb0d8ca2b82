"""The list of servos on the page "Your own robot" is the catalogue."""

import re

from tests.docs.pages import ROOT, read
from windup.hal.families import FAMILIES


def test_the_page_lists_every_servo_of_the_catalogue() -> None:
    page = read(ROOT / "docs/robot.md")
    (listed,) = re.findall(r"^<!-- servos -->\n\n((?:`.*\n)+)\n", page, re.M)
    names = [model.name for family in FAMILIES for model in family.models]
    assert re.findall(r"`([^`]+)`", listed) == names
