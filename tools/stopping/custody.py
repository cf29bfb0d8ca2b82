"""Who is in charge of a robot's torque: this program, watched by a guardian, or the guardian."""

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
from windup.robots import RobotDescription
from windup.tools.stopping.idle import IdleKeeper


class Custody:
    """The guardian of an armed robot, its heartbeat, and what holds the robot between two runs.

    Args:
        robot: The robot.
        backend: Its backend.
        give_up: Stops the robot, when it is idle for too long or unwell.
        motion: Its first motion; None where no servos are at stake.

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
    ) -> None:
        self._robot, self._backend = robot, backend
        self._give_up = WeakMethod(give_up)  # a robot that is closed and forgotten is freed at once
        self._motion = motion
        self.guardian: Guardian | None = None
        self._keeper: IdleKeeper | None = None

    def interrupt(self, by: str) -> None:
        """Hold the robot no longer: its program was interrupted between two runs."""
        keeper = self._keeper
        if keeper is not None:
            keeper.interrupt(by)

    def begin(self) -> None:
        """Have a guardian watch, before torque comes on.

        Raises:
            UsageError: Nobody could stop these servos.
            HardwareError: The guardian does not start.
        """
        if self.guardian is not None and self.guardian.alive:
            return
        self._drop_guardian()
        robot, servos = self._robot, self._backend.backend
        watch, hold = self._backend.watch, robot.safety.hold
        levels = None if watch is None else watch.levels
        self.guardian = guardian_for(servos, robot.stop, robot.crouch, hold, levels)
        if self.guardian is not None:
            self._backend.heartbeat = partial(_tick, self.guardian, self._motion)
            if isinstance(servos, ServoBackend):
                servos.heartbeat = self._alive

    def idle(self) -> None:
        """Hold the robot from now on, until `busy`."""
        if self._keeper is None and isinstance(self._backend.clock, WallClock):
            safety = self._robot.safety
            seconds = safety.hold if self._robot.stop == "hold" else safety.idle
            self._keeper = IdleKeeper(self._backend, seconds, self._beat, self._let_go)

    def busy(self) -> None:
        """Hold it no more: somebody commands it from now on."""
        keeper, self._keeper = self._keeper, None
        if keeper is not None:
            self._alive()
            keeper.end()

    def end(self, off: bool) -> None:
        """Let the guardian go, or leave the robot to it.

        Args:
            off: Torque was read back as off at every joint.
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
            "the guardian (process %d) has %s now: it goes on until torque has been read as off",
            guardian.pid,
            self._robot.name,
        )
        self._forget_guardian()

    def disown(self) -> None:
        """Leave guardian and robot to the process that this one was forked from."""
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

    def _let_go(self, error: WindupError | None) -> None:
        """Have the robot stopped, whose program holds on to it while it is armed."""
        give_up = self._give_up()
        if give_up is not None:
            give_up(error)

    def _beat(self) -> None:
        """Tell the guardian that this process lives.

        Raises:
            GuardianError: The guardian is gone.
        """
        if self.guardian is not None:
            self.guardian.idle()

    def _alive(self) -> None:
        """The same, where a guardian that is gone must not be in the way of a stop."""
        with suppress(GuardianError):
            self._beat()


def _tick(guardian: Guardian, motion: FirstMotion | None) -> None:
    """Tell a guardian of a tick, and whether the robot has made its first motion."""
    guardian.tick(first=motion is not None and not motion.made)
