"""The guard between every controller and every backend: limits, clamps, and how a robot stops."""

from hal.guard.guarded import CROUCH_SECONDS, GuardedBackend
from hal.guard.limits import SafetyLimits, StopPolicy

__all__ = ["CROUCH_SECONDS", "GuardedBackend", "SafetyLimits", "StopPolicy"]
