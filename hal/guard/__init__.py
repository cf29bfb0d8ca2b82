"""The guard between controllers and backends: limits, clamps, health checks and stop policies."""

from windup.hal.guard.guarded import CROUCH_SECONDS, GuardedBackend
from windup.hal.guard.levels import HealthLevels, Kind
from windup.hal.guard.limits import SafetyLimits, StopPolicy
from windup.hal.guard.watch import HealthWatch

__all__ = [
    "CROUCH_SECONDS",
    "GuardedBackend",
    "HealthLevels",
    "HealthWatch",
    "Kind",
    "SafetyLimits",
    "StopPolicy",
]
