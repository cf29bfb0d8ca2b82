"""Options of a behaviour as plain data for a message, and back."""

from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any, Final

import msgspec

from windup.hal.errors import UsageError
from windup.hal.ranges import check_numbers

REMOTE: Final = {"robot", "what", "up", "arm", "json"}
"""Options of a command that a robot that is up allows, beside those of the behaviour."""


def options_as_data(options: Any) -> dict[str, Any]:
    """Return those options, a dataclass, that are not at their defaults.

    Raises:
        UsageError: One of them is no plain data.
    """
    given = {}
    for item in fields(options):
        value = getattr(options, item.name)
        if not item.init or (item.default is not MISSING and value == item.default):
            continue
        try:
            # A path is meant in the folder of the client.
            given[item.name] = msgspec.to_builtins(value, enc_hook=_absolute)
        except (TypeError, NotImplementedError):
            raise UsageError(f"--{item.name.replace('_', '-')} cannot be used with --up") from None
    return given


def options_of(kind: type, given: dict[str, Any]) -> Any:
    """Return the options of a dataclass `kind` from plain data.

    Raises:
        UsageError: One is unknown, missing, of another type, or out of range.
    """
    known = {item.name for item in fields(kind) if item.init}
    if unknown := sorted(set(given) - known):
        raise UsageError(f"unknown option {unknown[0]!r}; known: {', '.join(sorted(known))}")
    try:
        options: Any = msgspec.convert(given, kind, dec_hook=_path)
    except msgspec.ValidationError as error:
        raise UsageError(f"options: {error}") from None
    check_numbers(options)
    return options


def check_alone(command: Any, kind: type) -> None:
    """Refuse options of a command that are not of its behaviour, for a robot that is up.

    Args:
        command: The command, a dataclass.
        kind: The dataclass of the behaviour's own options.

    Raises:
        UsageError: One of them is given.
    """
    known = {item.name for item in fields(kind)} | REMOTE
    for item in fields(command):
        given = item.default is not MISSING and getattr(command, item.name) != item.default
        if given and item.name not in known:
            raise UsageError(
                f"--{item.name.replace('_', '-')} is of a robot that this command opens; leave it "
                "or --up away"
            )


def _absolute(value: object) -> str:
    if isinstance(value, Path):
        return str(value.absolute())
    raise NotImplementedError


def _path(kind: type, value: object) -> Any:
    if issubclass(kind, Path) and isinstance(value, str):
        return Path(value)
    raise NotImplementedError
