"""The behaviours that a runtime can run: those of Windup, of packages, and of a user's files."""

from importlib import import_module
from typing import Any, Final

from windup.hal.errors import UnknownNameError
from windup.tools.behaviours.behaviour import Behaviour
from windup.tools.own_code.installed import INSTALLED
from windup.tools.own_code.python_file import is_python_file, load_own

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
    """Return a behaviour by its name, or from a user's file, FILE.py:NAME.

    Raises:
        UnknownNameError: There is none.
        UsageError: The file or the package that brings it cannot be imported.
    """
    if name in OWN:
        module = import_module(f"windup.tools.behaviours.{name}")
        found: Behaviour[Any] = getattr(module, OWN[name])
        return found
    if is_python_file(name):
        return load_own(name)
    if name not in INSTALLED.names():
        raise UnknownNameError("behaviour", name, (*OWN, *INSTALLED.names()))
    return INSTALLED.load(name)


def import_all() -> None:
    """Import the behaviours of Windup, so that no robot under torque waits for that."""
    for name in OWN:
        known_behaviour(name)
