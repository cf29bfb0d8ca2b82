"""The messages of the page "When something is wrong" are those of the code."""

import ast
import re
from collections.abc import Iterator
from functools import cache
from typing import Final

import pytest

from tests.docs.pages import ROOT, read

ROOMS = ("hal", "control", "robots", "sim_twin", "tools")
ROW = re.compile(r"^\| `([^`]+)` \| (.+) \| (.+) \|$", flags=re.MULTILINE)
MESSAGES = [row[0] for row in ROW.findall(read(ROOT / "docs/troubleshooting.md"))]
SHORTEST = 4
"""Shorter pieces between two gaps say nothing."""
IN_SEVERAL_FILES: Final = {
    "unknown key …; did you mean …": "hal/config.py says what, hal/errors.py the near word",
    "gait … has … perturbations for … regulation variables; give as many (for …)": (
        "control/regulation/variables.py counts, tools/assembly/build.py names the gait"
    ),
}
"""Messages whose pieces stand in different files, each with the reason."""


def strings(tree: ast.Module) -> Iterator[str]:
    """Yield every string of a module but those that are statements: docstrings."""
    docs = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in docs:
            yield node.value


@cache
def texts() -> dict[str, str]:
    """Return the strings of each file of the code, a line each."""
    return {
        str(path.relative_to(ROOT)): "\n".join(strings(ast.parse(path.read_text("utf-8"))))
        for room in ROOMS
        for path in sorted((ROOT / room).rglob("*.py"))
    }


def pieces(message: str) -> list[str]:
    """Return what stands between the gaps of a message."""
    found = [piece.strip(" :;,()") for piece in message.split("…")]
    return [piece for piece in found if len(piece) >= SHORTEST]


def files_of(message: str) -> list[str]:
    """Return the files with all pieces of a message."""
    wanted = pieces(message)
    return [file for file, text in texts().items() if all(piece in text for piece in wanted)]


def test_the_page_has_messages_of_every_kind() -> None:
    assert len(MESSAGES) > 60
    assert len(set(MESSAGES)) == len(MESSAGES)


@pytest.mark.parametrize("message", MESSAGES)
def test_a_message_is_in_the_code(message: str) -> None:
    assert pieces(message)
    for piece in pieces(message):
        assert any(piece in text for text in texts().values()), piece


@pytest.mark.parametrize("message", MESSAGES)
def test_the_pieces_of_a_message_are_in_one_file(message: str) -> None:
    assert bool(files_of(message)) != (message in IN_SEVERAL_FILES)
