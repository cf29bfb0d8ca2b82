"""The controller of a robot that a client streams goals to, or that holds without them."""

import time
from collections.abc import Callable
from typing import Final

import numpy as np

from windup.hal.command import JointCommand
from windup.hal.joints import Array, Joints
from windup.hal.observation import Observation
from windup.hal.publishing.controller_block import NOTHING, BlockNames, ControllerBlock
from windup.hal.publishing.run_state import RunState
from windup.tools.runtime.board import LEASE, Board
from windup.tools.runtime.counts import Count

DEADMAN: Final = 0.2
"""Time after the last goal at which the robot holds, s."""
FASTEST: Final = 3.0
"""Largest speed of a goal, rad/s; slower joints have their own largest speed."""


class GoalFollower:
    """Holds the last goal, and follows the newest goal of the client that has the lease.

    A goal is clamped to the limits of the joints, and each joint goes there no faster than its
    largest step a tick; all that is clamped is counted. After the deadman time without a new goal
    it holds where it has come to.

    Args:
        joints: The joints.
        board: The board with the goals.
        speed: (n,) largest speed of a goal, rad/s.
        ready: Returns whether goals may be followed yet.
        held: (n,) rad, pose to hold at first; None for that of the first observation.
        now: Clock of the goals, s.

    Attributes:
        streaming: Goals are being followed.
        position: (n,) rad, last goal that was commanded.
    """

    def __init__(
        self,
        joints: Joints,
        board: Board,
        speed: Array,
        ready: Callable[[], bool],
        held: Array | None = None,
        now: Callable[[], float] = time.monotonic,
    ) -> None:
        self._joints, self._board, self._speed = joints, board, speed
        self._ready, self._now = ready, now
        self._held = held
        self.position = np.zeros(len(joints)) if held is None else held
        self._number = board.newest
        self._came = 0.0
        self.streaming = False

    @property
    def first_pose(self) -> Array:
        """First pose (n,), rad; see `Begins`."""
        return self.position

    def reset(self, observation: Observation) -> None:
        """Hold the given pose, or the present one."""
        joints, held = self._joints, self._held
        pose = observation.joints.position if held is None else held
        self.position = np.clip(pose, joints.lower, joints.upper)
        self._goal = self.position

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command of this tick."""
        self._read()
        if self._goal is not self.position:
            way, most = self._goal - self.position, self._speed * dt
            step = np.clip(way, -most, most)
            if (step != way).any():
                self._board.count(Count.STEPPED)
                self.position = self.position + step
            else:
                self.position = self._goal
        return JointCommand.hold(self._joints, self.position)

    published: BlockNames = NOTHING

    def publish(self, block: ControllerBlock) -> None:
        """Publish that the robot is held."""
        block.run_state = RunState.HOLDING

    def _read(self) -> None:
        """Read the newest goal; hold when there has been none for too long."""
        goal = self._board.goal(self._number)
        if goal is None:
            if self.streaming and self._now() - self._came > DEADMAN:
                self.streaming, self._goal = False, self.position
                self._board.count(Count.SILENT)
            return
        self._number = goal.number
        if goal.owner != self._board.words[LEASE] or self._now() - goal.time > DEADMAN:
            return
        wanted = np.frombuffer(goal.position)
        if not self._ready():
            self._board.count(Count.NOT_READY)
            return
        self._goal = np.clip(wanted, self._joints.lower, self._joints.upper)
        if (self._goal != wanted).any():
            self._board.count(Count.LIMITED)
        self._came, self.streaming = goal.time, True


def largest_speed(joints: Joints) -> Array:
    """Return the largest speed (n,) rad/s of streamed goals."""
    return np.minimum(joints.velocity, FASTEST)
