"""Load of the servos: mean torque of each joint, and time at the torque limit without motion."""

from math import exp

import numpy as np

from windup.hal.command import JointCommand
from windup.hal.joints import Array
from windup.hal.observation import JointState

MEMORY = 1.0
"""Time constant of the mean torque, s."""
FULL, PUSHES = 0.8, 0.6
"""Fractions of stall torque from which a joint counts as at its torque limit: of the torque that
its goal commands, and of the measured torque if that is available."""
MAX_STANDING_SPEED = 0.1
"""Maximum speed of a joint that counts as standing still, rad/s."""


class LoadMonitor:
    """The mean load and the stall time of n joints.

    Args:
        torque: (n,) stall torque, N m; inf for an ideal joint, whose load is always 0.
        load: (n,) output: mean torque as a fraction of stall torque.
        stall: (n,) output: time at the torque limit without motion, s.
    """

    def __init__(self, torque: Array, load: Array, stall: Array) -> None:
        self._share, self.load, self.stall = 1.0 / torque, load, stall
        self.reset()

    def reset(self) -> None:
        """Reset load and stall time of all joints to 0."""
        self.load.fill(0.0)
        self.stall.fill(0.0)

    def update(self, joints: JointState, command: JointCommand | None, dt: float) -> None:
        """Update load and stall time after `dt` s; `command` is the one in effect, or None.

        A torque that is not measured (NaN) counts as no load; a stall is then found by the torque
        that the goal commands.
        """
        measured = np.abs(joints.torque) * self._share
        self.load += (1.0 - exp(-dt / MEMORY)) * (np.fmax(measured, 0.0) - self.load)
        if command is None:
            self.stall.fill(0.0)
            return
        goal, stiffness = command.block[0], command.block[3]
        asked = np.abs((goal - joints.position) * stiffness) * self._share >= FULL
        if not asked.any():
            self.stall.fill(0.0)
            return
        weak = measured < PUSHES  # never true where torque is not measured
        held = asked & (np.abs(joints.velocity) < MAX_STANDING_SPEED) & ~weak
        np.copyto(self.stall, np.where(held, self.stall + dt, 0.0))
