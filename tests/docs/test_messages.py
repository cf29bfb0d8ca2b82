"""The messages of the page "When something is wrong" are those of the code."""

import ast
import re
from functools import cache

import pytest

from tests.docs.pages import ROOT, read

ROOMS = ("hal", "control", "robots", "sim_twin", "tools")
ROW = re.compile(r"^\| `([^`]+)` \| (.+) \| (.+) \|$", flags=re.MULTILINE)
MESSAGES = [row[0] for row in ROW.findall(read(ROOT / "docs/troubleshooting.md"))]
SHORTEST = 4
"""Shorter pieces between two gaps say nothing."""


@cache
def texts() -> str:
    """Return every string of the code, a line each."""
    found = []
    for room in ROOMS:
        for path in sorted((ROOT / room).rglob("*.py")):
            tree = ast.parse(path.read_text(encoding="utf-8"))
            found += [
                node.value
                for node in ast.walk(tree)
                if isinstance(node, ast.Constant) and isinstance(node.value, str)
            ]
    return "\n".join(found)


def pieces(message: str) -> list[str]:
    """Return what stands between the gaps of a message."""
    found = [piece.strip(" :;,()") for piece in message.split("…")]
    return [piece for piece in found if len(piece) >= SHORTEST]


def test_the_page_has_messages_of_every_kind() -> None:
    assert len(MESSAGES) > 60
    assert len(set(MESSAGES)) == len(MESSAGES)


@pytest.mark.parametrize("message", MESSAGES)
def test_a_message_is_in_the_code(message: str) -> None:
    assert pieces(message)
    for piece in pieces(message):
        assert piece in texts(), piece
