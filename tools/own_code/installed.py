"""The behaviours that installed packages bring: entry points of the group `windup.behaviours`.

A package names its own in its pyproject.toml, without a change of Windup::

    [project.entry-points."windup.behaviours"]
    nod = "my_package.nod:Nod"
"""

from importlib.metadata import EntryPoint, entry_points
from typing import Any, Final

from windup.hal.errors import UnknownNameError, UsageError
from windup.tools.behaviours.behaviour import Behaviour

GROUP: Final = "windup.behaviours"


def installed_behaviours() -> dict[str, EntryPoint]:
    """Return the entry points of all installed behaviours by name; none is imported."""
    return {point.name: point for point in entry_points(group=GROUP)}


def load_behaviour(name: str) -> Behaviour[Any]:
    """Return an installed behaviour.

    Raises:
        UnknownNameError: No package has one of this name.
        UsageError: Its package cannot be imported, or gives something else.
    """
    points = installed_behaviours()
    if name not in points:
        raise UnknownNameError("behaviour", name, points)
    return _loaded(points[name])


def _loaded(point: EntryPoint) -> Behaviour[Any]:
    package = "" if point.dist is None else f" of {point.dist.name}"
    try:
        found = point.load()
        if isinstance(found, type) and issubclass(found, Behaviour):
            found = found()
    except Exception as error:  # whatever the code of a package raises
        raise UsageError(
            f"behaviour {point.name!r}{package} cannot be loaded: {type(error).__name__}: {error}"
        ) from error
    if not isinstance(found, Behaviour):
        raise UsageError(
            f"behaviour {point.name!r}{package}: {point.value} is a {type(found).__name__}; "
            "it should be a subclass of windup.Behaviour"
        )
    return found
