"""Health check of the joints: compares each observation with warning and stop levels.

A quantity that a joint does not measure is not judged. The result depends on the observations and
the commands only: the same inputs give the same result.
"""

from collections.abc import Sequence

import numpy as np

from windup.hal.command import JointCommand
from windup.hal.errors import UnhealthyError
from windup.hal.guard.finding import FINDING_TEXTS, Finding
from windup.hal.guard.levels import HealthKind, HealthLevels
from windup.hal.guard.load_monitor import LoadMonitor
from windup.hal.guard.persistence import SIGNS, Persistence
from windup.hal.joints import Array, Joints, Mask
from windup.hal.observation import JointState, Observation

PERIOD = 0.03
"""Period of the checks, s: no monitored quantity changes faster, and a check takes some 30 us."""
MAX_STEP = 0.1
"""Maximum time step of one check, s: a program may not call for a while between runs."""


class HealthWatch:
    """Monitors the health of the n joints of one robot.

    Args:
        joints: The joints.
        levels: Warning and stop levels.
        look: Text appended to messages: the command that shows details.

    Attributes:
        present: (5, n) bool in the order of `Kind`: values beyond their warning level for long
            enough, at the last check; None if there were none.
    """

    def __init__(self, joints: Joints, levels: HealthLevels, look: str = "") -> None:
        self.levels, self._names, self._look = levels, joints.names, look
        # Rows in the order of `HealthKind`, signed so that more is worse.
        self._values: Array = np.full((len(HealthKind), len(joints)), np.nan)
        self._load_monitor = LoadMonitor(
            levels.torque, self._values[HealthKind.LOAD], self._values[HealthKind.STALL]
        )
        self._persistence = Persistence(levels)
        self._time = -np.inf
        self.present: Mask | None = None
        # Warnings so far: by kind their number and first time, s; and the worst values.
        self._warned: Mask = np.zeros_like(self._values, dtype=bool)
        self._counts = np.zeros(len(HealthKind), dtype=np.int64)
        self._first = np.full(len(HealthKind), np.nan)
        self._worst: Array = np.full_like(self._values, np.nan)

    def update(
        self, observation: Observation, command: JointCommand | None = None
    ) -> Finding | None:
        """Judge an observation; record warnings and return the reason to stop, or None.

        Args:
            observation: The observation.
            command: The command in effect, or None if there is none.
        """
        now, joints = observation.time, observation.joints
        passed = now - self._time
        if 0.0 <= passed < PERIOD:
            return None
        if passed < 0.0:  # the clock was reset
            self._load_monitor.reset()
            self._persistence.reset()
        self._time = now
        _health(joints, self._values)
        self._load_monitor.update(joints, command, min(abs(passed), MAX_STEP))
        due = self._persistence.due(self._values, now, joints.health_age)
        self.present = None
        if due is None:
            return None
        if due[0].any():
            self.present = due[0]
        self._note(due[0], now)
        if not due[1].any():
            return None
        return self._reason(due[1], self._values)

    def error(self, found: Finding) -> UnhealthyError:
        """Return the error to raise for a finding of `update`."""
        return UnhealthyError(f"{found}: {found.text.remedy}{self._look}", found.text.name)

    def error_before_arming(
        self, observations: Sequence[Observation], max_age: float
    ) -> UnhealthyError | None:
        """Return an error if a joint is beyond a stop level in all `observations`, else None.

        States older than `max_age` s are not judged.
        """
        due, values = np.ones_like(self._warned), np.full_like(self._values, np.nan)
        for observation in observations:
            _health(observation.joints, values)
            due &= self._persistence.beyond_stop(values) & (observation.joints.age <= max_age)
        if not due.any():
            return None
        found = self._reason(due, values)
        said = f"{found}: nothing has moved; {found.text.remedy}"
        return UnhealthyError(said, found.text.name)

    @property
    def warnings(self) -> list[Finding]:
        """All warnings so far: one finding per kind, with its worst value and its count."""
        found = []
        for row in np.flatnonzero(self._counts).tolist():
            worst = self._worst[row]
            finding = self._finding(HealthKind(row), worst, np.isfinite(worst), self.levels.warn)
            finding.since, finding.count = float(self._first[row]), int(self._counts[row])
            found.append(finding)
        return found

    def _note(self, due: Mask, now: float) -> None:
        """Record the warnings that are `due` (5, n)."""
        begun = due & ~self._warned
        if begun.any():
            counts = np.count_nonzero(begun, axis=1)
            self._first[(counts > 0) & (self._counts == 0)] = now
            self._counts += counts
        self._warned = due
        np.fmax(self._worst, self._values, where=due, out=self._worst)

    def _reason(self, due: Mask, values: Array) -> Finding:
        """Return the finding for the first kind in `due` (5, n), the reasons to stop."""
        kind = HealthKind(int(np.argmax(due.any(axis=1))))
        found = self._finding(kind, values[kind], due[kind], self.levels.stop)
        found.stop = True
        return found

    def _finding(self, kind: HealthKind, values: Array, which: Mask, levels: Array) -> Finding:
        """Return the finding for the joints `which` (n,) bool; `values` (n,) are signed."""
        rows = np.flatnonzero(which)
        worst = int(rows[int(np.argmax(values[rows]))])
        return Finding(
            FINDING_TEXTS[kind],
            float(SIGNS[kind, 0] * values[worst]),
            float(levels[kind, worst]),
            self._time,
            joints=[self._names[row] for row in rows.tolist()],
        )


def _health(joints: JointState, values: Array) -> None:
    """Write supply and temperature into their rows of `values` (5, n), signed."""
    np.negative(joints.voltage, out=values[HealthKind.SUPPLY_LOW])
    values[HealthKind.SUPPLY_HIGH] = joints.voltage
    values[HealthKind.TEMPERATURE] = joints.temperature
