"""Does the body turn as the gyroscope says? Gravity, joints and pushes have to agree.

What begins to turn at once has been pushed, which the accelerometer feels: a jump of the rates that
it does not feel is doubted from the first sample, and wrong if it lasts. What begins slowly is
found by the vertical that the gyroscope carries along, drawn to the accelerometer, against the
accelerometer. A fall does not look like that: who tips over feels less than gravity. Only where the
accelerometer feels nothing but gravity, from another side and for a while, the gyroscope is wrong.
A turn about the vertical no accelerometer feels: there a robot whose joints stand still does not
turn on its feet.
"""

from collections.abc import Sequence
from math import acos, exp, pi, sqrt

import numpy as np

from windup.hal.geometry.gravity import GRAVITY
from windup.hal.guard.finding import AGAIN, Saying
from windup.hal.joints import Array

JUMP = 0.7
"""From one sample to the next, rates of a body at rest that change by more are doubted, unless the
accelerometer has felt it, rad/s."""
BUSY = 1.0
"""So much is added to that for each rad/s (rms of the last second) at which the body turns: the
knock of a foot falls between two samples, and turns a walking body as suddenly."""
PIVOT = 1.6
"""A change about the vertical counts as so many times less: a body that begins to turn on one foot,
below its IMU, shakes it little. Ducks that slip while walking reach 0.8 rad/s."""
SHAKE = 1.4
"""What it then changes by, or differs from gravity, at least: m/s2 for each rad/s. Twins that are
pushed, fall, roll over and get up show 2.3 or more."""
NEXT = 0.025
"""After a longer hole a sample is not the next one: a body may have been shaken meanwhile, s."""
SPUN = 0.5
"""Angle between the verticals of gyroscope and accelerometer, rad. Twins that fall, roll over and
get up show it for 0.04 s at most."""
PERSIST = 0.1
"""For how long either has to be seen, s."""
SAMPLES = 8
"""New samples that a jump has to last: on a busy machine few come within that time."""
AROUND = 1.0
"""Turn about the vertical while all joints stand still, rad."""
STANDS = 0.5
"""A joint slower than this stands still, rad/s."""
NEAR = 0.15
"""How far from gravity what feels nothing else may be, as a share."""
DRAW = 1.0
"""Time constant with which the accelerometer draws the vertical, s."""
LONGEST = 0.1
"""Longest time between two samples that says anything about turns, s."""

SPIN = Saying(
    "imu spinning", "turning by its gyroscope alone, by {:.0f} degrees", "at {:.0f}", AGAIN,
    180.0 / pi, "the IMU",
)  # fmt: skip
LEAP = SPIN._replace(state="turning by its gyroscope alone, from one sample to the next", level="")

Vector = tuple[float, float, float]
Verdict = tuple[Saying, float, float]
"""What is wrong, the value that shows it, and its limit."""
NOTHING: Vector = (0.0, 0.0, 0.0)


class GyroWatch:
    """Judges samples: (6,) rates rad/s and acceleration m/s2 in the body.

    Attributes:
        up: The vertical as the body sees it, a unit vector, the last that could be trusted.
        doubted: The present rates have jumped, and the accelerometer has not felt it.
    """

    def __init__(self) -> None:
        self.up: Vector = (0.0, 0.0, 1.0)
        self.restart()

    def restart(self) -> None:
        """Begin anew with the next sample; the vertical stays known."""
        self.doubted = False
        self._believed: Sequence[float] = NOTHING
        self._jumped, self._lasts, self._busy = 0.0, 0, 0.0
        self._vertical: Vector | None = None
        self._around = self._apart = 0.0

    def compare(self, sample: Sequence[float], last: Sequence[float], now: float) -> None:
        """Doubt a jump from the last sample, shortly before, or be satisfied that it is over."""
        if self.doubted:
            self._lasts += 1
            changed = self._change(self._believed, sample) > 0.5 * JUMP
            self.doubted = changed and size_of(sample) > size_of(self._believed)
            return
        jump = self._change(last, sample)
        if jump < JUMP + BUSY * self._busy or size_of(sample) < size_of(last):
            return  # who has stopped turning does not spin
        felt = sample[3:]
        shaken = max(abs(size_of(felt) - GRAVITY), distance(felt, last[3:]))
        if shaken < SHAKE * jump:
            self.doubted, self._believed, self._jumped, self._lasts = True, last[:3], now, 0

    def _change(self, before: Sequence[float], after: Sequence[float]) -> float:
        """Return by how much the rates have changed, rad/s; less about the vertical."""
        x, y, z = after[0] - before[0], after[1] - before[1], after[2] - before[2]
        about = x * self.up[0] + y * self.up[1] + z * self.up[2]
        whole = x * x + y * y + z * z
        return sqrt(max(whole - about * about * (1.0 - 1.0 / PIVOT**2), 0.0))

    def judge(
        self, sample: Sequence[float], now: float, dt: float, velocity: Array
    ) -> Verdict | None:
        """Let `dt` s pass with a sample; `velocity` (n,) is that of the joints, rad/s."""
        felt = sample[3:]
        if not self.doubted:
            kept = exp(-dt / DRAW)
            self._busy = sqrt(kept * self._busy**2 + (1.0 - kept) * size_of(sample) ** 2)
            return self._turn(sample, felt, dt, velocity)
        if now - self._jumped >= PERSIST and self._lasts >= SAMPLES:
            return LEAP, self._change(self._believed, sample), JUMP
        return self._turn(self._believed, felt, dt, velocity)

    def _turn(
        self, rate: Sequence[float], felt: Sequence[float], dt: float, velocity: Array
    ) -> Verdict | None:
        """Carry the vertical along, and say so where gravity does not follow."""
        size = size_of(felt)
        alone = abs(size - GRAVITY) < NEAR * GRAVITY
        if self._vertical is None:
            if alone:
                self._vertical = (felt[0] / size, felt[1] / size, felt[2] / size)
            return None
        up = self._vertical = carried(self._vertical, rate, felt, size, dt)
        if alone:
            angle = between(up, felt, size)
            self._apart = self._apart + dt if angle > SPUN else 0.0
            if self._apart >= PERSIST:
                return SPIN, angle, SPUN
        about = rate[0] * up[0] + rate[1] * up[1] + rate[2] * up[2]
        self._around = self._around * exp(-dt / DRAW) + about * dt
        if abs(self._around) > AROUND and alone:
            if np.abs(velocity).max() < STANDS:
                return SPIN, abs(self._around), AROUND
            self._around = 0.0
        self.up = up
        return None


def distance(a: Sequence[float], b: Sequence[float]) -> float:
    """Return how far the first three of `a` and `b` are from each other."""
    x, y, z = a[0] - b[0], a[1] - b[1], a[2] - b[2]
    return sqrt(x * x + y * y + z * z)


def size_of(a: Sequence[float]) -> float:
    """Return the length of the first three of `a`."""
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2])


def carried(
    up: Vector, rate: Sequence[float], felt: Sequence[float], size: float, dt: float
) -> Vector:
    """Return the vertical after `dt` s: turned against the body, drawn to what is felt."""
    x, y, z = up
    turned_x = x - dt * (rate[1] * z - rate[2] * y)
    turned_y = y - dt * (rate[2] * x - rate[0] * z)
    turned_z = z - dt * (rate[0] * y - rate[1] * x)
    if size > 0.0:
        share = 1.0 - exp(-dt / DRAW)
        turned_x += share * (felt[0] / size - turned_x)
        turned_y += share * (felt[1] / size - turned_y)
        turned_z += share * (felt[2] / size - turned_z)
    length = sqrt(turned_x * turned_x + turned_y * turned_y + turned_z * turned_z) or 1.0
    return turned_x / length, turned_y / length, turned_z / length


def between(up: Vector, felt: Sequence[float], size: float) -> float:
    """Return the angle between the vertical and what is felt, `size` m/s2, rad."""
    cosine = (up[0] * felt[0] + up[1] * felt[1] + up[2] * felt[2]) / size
    return acos(min(max(cosine, -1.0), 1.0))
