"""Measures the load of a robot's servos: the peak, and the longest time of high load."""

from dataclasses import dataclass, field

import numpy as np

from windup.hal.joints import Joints
from windup.hal.observation import Observation

HIGH = 0.5  # share of the stall torque that a geared servo tolerates only briefly


def format_load(share: float, joint: str) -> str:
    """Return a text about a peak load, given as a share of the joint's stall torque.

    A servo that is driven backward can bear more than its stall torque.

    >>> format_load(0.43, "l_knee")
    'peak load 43 % of stall at l_knee'
    >>> format_load(1.86, "l_knee")
    'l_knee was loaded with 1.9 x its stall torque, more than its motor can produce'
    """
    if share > 1.0:
        return (
            f"{joint} was loaded with {share:.1f} x its stall torque, "
            "more than its motor can produce"
        )
    return f"peak load {100.0 * share:.0f} % of stall at {joint}"


@dataclass
class LoadGauge:
    """Measures the torques of a run, as shares of each joint's torque limit.

    Attributes:
        joints: The robot's joints.
        peak: Highest share so far; NaN if no joint has both a limit and a measured torque.
        joint: Name of the joint with that share, or "".
        high_time: Longest uninterrupted time of one joint above half, s.
    """

    joints: Joints
    peak: float = field(default=float("nan"), init=False)
    joint: str = field(default="", init=False)
    high_time: float = field(default=0.0, init=False)
    _last: float | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        self._high = np.zeros(len(self.joints))

    def update(self, observation: Observation) -> None:
        """Process the observation of a tick."""
        now = observation.time
        dt = 0.0 if self._last is None else now - self._last
        self._last = now
        share = np.nan_to_num(np.abs(observation.joints.torque) / self.joints.torque)
        self._high = np.where(share > HIGH, self._high + dt, 0.0)
        self.high_time = max(self.high_time, float(self._high.max()))
        if not (np.isfinite(observation.joints.torque) & np.isfinite(self.joints.torque)).any():
            return
        top = int(share.argmax())
        if not share[top] <= self.peak:
            self.peak, self.joint = float(share[top]), self.joints.names[top]
