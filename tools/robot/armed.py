"""A robot whose torque comes on: once it is seen to be well, and in a posture for it."""

import atexit
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass

from windup.hal.errors import HardwareError, PostureError, UsageError, WindupError
from windup.hal.torque_state import TorqueState
from windup.tools.robot.port_urls import NOT_ARMED
from windup.tools.robot.stopping import Stoppable
from windup.tools.stopping.interrupts import (
    StopRequests,
    check_not_interrupted,
    counted_signals,
    forget_interruption,
)
from windup.tools.stopping.stop_request import check_released, how_to_stop
from windup.tools.terminal.say import say


@dataclass(eq=False)
class Armed(Stoppable):
    """A robot with the means to switch its torque on."""

    def arm(self) -> None:
        """Switch the torque on at the present pose, where there are servos to switch.

        Also what a program has to call that goes on after it was interrupted.

        Raises:
            UsageError: The port is real and `arm` was not given, or the robot is closed; nothing
                has moved.
            HardwareError: A servo did not take it, or the guardian does not start; all torque is
                off again.
            KeyboardInterrupt: A signal came meanwhile; all torque is off again.
        """
        forget_interruption()
        with counted_signals(self.stack.wired) as asked, self.held_afterwards():
            self._arm_once(asked)
        self._raise_if(asked)

    def rearm(self) -> None:
        """Switch the torque on again after a port was unplugged, at the pose of now.

        The servos are checked and set as when the robot was opened: some may have had no power.

        Raises:
            UsageError: As of `arm`.
            PortError: The port is still gone; torque is off wherever it can be reached.
            HardwareError: As of `arm`.
            KeyboardInterrupt: As of `arm`.
        """
        forget_interruption()
        with counted_signals(self.stack.wired) as asked, self.held_afterwards():
            if self.stack.wired:
                self._arm(self.backend.rearm, asked)
            else:
                self._power_twin()
        self._raise_if(asked)

    def _get_ready(self, down: bool, asked: StopRequests) -> None:
        """Switch torque on where it is off, once the robot is seen to be in a posture for it.

        Where somebody asks for the end meanwhile, it stays off, or goes off again.

        Raises:
            PostureError: It is in no posture for it; torque is off.
        """
        self._heed(asked)
        self.check_going_on(asked)
        start = self.start
        if start is not None and (start.unseen or not self.armed):
            try:
                start.check(down)
            except PostureError:
                if self.armed:
                    self._stop("limp", asked)
                raise
        self._arm_once(asked)
        if start is not None:
            start.unseen = False

    def check_going_on(self, asked: StopRequests) -> None:
        """Refuse to go on after an interruption, which stops the robot.

        Raises:
            UsageError: There was one; the stop policy has been carried out.
        """
        if not self.stack.wired or (self.armed and self.backend.stop_policy == "hold"):
            return
        try:
            check_not_interrupted()
        except UsageError:
            if self.armed:
                self._stop(None, asked)
            raise

    def _arm_once(self, asked: StopRequests) -> None:
        if not self.stack.wired:
            self._power_twin()
        elif not self.armed:
            self._arm(lambda: self.backend.set_torque(True), asked)

    def _power_twin(self) -> None:
        """Switch a twin without servos on again after a stop."""
        if self.stack.twin is not None and not self.stack.twin.powered:
            self.backend.set_torque(True)

    def _arm(self, switch_on: Callable[[], TorqueState], asked: StopRequests) -> None:
        """Switch torque on, unless or until somebody asks for the end."""
        if not self.stack.may_arm:
            raise UsageError(NOT_ARMED)
        check_released(self.backend.backend)
        if self.stack.real:
            say(f"arming {self.description.name}: {how_to_stop(self.backend.backend)}")
        self.backend.check_before_arming()
        self._heed(asked)
        if asked():
            return
        self.custody.begin()
        atexit.register(self._end_of_program)
        if self.start is not None:
            self.start.begin()
        self._heed(asked)
        if asked():
            self.custody.end(off=not self.armed)
            return
        self.armed = True
        try:
            self._switch(switch_on)
        except BaseException:
            with suppress(WindupError):
                self._stop("limp", asked)
            raise
        self._heed(asked)
        if asked():
            self._stop("limp", asked)

    def _switch(self, switch_on: Callable[[], TorqueState]) -> None:
        """Switch torque on and see that it is.

        Raises:
            HardwareError: It is not everywhere.
        """
        state = switch_on()
        if not state.all_on:
            where = state.names(self.description.joints, ~state.on)
            raise HardwareError(f"torque does not come on at {where}; run `windup scan`")
