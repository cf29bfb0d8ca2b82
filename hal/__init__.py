"""Hardware abstraction layer: the interfaces between controller and robot, and the servo buses.

A public name is imported when it is first used: `windup stop` needs parts of this package without
waiting for NumPy.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from windup.hal.backend import Backend, Clock
    from windup.hal.command import JointCommand
    from windup.hal.contacts import ContactSensors
    from windup.hal.controller import Controller, Predictor
    from windup.hal.errors import WindupError
    from windup.hal.guard import GuardedBackend, SafetyLimits
    from windup.hal.joints import Joint, Joints
    from windup.hal.observation import BaseState, ImuState, JointState, Observation

PLACES = {
    "Backend": "backend",
    "BaseState": "observation",
    "Clock": "backend",
    "ContactSensors": "contacts",
    "Controller": "controller",
    "GuardedBackend": "guard",
    "ImuState": "observation",
    "Joint": "joints",
    "JointCommand": "command",
    "JointState": "observation",
    "Joints": "joints",
    "Observation": "observation",
    "Predictor": "controller",
    "SafetyLimits": "guard",
    "WindupError": "errors",
}
"""Public name to the module that has it."""

__all__ = [
    "Backend",
    "BaseState",
    "Clock",
    "ContactSensors",
    "Controller",
    "GuardedBackend",
    "ImuState",
    "Joint",
    "JointCommand",
    "JointState",
    "Joints",
    "Observation",
    "Predictor",
    "SafetyLimits",
    "WindupError",
]


def __getattr__(name: str) -> Any:
    """Import a public name when it is first asked for.

    Raises:
        AttributeError: There is no such name.
    """
    if name not in PLACES:
        raise AttributeError(f"module 'windup.hal' has no attribute {name!r}")
    return getattr(import_module(f"windup.hal.{PLACES[name]}"), name)
