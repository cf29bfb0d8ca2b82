"""The behaviours that a runtime can run: those of Windup, and those of installed packages."""

from importlib import import_module
from typing import Any, Final

from windup.tools.behaviours.registry import installed_behaviours, load_behaviour

from windup.hal.errors import UnknownNameError
from windup.tools.behaviours.behaviour import Behaviour

OWN: Final = {
    "stand": "STAND",
    "walk": "WALK",
    "play": "PLAY",
    "rise": "RISE",
    "stride": "STRIDE",
    "step": "STEP",
    "footprints": "FOOTPRINTS",
}
"""Name of each behaviour of Windup to the object in the module of that name."""


def known_behaviour(name: str) -> Behaviour[Any]:
    """Return a behaviour by its name.

    Raises:
        UnknownNameError: There is none.
        UsageError: The package that brings it cannot be imported.
    """
    if name in OWN:
        found: Behaviour[Any] = getattr(import_module(f"windup.tools.behaviours.{name}"), OWN[name])
        return found
    installed = installed_behaviours()
    if name not in installed:
        raise UnknownNameError("behaviour", name, (*OWN, *installed))
    return load_behaviour(name)


def import_all() -> None:
    """Import the behaviours of Windup, so that no robot under torque waits for that."""
    for name in OWN:
        known_behaviour(name)
