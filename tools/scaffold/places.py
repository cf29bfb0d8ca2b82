"""Paths of the examples by the names that users give, and writing without overwriting."""

import keyword
import re
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from windup.hal.errors import UsageError
from windup.robots import robot_names
from windup.robots.folders import GAITS
from windup.tools.terminal.writing import check_folder, writing

WORD: Final = re.compile(r"[A-Za-z][A-Za-z0-9_-]{0,63}")
"""Valid names of robots and gaits."""


def robot_place(name: str) -> Path:
    """Return the folder of a new robot.

    Raises:
        UsageError: The name is invalid, or that of another robot.
    """
    folder = Path(name)
    _check_word("robot", folder.name)
    if folder.name in robot_names():
        raise UsageError(f"there is a robot {folder.name} already: give yours another name")
    return folder


def gait_place(name: str, robot: str) -> Path:
    """Return the path of a new gait: in the folder of a user's robot, else in the present one.

    Raises:
        UsageError: The name is invalid.
    """
    path = Path(name.removesuffix(".toml") + ".toml")
    _check_word("gait", path.stem)
    own = robot not in robot_names() and path.parent == Path()
    return Path(robot) / GAITS / path.name if own else path


def controller_place(name: str) -> Path:
    """Return the path of a new controller.

    Raises:
        UsageError: The name is no module name, or would hide another module.
    """
    path = Path(name.removesuffix(".py") + ".py")
    if not path.stem.isidentifier() or keyword.iskeyword(path.stem):
        raise UsageError(f"{path.stem!r} is no name for a file of Python: letters, digits and _")
    if path.stem in sys.stdlib_module_names or path.stem == "windup":
        raise UsageError(f"{path.name} would hide a module of this name: give it another one")
    return path


def check_new(files: Mapping[Path, str]) -> None:
    """Raise unless all files are new and can be written.

    Raises:
        UsageError: A file exists already, or its folder cannot be written.
    """
    for path in files:
        if path.exists() or path.is_symlink():
            raise UsageError(f"{path} is there already, and nothing is overwritten: another name?")
        into_gaits = path.parent.name == GAITS and not path.parent.exists()
        check_folder(path.parent.parent if into_gaits else path.parent)


def write_new(files: Mapping[Path, str]) -> None:
    """Write new files, and make their folders.

    Raises:
        OutputError: A file cannot be written, or exists by now.
    """
    for path, text in files.items():
        with writing(path):
            path.parent.mkdir(parents=True, exist_ok=True)
            with path.open("x", encoding="utf-8") as file:
                file.write(text)


def _check_word(kind: str, name: str) -> None:
    if not WORD.fullmatch(name):
        rule = "letters, digits, _ and -, beginning with a letter"
        raise UsageError(f"{name!r} is no name for a {kind}: {rule}, at most 64")
