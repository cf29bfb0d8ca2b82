"""The `windup` command, and `Robot`, which puts a stack together.

Windup's packages have plain names, and `control` is also the import name of python-control. Two
distributions in one environment would shadow each other in silence, so this says it instead.
"""

from importlib.util import find_spec
from pathlib import Path

ROOMS = ("hal", "control", "robots", "sim_twin", "tools")


def _check_rooms() -> None:
    """Raise an ImportError unless our five packages lie side by side."""
    here = Path(__file__).resolve().parent.parent
    for room in ROOMS:
        spec = find_spec(room)
        place = None if spec is None or spec.origin is None else Path(spec.origin).resolve()
        if place is None or place.parent.parent != here:
            raise ImportError(
                f"the package {room!r} is not Windup's but {place}; another distribution uses "
                "the same import name: install Windup in an environment of its own"
            )


_check_rooms()

from tools.robot import Robot  # noqa: E402 - only after the check

__all__ = ["Robot"]
