"""A robot whose torque is on or off: arming, stopping, and who holds it between two runs."""

import atexit
import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from control.loop import LoopReport
from hal.errors import HardwareError, PostureError, UsageError, WindupError
from hal.guard import StopPolicy
from hal.torque_state import TorqueState
from tools.custody import Custody
from tools.interrupts import (
    Asked,
    RunInterruptedError,
    check_not_interrupted,
    counted_signals,
    forget_interruption,
)
from tools.on_stack import OnStack
from tools.output import console
from tools.running import Running
from tools.start import Start
from tools.stop_request import check_released, how_to_stop


@dataclass
class Armed(OnStack):
    """A robot with the means to switch its torque on, and to have it off in every ending.

    Attributes:
        loop: Report of the last run.
        armed: Torque was switched on, and has not been read back as off since.
        custody: Who is in charge of the torque.
        start: What comes before the first command; None without servos.
    """

    loop: LoopReport = field(default_factory=LoopReport, init=False)
    armed: bool = field(default=False, init=False)

    def __post_init__(self) -> None:
        self.custody = Custody(self.description, self.backend, self._stop_idle)
        self.start = None
        if self.stack.wired:
            self.start = Start(self.description, self.stack)
        self._running = Running()
        self._failed: WindupError | None = None
        self._closed = False

    def arm(self) -> None:
        """Switch the torque on at the present pose, where there are servos to switch.

        Also what a program has to call that goes on after it was interrupted.

        Raises:
            UsageError: The port is real and `arm` was not given; nothing has moved.
            HardwareError: A servo did not take it, or the guardian does not start; all torque is
                off again.
        """
        forget_interruption()
        with self._held_afterwards():
            self._arm_once()

    def rearm(self) -> None:
        """Switch the torque on again after a port was unplugged, at the pose of now.

        The servos are checked and set as when the robot was opened: some may have had no power.

        Raises:
            UsageError: As of `arm`.
            PortError: The port is still gone; torque is off wherever it can be reached.
            HardwareError: As of `arm`.
        """
        forget_interruption()
        with self._held_afterwards():
            if self.stack.wired:
                self._arm(self.backend.rearm)

    def _get_ready(self, down: bool, asked: Asked) -> None:
        """Switch torque on where it is off, once the robot is seen to be in a posture for it.

        Raises:
            PostureError: It is not; torque is off.
        """
        start = self.start
        if start is not None and (start.unseen or not self.armed):
            try:
                start.check(down)
            except PostureError:
                if self.armed:
                    self._stop("limp", asked)
                raise
        self._arm_once()
        if start is not None:
            start.unseen = False

    def _arm_once(self) -> None:
        if not self.armed and self.stack.wired:
            check_not_interrupted()
            self._arm(lambda: self.backend.set_torque(True))

    def _arm(self, switch_on: Callable[[], TorqueState]) -> None:
        if not self.stack.may_arm:
            raise UsageError("this moves a robot: give --arm (arm=True), and hold on to it")
        check_released(self.backend.backend)
        if self.stack.real:
            console.print(f"arming {self.description.name}: {how_to_stop(self.backend.backend)}")
        self.backend.admit()
        self.custody.begin()
        self.armed = True
        atexit.register(self._end_of_program)
        state = switch_on()
        if not state.all_on:
            where = state.names(self.description.joints, ~state.on)
            raise HardwareError(f"torque does not come on at {where}; run `windup scan`")
        if self.start is not None:
            self.start.begin()

    def stop(self, *, limp: bool = False) -> None:
        """Carry out the stop policy at once; with `limp`, just switch the torque off.

        Signals do not interrupt it; three of them leave out a crouch. From another thread than
        that of a run it ends the run, which stops the robot.

        Raises:
            HardwareError: Torque was told to go off and a joint read back on, or not at all.
            KeyboardInterrupt: A signal came meanwhile; the robot has stopped.
        """
        with counted_signals(self.stack.wired) as asked:
            if not self._running.end_from_elsewhere():
                with self._held_afterwards():
                    self._stop("limp" if limp else None, asked)
        if asked():
            raise RunInterruptedError(self.loop, asked.by)

    @contextmanager
    def _held_afterwards(self) -> Iterator[None]:
        """Take the robot from whoever holds it, and have it held again while it is armed.

        Raises:
            WindupError: It could not be held; nobody knows whether its torque is off.
        """
        self.custody.busy()
        if self._failed is not None:
            raise self._failed
        try:
            yield
        finally:
            if self.armed and not self._closed:
                self.custody.idle()

    def _stop(self, policy: StopPolicy | None, asked: Asked) -> None:
        """Stop; the guardian is let go only if torque has been read back as off.

        A robot that has fallen goes limp whatever its policy is.
        """
        if self.fallen:
            policy = "limp"
        self.armed = not self.backend.stop(policy, lambda: asked.impatient).all_off
        if not self.armed:
            self.custody.end(off=True)

    def _stop_idle(self, error: WindupError | None) -> None:
        """Switch the torque off because nobody commands the robot, or because of an error."""
        self._failed = error
        try:
            self.armed = not self.backend.stop("limp").all_off
        except WindupError as failed:
            logging.getLogger(__name__).warning("%s", failed)
            self._failed = error or failed
        self.custody.end(off=not self.armed)

    def _end_of_program(self) -> None:
        """The program ends without having closed the robot."""
        try:
            if self.armed:
                self.stop()
        except (WindupError, KeyboardInterrupt) as error:
            logging.getLogger(__name__).warning("%s", error)
        finally:
            self.close()

    def close(self) -> None:
        """Disconnect; torque that has not been read back as off is left to the guardian."""
        self._closed = True
        atexit.unregister(self._end_of_program)
        with counted_signals(self.stack.wired):
            self.custody.busy()
            self.stack.close()
            self.custody.end(off=not self.armed)
