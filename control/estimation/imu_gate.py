"""What stands between an IMU and the estimator: a sample that cannot be trusted does not pass."""

from collections.abc import Callable
from dataclasses import replace
from typing import Protocol

import numpy as np

from windup.hal.errors import ImuError
from windup.hal.geometry.gravity import GRAVITY
from windup.hal.guard.finding import CHECK
from windup.hal.guard.imu_watch import SILENT, ImuWatch
from windup.hal.observation import ImuState, Observation

ATTEMPTS = 5


class ImuUser(Protocol):
    """An estimator that uses the IMU, such as `estimator.BaseEstimator`."""

    def reset(self) -> None:
        """Begin anew at the next observation."""
        ...

    def update(self, observation: Observation, dt: float) -> Observation:
        """Return `observation` with its base."""
        ...


class ImuGate:
    """An estimator for a robot whose IMU may fail.

    A controller that needs the IMU is stopped. One that does not goes on with an IMU that seems to
    rest where it was upright last, and a base that nobody is sure of.

    Args:
        estimator: Who uses the IMU.
        watch: Judges it.
        needed: Does the controller need it?
        look: What a message ends with: the command that shows more.
    """

    def __init__(self, estimator: ImuUser, watch: ImuWatch, needed: bool, look: str = "") -> None:
        self._estimator, self._watch, self._needed, self._look = estimator, watch, needed, look
        level = np.array([1.0, 0.0, 0.0, 0.0])
        self._last = ImuState(level, np.zeros(3), np.array([0.0, 0.0, GRAVITY]), 0.0)
        self._failed = False

    def admit(self, read: Callable[[], Observation]) -> None:
        """Look at the IMU before anything moves, a few times: an answer may get lost.

        Raises:
            ImuError: It says nothing, and the controller needs it.
        """
        looks = ATTEMPTS if self._needed else 0
        for _ in range(looks):
            imu = read().imu
            if imu is not None and imu.age <= SILENT:
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
            raise ImuError(f"{found}: {found.saying.do}{self._look}", found.saying.name)
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
        """Return `observation` with a base that stands as it did last; its confidence is 0."""
        if not self._failed:
            self._failed = True
            self._estimator.reset()  # it may have followed what was wrong
        up = GRAVITY * np.array(self._watch.gyro.up)
        resting = ImuState(self._last.orientation, np.zeros(3), up, 0.0)
        guessed = self._estimator.update(replace(observation, imu=resting), dt)
        assert guessed.base is not None, "an estimator fills it in"
        base = replace(guessed.base, confidence=0.0)
        return replace(guessed, imu=observation.imu, base=base)
