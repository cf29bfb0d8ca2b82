"""The OpenCR board of the OP3: IMU, voltage, buttons and the switch of the servo power.

A Dynamixel protocol 2 device, id 200. Its registers are those of the OP3's firmware
(`dxl_node_op3.cpp` of ROBOTIS' OpenCR); roll, pitch and yaw are signed tenths of a degree, whatever
the device file of the ROBOTIS framework says. The fourth button, reset (bit 3), which switches the
servo power off when it is held for 0.1 s, is not emulated.
"""

import math
from collections.abc import Callable, Sequence

import numpy as np

from windup.hal.geometry.gravity import STANDARD_GRAVITY
from windup.hal.imu.mounting import Mounting
from windup.hal.imu.opencr import IN_OP3
from windup.hal.joints import Array
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.imu.imu import ImuSource
from windup.sim_twin.wire.servos.register_file import (
    BAD_ACCESS,
    BAD_INSTRUCTION,
    BAD_RANGE,
    OK,
    Item,
    RegisterFile,
)
from windup.sim_twin.wire.servos.x_series import BAUD_RATES

GYRO_UNIT = math.radians(2000.0 / 32800.0)  # rad/s a count
ACCELERATION_UNIT = 2.0 / 32768.0 * STANDARD_GRAVITY  # m/s2 a count
MODE_BUTTON, START_BUTTON, USER_BUTTON = 0x01, 0x02, 0x04
PRESENT = (30, 49)

REGISTERS = (
    Item(0, 2, "model_number", default=0x7400),
    Item(2, 1, "firmware_version", default=1),
    Item(3, 1, "id", "RW", 200, 0, 252),
    Item(4, 1, "baud_rate", "RW", 3, 0, 7),
    Item(5, 1, "return_delay_time", "RW", 0, 0, 254),
    Item(16, 1, "status_return_level", "RW", 2, 0, 2),
    Item(18, 2, "roll_offset", "RW", 0, -32768, 32767),
    Item(20, 2, "pitch_offset", "RW", 0, -32768, 32767),
    Item(22, 2, "yaw_offset", "RW", 0, -32768, 32767),
    Item(24, 1, "dynamixel_power", "RW", 0, 0, 1),
    Item(25, 1, "led", "RW", 0, 0, 255),
    Item(26, 2, "led_rgb", "RW", 0, 0, 0x7FFF),
    Item(28, 2, "buzzer", "RW", 0, 0, 65535),
    Item(30, 1, "button"),
    Item(31, 1, "present_voltage"),
    *(
        Item(32 + 2 * k, 2, name, low=-32768)
        for k, name in enumerate(
            ("gyro_x", "gyro_y", "gyro_z", "acc_x", "acc_y", "acc_z", "roll", "pitch", "yaw")
        )
    ),
    Item(50, 1, "imu_control", "RW", 0, 0, 15),
)


class OpenCr:
    """The board.

    Args:
        imu: Where its IMU gets its motion from.
        servos: What hangs on its servo power.
        baud: Its baud rate.
        supply: Battery voltage, V.
        powered: Whether the servos have power from the start; on the robot they do not.
        mounting: How its chip is turned in the body.

    Attributes:
        buttons: The buttons that are pressed.
        dead: Servos that work no more, whatever power they get.
        on_power: Called when the servo power is switched.
    """

    def __init__(
        self,
        imu: ImuSource,
        servos: Sequence[Device] = (),
        baud: int = 1_000_000,
        supply: float = 12.0,
        powered: bool = False,
        mounting: Mounting = IN_OP3,
    ) -> None:
        self.imu, self.servos, self.supply = imu, tuple(servos), supply
        self._chip = mounting.chip
        self.buttons = 0
        self.dead: list[Device] = []
        self.on_power: Callable[[bool], None] | None = None
        self.registers = RegisterFile(REGISTERS)
        self.registers.set("baud_rate", BAUD_RATES.index(baud))
        self._motion = np.zeros(9)
        self._registered: tuple[int, bytes] | None = None
        self._switch(powered, 0.0)

    @property
    def name(self) -> str:
        """What people call it."""
        return "OpenCR"

    @property
    def identifier(self) -> int:
        """Its id."""
        return self.registers.memory[3]

    @property
    def shadow(self) -> int:
        """It has no second id."""
        return 255

    @property
    def protocol(self) -> int:
        """It speaks protocol 2."""
        return 2

    @property
    def baud(self) -> int:
        """Its baud rate."""
        return BAUD_RATES[self.registers.memory[4]]

    @property
    def return_delay(self) -> float:
        """From the end of an instruction to its answer, s."""
        return self.registers.memory[5] * 2e-6

    @property
    def return_level(self) -> int:
        """What it answers: 0 pings, 1 reads as well, 2 everything."""
        return self.registers.memory[16]

    @property
    def fast(self) -> bool:
        """It does not know fast sync read."""
        return False

    @property
    def busy(self) -> bool:
        """It controls nothing."""
        return False

    @property
    def driving(self) -> bool:
        """It has no motor."""
        return False

    def listens(self, now: float) -> bool:
        """Whether it has power; with its IMU all of it is silent."""
        return self.supply > 0.0 and not self.imu.silent

    def ping(self) -> bytes:
        """Return model number and firmware version."""
        return bytes(self.registers.memory[0:3])

    def sample(self) -> None:
        """Look at the IMU."""
        motion = self._motion
        motion[0:3] = self._chip(self.imu.angular_velocity) / GYRO_UNIT
        motion[3:6] = self._chip(self.imu.acceleration) / ACCELERATION_UNIT
        motion[6:9] = 10.0 * np.degrees(roll_pitch_yaw(self.imu.orientation))

    def read(self, address: int, count: int, now: float) -> tuple[int, bytes]:
        """Return the error byte and the data of a read."""
        if self.registers.touches(address, count, *PRESENT):
            memory = self.registers.memory
            memory[30], memory[31] = self.buttons, min(255, round(self.supply * 10.0))
            values = np.clip(np.rint(self._motion), -32768, 32767)
            memory[32:50] = values.astype("<i2").tobytes()
        data = self.registers.read(address, count)
        return (OK, data) if data is not None else (BAD_ACCESS, b"")

    def write(self, address: int, data: bytes, now: float) -> int:
        """Do a write and return the error byte."""
        error, writes = self.registers.check(address, data, locked=False)
        if not error:
            self.registers.commit(writes)
            for item, value in writes:
                if item.name == "dynamixel_power":
                    self._switch(bool(value), now)
        return error

    def register_write(self, address: int, data: bytes) -> int:
        """Keep a write for `action` and return the error byte."""
        error, _ = self.registers.check(address, data, locked=False)
        if not error:
            self._registered = (address, data)
        return error

    def action(self, now: float) -> int:
        """Do the write that is kept and return the error byte."""
        if self._registered is None:
            return BAD_INSTRUCTION
        (address, data), self._registered = self._registered, None
        return self.write(address, data, now)

    def reboot(self, now: float) -> None:
        """Start again: the servos lose their power."""
        self._switch(False, now)

    def factory_reset(self, option: int, broadcast: bool, now: float) -> int:
        """It has none."""
        return BAD_INSTRUCTION

    def clear(self, parameters: bytes) -> int:
        """It has nothing to clear."""
        return BAD_RANGE

    def backup(self, parameters: bytes, now: float) -> int:
        """It has no backup."""
        return BAD_INSTRUCTION

    def overload(self, now: float) -> None:
        """It drives nothing that could be too heavy."""

    def heat(self, degrees: float) -> None:
        """It has no motor."""

    def press(self, buttons: int) -> None:
        """Press buttons, bits of `MODE_BUTTON` and the others."""
        self.buttons |= buttons

    def release(self, buttons: int) -> None:
        """Release buttons."""
        self.buttons &= ~buttons

    def control(self, now: float, dt: float) -> None:
        """It controls nothing."""

    def watch(self, now: float, dt: float, heard: float) -> None:
        """It has no watchdog."""

    def set_supply(self, volts: float, now: float) -> None:
        """Change the battery voltage."""
        self.supply = volts
        self._switch(bool(self.registers.get("dynamixel_power")), now)

    def _switch(self, on: bool, now: float) -> None:
        """Switch the servo power; servos that get it boot."""
        self.registers.set("dynamixel_power", int(on))
        for servo in self.servos:
            servo.set_supply(self.supply if on and servo not in self.dead else 0.0, now)
        if self.on_power is not None:
            self.on_power(on)


def roll_pitch_yaw(quaternion: Array) -> Array:
    """Return (3,) rad: the turns about x, then y, then z of a wxyz quaternion."""
    w, x, y, z = quaternion
    return np.array(
        [
            math.atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
            math.asin(max(-1.0, min(1.0, 2.0 * (w * y - z * x)))),
            math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)),
        ]
    )
