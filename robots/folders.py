"""Folders of robots, of Windup and of other distributions, and a cache of what is in them."""

import os
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Generic, TypeVar

from windup.hal.plugins.plugins import Plugins

FOLDER = Path(__file__).parent
FILE = "robot.toml"
GAITS = "gaits"
Made = TypeVar("Made")
Stamp = tuple[tuple[int, int, int], ...]

FRESH = 0.1
"""Minimum age of a file, s: a younger one may change again with the same modification time."""


def _own_names() -> tuple[str, ...]:
    """Return the names of the robots that come with Windup, sorted."""
    return tuple(sorted(path.parent.name for path in FOLDER.glob(f"*/{FILE}")))


def _accept(name: str, found: object) -> Path:
    """Return the folder that an entry point names; see `Plugins`.

    Raises:
        ValueError: It is neither a package nor a path, or there is no robot.toml.
    """
    places = [found] if isinstance(found, Path) else getattr(found, "__path__", ())
    folders = [Path(place) for place in places]
    for folder in folders:
        if (folder / FILE).is_file():
            return folder
    if folders:
        raise ValueError(f"there is no {FILE} in {folders[0]}")
    kind = type(found).__name__
    raise ValueError(f"should be a package with a {FILE} or a pathlib.Path, and is of type {kind}")


ADDED_ROBOTS: Plugins[Path] = Plugins("windup.robots", _accept, own=_own_names)
"""The folders of the robots that other distributions add."""


def robot_names() -> tuple[str, ...]:
    """Return the names of all robots: of Windup, and of those that other distributions add.

    >>> {"human", "op3"} <= set(robot_names())
    True
    """
    return tuple(sorted((*_own_names(), *ADDED_ROBOTS.names())))


def named_folder(name: str) -> Path | None:
    """Return the folder of the robot called `name`; None if there is no such robot.

    Raises:
        PluginError: Another distribution adds it, and its entry point is broken.
    """
    if name in _own_names():
        return FOLDER / name
    if Path(name).name == name and name in ADDED_ROBOTS.names():
        return ADDED_ROBOTS.load(name)
    return None


def robot_folders() -> dict[str, Path]:
    """Return the folders of all robots by name; a broken entry point is reported and left out."""
    own = {name: FOLDER / name for name in _own_names()}
    return dict(sorted({**own, **ADDED_ROBOTS.all()}.items()))


def gait_files(folder: Path) -> dict[str, Path]:
    """Return the paths of the gait files in a robot's folder by name."""
    return {path.stem: path for path in sorted((folder / GAITS).glob("*.toml"))}


class RobotCache(Generic[Made]):
    """Keeps one object per folder.

    Args:
        most: Maximum number of folders.
    """

    def __init__(self, most: int = 32) -> None:
        self._most = most
        self._kept: dict[tuple[str, str], tuple[Sequence[Path], Stamp, Made]] = {}

    def get(self, folder: Path) -> Made | None:
        """Return the object kept for a folder if its files are unchanged, else None."""
        kept = self._kept.get(_key(folder))
        if kept is None:
            return None
        files, stamp, made = kept
        return made if _stamp(files) == stamp else None

    def put(self, folder: Path, files: Sequence[Path], made: Made) -> None:
        """Keep the object made from the `files` of a folder, unless one was just written."""
        stamp = _stamp(files)
        newest = max((changed for changed, _, _ in stamp), default=0)
        if len(stamp) == len(files) and time.time() - newest * 1e-9 > FRESH:
            self._kept.pop(_key(folder), None)
            self._kept[_key(folder)] = (files, stamp, made)
            while len(self._kept) > self._most:
                del self._kept[next(iter(self._kept))]


def _key(folder: Path) -> tuple[str, str]:
    """Return the folder as named, which error messages repeat, and its absolute path."""
    return str(folder), os.path.abspath(folder)


def _stamp(files: Sequence[Path]) -> Stamp:
    """Return modification time, size and inode of each file; () if one is missing."""
    try:
        found = [os.stat(file) for file in files]
    except OSError:
        return ()
    return tuple((item.st_mtime_ns, item.st_size, item.st_ino) for item in found)
