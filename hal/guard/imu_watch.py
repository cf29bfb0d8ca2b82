"""Detects faults of the IMU from the observations.

The faults are: silent, frozen, NaN, spinning (`gyro_watch`), or stuck about one axis
(`stuck_axis`). A frozen IMU repeats one sample of gyroscope and accelerometer bit for bit. A real
IMU at rest is never that still, but an emulated one is, if its robot lies or is held: so it is a
reason to stop only if the joints have moved meanwhile.
"""

from collections.abc import Sequence
from math import isfinite, nan

import numpy as np

from windup.hal.guard.finding import AGAIN, CHECK, Finding, FindingText
from windup.hal.guard.gyro_watch import MAX_SAMPLE_GAP, MAX_STEP, SPINNING, GyroWatch, Verdict
from windup.hal.guard.stuck_axis import StuckAxis
from windup.hal.joints import Array
from windup.hal.observation import ImuState, Observation

MAX_SILENCE = 0.25
"""Maximum age of the newest sample, s."""
MAX_FROZEN = 0.5
"""Maximum time with the same sample while joints move, s."""
MAX_RIGID = 1.0
"""Maximum time with the same sample while no joint moves, s; longer causes a warning only."""
MIN_MOTION = 0.03
"""Minimum motion of a joint that counts as moved, rad."""

SILENCE = FindingText("imu silent", "silent for {:.2f} s", "at {:.2f} s", CHECK, subject="the IMU")
STUCK = FindingText(
    "imu frozen", "repeating one sample for {:.1f} s", "at {:.1f} s", AGAIN, subject="the IMU"
)
NO_NUMBER = FindingText(
    "imu not a number", "not a number", "", AGAIN, subject="a reading of the IMU"
)
IMU_KINDS = tuple(text.name for text in (SILENCE, STUCK, NO_NUMBER, SPINNING))
"""Names of all kinds of finding."""


class ImuWatch:
    """Judges every sample of one IMU, from the observations only.

    Attributes:
        gyro: Judges the angular rates.
    """

    def __init__(self) -> None:
        self.gyro, self._axis = GyroWatch(), StuckAxis()
        self._warnings: dict[str, Finding] = {}
        self._present = ""
        self._time = -np.inf

    @property
    def present(self) -> str:
        """Name of the present finding, or "" if there is none."""
        return self._present

    @property
    def warnings(self) -> list[Finding]:
        """All findings so far: one per kind, with its worst value and its count."""
        return list(self._warnings.values())

    def update(self, observation: Observation) -> Finding | None:
        """Judge an observation; return the present fault of the IMU, or None."""
        now = observation.time
        passed = now - self._time
        if not 0.0 <= passed < MAX_FROZEN:  # another run, or a gap between calls
            self._restart(now)
            passed = 0.0
        self._time = now
        verdict, stop = self._judge(observation, observation.imu, min(passed, MAX_STEP))
        if verdict is None:
            self._present = ""
            return None
        found = Finding(*verdict, now, stop)
        self._note(found)
        return found

    def _restart(self, now: float) -> None:
        self._sample: Sequence[float] = ()
        self._changed = self._sampled_at = self._taken = now
        self._pose: Array = np.zeros(0)
        self.gyro.restart()
        self._axis.restart()
        self._stuck: Verdict | None = None

    def _judge(
        self, observation: Observation, imu: ImuState | None, dt: float
    ) -> tuple[Verdict | None, bool]:
        """Return the fault or None, and whether it is a reason to stop."""
        now, joints = observation.time, observation.joints
        self._sampled_at = self._sampled_at if imu is None else now - imu.age
        if (silence := now - self._sampled_at) > MAX_SILENCE:
            return (SILENCE, silence, MAX_SILENCE), True
        if imu is None:
            return None, False
        sample = (*imu.angular_velocity.tolist(), *imu.acceleration.tolist())
        if not isfinite(sum(sample)):
            return (NO_NUMBER, nan, nan), True
        same = now - self._changed
        if sample != self._sample:
            if self._sample and (
                self._sampled_at - self._taken < MAX_SAMPLE_GAP or self.gyro.doubted
            ):
                self.gyro.compare(sample, self._sample, now)
            self._sample, self._taken = sample, self._sampled_at
            self._changed, self._pose = now, joints.position
            self._stuck = self._axis.update(sample, now)
        elif same > MAX_FROZEN and np.abs(joints.position - self._pose).max() > MIN_MOTION:
            return (STUCK, same, MAX_FROZEN), True
        elif same > MAX_RIGID:
            return (STUCK, same, MAX_RIGID), False
        if self._stuck is not None:
            return self._stuck, True
        return self.gyro.judge(sample, now, dt, joints.velocity), True

    def _note(self, found: Finding) -> None:
        """Record a finding, its worst value, and how many times it began."""
        name = found.text.name
        fresh = Finding(found.text, found.value, found.limit, found.since)
        known = self._warnings.setdefault(name, fresh)
        if found.value > known.value:
            known.value, known.limit = found.value, found.limit
        known.count += self._present != name
        self._present = name
