"""The guard between every controller and every backend: limits, clamps, health, and how to stop."""

from hal.guard.guarded import CROUCH_SECONDS, GuardedBackend
from hal.guard.levels import HealthLevels, Kind
from hal.guard.limits import SafetyLimits, StopPolicy
from hal.guard.watch import HealthWatch

__all__ = [
    "CROUCH_SECONDS",
    "GuardedBackend",
    "HealthLevels",
    "HealthWatch",
    "Kind",
    "SafetyLimits",
    "StopPolicy",
]
