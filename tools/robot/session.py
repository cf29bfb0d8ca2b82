"""A session on a robot: run controllers in the loop, read and write by hand, and stop."""

import logging
from dataclasses import dataclass, field
from types import TracebackType
from typing import Annotated, Self

from windup.control.motions.play import PoseHolder
from windup.hal.command import JointCommand
from windup.hal.errors import WindupError
from windup.hal.guard.finding import Finding
from windup.hal.observation import Observation
from windup.hal.ranges import numbers_checked
from windup.tools.robot.by_hand import ByHand
from windup.tools.robot.given import LASTING, check_command
from windup.tools.robot.runner import Runner
from windup.tools.robot.ticks import Ticks
from windup.tools.stopping.interrupts import (
    RunInterruptedError,
    counted_signals,
    note_interruption,
)
from windup.tools.terminal.run_notes import NOTES

REST_SECONDS = 1.5


@dataclass(eq=False)
class Session(Runner):
    """An open robot: the implementation behind `Robot`.

    Attributes:
        by_hand: Reads and writes outside of a run.
    """

    by_hand: ByHand = field(init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        self.by_hand = ByHand()

    @property
    def lasting(self) -> bool:
        """Does a run take real time?"""
        return self.paced

    @property
    def warnings(self) -> list[Finding]:
        """What there was to warn about so far: one finding a kind."""
        health = self.backend.watch.warnings if self.backend.watch is not None else []
        return [*health, *self.imu.warnings]

    @numbers_checked
    def ticks(
        self,
        seconds: Annotated[float | None, LASTING] = None,
        *,
        down: bool = False,
        needs_imu: bool = False,
    ) -> Ticks:
        """Return the ticks of a run, for a `for` loop whose body is the controller.

        Args:
            seconds: How long, s; for ever if None.
            down: As of `run`.
            needs_imu: As of `run`.
        """
        return Ticks(self, seconds, down=down, needs_imu=needs_imu)

    def read(self) -> Observation:
        """Return the observation of the present tick, or outside of a run a new one.

        Raises:
            UsageError: The robot is closed.
            WindupError: From the backend or the guard.
        """
        if self.running.active and self.seen is not None:
            return self.seen
        return self.by_hand.read(self)

    def write(self, command: JointCommand) -> JointCommand:
        """Send the command of the present tick; return the command that the joints really got.

        Outside of a run this is a tick by itself: it waits until the next one is due.

        Raises:
            UsageError: It is no command, or the joints may not move; nothing was sent.
            WindupError: From the guard or the backend; the robot has stopped.
        """
        self.check_open()
        check_command(command)
        self.by_hand.check_may_move(self)
        if self.body is not None:
            return self.body.write(command)
        return self.by_hand.write(self, command)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if self._closed:
            return
        self.close_ticks()
        with counted_signals(self.stack.wired) as asked:
            try:
                self._let_go(error)
            finally:
                self._disconnect()
        if asked():
            note_interruption(asked.by)
            if error is None:
                raise RunInterruptedError(self.loop, asked.by)
        if error is None:
            self.raise_pending_interrupt()

    def _let_go(self, error: BaseException | None) -> None:
        """Rest after a run that went well, else stop; an error is never replaced by the stop's."""
        if self.armed and error is None and not self.fallen:
            self.rest()
        elif self.armed:
            try:
                self.stop()
            except WindupError as failed:
                if error is None:
                    raise
                logging.getLogger(__name__).warning("%s", failed)

    def rest(self) -> None:
        """Crouch, if the robot has a pose for it, and switch the torque off."""
        crouch = self.description.crouch
        if crouch is not None:
            self.run(PoseHolder(self.description.joints, crouch, REST_SECONDS), REST_SECONDS + 0.3)
        self.stop(limp=True)

    def close(self) -> None:
        """Rest and disconnect, as at the end of a `with`; once more is no matter.

        Raises:
            HardwareError: Torque is not off at every joint; the guardian has the robot now.
        """
        self.__exit__(None, None, None)

    def _disconnect(self) -> None:
        if not self._closed:
            NOTES.add(self.warnings, self.slowness, self.backend.backend)
        self.by_hand.forget()
        super()._disconnect()
        self.telemetry.close()
