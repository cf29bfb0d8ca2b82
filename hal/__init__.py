"""Hardware abstraction layer: the interfaces between controller and robot, and the servo buses."""

from windup.hal.backend import Backend, Clock
from windup.hal.command import JointCommand
from windup.hal.contacts import ContactSensors
from windup.hal.controller import Controller, Predictor
from windup.hal.errors import WindupError
from windup.hal.guard import GuardedBackend, SafetyLimits
from windup.hal.joints import Joint, Joints
from windup.hal.observation import BaseState, ImuState, JointState, Observation

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
