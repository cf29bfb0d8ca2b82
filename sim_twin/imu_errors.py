"""Error model of an IMU: low-pass filter, noise, bias and quantisation to counts."""

from math import pi

import numpy as np

from windup.hal.imu.kind import ImuKind
from windup.hal.imu.opencr import OPENCR
from windup.hal.joints import Array
from windup.robots import RobotDescription


def imu_on_twin(robot: RobotDescription) -> ImuKind:
    """Return the IMU of a twin without a wire whose base state is estimated.

    A twin measures angular rates and accelerations. Robots without an IMU, or with one that sends
    no rates, get an OpenCR; behind ``twin://`` the robot's own IMU is emulated.
    """
    kind = robot.imu_kind
    return kind if kind is not None and kind.gyroscope else OPENCR


class LowPass:
    """A first-order low-pass filter for an array of signals.

    Args:
        lag: Time constant, s.
        timestep: Time between two calls of `update`, s.
    """

    def __init__(self, lag: float, timestep: float) -> None:
        self._gain = 1.0 - np.exp(-timestep / lag)
        self._value: Array | None = None

    def update(self, signal: Array) -> None:
        """Advance the filter by one time step with input `signal`."""
        if self._value is None:
            self._value = np.array(signal)
        else:
            self._value += self._gain * (signal - self._value)

    def value(self, signal: Array) -> Array:
        """Return the filtered signal; before the first `update`, return `signal` itself."""
        return np.array(signal if self._value is None else self._value)


class ImuErrors:
    """Turns true motion into IMU samples with errors.

    Args:
        kind: The IMU.
        timestep: Time between two calls of `filter_motion`, s.
        seed: Seed of noise and biases.

    Attributes:
        bias: (6,) biases of gyro and accelerometer, rad/s and m/s2.
    """

    def __init__(self, kind: ImuKind, timestep: float, seed: int = 0) -> None:
        self._random = np.random.default_rng(seed)
        self._filter = LowPass(kind.lag, timestep)
        bandwidth = 0.5 * pi * kind.cutoff
        self._noise = np.repeat(kind.noise, 3) * bandwidth**0.5
        self._unit = np.repeat(kind.count_size, 3)
        self.bias = self._random.normal(size=6) * np.repeat(kind.bias, 3)

    def filter_motion(self, motion: Array) -> None:
        """Filter the true angular rates and accelerations (6,) of one time step."""
        self._filter.update(motion)

    def sample(self, motion: Array) -> Array:
        """Return a sample (6,) with errors; before any `filter_motion`, of `motion` (6,)."""
        noise = self._noise * self._random.normal(size=6)
        return np.rint((self._filter.value(motion) + self.bias + noise) / self._unit) * self._unit
