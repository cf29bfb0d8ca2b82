"""The OpenCR board of a ROBOTIS humanoid: a Dynamixel slave with an IMU, on the servos' bus.

Scales, addresses and axis signs are those of ROBOTIS' OpenCR firmware for the OP3 and of its host
driver (Apache-2.0). The board's own roll, pitch and yaw are left alone, as that driver does: the
attitude is the estimator's business.
"""

from dataclasses import dataclass
from math import pi, radians

import numpy as np

from windup.hal.geometry.gravity import STANDARD_GRAVITY
from windup.hal.imu.kind import ImuKind
from windup.hal.imu.mounting import Mounting
from windup.hal.observation import ImuState
from windup.hal.protocols.protocol2 import Span
from windup.hal.registers import Register

MODEL_NUMBER = 0x7400
"""What the board answers to a ping."""
GYRO = 2000.0 / 32800.0 * pi / 180.0
"""rad/s of one count."""
ACCELERATION = 2.0 / 32768.0 * STANDARD_GRAVITY
"""m/s2 of one count."""
IN_OP3 = Mounting(("-x", "-y", "z"))
"""How the chip of its board is turned in the body of an OP3."""
POWER = Register("dynamixel_power", 24, 1)
"""1: the servos of the bus have power."""
POWER_UP_TIME = 0.5
"""From switching that power on to servos that answer, s."""
CUTOFF = 41.0
"""Of the low-pass filter of gyroscope and accelerometer (MPU9250), as the firmware sets it, Hz."""
VOLTAGE = Register("present_voltage", 31, 1)
BUTTONS = ("mode", "start", "user", "reset")
"""Names on the back of the robot, from the lowest bit of register 30 up (`dxl_node_op3.cpp`).

The firmware ignores what bounces for less than 30 ms. Held for 0.1 s, "reset" also takes the power
from the servos, without asking a host.
"""


@dataclass(frozen=True)
class OpenCr:
    """Where the board is and how it is turned in the body.

    Attributes:
        bus: Name of its bus.
        id: Its id there.
        mounting: How the chip is turned in the body; by default as in an OP3.
    """

    bus: str
    id: int = 200
    mounting: Mounting = IN_OP3

    @property
    def span(self) -> Span:
        """Buttons, voltage, gyroscope, accelerometer and angles in one run of registers."""
        return Span(self.id, 30, 20)

    @property
    def lag(self) -> float:
        """Delay of the sensor's own filter, taken as one of first order, s."""
        return OPENCR.lag

    def buttons(self, data: bytes) -> tuple[str, ...]:
        """Return the names of the buttons that are down in the bytes of `span`."""
        down = data[0]
        return tuple(name for bit, name in enumerate(BUTTONS) if down >> bit & 1) if down else ()

    def decode(self, data: bytes, age: float) -> ImuState:
        """Return the sample in the bytes of `span`, `age` s old, in the body frame."""
        counts = np.frombuffer(data, "<i2", count=6, offset=2).astype(np.float64)
        body = self.mounting.to_body
        return ImuState(None, body(counts[:3]) * GYRO, body(counts[3:]) * ACCELERATION, age)


OPENCR = ImuKind(
    name="opencr",
    wiring="board",
    rate=1000.0,  # the firmware's loop over the chip
    cutoff=CUTOFF,
    noise=(radians(0.01), 300e-6 * STANDARD_GRAVITY),  # data sheet of the MPU9250, tables 1 and 2
    bias=(radians(0.3), 0.05),  # our guess of the residual after calibration at rest
    count_size=(GYRO, ACCELERATION),
    axes=IN_OP3.axes,
)
