"""Responsibility for a robot's torque: this program's, watched by a guardian, or the guardian's."""

import logging
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from weakref import WeakMethod

from windup.control.motions.first_motion import FirstMotion
from windup.hal.clock import WallClock
from windup.hal.errors import GuardianError, WindupError
from windup.hal.guard import GuardedBackend
from windup.hal.guardian.handle import Guardian, guardian_for
from windup.hal.heartbeat import no_heartbeat
from windup.hal.servo_bus.servo_backend import ServoBackend
from windup.hal.stopping.stop_flag import StopFlag
from windup.robots import RobotDescription
from windup.tools.stopping.idle import IdleKeeper


class Custody:
    """The guardian of an armed robot, its heartbeat, and the holding of the robot between two runs.

    Args:
        robot: The robot.
        backend: Its backend.
        give_up: Stops the robot when it has been idle for too long, or is unhealthy.
        motion: Its first motion; None for a robot without servos.
        flag: Stop flag of this program.

    Attributes:
        guardian: The process that stops the robot when this one dies or hangs; None without torque,
            and where the servos are emulated in this process.
    """

    def __init__(
        self,
        robot: RobotDescription,
        backend: GuardedBackend,
        give_up: Callable[[WindupError | None], None],
        motion: FirstMotion | None = None,
        flag: StopFlag | None = None,
    ) -> None:
        self._robot, self._backend, self._flag = robot, backend, flag
        self._give_up = WeakMethod(give_up)  # does not keep a robot that is closed alive
        self._motion = motion
        self.guardian: Guardian | None = None
        self._keeper: IdleKeeper | None = None

    def interrupt(self, by: str) -> None:
        """Hold the robot no longer, because its program was interrupted between two runs."""
        keeper = self._keeper
        if keeper is not None:
            keeper.interrupt(by)

    def begin(self) -> None:
        """Start a guardian, before torque is switched on.

        Raises:
            UsageError: No guardian could stop these servos.
            HardwareError: The guardian does not start.
        """
        if self.guardian is not None and self.guardian.alive:
            return
        self._drop_guardian()
        robot, servos = self._robot, self._backend.backend
        watch, hold = self._backend.watch, robot.safety.hold
        levels = None if watch is None else watch.levels
        self.guardian = guardian_for(servos, robot.stop, robot.crouch, hold, levels, self._flag)
        if self.guardian is not None:
            self._backend.heartbeat = partial(_tick, self.guardian, self._motion)
            if isinstance(servos, ServoBackend):
                servos.heartbeat = self._alive

    def idle(self) -> None:
        """Hold the robot until `busy`."""
        if self._keeper is None and isinstance(self._backend.clock, WallClock):
            safety = self._robot.safety
            seconds = safety.hold if self._robot.stop == "hold" else safety.idle
            self._keeper = IdleKeeper(
                self._backend, seconds, self._beat, self._stop_robot, self._flag
            )

    def busy(self) -> None:
        """Stop holding the robot, because it is commanded from now on."""
        keeper, self._keeper = self._keeper, None
        if keeper is not None:
            self._alive()
            keeper.end()

    def end(self, off: bool) -> None:
        """Release the guardian, or hand the robot over to it.

        Args:
            off: Whether torque was read back as off at every joint.
        """
        self.busy()
        guardian = self.guardian
        if guardian is None:
            return
        if off or not guardian.alive:
            self._drop_guardian()
            return
        guardian.hand_over()
        logging.getLogger(__name__).warning(
            "the guardian (process %d) has %s now: it continues until torque has been read as off",
            guardian.pid,
            self._robot.name,
        )
        self._forget_guardian()

    def disown(self) -> None:
        """Leave guardian and robot to the parent process, after a fork."""
        self._keeper = None
        self._forget_guardian()

    def _drop_guardian(self) -> None:
        if self.guardian is not None:
            self.guardian.release()
        self._forget_guardian()

    def _forget_guardian(self) -> None:
        self.guardian = None
        self._backend.heartbeat = no_heartbeat
        if isinstance(self._backend.backend, ServoBackend):
            self._backend.backend.heartbeat = no_heartbeat

    def _stop_robot(self, error: WindupError | None) -> None:
        """Stop the robot by `give_up`, if it still exists."""
        give_up = self._give_up()
        if give_up is not None:
            give_up(error)

    def _beat(self) -> None:
        """Send the guardian an idle heartbeat, if there is one.

        Raises:
            GuardianError: The guardian has died.
        """
        if self.guardian is not None:
            self.guardian.idle()

    def _alive(self) -> None:
        """Send an idle heartbeat; ignore a dead guardian, which must not prevent a stop."""
        with suppress(GuardianError):
            self._beat()


def _tick(guardian: Guardian, motion: FirstMotion | None) -> None:
    """Send the guardian the heartbeat of a tick, and whether the first motion is still due."""
    guardian.tick(first=motion is not None and not motion.made)
