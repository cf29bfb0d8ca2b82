"""Parses the words of a command line into a command object."""

import io
import sys
from contextlib import redirect_stderr, redirect_stdout, suppress
from typing import Any

import tyro

from windup.hal.errors import UsageError
from windup.tools.command_line.parse_errors import mistake
from windup.tools.terminal.writing import STANDARD_OUTPUT, check_writable, writing


def parse_options(name: str, kind: type, words: list[str]) -> Any:
    """Return the command of class `kind` with its options; exit after printing its help.

    Args:
        name: Name of the command.
        kind: Class of the command.
        words: Words after the name.

    Raises:
        UsageError: The words are invalid, or ask for help while standard output is closed.
        OutputError: The help cannot be written.
    """
    said = io.StringIO()
    try:
        with redirect_stderr(said), redirect_stdout(said):
            return _parse(name, kind, words)
    except SystemExit as ended:
        if ended.code:
            raise UsageError(mistake(name, kind, words, said.getvalue())) from None
    check_writable(STANDARD_OUTPUT)
    with writing(STANDARD_OUTPUT):
        try:
            # Once more in the terminal's width; tyro leaves out positional words before --help.
            return _parse(name, kind, ["--help"])
        finally:
            sys.stdout.flush()


def help_text(name: str, kind: type) -> str:
    """Return the help text of a command of this kind, as wide as COLUMNS or the terminal."""
    said = io.StringIO()
    with redirect_stdout(said), suppress(SystemExit):
        _parse(name, kind, ["--help"])
    return said.getvalue()


def _parse(name: str, kind: type, words: list[str]) -> Any:
    return tyro.cli(kind, prog=f"windup {name}", args=words, config=(tyro.conf.OmitArgPrefixes,))
