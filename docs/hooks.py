"""What the build of the documentation adds to its pages: the help of commands, and tables."""

import os

from windup.tools.command_line.reference import command_reference
from windup.tools.command_line.table import COMMANDS
from windup.tools.schemas.telemetry_tables import fields_table, head_table, states_table

MARK = "<!-- generated: commands -->"
TABLES = {"fields": fields_table, "head": head_table, "states": states_table}
WIDTH = "92"
"""Columns of the help texts."""


def on_page_markdown(markdown: str, **_: object) -> str:
    """Replace the marks on a page; see the hooks of MkDocs."""
    for name, table in TABLES.items():
        markdown = markdown.replace(f"<!-- generated: {name} -->", table())
    if MARK not in markdown:
        return markdown
    os.environ["COLUMNS"] = WIDTH
    return markdown.replace(MARK, command_reference(COMMANDS))
