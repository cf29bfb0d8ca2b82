"""What a robot is to a controller, and the buses that move one."""

from hal.backend import Backend, Clock
from hal.command import JointCommand
from hal.contacts import ContactSensors
from hal.controller import Controller, Predictor
from hal.errors import WindupError
from hal.guard import GuardedBackend, SafetyLimits
from hal.joints import Joint, Joints
from hal.observation import BaseState, ImuState, JointState, Observation

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
