"""The entry points of one group: names at once, objects when they are asked for.

Another distribution adds to Windup by an entry point in its pyproject.toml::

    [project.entry-points."windup.servos"]
    acme = "acme_servos:ACME"

Names are read from the metadata of the installed distributions and import nothing of them. An entry
point that cannot be used never stops what does not need it: it is left out, and reported once.
"""

import logging
import sys
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Generic, TypeVar

from windup.hal.errors import PluginError
from windup.hal.plugins.discovery import distribution_of, entry_points_of

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

Thing = TypeVar("Thing")


class Plugins(Generic[Thing]):
    """The objects that other distributions add to one group.

    The metadata is read again when `sys.path` has changed.

    Args:
        group: Name of the group, such as "windup.servos".
        accept: Returns what the group keeps for an entry point, from its name and its object, or
            raises ValueError with what is wrong with the object.
        own: Returns the names of Windup itself, which no entry point can take.
    """

    def __init__(
        self,
        group: str,
        accept: Callable[[str, object], Thing],
        own: Callable[[], Iterable[str]] = tuple,
    ) -> None:
        self.group = group
        self._accept, self._own = accept, own
        self._path: list[str] = []
        self._entries: dict[str, EntryPoint] = {}
        self._things: dict[str, Thing | PluginError] = {}
        self._reported: set[str] = set()

    def names(self) -> tuple[str, ...]:
        """Return the names of the usable entry points, sorted; imports nothing that they name."""
        self._discover()
        return tuple(self._entries)

    def load(self, name: str) -> Thing:
        """Return the object of an entry point, one of `names`.

        Raises:
            PluginError: It cannot be imported, or is not what the group needs.
        """
        self._discover()
        if name not in self._things:
            self._things[name] = self._loaded(self._entries[name])
        thing = self._things[name]
        if isinstance(thing, PluginError):
            raise thing
        return thing

    def all(self) -> dict[str, Thing]:
        """Return the objects of all entry points by name; broken ones are left out and reported."""
        found = {}
        for name in self.names():
            try:
                found[name] = self.load(name)
            except PluginError as error:
                self._report(str(error))
        return found

    def origin(self, thing: Thing) -> str:
        """Return the name and version of the distribution that added a loaded object."""
        names = [name for name, loaded in self._things.items() if loaded is thing]
        return distribution_of(self._entries[names[0]])

    def _discover(self) -> None:
        """Read the metadata of all distributions, unless that was done for this `sys.path`."""
        if self._path == sys.path:
            return
        self._path, self._entries, self._things = sys.path.copy(), {}, {}
        own = set(self._own())
        for entry in entry_points_of(self.group, self._report):
            if entry.name in own:
                self._report(_describe(entry, "Windup has this name itself; choose another"))
            elif entry.name in self._entries:
                other = distribution_of(self._entries[entry.name])
                self._report(_describe(entry, f"{other} has this name too, and is used"))
            else:
                self._entries[entry.name] = entry

    def _loaded(self, entry: "EntryPoint") -> "Thing | PluginError":
        """Return what the group keeps for an entry point, or the error to raise for it."""
        try:
            found = entry.load()
        except (Exception, SystemExit) as error:  # importing it runs code that is not ours
            return PluginError(_describe(entry, exception_text(error)))
        try:
            return self._accept(entry.name, found)
        except ValueError as error:
            return PluginError(_describe(entry, str(error)))
        except Exception as error:  # from the code of the object, such as its constructor
            return PluginError(_describe(entry, exception_text(error)))

    def _report(self, line: str) -> None:
        if line not in self._reported:
            self._reported.add(line)
            logging.getLogger(__name__).warning("%s", line)


def _describe(entry: "EntryPoint", what: str) -> str:
    place = f"entry point {entry.name} = {entry.value} of {entry.group}"
    return f"{distribution_of(entry)}: {place}: {what}"


def exception_text(error: BaseException) -> str:
    """Return type and message of an exception in one line.

    >>> exception_text(KeyError("angle"))
    "KeyError: 'angle'"
    """
    return " ".join(f"{type(error).__name__}: {error}".split())
