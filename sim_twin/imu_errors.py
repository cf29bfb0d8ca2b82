"""Error model of an IMU: low-pass filter, noise, bias and quantisation to counts."""

from dataclasses import dataclass
from math import pi, radians

import numpy as np

from windup.hal.imu.opencr import ACCELERATION, CUTOFF, GYRO
from windup.hal.joints import Array


@dataclass(frozen=True)
class ImuFigures:
    """Error parameters of an IMU, as (gyro, accelerometer) pairs.

    Attributes:
        cutoff: Cutoff frequency of the low-pass filter, modelled as first order, Hz.
        noise: Noise densities, rad/s/sqrt(Hz) and m/s2/sqrt(Hz).
        bias: Standard deviations of the bias on each axis, rad/s and m/s2.
        unit: Size of one count, rad/s and m/s2.
    """

    cutoff: float
    noise: tuple[float, float]
    bias: tuple[float, float]
    unit: tuple[float, float]

    @property
    def lag(self) -> float:
        """Time constant of the filter, s."""
        return 1.0 / (2.0 * pi * self.cutoff)


OPENCR = ImuFigures(
    cutoff=CUTOFF,
    noise=(radians(0.01), 300e-6 * 9.80665),  # from the data sheet
    bias=(radians(0.3), 0.05),  # our guess of the residual after calibration at rest
    unit=(GYRO, ACCELERATION),
)


class LowPass:
    """A first-order low-pass filter for an array of signals.

    Args:
        lag: Time constant, s.
        timestep: Time between two calls of `follow`, s.
    """

    def __init__(self, lag: float, timestep: float) -> None:
        self._gain = 1.0 - np.exp(-timestep / lag)
        self._value: Array | None = None

    def follow(self, signal: Array) -> None:
        """Advance the filter by one time step with input `signal`."""
        if self._value is None:
            self._value = np.array(signal)
        else:
            self._value += self._gain * (signal - self._value)

    def value(self, signal: Array) -> Array:
        """Return the filtered signal; before the first `follow`, return `signal` itself."""
        return np.array(signal if self._value is None else self._value)


class ImuErrors:
    """Turns true motion into IMU samples with errors.

    Args:
        figures: Error parameters of the IMU.
        timestep: Time between two calls of `feel`, s.
        seed: Seed of noise and biases.

    Attributes:
        bias: (6,) biases of gyro and accelerometer, rad/s and m/s2.
    """

    def __init__(self, figures: ImuFigures, timestep: float, seed: int = 0) -> None:
        self._random = np.random.default_rng(seed)
        self._filter = LowPass(figures.lag, timestep)
        bandwidth = 0.5 * pi * figures.cutoff
        self._noise = np.repeat(figures.noise, 3) * bandwidth**0.5
        self._unit = np.repeat(figures.unit, 3)
        self.bias = self._random.normal(size=6) * np.repeat(figures.bias, 3)

    def feel(self, motion: Array) -> None:
        """Filter the true angular rates and accelerations (6,) of one time step."""
        self._filter.follow(motion)

    def sample(self, motion: Array) -> Array:
        """Return a sample (6,) with errors; `motion` (6,) is its input until the first `feel`."""
        noise = self._noise * self._random.normal(size=6)
        return np.rint((self._filter.value(motion) + self.bias + noise) / self._unit) * self._unit
