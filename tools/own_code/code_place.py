"""Where in a user's file an error happened, and the traceback from there on."""

import traceback
from collections.abc import Iterator
from contextlib import contextmanager
from inspect import getsourcelines
from pathlib import Path
from typing import Any

from windup.hal.errors import ControllerError, UnsafeCommandError, UsageError, WindupError
from windup.tools.terminal.say import say


def place_of_error(error: BaseException, path: Path) -> str:
    """Return "FILE:LINE" of the last line of a file that an exception passed, or "FILE"."""
    if isinstance(error, SyntaxError) and error.filename == str(path):
        return f"{path}:{error.lineno}"
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__)
             if frame.filename == str(path)]  # fmt: skip
    return f"{path}:{lines[-1]}" if lines else str(path)


def place_of_code(code: Any, path: Path) -> str:
    """Return "FILE:LINE" of a class or function of a file, or "FILE" for one from elsewhere."""
    try:
        return f"{path}:{max(getsourcelines(code)[1], 1)}"
    except (OSError, TypeError):
        return str(path)


def named(error: BaseException) -> str:
    """Return an exception as one line; our own ones are messages already."""
    text = " ".join(str(error.msg if isinstance(error, SyntaxError) else error).split())
    if isinstance(error, WindupError):
        return text
    if isinstance(error, SystemExit):
        return f"it ends the program (SystemExit: {text}); raise an error instead"
    return f"{type(error).__name__}: {text}" if text else type(error).__name__


def own_traceback(error: BaseException, path: Path) -> str:
    """Return the traceback of an exception from the first line of a file on."""
    trace = error.__traceback__
    while trace is not None and trace.tb_frame.f_code.co_filename != str(path):
        trace = trace.tb_next
    lines = traceback.format_exception(type(error), error, trace or error.__traceback__)
    return "".join(lines).rstrip()


@contextmanager
def refusing(path: Path) -> Iterator[None]:
    """Convert what a file's code raises before anything moves into one line.

    Errors of the stack that did not pass the file are raised as they are.

    Raises:
        UsageError: The code raised something; the message has file, line and cause.
    """
    try:
        yield
    except (Exception, SystemExit) as error:  # whatever a user's code raises
        place = place_of_error(error, path)
        if isinstance(error, WindupError | SystemExit) and place == str(path):
            raise  # it did not come from there
        raise UsageError(f"{place}: {named(error)}") from error


@contextmanager
def failing(path: Path) -> Iterator[None]:
    """Convert what a file's code raises in a run, and print its traceback.

    Raises:
        ControllerError: The code raised something that is no error of the stack.
        UnsafeCommandError: It made a command of another shape; the message has the line.
    """
    try:
        yield
    except ControllerError as error:
        if error.__cause__ is None:  # a message about what the code returned
            raise
        raise _failure(error.__cause__, path) from error.__cause__
    except UnsafeCommandError as error:
        place = place_of_error(error, path)
        if place == str(path):  # the guard refused it
            raise
        raise UnsafeCommandError(f"{error} ({place})") from error
    except WindupError:
        raise
    except (Exception, SystemExit) as error:  # whatever a user's code raises
        raise _failure(error, path) from error


def _failure(cause: BaseException, path: Path) -> ControllerError:
    say(own_traceback(cause, path))
    place = place_of_error(cause, path)
    return ControllerError(f"the controller failed: {named(cause)} ({place})")
