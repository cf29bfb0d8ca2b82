"""What a real IMU does to the twin's true motion: a low-pass filter, noise, bias, and counts."""

from math import pi

import numpy as np

from windup.hal.imu.kind import ImuKind
from windup.hal.imu.opencr import OPENCR
from windup.hal.joints import Array
from windup.robots import RobotDescription


def imu_on_twin(robot: RobotDescription) -> ImuKind:
    """Return the IMU that a twin without a wire has where its robot's state is estimated.

    A twin feels rates and accelerations. For a robot whose IMU sends no rates, or that has none,
    that is an OpenCR; behind ``twin://`` it has its own.
    """
    kind = robot.imu_kind
    return kind if kind is not None and kind.gyroscope else OPENCR


class LowPass:
    """A low-pass filter of first order, for as many signals as come.

    Args:
        lag: Its time constant, s.
        timestep: Time between two calls of `follow`, s.
    """

    def __init__(self, lag: float, timestep: float) -> None:
        self._gain = 1.0 - np.exp(-timestep / lag)
        self._value: Array | None = None

    def follow(self, signal: Array) -> None:
        """Let one time step pass with `signal`."""
        if self._value is None:
            self._value = np.array(signal)
        else:
            self._value += self._gain * (signal - self._value)

    def value(self, signal: Array) -> Array:
        """Return the filtered signal; before the first step that is `signal`."""
        return np.array(signal if self._value is None else self._value)


class ImuErrors:
    """Turns true motion into samples.

    Args:
        kind: The IMU.
        timestep: Time between two calls of `feel`, s.
        seed: Seed of its noise and biases.

    Attributes:
        bias: (6,) rad/s and m/s2.
    """

    def __init__(self, kind: ImuKind, timestep: float, seed: int = 0) -> None:
        self._random = np.random.default_rng(seed)
        self._filter = LowPass(kind.lag, timestep)
        bandwidth = 0.5 * pi * kind.cutoff
        self._noise = np.repeat(kind.noise, 3) * bandwidth**0.5
        self._unit = np.repeat(kind.unit, 3)
        self.bias = self._random.normal(size=6) * np.repeat(kind.bias, 3)

    def feel(self, motion: Array) -> None:
        """Take the true rates and accelerations (6,) of one time step."""
        self._filter.follow(motion)

    def sample(self, motion: Array) -> Array:
        """Return what the IMU says (6,); `motion` (6,) is the true one, before any `feel`."""
        noise = self._noise * self._random.normal(size=6)
        return np.rint((self._filter.value(motion) + self.bias + noise) / self._unit) * self._unit
