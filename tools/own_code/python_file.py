"""Loads the controller or behaviour that `FILE.py:NAME` means."""

import linecache
import sys
from collections.abc import Iterator
from inspect import isabstract
from pathlib import Path
from types import ModuleType
from typing import Any, Final

from windup.hal.errors import UsageError, suggest
from windup.hal.small_file import read_small
from windup.tools.behaviours.behaviour import Behaviour
from windup.tools.own_code.code_place import named, place_of_code, place_of_error
from windup.tools.own_code.own_controller import METHODS, OwnController

PREFIX: Final = "windup_own_"
"""Of the name of a user's module, so that it hides no other module."""


def is_python_file(word: str) -> bool:
    """Return whether a word of a command line means a file of Python.

    >>> is_python_file("mine.py:Balance"), is_python_file("nod")
    (True, False)
    """
    return word.endswith(".py") or ".py:" in word


def split(word: str) -> tuple[Path, str]:
    """Return file and name of FILE.py or FILE.py:NAME.

    >>> split("a/mine.py:Balance")
    (PosixPath('a/mine.py'), 'Balance')
    """
    file, colon, name = word.partition(".py:")
    return (Path(f"{file}.py"), name) if colon else (Path(word), "")


def load_own(word: str) -> Behaviour[Any]:
    """Return the behaviour in a file of Python; a controller becomes one.

    Args:
        word: FILE.py:NAME, or FILE.py if there is only one in the file.

    Raises:
        UsageError: The file cannot be read or run, or what is meant is neither a controller nor a
            behaviour.
    """
    path, name = split(word)
    module = run_file(path)
    found = _by_name(module, name, path) if name else _only(module, path)
    if isinstance(found, type) and issubclass(found, Behaviour):
        try:
            found = found()
        except TypeError as error:
            raise UsageError(f"{place_of_code(found, path)}: {error}") from error
    if isinstance(found, Behaviour):
        return found
    return OwnController(found, path)


def run_file(path: Path) -> ModuleType:
    """Return the module that a file is; modules beside it can be imported by it.

    Raises:
        UsageError: It cannot be read, or raises something; the message has the line.
    """
    try:
        source = read_small(path)
    except OSError as error:
        raise UsageError(f"{path} cannot be read: {error.strerror}") from None
    linecache.checkcache(str(path))
    module = ModuleType(PREFIX + path.stem)
    module.__file__ = str(path)
    sys.modules[module.__name__] = module
    folder = str(path.resolve().parent)
    if folder not in sys.path:
        sys.path.append(folder)  # last: nothing there hides a module of another package
    try:
        exec(compile(source, str(path), "exec"), module.__dict__)
    except KeyboardInterrupt:
        raise
    except SystemExit:
        raise UsageError(
            f"{path} ends the program when it is loaded: put what it runs under "
            '`if __name__ == "__main__":`'
        ) from None
    except BaseException as error:
        raise UsageError(f"{place_of_error(error, path)}: {named(error)}") from error
    return module


def _only(module: ModuleType, path: Path) -> Any:
    """Return the only controller or behaviour that a module defines."""
    names = list(_candidates(module))
    if not names:
        raise UsageError(f"{path} has no controller: a class with reset(observation) and "
                         "step(observation, dt)")  # fmt: skip
    if len(names) > 1:
        raise UsageError(f"{path} has several controllers; give one of "
                         f"{', '.join(f'{path}:{name}' for name in names)}")  # fmt: skip
    return vars(module)[names[0]]


def _candidates(module: ModuleType) -> Iterator[str]:
    """Yield the names of the controllers and behaviours that a module defines itself."""
    for name, value in vars(module).items():
        own = isinstance(value, type) and value.__module__ == module.__name__
        if own and not isabstract(value) and (issubclass(value, Behaviour) or _is_one(value)):
            yield name


def _is_one(kind: type) -> bool:
    return all(callable(getattr(kind, method, None)) for method in METHODS)


def _by_name(module: ModuleType, name: str, path: Path) -> Any:
    if name not in vars(module):
        raise UsageError(f"{path} has no {name!r}{suggest(name, _candidates(module))}")
    found = vars(module)[name]
    if not isinstance(found, type | Behaviour):
        raise UsageError(f"{path}: {name} is a {type(found).__name__}; give the name of a class")
    return found
