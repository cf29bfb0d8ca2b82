"""Warning and stop levels of supply, temperature, load and stall, by joint."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from windup.hal.joints import Array
from windup.hal.servos.servo_model import ProtectionLimits, ServoModel, ServoMount

COOLER = (15.0, 8.0)
"""Margins of warning and stop below the temperature at which a servo switches off, degrees C. An
XM430 at stall (27 W into about 20 J/K) gains 1.4 degrees C/s, so there is time to crouch between
the stop level and the servo's own shutdown."""
UNKNOWN_HEAT = 70.0
"""Temperature limit of a servo without a published one, degrees C: the lowest of all servos."""
LOW = (0.9, 0.8)
"""Low supply: warning and stop as fractions of the robot's nominal supply voltage; an empty LiPo
cell has 3.0 V of its nominal 3.7 V, 0.81."""
ABOVE_MINIMUM = 1.05
"""Low supply: the stop is at least the servo's minimum voltage times this."""
HIGH = 1.15
"""High supply: warning as a fraction of the nominal supply; a full LiPo cell has 4.2 V, 1.135."""
LOAD = (0.6, 0.75)
"""Warning and stop: mean torque over about 1 s as a fraction of stall torque. Walking and getting
up stay below 0.5; an STS reduces its torque after 2 s above 0.8."""
STALL = (0.3, 0.8)
"""Warning and stop: time at the torque limit without motion, s; an STS reduces its torque after
2 s."""


class HealthKind(IntEnum):
    """Monitored quantity; its value is the row in `HealthLevels`."""

    SUPPLY_LOW = 0
    SUPPLY_HIGH = 1
    TEMPERATURE = 2
    LOAD = 3
    STALL = 4


@dataclass(frozen=True)
class HealthLevels:
    """Levels in the order of `HealthKind`: V, V, degrees C, fraction of stall torque, s.

    Attributes:
        warn: (5, n) warning levels; NaN where nothing is monitored.
        stop: (5, n) levels at which the robot is stopped; NaN where nothing is monitored.
        torque: (n,) stall torque, N m; inf for an ideal joint.
    """

    warn: Array
    stop: Array
    torque: Array

    @classmethod
    def of(
        cls,
        servos: Sequence[ServoMount | None],
        supply: float,
        configured: Mapping[HealthKind, tuple[float, float]] | None = None,
    ) -> "HealthLevels":
        """Return the levels of a robot.

        Args:
            servos: The servo of each joint; an ideal joint (None) is not monitored.
            supply: Nominal supply voltage of the servos, V.
            configured: Warning and stop levels from the robot's file, for the kinds it states.
        """
        table = np.full((2, len(HealthKind), len(servos)), np.nan)
        torque = np.full(len(servos), np.inf)
        for joint, servo in enumerate(servos):
            if servo is not None:
                levels = defaults(servo.model, supply) | dict(configured or {})
                table[:, :, joint] = np.transpose([levels[kind] for kind in HealthKind])
                torque[joint] = servo.model.motor(supply).stall_torque * servo.ratio
        table.setflags(write=False)
        return cls(table[0], table[1], torque)


def defaults(servo: ServoModel, supply: float) -> dict[HealthKind, tuple[float, float]]:
    """Return the default warning and stop levels of each kind for a servo.

    >>> from windup.hal.families import servo_model
    >>> defaults(servo_model("XM430-W350"), 12.0)[HealthKind.TEMPERATURE]
    (65.0, 72.0)
    """
    own = servo.limits or ProtectionLimits(UNKNOWN_HEAT, 0.0, np.inf)
    low = max(LOW[1] * supply, ABOVE_MINIMUM * own.low)
    return {
        HealthKind.SUPPLY_LOW: (max(LOW[0] * supply, low), low),
        HealthKind.SUPPLY_HIGH: (min(HIGH * supply, own.high), own.high),
        HealthKind.TEMPERATURE: (own.temperature - COOLER[0], own.temperature - COOLER[1]),
        HealthKind.LOAD: LOAD,
        HealthKind.STALL: STALL,
    }
