"""An emulated Bosch BNO055 on I2C: registers, and a new sample every 10 ms.

Addresses, units, reset values and times are those of the data sheet BST-BNO055-DS000-14. Only the
mode "IMU" is emulated: in other modes, and during a change of mode, the data registers keep their
values. Units and axes are taken in the mode "config" alone; axes other than the chip's own are
kept but turn nothing. The host powers the chip: a brown-out of the servos does not reach it.
"""

import errno
import math
from typing import Final

import numpy as np

from windup.hal.joints import Array
from windup.sim_twin.wire.imu.imu import ImuSource
from windup.sim_twin.wire.schedule import Schedule

PERIOD: Final = 0.01  # s
CHIP_ID, DATA, UNIT_SEL, OPR_MODE = 0x00, 0x08, 0x3B, 0x3D
AXES: Final = {0x41: 0x24, 0x42: 0x00}
VERSIONS: Final = {CHIP_ID: 0xA0, 0x01: 0xFB, 0x02: 0x32, 0x03: 0x0F}
RESET: Final = {**VERSIONS, UNIT_SEL: 0x80, OPR_MODE: 0x10, **AXES}
CONFIG, IMU_MODE = 0x00, 0x08
SWITCH: Final = 0.007  # s, from the mode "config" to another one
ALWAYS, IN_CONFIG = (0x07, OPR_MODE), (UNIT_SEL, *AXES)
"""Registers that can be written in every mode, and in the mode "config" alone."""
PER_M_S2, PER_RAD_S, PER_DEGREE_S, PER_ONE = 100.0, 900.0, 16.0, 16_384.0


class Bno055Registers:
    """The registers of the chip.

    Args:
        imu: Source of the motion, in the frame of the chip.
        schedule: Schedule of its world.
    """

    def __init__(self, imu: ImuSource, schedule: Schedule) -> None:
        self._imu, self._schedule = imu, schedule
        self._memory = bytearray(0x80)
        for register, value in RESET.items():
            self._memory[register] = value
        self._measures_from = math.inf
        schedule.add(schedule.now + PERIOD, self._sample)

    def read(self, register: int, count: int) -> bytes:
        """Return `count` registers from one on.

        Raises:
            OSError: The chip is silent.
        """
        self._answer()
        return bytes(self._memory[register : register + count])

    def write(self, register: int, value: int) -> None:
        """Set a register; one that cannot be written now keeps its value.

        Raises:
            OSError: The chip is silent.
        """
        self._answer()
        configuring = self._memory[OPR_MODE] & 0x0F == CONFIG
        if register in ALWAYS or (configuring and register in IN_CONFIG):
            self._memory[register] = value
        if register == OPR_MODE:
            measures = value & 0x0F == IMU_MODE
            self._measures_from = self._schedule.now + SWITCH if measures else math.inf

    def _answer(self) -> None:
        if self._imu.silent:
            raise OSError(errno.EREMOTEIO, "Remote I/O error")

    def _sample(self) -> None:
        now = self._schedule.now
        if now >= self._measures_from and not self._imu.silent:
            self._memory[DATA : DATA + 32] = self._data()
        self._schedule.add(now + PERIOD, self._sample)

    def _data(self) -> bytes:
        """Return the registers from DATA on; magnetic field and Euler angles are 0."""
        rate = PER_RAD_S if self._memory[UNIT_SEL] & 0x02 else math.degrees(PER_DEGREE_S)
        none: Array = np.zeros(3)
        rows = [
            self._imu.acceleration * PER_M_S2,
            none,
            self._imu.angular_velocity * rate,
            none,
            self._imu.orientation * PER_ONE,
        ]
        counts = np.clip(np.rint(np.concatenate(rows)), -32768, 32767)
        return counts.astype("<i2").tobytes()
