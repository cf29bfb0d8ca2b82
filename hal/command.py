"""Joint commands, and the torque law that defines them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from windup.hal.errors import UnsafeCommandError
from windup.hal.joints import Array, Joints

FIELDS = ("position", "velocity", "torque", "stiffness", "damping")


@dataclass(frozen=True, slots=True)
class JointCommand:
    """Targets and gains for n joints in MJCF order.

    The torque law, within the joint's limits, with q and dq the measured position and velocity::

        tau = stiffness (position - q) + damping (velocity - dq) + torque

    Ideal torque joints apply this law at every physics step. A position servo approximates it:
    gain registers, a goal shifted by ``(damping velocity + torque) / stiffness``, a voltage limit
    instead of a torque limit, and at least the back-EMF damping K^2/R of its motor. The backend's
    `write` therefore returns the command that was really applied.

    Made by `of`, and not changed afterwards: whoever wants another command makes another one.

    Attributes:
        block: (5, n) array with the rows of `FIELDS`; the properties are views of its rows.
    """

    block: Array

    @property
    def position(self) -> Array:
        """Target position (n,), rad."""
        return self.block[0]

    @property
    def velocity(self) -> Array:
        """Target velocity (n,), rad/s."""
        return self.block[1]

    @property
    def torque(self) -> Array:
        """Feed-forward torque (n,), N m."""
        return self.block[2]

    @property
    def stiffness(self) -> Array:
        """Proportional gain (n,), N m/rad."""
        return self.block[3]

    @property
    def damping(self) -> Array:
        """Derivative gain (n,), N m s/rad."""
        return self.block[4]

    @classmethod
    def of(
        cls,
        joints: Joints,
        *,
        position: Array | float,
        velocity: Array | float | None = None,
        torque: Array | float | None = None,
        stiffness: Array | float | None = None,
        damping: Array | float | None = None,
    ) -> "JointCommand":
        """Return a command whose arrays are read-only.

        Args:
            joints: The joints.
            position: (n,) rad.
            velocity: (n,) rad/s, by default 0.
            torque: (n,) N m, by default 0.
            stiffness: (n,) N m/rad, by default the joints' own.
            damping: (n,) N m s/rad, by default the joints' own.

        Raises:
            UnsafeCommandError: An array has another shape.
        """
        block = np.zeros((len(FIELDS), len(joints)))
        try:
            block[0] = position
            if velocity is not None:
                block[1] = velocity
            if torque is not None:
                block[2] = torque
            block[3] = joints.stiffness if stiffness is None else stiffness
            block[4] = joints.damping if damping is None else damping
        except ValueError:
            _check_rows((position, velocity, torque, stiffness, damping), len(joints))
            raise
        block.setflags(write=False)
        return cls(block)

    @classmethod
    def hold(cls, joints: Joints, position: Array) -> "JointCommand":
        """Return the command that holds `position` (n,) rad with the robot's default gains."""
        return cls.of(joints, position=position)

    def with_position(self, position: Array) -> "JointCommand":
        """Return the same command with other target positions (n,) rad."""
        block = self.block.copy()
        block[0] = position
        return JointCommand(block)


def check_shape(block: Array, joints: int) -> None:
    """Raise unless the block of a command has the shape (5, n) for n `joints`.

    Raises:
        UnsafeCommandError: It has another one.
    """
    shape = (len(FIELDS), joints)
    if block.shape != shape:
        raise UnsafeCommandError(
            f"a command of shape {block.shape} for {joints} joints; its shape has to be {shape}"
        )


def _check_rows(rows: Sequence[Array | float | None], joints: int) -> None:
    """Raise if an array of `FIELDS` has not one value for each of n `joints`.

    Raises:
        UnsafeCommandError: It has not; the message names it.
    """
    for name, row in zip(FIELDS, rows, strict=True):
        shape = np.shape(0.0 if row is None else row)
        if shape not in ((), (joints,)):
            raise UnsafeCommandError(
                f"{name}: a command of shape {shape} for {joints} joints; its shape has to be "
                f"{(joints,)}"
            )


def joint_torque(command: JointCommand, q: Array, dq: Array, limit: Array) -> Array:
    """Return the torque (n,) N m of ideal joints at `q` rad and `dq` rad/s, within ±`limit` N m."""
    torque = (
        command.stiffness * (command.position - q)
        + command.damping * (command.velocity - dq)
        + command.torque
    )
    return np.clip(torque, -limit, limit)


def shifted_goal(command: JointCommand, stiffness: Array | None = None) -> Array:
    """Return the goal (n,) rad that makes a position servo apply the feed-forward terms as well.

    ``position + (damping velocity + torque) / stiffness``; without stiffness the goal is
    `position`.

    Args:
        command: The wanted command.
        stiffness: (n,) N m/rad that the joints really have, if it is not the commanded one.
    """
    real = command.stiffness if stiffness is None else stiffness
    push = command.damping * command.velocity + command.torque
    shift = np.divide(push, real, out=np.zeros_like(push), where=real > 0.0)
    return command.position + shift
