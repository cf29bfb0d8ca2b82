"""Bosch BNO055 on I2C: gyroscope, accelerometer and an orientation fused on the chip.

Registers, units and times are those of the data sheet BST-BNO055-DS000-14 (revision 1.4). In the
mode "IMU" the chip fuses gyroscope and accelerometer a hundred times a second, and leaves out the
magnetometer, which servos would mislead. Registers 0x08 to 0x27 hold, each little-endian::

    acceleration x y z | magnetic field x y z | angular rate x y z | Euler angles | w x y z

They are one read: 0.8 ms at 400 kHz, 3.2 ms at 100 kHz. The chip holds the clock line while it
fuses (clock stretching), which the hardware I2C of a Raspberry Pi up to 4 does not wait for: there
use a bus of the overlay `i2c-gpio`.
"""

import contextlib
from dataclasses import dataclass
from math import radians

import numpy as np

from windup.hal.backend import Clock
from windup.hal.errors import PortError
from windup.hal.geometry.gravity import STANDARD_GRAVITY
from windup.hal.imu.i2c import I2cChip, I2cOpener, open_i2c
from windup.hal.imu.kind import ImuKind
from windup.hal.imu.mounting import Mounting
from windup.hal.imu.quaternion import conjugate, multiply
from windup.hal.observation import ImuState
from windup.hal.port.replug import RETRY, Opener

ADDRESS = 0x28
"""Of the chip; 0x29 where its pin COM3 is high (section 4.6)."""
CHIP_ID, PAGE_ID, DATA, UNIT_SEL, OPR_MODE = 0x00, 0x07, 0x08, 0x3B, 0x3D
BNO055_ID = 0xA0
CONFIG, IMU_MODE = 0x00, 0x08
"""Values of OPR_MODE, whose upper four bits mean nothing (table 3-5)."""
UNITS = 0x82
"""UNIT_SEL: m/s2, rad/s, and the sense of rotation after a reset (tables 3-11 and 3-12)."""
LENGTH = 32
"""Bytes from DATA to the end of the quaternion."""
ACCELERATION = 0.01
"""m/s2 of one count (1 m/s2 = 100 LSB)."""
GYRO = 1.0 / 900.0
"""rad/s of one count (table 3-22)."""
QUATERNION = 2.0**-14
PERIOD = 0.01
"""From one sample to the next, s (table 3-14)."""
TO_CONFIG, TO_IMU = 0.019, 0.007
"""Time that a change of mode takes, s (table 3-6)."""
START_UP = 0.65
"""From power on to a chip that answers, s (table 0-2)."""
STEPS = 6
"""Changes of mode after which a chip that still does not measure never will."""
FASTEST = 36.0
"""rad/s: the gyroscope ends at 2000 degrees/s."""


class Bno055:
    """The IMU in the body frame.

    Args:
        url: Its bus, and its address if that is another one; see `windup.hal.imu.i2c`.
        mounting: How it is turned in the body.
        opener: Opens the bus.

    Attributes:
        lag: Delay of its own filters, s.
        implausible: Samples that said what cannot be.
    """

    def __init__(
        self, url: str, mounting: Mounting | None = None, opener: I2cOpener = open_i2c
    ) -> None:
        self.url, self.lag = url, BNO055.lag
        self._mounting, self._opener = mounting or Mounting(), opener
        self._back = conjugate(self._mounting.quaternion)
        self._state: ImuState | None = None
        self._data, self._at = b"", -np.inf
        self.implausible = 0

    def connect(self, opener: Opener) -> "Bno055Link":
        """Open the bus and have the chip measure; see `ImuSource`.

        Raises:
            PortError: The bus cannot be opened, or there is no BNO055 at this address.
        """
        return Bno055Link(self, self._opener(self.url, ADDRESS))

    def take(self, data: bytes, now: float) -> None:
        """Take in what the registers from DATA on hold at `now` s.

        A sample that was read before is not taken again: it ages. A new one is half a period old.
        """
        if data == self._data:
            return
        self._data = data
        counts = np.frombuffer(data, "<i2").astype(np.float64)
        orientation = counts[12:16] * QUATERNION
        rates, size = counts[6:9] * GYRO, float(np.linalg.norm(orientation))
        if not 0.9 < size < 1.1 or np.linalg.norm(rates) > FASTEST:
            self.implausible += 1
            return
        body = self._mounting.body
        self._state = ImuState(
            multiply(orientation / size, self._back),
            body(rates),
            body(counts[:3] * ACCELERATION),
            0.0,
        )
        self._at = now - 0.5 * PERIOD

    def state(self, now: float) -> ImuState | None:
        """Return the last sample, aged to `now` s, or None before the first."""
        last = self._state
        if last is None:
            return None
        return ImuState(last.orientation, last.angular_velocity, last.acceleration, now - self._at)


@dataclass
class _Setting:
    """How far the chip has been set, which takes some steps with waits between them.

    Attributes:
        due: When the next step may be taken, s.
        done: It measures.
    """

    due: float = -np.inf
    done: bool = False


class Bno055Link:
    """A BNO055 and its bus, which may lose the chip and find it again; an `ImuConnection`.

    Args:
        imu: Who takes the samples.
        chip: The chip on its bus.

    Raises:
        PortError: There is no BNO055.
    """

    def __init__(self, imu: Bno055, chip: I2cChip) -> None:
        self._imu, self._chip = imu, chip
        self.clock: Clock = chip.clock
        self._setting = _Setting()
        try:
            self._find()
            self._begin()
        except OSError as error:
            chip.close()
            raise PortError(f"the BNO055 of {imu.url} stopped answering: {error}") from None
        except BaseException:
            chip.close()
            raise

    def poll(self) -> None:
        """Read the newest sample, if the chip measures; bring it there again after a reset."""
        now = self.clock.now()
        try:
            if self._set_up(now):
                self._imu.take(self._chip.read(DATA, LENGTH), self.clock.now())
        except OSError:  # unplugged: the last sample ages, and whoever needs it stops
            self._setting = _Setting(due=now + RETRY)

    def close(self) -> None:
        """Give the bus back. The chip goes on measuring."""
        with contextlib.suppress(OSError):
            self._chip.close()

    def _find(self) -> None:
        """Wait for the chip, which may have got its power a moment ago."""
        end = self.clock.now() + START_UP
        while (found := self._identity()) != BNO055_ID:
            if self.clock.now() > end:
                what = "nothing answers" if found is None else f"a chip with id 0x{found:02X} is"
                raise PortError(
                    f"{self._imu.url}: {what} where a BNO055 should be; `i2cdetect -y 1` shows the "
                    "addresses that answer"
                )
            self.clock.wait_until(self.clock.now() + PERIOD)

    def _begin(self) -> None:
        """Have the chip measure, with the waits that takes.

        Raises:
            PortError: It does not take its settings.
            OSError: It stopped answering.
        """
        for _ in range(STEPS):
            if self._set_up(self.clock.now()):
                return
            self.clock.wait_until(self._setting.due)
        raise PortError(f"{self._imu.url}: the BNO055 does not take its mode: power it off and on")

    def _identity(self) -> int | None:
        try:
            return self._chip.read(CHIP_ID, 1)[0]
        except OSError:
            return None

    def _set_up(self, now: float) -> bool:
        """Take the next step to a chip that measures in our units; return whether it does.

        Raises:
            OSError: The chip did not answer.
        """
        setting, chip = self._setting, self._chip
        if setting.done or now < setting.due:
            return setting.done
        mode = chip.read(OPR_MODE, 1)[0] & 0x0F
        if mode == IMU_MODE and chip.read(UNIT_SEL, 1)[0] == UNITS:
            setting.done = True
        elif mode == CONFIG:
            chip.write(PAGE_ID, 0)
            chip.write(UNIT_SEL, UNITS)
            chip.write(OPR_MODE, IMU_MODE)
            setting.due = now + TO_IMU
        else:
            chip.write(OPR_MODE, CONFIG)
            setting.due = now + TO_CONFIG
        return setting.done


BNO055 = ImuKind(
    name="bno055",
    wiring="i2c",
    rate=1.0 / PERIOD,
    cutoff=32.0,  # the gyroscope's; the accelerometer's is 62.5 Hz (table 3-4)
    noise=(radians(0.014), 150e-6 * STANDARD_GRAVITY),  # typical, table 0-2
    bias=(radians(0.3), 0.05),  # our guess of what its calibration while it runs leaves
    unit=(GYRO, ACCELERATION),
    driver=Bno055,
)
