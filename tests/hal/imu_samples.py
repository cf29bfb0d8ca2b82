"""Made-up observations of an IMU on a body with two joints."""

from collections.abc import Sequence

import numpy as np

from windup.hal.guard.finding import Finding
from windup.hal.guard.imu_watch import ImuWatch
from windup.hal.joints import Array
from windup.hal.observation import ImuState, JointState, Observation

DT = 1.0 / 128.0  # no rounding in sums of it
GRAVITY = 9.81
UP = (0.0, 0.0, 1.0)


Rows = Sequence[float] | Array


def seen(
    time: float,
    rate: Rows = (0.0, 0.0, 0.0),
    felt: Rows = (0.0, 0.0, GRAVITY),
    *,
    age: float = 0.0,
    joint: float = 0.0,
    speed: float = 0.0,
) -> Observation:
    """Return an observation whose second joint is somewhere, and moves."""
    imu = ImuState(None, np.array(rate, float), np.array(felt, float), age)
    zero, joints = np.zeros(2), np.array([0.0, joint])
    state = JointState(joints, np.array([0.0, speed]), zero, zero, zero, zero)
    return Observation(time, state, imu, np.zeros(0), None)


def upright(k: int) -> Array:
    """Return what an accelerometer feels at rest, with noise of one count."""
    return np.array([0.0, 6e-4 * (k % 2), GRAVITY])


def noisy(rate: Rows, k: int) -> Array:
    """Return a rate with noise of one part in a thousand."""
    return np.asarray(rate, float) * (1.0 + 1e-3 * (k % 2))


def still(seconds: float, begin: float = 0.0, rate: Rows = (0.0, 0.0, 0.0)) -> list[Observation]:
    """Return what an IMU says that rests; its gyroscope may say else."""
    steps = range(round(seconds / DT))
    return [seen(begin + k * DT, noisy(rate, k), upright(k)) for k in steps]


def tipping(seconds: float, begin: float, height: float = 0.25) -> list[Observation]:
    """Return what a rod feels at a `height` m that falls over about its end, from 0.05 rad on.

    `length` is that of a rod; the specific force at the IMU is gravity less its acceleration.
    """
    angle, speed, length, run = 0.05, 0.0, 0.45, []
    for k in range(round(seconds / DT)):
        turn = 1.5 * GRAVITY / length * np.sin(angle)
        across = GRAVITY * np.sin(angle) - height * turn
        along = GRAVITY * np.cos(angle) - height * speed**2
        felt = np.array([-across, 6e-4 * (k % 2), along])
        run.append(seen(begin + k * DT, (0.0, speed, 0.0), felt))
        speed += turn * DT
        angle += speed * DT
        if angle > np.pi / 2.0:  # it lies
            angle, speed = np.pi / 2.0, 0.0
    return run


def found(watch: ImuWatch, run: Sequence[Observation]) -> tuple[float, Finding] | None:
    """Return when something is first wrong, and what."""
    for observation in run:
        if (finding := watch.update(observation)) is not None:
            return observation.time, finding
    return None
