"""A kind of IMU: all that the stack has to know of it, as one small table."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from math import pi
from typing import Literal

from windup.hal.imu.mounting import STRAIGHT, Axes, Mounting
from windup.hal.imu.source import ImuSource


@dataclass(frozen=True)
class ImuKind:
    """What one kind of IMU measures, how late, how noisily, and how it is connected.

    Attributes:
        name: What `[imu] kind` of a robot.toml calls it.
        wiring: "board": it is a device on the first servo bus, read with the servos; "serial" or
            "i2c": it has a connection of its own, the port "imu".
        rate: New samples a second, Hz.
        cutoff: Of its own low-pass filter, taken as one of first order, Hz.
        noise: Densities of gyroscope and accelerometer, rad/s and m/s2 in a root of hertz.
        bias: Standard deviations on each axis, rad/s and m/s2.
        unit: One count, rad/s and m/s2.
        gyroscope: It sends angular rates. One without sends its orientation, and rates are
            differences of that.
        axes: How it is mounted unless robot.toml says otherwise, see `Mounting`.
        driver: Makes the driver of one with a connection of its own from URL and mounting.
    """

    name: str
    wiring: Literal["board", "serial", "i2c"]
    rate: float
    cutoff: float
    noise: tuple[float, float]
    bias: tuple[float, float]
    unit: tuple[float, float]
    gyroscope: bool = True
    axes: Axes = STRAIGHT
    driver: Callable[[str, Mounting], ImuSource] | None = field(default=None, repr=False)

    @property
    def lag(self) -> float:
        """Delay of its own filter, s."""
        return 1.0 / (2.0 * pi * self.cutoff)

    @cached_property
    def mounting(self) -> Mounting:
        """How its axes lie in the body.

        Raises:
            ConfigError: They cannot lie so.
        """
        return Mounting(self.axes)
