"""What a real IMU does to the twin's true motion: a low-pass filter, noise, bias, and counts."""

from dataclasses import dataclass
from math import pi, radians

import numpy as np

from windup.hal.imu.opencr import ACCELERATION, CUTOFF, GYRO
from windup.hal.joints import Array


@dataclass(frozen=True)
class ImuFigures:
    """Figures of an IMU, gyro and accelerometer; the biases are standard deviations.

    Attributes:
        cutoff: Of its low-pass filter, taken as one of first order, Hz.
        noise: Densities, rad/s and m/s2 in a root of hertz.
        bias: rad/s and m/s2, on each axis.
        unit: One count, rad/s and m/s2.
    """

    cutoff: float
    noise: tuple[float, float]
    bias: tuple[float, float]
    unit: tuple[float, float]

    @property
    def lag(self) -> float:
        """Delay of the filter, s."""
        return 1.0 / (2.0 * pi * self.cutoff)


OPENCR = ImuFigures(
    cutoff=CUTOFF,
    noise=(radians(0.01), 300e-6 * 9.80665),  # its data sheet
    bias=(radians(0.3), 0.05),  # our guess of what the calibration at rest leaves
    unit=(GYRO, ACCELERATION),
)


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
        figures: The IMU.
        timestep: Time between two calls of `feel`, s.
        seed: Seed of its noise and biases.

    Attributes:
        bias: (6,) rad/s and m/s2.
    """

    def __init__(self, figures: ImuFigures, timestep: float, seed: int = 0) -> None:
        self._random = np.random.default_rng(seed)
        self._filter = LowPass(figures.lag, timestep)
        bandwidth = 0.5 * pi * figures.cutoff
        self._noise = np.repeat(figures.noise, 3) * bandwidth**0.5
        self._unit = np.repeat(figures.unit, 3)
        self.bias = self._random.normal(size=6) * np.repeat(figures.bias, 3)

    def feel(self, motion: Array) -> None:
        """Take the true rates and accelerations (6,) of one time step."""
        self._filter.follow(motion)

    def sample(self, motion: Array) -> Array:
        """Return what the IMU says (6,); `motion` (6,) is the true one, before any `feel`."""
        noise = self._noise * self._random.normal(size=6)
        return np.rint((self._filter.value(motion) + self.bias + noise) / self._unit) * self._unit
