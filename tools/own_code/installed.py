"""The behaviours that other distributions add: entry points of the group `windup.behaviours`.

A distribution names its own in its pyproject.toml, without a change of Windup::

    [project.entry-points."windup.behaviours"]
    nod = "my_package.nod:Nod"
"""

from typing import Any

from windup.hal.plugins.plugins import Plugins
from windup.tools.behaviours.behaviour import Behaviour


def _behaviour(name: str, found: object) -> Behaviour[Any]:
    """Return an object that an entry point names, or an instance of its class.

    Raises:
        ValueError: It is no behaviour.
    """
    if isinstance(found, type) and issubclass(found, Behaviour):
        try:
            found = found()
        except TypeError as error:  # it is abstract, or needs arguments
            raise ValueError(str(error)) from error
    if not isinstance(found, Behaviour):
        raise ValueError(f"it should be a windup.Behaviour, not a {type(found).__name__}")
    return found


INSTALLED = Plugins("windup.behaviours", _behaviour)
"""The behaviours by name."""
