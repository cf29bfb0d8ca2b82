"""How hard the servos work: the mean torque of each joint, and how long it pushes in vain."""

from math import exp

import numpy as np

from windup.hal.command import JointCommand
from windup.hal.joints import Array
from windup.hal.observation import JointState

MEMORY = 1.0
"""Time constant of the mean torque, s."""
FULL, PUSHES = 0.8, 0.6
"""Shares of the torque at stall: what the goal has to ask for, and what has to be measured where it
is, for a joint to be at its limit."""
STANDS = 0.1
"""A joint slower than this does not move, rad/s."""


class Strain:
    """The mean load and the stall time of n joints.

    Args:
        torque: (n,) torque at stall, N m; inf for an ideal joint, which is never strained.
        load: (n,) where the mean share of it goes.
        stall: (n,) where the time of pushing at the limit without moving goes, s.
    """

    def __init__(self, torque: Array, load: Array, stall: Array) -> None:
        self._share, self.load, self.stall = 1.0 / torque, load, stall
        self.reset()

    def reset(self) -> None:
        """Begin anew, with joints that rest."""
        self.load.fill(0.0)
        self.stall.fill(0.0)

    def update(self, joints: JointState, command: JointCommand | None, dt: float) -> None:
        """Let `dt` s pass with a state, and what the joints were told; None where nobody drives.

        A torque that is not measured does not count as a load; whether a joint is blocked, the
        torque that its goal asks for says as well.
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
        weak = measured < PUSHES  # never true where nothing is measured
        held = asked & (np.abs(joints.velocity) < STANDS) & ~weak
        np.copyto(self.stall, np.where(held, self.stall + dt, 0.0))
