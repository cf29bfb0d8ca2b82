"""Detects gyroscope rates that contradict the accelerometer or the joints.

A body that starts to turn suddenly has been pushed, which the accelerometer measures: a jump of the
rates without an acceleration is doubted from the first sample, and reported if it lasts. A rate
error that begins slowly is found by comparing the accelerometer with the vertical integrated from
the gyroscope (slowly corrected by the accelerometer). A fall differs from that: a body that tips
over measures less than gravity. Only if the accelerometer measures gravity alone, from another
direction and for `MIN_DURATION`, the gyroscope is wrong. An accelerometer cannot measure a turn
about the vertical: there, a robot whose joints stand still is taken not to turn on its feet.
"""

from collections.abc import Sequence
from math import acos, exp, pi, sqrt

import numpy as np

from windup.hal.geometry.gravity import GRAVITY
from windup.hal.guard.finding import AGAIN, FindingText
from windup.hal.joints import Array

MIN_JUMP = 0.7
"""Minimum change of the rates from one sample to the next that is doubted if the accelerometer
shows no matching change, for a body at rest, rad/s."""
MIN_JUMP_PER_RATE = 1.0
"""Increase of `MIN_JUMP` per rad/s of body rate (rms of the last second): a foot impact may fall
between two samples, and changes the rates of a walking body as suddenly."""
YAW_DIVISOR = 1.6
"""Divisor of rate changes about the vertical: a body that begins to turn on one foot, below its
IMU, accelerates it little. Ducks that slip while walking reach 0.8 rad/s."""
MIN_SHOCK = 1.4
"""Minimum change of acceleration, or deviation from gravity, that explains a jump: m/s2 per rad/s.
Twins that are pushed, fall, roll over and get up show 2.3 or more."""
MAX_SAMPLE_GAP = 0.025
"""Maximum time between two samples compared for a jump, s: a longer gap may hide a shock."""
MAX_ANGLE = 0.5
"""Maximum angle between the verticals of gyroscope and accelerometer, rad. Twins that fall, roll
over and get up exceed it for 0.04 s at most."""
MIN_DURATION = 0.1
"""Minimum duration of a jump, or of an excessive angle, before it is reported, s."""
MIN_SAMPLES = 8
"""Minimum number of samples of a jump: on a loaded host few arrive within `MIN_DURATION`."""
MAX_YAW = 1.0
"""Maximum turn about the vertical while all joints stand still, rad."""
MAX_STANDING_SPEED = 0.5
"""Maximum speed of a joint that counts as standing still, rad/s."""
GRAVITY_TOLERANCE = 0.15
"""Relative deviation from gravity within which an acceleration counts as gravity."""
CORRECTION_TIME = 1.0
"""Time constant of the correction of the vertical by the accelerometer, s."""
MAX_STEP = 0.1
"""Maximum time step of the integration, s."""

SPINNING = FindingText(
    "imu spinning",
    "reporting a rotation of {:.0f} degrees that accelerometer or joints contradict",
    "at {:.0f}", AGAIN,
    180.0 / pi, "the IMU",
)  # fmt: skip
JUMPING = SPINNING._replace(state="reporting a jump of its rates without an acceleration", level="")

Vector = tuple[float, float, float]
Verdict = tuple[FindingText, float, float]
"""Texts of the fault, the value that shows it, and its limit."""
NOTHING: Vector = (0.0, 0.0, 0.0)


class GyroWatch:
    """Judges samples (6,): angular rates, rad/s, and acceleration, m/s2, in the body frame.

    Attributes:
        up: The last trusted vertical in the body frame, a unit vector.
        doubted: The present rates have jumped without a matching change of acceleration.
    """

    def __init__(self) -> None:
        self.up: Vector = (0.0, 0.0, 1.0)
        self.restart()

    def restart(self) -> None:
        """Reset all but `up`; judging starts with the next sample."""
        self.doubted = False
        self._believed: Sequence[float] = NOTHING
        self._jumped, self._lasts, self._busy = 0.0, 0, 0.0
        self._vertical: Vector | None = None
        self._around = self._apart = 0.0

    def compare(self, sample: Sequence[float], last: Sequence[float], now: float) -> None:
        """Compare a sample with the previous one: set `doubted` at a jump, clear it at its end."""
        if self.doubted:
            self._lasts += 1
            changed = self._change(self._believed, sample) > 0.5 * MIN_JUMP
            self.doubted = changed and norm_of(sample) > norm_of(self._believed)
            return
        jump = self._change(last, sample)
        if jump < MIN_JUMP + MIN_JUMP_PER_RATE * self._busy or norm_of(sample) < norm_of(last):
            return  # a decreasing rate is not a fault
        felt = sample[3:]
        shaken = max(abs(norm_of(felt) - GRAVITY), distance(felt, last[3:]))
        if shaken < MIN_SHOCK * jump:
            self.doubted, self._believed, self._jumped, self._lasts = True, last[:3], now, 0

    def _change(self, before: Sequence[float], after: Sequence[float]) -> float:
        """Return the change of the rates, rad/s; the part about the vertical counts less."""
        x, y, z = after[0] - before[0], after[1] - before[1], after[2] - before[2]
        about = x * self.up[0] + y * self.up[1] + z * self.up[2]
        whole = x * x + y * y + z * z
        return sqrt(max(whole - about * about * (1.0 - 1.0 / YAW_DIVISOR**2), 0.0))

    def judge(
        self, sample: Sequence[float], now: float, dt: float, velocity: Array
    ) -> Verdict | None:
        """Judge a sample after `dt` s; return the fault or None.

        `velocity` (n,) is that of the joints, rad/s.
        """
        felt = sample[3:]
        if not self.doubted:
            kept = exp(-dt / CORRECTION_TIME)
            self._busy = sqrt(kept * self._busy**2 + (1.0 - kept) * norm_of(sample) ** 2)
            return self._turn(sample, felt, dt, velocity)
        if now - self._jumped >= MIN_DURATION and self._lasts >= MIN_SAMPLES:
            return JUMPING, self._change(self._believed, sample), MIN_JUMP
        return self._turn(self._believed, felt, dt, velocity)

    def _turn(
        self, rate: Sequence[float], felt: Sequence[float], dt: float, velocity: Array
    ) -> Verdict | None:
        """Integrate the vertical; return the fault if accelerometer or joints contradict it."""
        size = norm_of(felt)
        alone = abs(size - GRAVITY) < GRAVITY_TOLERANCE * GRAVITY
        if self._vertical is None:
            if alone:
                self._vertical = (felt[0] / size, felt[1] / size, felt[2] / size)
            return None
        up = self._vertical = rotated_vertical(self._vertical, rate, felt, size, dt)
        if alone:
            angle = angle_between(up, felt, size)
            self._apart = self._apart + dt if angle > MAX_ANGLE else 0.0
            if self._apart >= MIN_DURATION:
                return SPINNING, angle, MAX_ANGLE
        about = rate[0] * up[0] + rate[1] * up[1] + rate[2] * up[2]
        self._around = self._around * exp(-dt / CORRECTION_TIME) + about * dt
        if abs(self._around) > MAX_YAW and alone:
            if np.abs(velocity).max() < MAX_STANDING_SPEED:
                return SPINNING, abs(self._around), MAX_YAW
            self._around = 0.0
        self.up = up
        return None


def distance(a: Sequence[float], b: Sequence[float]) -> float:
    """Return the Euclidean distance of the first three elements of `a` and `b`."""
    x, y, z = a[0] - b[0], a[1] - b[1], a[2] - b[2]
    return sqrt(x * x + y * y + z * z)


def norm_of(a: Sequence[float]) -> float:
    """Return the Euclidean norm of the first three elements of `a`."""
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])


def rotated_vertical(
    up: Vector, rate: Sequence[float], felt: Sequence[float], size: float, dt: float
) -> Vector:
    """Return the vertical in the body frame after `dt` s, corrected towards the acceleration.

    Args:
        up: The vertical before, a unit vector.
        rate: Angular rates of the body, rad/s.
        felt: Acceleration, m/s2.
        size: Norm of `felt`, m/s2.
        dt: Time step, s.
    """
    x, y, z = up
    turned_x = x - dt * (rate[1] * z - rate[2] * y)
    turned_y = y - dt * (rate[2] * x - rate[0] * z)
    turned_z = z - dt * (rate[0] * y - rate[1] * x)
    if size > 0.0:
        share = 1.0 - exp(-dt / CORRECTION_TIME)
        turned_x += share * (felt[0] / size - turned_x)
        turned_y += share * (felt[1] / size - turned_y)
        turned_z += share * (felt[2] / size - turned_z)
    length = sqrt(turned_x * turned_x + turned_y * turned_y + turned_z * turned_z) or 1.0
    return turned_x / length, turned_y / length, turned_z / length


def angle_between(up: Vector, felt: Sequence[float], size: float) -> float:
    """Return the angle between the vertical and the acceleration `felt` of norm `size`, rad."""
    cosine = (up[0] * felt[0] + up[1] * felt[1] + up[2] * felt[2]) / size
    return acos(min(max(cosine, -1.0), 1.0))
