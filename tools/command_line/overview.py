"""`windup --help`: all commands on one screen."""

from collections.abc import Mapping
from typing import Final

from windup.tools.command_line.table import Entry

HEAD: Final = """\
usage: windup COMMAND ...       `windup COMMAND --help` lists its options
Controllers for small servo humanoids: on the robot, and on its twin.
"""


def overview(commands: Mapping[str, Entry]) -> str:
    """Return the help text: one line for each command."""
    wide = max(map(len, commands)) + 2
    return HEAD + "".join(f"{name:{wide}}{entry.gist}\n" for name, entry in commands.items())
