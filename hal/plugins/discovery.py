"""Reads the entry points of the installed distributions."""

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from importlib.metadata import Distribution, EntryPoint


def entry_points_of(group: str, report: Callable[[str], None]) -> "list[EntryPoint]":
    """Return the entry points of a group in the order of name and distribution.

    Args:
        group: Name of the group.
        report: Called with one line for each distribution whose metadata cannot be read.
    """
    from importlib.metadata import entry_points  # slow to import, and needed only now

    try:
        found = list(entry_points(group=group))
    except Exception:  # one malformed file makes the standard library raise for all of them
        found = [entry for entry in _each(report) if entry.group == group]
    return sorted(found, key=lambda entry: (entry.name, distribution_of(entry)))


def distribution_of(entry: "EntryPoint") -> str:
    """Return name and version of the distribution of an entry point."""
    return _name(entry.dist) if entry.dist is not None else "an unknown distribution"


def _each(report: Callable[[str], None]) -> "Iterator[EntryPoint]":
    """Yield the entry points of each distribution whose metadata can be read."""
    from importlib.metadata import distributions

    seen = set[str]()
    for distribution in distributions():
        name = _name(distribution)
        if name in seen:  # the first one on `sys.path` is the one that is imported
            continue
        seen.add(name)
        try:
            yield from distribution.entry_points
        except Exception as error:
            why = " ".join(str(error).split())
            report(f"{name}: its entry_points.txt cannot be read: {why}")


def _name(distribution: "Distribution") -> str:
    metadata = distribution.metadata
    words = [metadata[key] for key in ("Name", "Version") if key in metadata]
    return " ".join(words) or "a distribution without a name"
