"""The guard between controllers and backends: limits, clamps, health checks and stop policies."""

from windup.hal.guard.guarded import CROUCH_SECONDS, GuardedBackend
from windup.hal.guard.levels import HealthKind, HealthLevels
from windup.hal.guard.limits import SafetyLimits, StopPolicy
from windup.hal.guard.watch import HealthWatch

__all__ = [
    "CROUCH_SECONDS",
    "GuardedBackend",
    "HealthKind",
    "HealthLevels",
    "HealthWatch",
    "SafetyLimits",
    "StopPolicy",
]
