"""The health of a robot, as every tick publishes it: supply, hottest joint and present warnings."""

from math import nan

import numpy as np

from windup.hal.guard import GuardedBackend, HealthKind
from windup.hal.guard.imu_watch import IMU_KINDS, ImuWatch
from windup.hal.joints import Mask
from windup.hal.observation import JointState, Observation
from windup.hal.telemetry.record import Record

PERIOD = 0.1
"""Time between two updates of supply and hottest joint, s: they change slowly."""
POWERS = np.uint32(1) << np.arange(len(HealthKind), dtype=np.uint32)


class TickHealth:
    """The present health, from the guard's check of the joints and the check of the IMU.

    Args:
        guard: The guarded backend.
        record: The record whose warnings by joint are kept up to date.
        imu: The check of the IMU, or None.

    Attributes:
        supply: Lowest voltage of all joints, V; NaN if none is measured.
        hottest: Highest temperature of all joints, degrees C; NaN if none is measured.
        hottest_joint: Index of that joint, or -1.
        warnings: Bits of the kinds of present warnings.
    """

    def __init__(self, guard: GuardedBackend, record: Record, imu: ImuWatch | None) -> None:
        self._guard, self._record, self._imu = guard, record, imu
        self.supply, self.hottest, self.hottest_joint = nan, nan, -1
        self.warnings = self._of_joints = self._of_imu = 0
        self._seen: Mask | None = None
        self._name = ""
        self._looked = -np.inf

    def update(self, observation: Observation) -> None:
        """Update the health for a tick."""
        if not 0.0 <= observation.time - self._looked < PERIOD:
            self._looked = observation.time
            self._look(observation.joints)
        watch = self._guard.watch
        if watch is not None and watch.present is not self._seen:
            self._seen = watch.present
            self._note_joints(watch.present)
        if self._imu is not None and self._imu.present != self._name:
            self._name = self._imu.present
            self._of_imu = 1 << len(HealthKind) + IMU_KINDS.index(self._name) if self._name else 0
        self.warnings = self._of_joints | self._of_imu

    def _look(self, joints: JointState) -> None:
        """Find the lowest supply and the hottest joint."""
        self.supply = float(np.fmin.reduce(joints.voltage))
        self.hottest = float(np.fmax.reduce(joints.temperature))
        known = self.hottest == self.hottest  # not NaN
        self.hottest_joint = int(np.argmax(joints.temperature == self.hottest)) if known else -1

    def _note_joints(self, present: Mask | None) -> None:
        """Put in the warnings of the joints, `present` (5, n) by kind."""
        if present is None:
            self._record.joint_warnings.fill(0)
            self._of_joints = 0
            return
        self._record.joint_warnings[...] = POWERS @ present
        self._of_joints = int(POWERS @ present.any(axis=1))
