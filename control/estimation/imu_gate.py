"""Gate between IMU and estimator, which rejects samples that cannot be trusted."""

from collections.abc import Callable
from dataclasses import replace
from typing import Protocol

import numpy as np

from windup.hal.errors import ImuError
from windup.hal.geometry.gravity import GRAVITY
from windup.hal.guard.finding import CHECK
from windup.hal.guard.imu_watch import MAX_SILENCE, ImuWatch
from windup.hal.observation import ImuState, Observation

ATTEMPTS = 5


class ImuUser(Protocol):
    """An estimator that uses the IMU, such as `estimator.BaseEstimator`."""

    def reset(self) -> None:
        """Start over at the next observation."""
        ...

    def update(self, observation: Observation, dt: float) -> Observation:
        """Return `observation` with its base."""
        ...


class ImuGate:
    """An estimator with handling of IMU failures.

    A controller that needs the IMU is stopped by an error. Another one continues with a substitute
    sample (at rest, with the last trusted vertical) and a base state of confidence 0.

    Args:
        estimator: The estimator.
        watch: Monitor of the IMU.
        needed: The controller needs the IMU.
        look: End of error messages: the command that shows more.
    """

    def __init__(self, estimator: ImuUser, watch: ImuWatch, needed: bool, look: str = "") -> None:
        self._estimator, self._watch, self._needed, self._look = estimator, watch, needed, look
        level = np.array([1.0, 0.0, 0.0, 0.0])
        self._last = ImuState(level, np.zeros(3), np.array([0.0, 0.0, GRAVITY]), 0.0)
        self._failed = False

    def admit(self, read: Callable[[], Observation]) -> None:
        """Check the IMU before any motion, with retries because an answer may get lost.

        Args:
            read: Reads the robot.

        Raises:
            ImuError: There is no recent sample, and the controller needs the IMU.
        """
        looks = ATTEMPTS if self._needed else 0
        for _ in range(looks):
            imu = read().imu
            if imu is not None and imu.age <= MAX_SILENCE:
                return
        if looks:
            since = "yet" if imu is None else f"for {imu.age:.2f} s"
            raise ImuError(f"the IMU has said nothing {since}: nothing has moved; {CHECK}")

    def update(self, observation: Observation, dt: float) -> Observation:
        """Return `observation` with its base; see `windup.control.loop.Estimator`.

        Raises:
            ImuError: The IMU cannot be trusted, and the controller needs it.
        """
        watch, imu = self._watch, observation.imu
        found = watch.update(observation)
        if found is not None and not found.stop:
            found = None
        if found is not None and self._needed:
            raise ImuError(f"{found}: {found.text.remedy}{self._look}", found.text.name)
        if found is not None or imu is None:
            return self._guess(observation, dt)
        self._failed = False
        if not watch.gyro.doubted:
            self._last = imu
            return self._estimator.update(observation, dt)
        believed = replace(self._last, acceleration=imu.acceleration, age=imu.age)
        estimated = self._estimator.update(replace(observation, imu=believed), dt)
        return replace(estimated, imu=imu)

    def _guess(self, observation: Observation, dt: float) -> Observation:
        """Return `observation` with a base as last estimated, at rest, with confidence 0."""
        if not self._failed:
            self._failed = True
            self._estimator.reset()  # it may have used wrong samples
        up = GRAVITY * np.array(self._watch.gyro.up)
        resting = ImuState(self._last.orientation, np.zeros(3), up, 0.0)
        guessed = self._estimator.update(replace(observation, imu=resting), dt)
        assert guessed.base is not None, "an estimator fills it in"
        base = replace(guessed.base, confidence=0.0)
        return replace(guessed, imu=observation.imu, base=base)
