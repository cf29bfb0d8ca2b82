"""Bosch BNO055 on I2C: gyroscope, accelerometer and an orientation fused on the chip.

Registers, units and times are those of the data sheet BST-BNO055-DS000-14 (revision 1.4). In the
mode "IMU" the chip fuses gyroscope and accelerometer at 100 Hz, without the magnetometer, which
servo currents disturb. Registers 0x08 to 0x27 hold, each little-endian::

    acceleration x y z | magnetic field x y z | angular rate x y z | Euler angles | w x y z

They are one read: 0.8 ms at 400 kHz, 3.2 ms at 100 kHz. The chip stretches the I2C clock, which
the I2C hardware of Raspberry Pis mishandles (learn.adafruit.com, "Raspberry Pi I2C clock stretching
fixes"): use a bus of the `i2c-gpio` overlay.
"""

import contextlib
from dataclasses import dataclass
from math import radians

import numpy as np

from windup.hal.backend import Clock
from windup.hal.errors import PortError
from windup.hal.geometry.gravity import STANDARD_GRAVITY
from windup.hal.geometry.quaternion import conjugate, multiply
from windup.hal.imu.i2c import I2cChip, I2cOpener, open_i2c
from windup.hal.imu.kind import ImuKind
from windup.hal.imu.mounting import Mounting
from windup.hal.observation import ImuState
from windup.hal.port.port_reopener import RETRY, Opener

ADDRESS = 0x28
"""I2C address of the chip; 0x29 if its pin COM3 is high (section 4.6)."""
CHIP_ID, PAGE_ID, DATA, UNIT_SEL, OPR_MODE = 0x00, 0x07, 0x08, 0x3B, 0x3D
AXIS_MAP_CONFIG, AXIS_MAP_SIGN = 0x41, 0x42
STRAIGHT_AXES = 0x24, 0x00
"""Reset values of AXIS_MAP_CONFIG and AXIS_MAP_SIGN: the chip's own axes (section 3.4). Another
program may have left others, which survive a change of mode; `mounting` counts from the chip's own.
"""
BNO055_ID = 0xA0
CONFIG, IMU_MODE = 0x00, 0x08
"""Values of OPR_MODE; its upper four bits are unused (table 3-5)."""
UNITS = 0x82
"""UNIT_SEL: m/s2 and rad/s; the orientation format is the default (tables 3-11 and 3-12)."""
LENGTH = 32
"""Number of bytes from DATA to the end of the quaternion."""
ACCELERATION = 0.01
"""m/s2 of one count (1 m/s2 = 100 LSB)."""
GYRO = 1.0 / 900.0
"""rad/s of one count (table 3-22)."""
QUATERNION = 2.0**-14
PERIOD = 0.01
"""Sample period, s (table 3-14)."""
TO_CONFIG, TO_IMU = 0.019, 0.007
"""Duration of a change of mode, s (table 3-6)."""
START_UP = 0.65
"""How long a chip that was powered on or reset is waited for, s (table 0-2)."""
STEPS = 6
"""Maximum number of changes of mode until the chip measures."""
FASTEST = 36.0
"""Maximum plausible rate, rad/s: the range of the gyroscope is 2000 degrees/s."""


class Bno055:
    """Driver of a BNO055; its samples are in the body frame.

    Args:
        url: URL of its I2C bus, see `windup.hal.imu.i2c`.
        mounting: Orientation of the chip in the body.
        opener: Opens the bus.

    Attributes:
        lag: Delay of the chip's filters, s.
        implausible: Number of samples outside the physical range.
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
        """Open the bus and start the chip; see `ImuSource`.

        Raises:
            PortError: The bus cannot be opened, or there is no BNO055 at this address.
        """
        return Bno055Link(self, self._opener(self.url, ADDRESS))

    def decode(self, data: bytes, now: float) -> None:
        """Decode the registers from DATA on, read at `now` s.

        A new sample is half a period old on average. An unchanged one was read before: it ages.
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
        body = self._mounting.to_body
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
    """Progress of configuring the chip, in steps with waits between them.

    Attributes:
        due: Earliest time of the next step, s.
        done: The chip measures.
    """

    due: float = -np.inf
    done: bool = False


class Bno055Link:
    """An open BNO055, which is configured again after it lost power; an `ImuConnection`.

    Args:
        imu: Decodes the samples.
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
        """Read the newest sample; configure the chip again if it was reset."""
        now = self.clock.now()
        try:
            if self._set_up(now):
                self._imu.decode(self._chip.read(DATA, LENGTH), self.clock.now())
        except OSError:  # unplugged: the last sample ages until the IMU watch reports it as silent
            self._setting = _Setting(due=now + RETRY)

    def close(self) -> None:
        """Give the bus back. The chip goes on measuring."""
        with contextlib.suppress(OSError):
            self._chip.close()

    def _find(self) -> None:
        """Wait until the chip answers: it may have been powered a moment ago."""
        end = self.clock.now() + START_UP
        while (found := self._identity()) != BNO055_ID:
            if self.clock.now() > end:
                what = "nothing answers" if found is None else f"a chip with id 0x{found:02X} is"
                raise PortError(
                    f"{self._imu.url}: {what} where a BNO055 should be; check its power and wires; "
                    "`i2cdetect -y N` shows which addresses answer on /dev/i2c-N"
                )
            self.clock.wait_until(self.clock.now() + PERIOD)

    def _begin(self) -> None:
        """Configure the chip, with the waits that this takes.

        Raises:
            PortError: It does not take its settings.
            OSError: It stopped answering.
        """
        for _ in range(STEPS):
            if self._set_up(self.clock.now()):
                return
            self.clock.wait_until(self._setting.due)
        raise PortError(
            f"{self._imu.url}: the BNO055 does not enter its IMU mode: switch its power off and on"
        )

    def _identity(self) -> int | None:
        try:
            return self._chip.read(CHIP_ID, 1)[0]
        except OSError:
            return None

    def _set_up(self, now: float) -> bool:
        """Do the next step of configuring the chip; return whether it measures in our units.

        Raises:
            OSError: The chip did not answer.
        """
        setting, chip = self._setting, self._chip
        if setting.done or now < setting.due:
            return setting.done
        mode = chip.read(OPR_MODE, 1)[0] & 0x0F
        if mode == IMU_MODE and self._is_set():
            setting.done = True
        elif mode == CONFIG:
            chip.write(PAGE_ID, 0)
            chip.write(UNIT_SEL, UNITS)
            chip.write(AXIS_MAP_CONFIG, STRAIGHT_AXES[0])
            chip.write(AXIS_MAP_SIGN, STRAIGHT_AXES[1])
            chip.write(OPR_MODE, IMU_MODE)
            setting.due = now + TO_IMU
        else:
            chip.write(OPR_MODE, CONFIG)
            setting.due = now + TO_CONFIG
        return setting.done

    def _is_set(self) -> bool:
        """Return whether the chip has our units and its own axes."""
        axes = tuple(self._chip.read(AXIS_MAP_CONFIG, 2))
        return axes == STRAIGHT_AXES and self._chip.read(UNIT_SEL, 1)[0] == UNITS


BNO055 = ImuKind(
    name="bno055",
    wiring="i2c",
    rate=1.0 / PERIOD,
    cutoff=32.0,  # the gyroscope's; the accelerometer's is 62.5 Hz (table 3-4)
    noise=(radians(0.014), 150e-6 * STANDARD_GRAVITY),  # typical, table 0-2
    bias=(radians(0.3), 0.05),  # our guess of the residual after its continuous calibration
    count_size=(GYRO, ACCELERATION),
    driver=Bno055,
)
