"""Text of exceptions for a person, including those that are not of this package."""

import errno

from windup.hal.errors import WindupError


def error_text(error: Exception) -> str:
    """Return the message of `error`; for errors of the operating system, a readable one."""
    if isinstance(error, WindupError):
        return str(error)
    if isinstance(error, OSError) and error.errno in (errno.EMFILE, errno.ENFILE):
        return "too many open files: close some, or allow more with `ulimit -n 4096`"
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    return f"{type(error).__name__}: {error}"
