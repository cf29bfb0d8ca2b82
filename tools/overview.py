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
    """Return the first sentence of a docstring, or as many of its parts as there is room for.

    >>> from tools.stand import Stand
    >>> gist(Stand, 60)
    'Stand for some seconds'
    """
    text = " ".join((kind.__doc__ or "").split("\n\n")[0].split())
    sentence = re.split(r"\.(?:\s|$)", text)[0]
    if len(sentence) <= room:
        return sentence
    marks = ";:" if re.search(r"[;:]", sentence[:room]) else ","
    return re.split(f"[{marks}][^{marks}]*$", sentence[:room])[0]
