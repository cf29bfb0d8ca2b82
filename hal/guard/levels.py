"""At which values a robot is warned about and at which it is stopped, by joint and kind."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from windup.hal.joints import Array
from windup.hal.servos.servo_model import OwnLimits, ServoModel, ServoMount

COOLER = (15.0, 8.0)
"""Warning and stop below the temperature at which a servo switches off, degrees C. An XM430 at
stall (27 W into about 20 J/K) gains 1.4 degrees C/s: between the stop and the servo's own there is
time to notice, and to crouch."""
UNKNOWN_HEAT = 70.0
"""The temperature limit of a servo of which none is published, degrees C: the lowest of all."""
LOW = (0.9, 0.8)
"""Warning and stop as shares of the robot's supply; an empty LiPo has 3.0 of its 3.7 V, 0.81."""
ABOVE_MINIMUM = 1.05
"""The stop is at least this much of the servo's own minimum."""
HIGH = 1.15
"""The warning as a share of the robot's supply; a full LiPo has 4.2 of its 3.7 V, 1.135."""
LOAD = (0.6, 0.75)
"""Mean over about a second of the torque, as a share of that at stall. Walks and motions that
get up stay below 0.5; an STS unloads after 2 s above 0.8."""
STALL = (0.3, 0.8)
"""How long a joint may push at its limit without moving, s; an STS unloads after 2 s."""


class Kind(IntEnum):
    """What is judged; also the row of `HealthLevels`."""

    SUPPLY_LOW = 0
    SUPPLY_HIGH = 1
    TEMPERATURE = 2
    LOAD = 3
    STALL = 4


@dataclass(frozen=True)
class HealthLevels:
    """When a joint is unwell, in the order of `Kind`: V, V, degrees C, a share of stall torque, s.

    Attributes:
        warn: (5, n) values from which on a warning is due; nan where nothing is judged.
        stop: (5, n) values from which on the robot is stopped.
        torque: (n,) torque at stall, N m; inf for an ideal joint.
    """

    warn: Array
    stop: Array
    torque: Array

    @classmethod
    def of(
        cls,
        servos: Sequence[ServoMount | None],
        supply: float,
        given: Mapping[Kind, tuple[float, float]] | None = None,
    ) -> "HealthLevels":
        """Return the levels of a robot.

        Args:
            servos: The servo of each joint; an ideal joint (None) is never unwell.
            supply: Voltage of the servos, V.
            given: Warning and stop of whatever the robot's file states.
        """
        table = np.full((2, len(Kind), len(servos)), np.nan)
        torque = np.full(len(servos), np.inf)
        for joint, servo in enumerate(servos):
            if servo is not None:
                levels = defaults(servo.model, supply) | dict(given or {})
                table[:, :, joint] = np.transpose([levels[kind] for kind in Kind])
                torque[joint] = servo.model.motor(supply).stall_torque * servo.ratio
        table.setflags(write=False)
        return cls(table[0], table[1], torque)


def defaults(servo: ServoModel, supply: float) -> dict[Kind, tuple[float, float]]:
    """Return warning and stop of each kind from the servo's own limits.

    >>> from windup.hal.servos import servo_model
    >>> defaults(servo_model("XM430-W350"), 12.0)[Kind.TEMPERATURE]
    (65.0, 72.0)
    """
    own = servo.limits or OwnLimits(UNKNOWN_HEAT, 0.0, np.inf)
    low = max(LOW[1] * supply, ABOVE_MINIMUM * own.low)
    return {
        Kind.SUPPLY_LOW: (max(LOW[0] * supply, low), low),
        Kind.SUPPLY_HIGH: (min(HIGH * supply, own.high), own.high),
        Kind.TEMPERATURE: (own.temperature - COOLER[0], own.temperature - COOLER[1]),
        Kind.LOAD: LOAD,
        Kind.STALL: STALL,
    }
