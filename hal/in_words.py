"""Errors that this package did not expect, as a person reads them."""

import errno

from windup.hal.errors import WindupError


def in_words(error: Exception) -> str:
    """Return what an error says, with what helps where the operating system said it."""
    if isinstance(error, WindupError):
        return str(error)
    if isinstance(error, OSError) and error.errno in (errno.EMFILE, errno.ENFILE):
        return "too many open files: close some, or allow more with `ulimit -n 4096`"
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    return f"{type(error).__name__}: {error}"
