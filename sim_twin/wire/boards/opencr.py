"""The OpenCR board of the OP3: IMU, supply voltage, buttons and the servo power switch.

A Dynamixel protocol 2 device with id 200. Its registers are those of the OP3's firmware
(`dxl_node_op3.cpp` of ROBOTIS' OpenCR). Roll, pitch and yaw are signed tenths of a degree, unlike
in the device file of the ROBOTIS framework. The fourth button, reset (bit 3), which switches the
servo power off when it is held for 0.1 s, is not emulated.
"""

import math
from collections.abc import Callable, Sequence

import numpy as np

from windup.hal.geometry.gravity import STANDARD_GRAVITY
from windup.hal.geometry.quaternion import roll_pitch_yaw
from windup.hal.imu.mounting import Mounting
from windup.hal.imu.opencr import IN_OP3
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.imu.imu import ImuSource
from windup.sim_twin.wire.servos.register_file import (
    BAD_ACCESS,
    BAD_INSTRUCTION,
    BAD_RANGE,
    OK,
    RegisterFile,
    TableItem,
)
from windup.sim_twin.wire.servos.x_series import BAUD_RATES

GYRO_UNIT = math.radians(2000.0 / 32800.0)  # rad/s per count
ACCELERATION_UNIT = 2.0 / 32768.0 * STANDARD_GRAVITY  # m/s2 per count
MODE_BUTTON, START_BUTTON, USER_BUTTON = 0x01, 0x02, 0x04
PRESENT = (30, 49)

REGISTERS = (
    TableItem(0, 2, "model_number", default=0x7400),
    TableItem(2, 1, "firmware_version", default=1),
    TableItem(3, 1, "id", "RW", 200, 0, 252),
    TableItem(4, 1, "baud_rate", "RW", 3, 0, 7),
    TableItem(5, 1, "return_delay_time", "RW", 0, 0, 254),
    TableItem(16, 1, "status_return_level", "RW", 2, 0, 2),
    TableItem(18, 2, "roll_offset", "RW", 0, -32768, 32767),
    TableItem(20, 2, "pitch_offset", "RW", 0, -32768, 32767),
    TableItem(22, 2, "yaw_offset", "RW", 0, -32768, 32767),
    TableItem(24, 1, "dynamixel_power", "RW", 0, 0, 1),
    TableItem(25, 1, "led", "RW", 0, 0, 255),
    TableItem(26, 2, "led_rgb", "RW", 0, 0, 0x7FFF),
    TableItem(28, 2, "buzzer", "RW", 0, 0, 65535),
    TableItem(30, 1, "button"),
    TableItem(31, 1, "present_voltage"),
    *(
        TableItem(32 + 2 * k, 2, name, low=-32768)
        for k, name in enumerate(
            ("gyro_x", "gyro_y", "gyro_z", "acc_x", "acc_y", "acc_z", "roll", "pitch", "yaw")
        )
    ),
    TableItem(50, 1, "imu_control", "RW", 0, 0, 15),
)


class OpenCr:
    """An emulated OpenCR board.

    Args:
        imu: Source of the motion that its IMU measures.
        servos: The devices that its servo power supplies.
        baud: Baud rate.
        supply: Battery voltage, V.
        powered: Whether the servos are powered from the start; on the robot they are not.
        mounting: Orientation of its chip in the body.

    Attributes:
        buttons: Bit mask of the pressed buttons.
        dead: Servos that stay broken even when they are powered again.
        on_power: Called with the new state when the servo power is switched.
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
        self._chip = mounting.to_imu
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
        """Name for messages."""
        return "OpenCR"

    @property
    def identifier(self) -> int:
        """Bus id."""
        return self.registers.memory[3]

    @property
    def secondary_id(self) -> int:
        """No secondary id."""
        return 255

    @property
    def protocol(self) -> int:
        """Protocol version, 2."""
        return 2

    @property
    def baud(self) -> int:
        """Baud rate."""
        return BAUD_RATES[self.registers.memory[4]]

    @property
    def return_delay(self) -> float:
        """Delay from the end of an instruction to the status packet, s."""
        return self.registers.memory[5] * 2e-6

    @property
    def return_level(self) -> int:
        """Status return level: 0 answers pings, 1 also reads, 2 all instructions."""
        return self.registers.memory[16]

    @property
    def fast(self) -> bool:
        """False: fast sync read is not supported."""
        return False

    @property
    def busy(self) -> bool:
        """False: there is no control loop to step."""
        return False

    @property
    def driving(self) -> bool:
        """False: there is no motor."""
        return False

    def listens(self, now: float) -> bool:
        """Whether the board is powered; it does not respond at all while its IMU is silent."""
        return self.supply > 0.0 and not self.imu.silent

    def ping(self) -> bytes:
        """Return model number and firmware version."""
        return bytes(self.registers.memory[0:3])

    def sample(self) -> None:
        """Sample the IMU for the next `read`."""
        motion = self._motion
        motion[0:3] = self._chip(self.imu.angular_velocity) / GYRO_UNIT
        motion[3:6] = self._chip(self.imu.acceleration) / ACCELERATION_UNIT
        motion[6:9] = 10.0 * np.degrees(roll_pitch_yaw(self.imu.orientation))

    def read(self, address: int, count: int, now: float) -> tuple[int, bytes]:
        """Return the error byte and the data of a read instruction."""
        if self.registers.touches(address, count, *PRESENT):
            memory = self.registers.memory
            memory[30], memory[31] = self.buttons, min(255, round(self.supply * 10.0))
            values = np.clip(np.rint(self._motion), -32768, 32767)
            memory[32:50] = values.astype("<i2").tobytes()
        data = self.registers.read(address, count)
        return (OK, data) if data is not None else (BAD_ACCESS, b"")

    def write(self, address: int, data: bytes, now: float) -> int:
        """Execute a write and return the error byte."""
        error, writes = self.registers.check(address, data, locked=False)
        if not error:
            self.registers.commit(writes)
            for item, value in writes:
                if item.name == "dynamixel_power":
                    self._switch(bool(value), now)
        return error

    def register_write(self, address: int, data: bytes) -> int:
        """Store a write for `action` and return the error byte."""
        error, _ = self.registers.check(address, data, locked=False)
        if not error:
            self._registered = (address, data)
        return error

    def action(self, now: float) -> int:
        """Execute the stored write and return the error byte."""
        if self._registered is None:
            return BAD_INSTRUCTION
        (address, data), self._registered = self._registered, None
        return self.write(address, data, now)

    def reboot(self, now: float) -> None:
        """Reboot; this switches the servo power off."""
        self._switch(False, now)

    def factory_reset(self, option: int, broadcast: bool, now: float) -> int:
        """Reject the instruction: the board does not support it."""
        return BAD_INSTRUCTION

    def clear(self, parameters: bytes) -> int:
        """Reject the instruction: there is nothing to clear."""
        return BAD_RANGE

    def backup(self, parameters: bytes, now: float) -> int:
        """Reject the instruction: the board has no backup."""
        return BAD_INSTRUCTION

    def overload(self, now: float) -> None:
        """Do nothing: there is no motor to overload."""

    def heat(self, degrees: float) -> None:
        """Do nothing: there is no motor to heat."""

    def press(self, buttons: int) -> None:
        """Press buttons, given as bits such as `MODE_BUTTON`."""
        self.buttons |= buttons

    def release(self, buttons: int) -> None:
        """Release buttons, given as bits."""
        self.buttons &= ~buttons

    def control(self, now: float, dt: float) -> None:
        """Do nothing: there is no control loop."""

    def watch(self, now: float, dt: float, last_instruction: float) -> None:
        """Do nothing: there is no watchdog."""

    def set_supply(self, volts: float, now: float) -> None:
        """Change the battery voltage, V."""
        self.supply = volts
        self._switch(bool(self.registers.get("dynamixel_power")), now)

    def _switch(self, on: bool, now: float) -> None:
        """Switch the servo power; servos that become powered boot."""
        self.registers.set("dynamixel_power", int(on))
        for servo in self.servos:
            servo.set_supply(self.supply if on and servo not in self.dead else 0.0, now)
        if self.on_power is not None:
            self.on_power(on)
