"""`windup --help`: all commands on one screen."""

import re
from collections.abc import Mapping
from typing import Final

HEAD: Final = """\
usage: windup COMMAND ...       `windup COMMAND --help` lists its options

Controllers for small servo humanoids: on the robot, and on its twin.
"""
LINE: Final = 79
"""Characters of a line."""


def overview(commands: Mapping[str, type]) -> str:
    """Return the help: a line for each command."""
    wide = max(map(len, commands)) + 2
    return HEAD + "".join(
        f"{name:{wide}}{gist(kind, LINE - wide)}\n" for name, kind in commands.items()
    )


def gist(kind: type, room: int) -> str:
    """Return what the first sentence of a docstring says before its details.

    >>> from tools.stand import Stand
    >>> gist(Stand, 70)
    'Stand for some seconds'
    """
    sentence = " ".join((kind.__doc__ or "").split("\n\n")[0].split())
    first = re.split(r"[.;:](?:\s|$)", sentence)[0]
    return first if len(first) <= room else first[:room].rpartition(",")[0] or first[:room]
