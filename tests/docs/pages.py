"""The pages of the documentation, and the blocks of code in them."""

import re
import shlex
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGES = (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")))
FENCE = re.compile(
    r"^(?:<!-- (?P<note>[^>]*?) -->\n)?```(?P<language>\w*)[^\n]*\n(?P<text>.*?)^```$",
    flags=re.DOTALL | re.MULTILINE,
)


@dataclass(frozen=True)
class Block:
    """A fenced block.

    Attributes:
        place: Page and number, for names of tests.
        language: As the fence says.
        note: Of the comment before it: "run", or "not run: why".
        text: What stands in it.
    """

    place: str
    language: str
    note: str
    text: str


def name_of(page: Path) -> str:
    """Return what a page is called."""
    return str(page.relative_to(ROOT))


def read(page: Path) -> str:
    """Return the text of a page."""
    return page.read_text(encoding="utf-8")


def blocks(page: Path) -> list[Block]:
    """Return the blocks of a page."""
    return [
        Block(f"{name_of(page)}:{number}", found["language"], found["note"] or "", found["text"])
        for number, found in enumerate(FENCE.finditer(read(page)), start=1)
    ]


def all_blocks(language: str) -> list[Block]:
    """Return the blocks of a language of all pages."""
    return [block for page in PAGES for block in blocks(page) if block.language == language]


def command_lines(block: Block) -> list[list[str]]:
    """Return the words of each `windup` line of a block of shell, without its comment."""
    lines = [line for line in block.text.splitlines() if line.startswith("windup ")]
    return [shlex.split(line, comments=True) for line in lines]
