"""The parameters of one kind of IMU: rate, lag, noise, wiring and mounting."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from math import pi
from typing import Literal

from windup.hal.imu.mounting import STRAIGHT, Axes, Mounting
from windup.hal.imu.source import ImuSource


@dataclass(frozen=True)
class ImuKind:
    """What one kind of IMU measures and how it is connected.

    Attributes:
        name: Its name in `[imu] kind` of a robot.toml.
        wiring: "board": a device on the first servo bus, read with the servos; "serial" or "i2c":
            a port of its own, named "imu".
        rate: Sample rate, Hz.
        cutoff: Cutoff frequency of its low-pass filter, modelled as first order, Hz.
        noise: Noise densities of gyroscope and accelerometer, rad/s/sqrt(Hz) and m/s2/sqrt(Hz).
        bias: Standard deviations of the biases on each axis, rad/s and m/s2.
        count_size: Size of one count, rad/s and m/s2.
        gyroscope: It sends angular rates. An IMU without sends its orientation, and rates are
            differences of orientations.
        axes: Default mounting, see `Mounting`.
        driver: Makes the driver of an IMU with a port of its own, from URL and mounting.
    """

    name: str
    wiring: Literal["board", "serial", "i2c"]
    rate: float
    cutoff: float
    noise: tuple[float, float]
    bias: tuple[float, float]
    count_size: tuple[float, float]
    gyroscope: bool = True
    axes: Axes = STRAIGHT
    driver: Callable[[str, Mounting], ImuSource] | None = field(default=None, repr=False)

    @property
    def lag(self) -> float:
        """Delay of its filter, s."""
        return 1.0 / (2.0 * pi * self.cutoff)

    @cached_property
    def mounting(self) -> Mounting:
        """Orientation of its axes in the body.

        Raises:
            ConfigError: The axes are not those of a rotation.
        """
        return Mounting(self.axes)
