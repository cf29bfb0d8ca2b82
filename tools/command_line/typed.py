"""The command line of a parsed command, for files that record how they were made."""

import shlex
from dataclasses import fields
from typing import Any

POSITIONAL = "robot"


def as_typed(command: Any, leave: tuple[str, ...] = ()) -> str:
    """Return the line of a command, which is a dataclass named as its subcommand.

    Args:
        command: Its options; those at their defaults are left out.
        leave: Names of others to leave out.
    """
    words = ["windup", type(command).__name__.lower()]
    for item in fields(command):
        value = getattr(command, item.name)
        if item.name == POSITIONAL:
            words.append(str(value))
        elif item.init and value != item.default and item.name not in leave:
            words += _option(item.name.replace("_", "-"), value)
    return shlex.join(words)


def _option(name: str, value: Any) -> list[str]:
    if isinstance(value, bool):
        return [f"--{name}" if value else f"--no-{name}"]
    values = value if isinstance(value, tuple | list) else (value,)
    return [f"--{name}", *map(str, values)]
