"""What the build of the documentation adds to its pages: the help of every command."""

import os

from windup.tools.command_line.reference import command_reference
from windup.tools.command_line.table import COMMANDS

MARK = "<!-- generated: commands -->"
WIDTH = "92"
"""Columns of the help texts."""


def on_page_markdown(markdown: str, **_: object) -> str:
    """Replace the mark on a page; see the hooks of MkDocs."""
    if MARK not in markdown:
        return markdown
    os.environ["COLUMNS"] = WIDTH
    return markdown.replace(MARK, command_reference(COMMANDS))
