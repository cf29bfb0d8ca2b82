"""The reference of all commands as Markdown: what each does, and its own help."""

from collections.abc import Mapping

from windup.tools.command_line.parsing import help_text
from windup.tools.command_line.table import Entry


def command_reference(commands: Mapping[str, Entry]) -> str:
    """Return a section for each command, with its help as wide as COLUMNS says."""
    return "\n".join(_section(name, entry) for name, entry in commands.items())


def _section(name: str, entry: Entry) -> str:
    return f"## {name}\n\n{entry.gist}.\n\n```text\n{help_text(name, entry.load()).strip()}\n```\n"
