"""The page on telemetry has its tables from the layout, and what it says in words is so."""

import re

from tests.docs.pages import ROOT, read
from windup.hal.publishing.run_state import RunState
from windup.hal.telemetry.fields import KINDS
from windup.hal.telemetry.layout import HEAD
from windup.hal.telemetry.writer import SECONDS
from windup.tools.schemas.telemetry_tables import fields_table, head_table, states_table

PAGE = read(ROOT / "docs/telemetry.md")


def names(table: str) -> list[str]:
    return re.findall(r"^\| `(\w+)` \|", table, flags=re.MULTILINE)


def test_the_page_has_a_place_for_each_table() -> None:
    assert re.findall(r"<!-- generated: (\w+) -->", PAGE) == ["states", "fields", "head"]


def test_each_field_has_a_row() -> None:
    assert names(fields_table()) == [kind.name for kind in KINDS]
    assert "| `position` | f8 | n | rad | measured joint positions |" in fields_table()


def test_each_field_of_the_head_has_a_row() -> None:
    assert names(head_table()) == list(HEAD.names or ())
    assert "| `sequence` | 16 | u8 | number of the newest tick" in head_table()


def test_each_state_has_a_row() -> None:
    rows = states_table().splitlines()[2:]
    assert len(rows) == len(RunState)
    assert rows[1] == "| 1 | limp | Torque is off. |"


def test_the_numbers_of_the_page_are_those_of_the_layout() -> None:
    assert f"the last {SECONDS:.0f} s" in PAGE
    assert f"The head has {HEAD.itemsize} bytes" in PAGE
