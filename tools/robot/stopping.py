"""A robot that can be stopped: by its program, a signal, a fork, or because nobody commands it."""

import atexit
import logging
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from weakref import WeakSet

from windup.hal.errors import UnhealthyError, UsageError, WindupError
from windup.hal.guard import StopPolicy
from windup.hal.stopping.stop_flag import Outcome, StopFlag
from windup.tools.reports.run_report import RunReport
from windup.tools.robot.on_stack import OnStack
from windup.tools.robot.start import Start
from windup.tools.stopping.custody import Custody
from windup.tools.stopping.interrupts import (
    RunInterruptedError,
    StopRequests,
    counted_signals,
    note_interruption,
)
from windup.tools.stopping.running import Running
from windup.tools.stopping.signal_listeners import add_signal_listener, remove_signal_listener
from windup.tools.stopping.stop_outcome import stop_outcome
from windup.tools.stopping.stop_request import told_to_stop
from windup.tools.terminal.say import say

INTERRUPTED = "interrupted"
"""The reason of a run that somebody ended."""
LAY = "it was already lying down: put it on its feet"
"""Why a run of a robot that had fallen before ends without a tick."""


@dataclass(eq=False)
class Stoppable(OnStack):
    """A robot with the means to have its torque off in every ending.

    Attributes:
        loop: Report of the last run.
        armed: Torque was switched on, and has not been read back as off since.
        custody: Who is in charge of the torque.
        start: What comes before the first command; None without servos.
        flag: By which `windup stop` stops it from another terminal; None in mere simulations.
        on_stop: Called when the stop policy is about to be carried out.
    """

    loop: RunReport = field(default_factory=RunReport, init=False)
    armed: bool = field(default=False, init=False)
    on_stop: Callable[[], None] | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        self.start = Start(self.description, self.stack) if self.stack.wired else None
        motion = None if self.start is None else self.start.motion
        self.flag = self._open_flag()
        self.custody = Custody(self.description, self.backend, self._stop_idle, motion, self.flag)
        self.running = Running()
        self._failed: WindupError | None = None
        self._closed = ""
        if self.stack.wired:
            add_signal_listener(self)
            _open.add(self)

    @property
    def lasting(self) -> bool:
        """Does a run take real time, so that somebody may want to stop it from elsewhere?"""
        return self.stack.real

    def _open_flag(self) -> StopFlag | None:
        """Return the stop flag of this program for this robot; it runs without one all the same."""
        if not self.lasting:
            return None
        try:
            return StopFlag.create(self.description.name, self.stack.port)
        except UsageError as error:
            logging.getLogger(__name__).warning("`windup stop` cannot stop this: %s", error)
            return None

    def _heed(self, asked: StopRequests) -> None:
        """Count a request by the stop flag."""
        if (by := told_to_stop(self.flag)) is not None:
            asked.add(by)

    def on_signal(self, by: str) -> None:
        """Stop where a signal tells the main thread, which is not in a run, to end."""
        note_interruption(by)
        self.running.end(by)
        self.custody.interrupt(by)

    def stop(self, *, limp: bool = False) -> None:
        """Carry out the stop policy at once; with `torque_off`, just switch the torque off.

        Signals do not interrupt it; three of them leave out a crouch. While a run is going on, it
        ends the run, which stops the robot: at the next tick, where the run calls this itself.

        Raises:
            UsageError: The robot is closed.
            HardwareError: Torque was told to go off and a joint read back on, or not at all.
            KeyboardInterrupt: A signal came meanwhile; the robot has stopped.
        """
        with counted_signals(self.stack.wired) as asked:
            if not self.running.end_and_wait("robot.stop()"):
                with self.held_afterwards():
                    self._stop("limp" if limp else None, asked)
        self._raise_if(asked)

    def _raise_if(self, asked: StopRequests) -> None:
        """Raise what was asked for meanwhile; from now on nothing arms by itself.

        Raises:
            RunInterruptedError: A signal came.
        """
        if asked():
            note_interruption(asked.by)
            raise RunInterruptedError(self.loop, asked.by)

    def check_open(self) -> None:
        """Raise unless the robot is open.

        Raises:
            UsageError: It is closed, or belongs to the process that this one was forked from.
        """
        if self._closed:
            raise UsageError(
                f"this {self.description.name} {self._closed}: open it with Robot.open"
            )

    @contextmanager
    def held_afterwards(self) -> Iterator[None]:
        """Take the robot from whoever holds it, and have it held again while it is armed.

        Raises:
            UsageError: It is closed.
            WindupError: It could not be held; nobody knows whether its torque is off.
        """
        self.check_open()
        self.custody.busy()
        if self._failed is not None:
            raise self._failed
        try:
            yield
        finally:
            if self.armed and not self._closed:
                self.custody.idle()

    def _stop(self, policy: StopPolicy | None, asked: StopRequests) -> None:
        """Stop; the guardian is let go only if torque has been read back as off.

        A robot that has fallen goes limp, and so does one that would crouch before it has made its
        first motion.
        """
        policy = policy or self.backend.stop_policy
        moved = self.start is None or self.start.motion.made
        if self.fallen or (policy == "crouch" and not moved):
            policy = "limp"
        before, flag = self.armed, self.flag
        if self.on_stop is not None:
            self.on_stop()
        try:
            state = self.backend.stop(
                policy, lambda: asked.skip_crouch or (flag is not None and flag.again())
            )
        except WindupError as error:
            self._report(Outcome(said=str(error), stopped=False))
            raise
        self.armed = not state.all_off
        self._report(stop_outcome(state, self.description.joints))
        if not self.armed:
            self.custody.end(off=True)
            self._say_off(before)

    def _report(self, outcome: Outcome) -> None:
        """Tell who asked for a stop by the flag what became of it."""
        if self.flag is not None:
            self.flag.finish(outcome)

    def _say_off(self, was_on: bool) -> None:
        if was_on and self.stack.real:
            count = len(self.description.joints)
            say(f"{self.description.name}: torque is off at all {count} joints, read back")

    def _stop_before(self, asked: StopRequests) -> None:
        """Stop a robot whose run was to end before its first tick."""
        self.loop.reason = INTERRUPTED
        note_interruption(asked.by)
        if self.armed:
            self._stop_after_error(asked)
        elif self.flag is not None and self.flag.asked():
            self._stop("limp", asked)  # also says what is read of the torque

    def _stop_after_error(self, asked: StopRequests, error: WindupError | None = None) -> None:
        """Carry out the stop policy; nobody holds a joint that is unwell, or bad news."""
        unwell = isinstance(error, UnhealthyError) and self.backend.stop_policy == "hold"
        limp = error is not None and (error.torque_off_at_once or unwell)
        try:
            self._stop("limp" if limp else None, asked)
        except WindupError as failed:
            self.loop.reason += f"; and the stop failed: {failed}"

    def _stop_idle(self, error: WindupError | None) -> None:
        """Stop because nobody commands the robot, or because of an error, which leaves no time."""
        self._failed, before = error, self.armed
        try:
            policy = self.backend.stop_policy if error is None else "limp"
            moved = self.start is None or self.start.motion.made
            if policy == "hold" or self.fallen or not moved:
                policy = "limp"
            state = self.backend.stop(policy)
            self.armed = not state.all_off
            self._report(stop_outcome(state, self.description.joints))
        except WindupError as failed:
            self._report(Outcome(said=str(failed), stopped=False))
            logging.getLogger(__name__).warning("%s", failed)
            self._failed = error or failed
        self.custody.end(off=not self.armed)
        if not self.armed:
            self._say_off(before)

    def _end_of_program(self) -> None:
        """The program ends without having closed the robot."""
        try:
            if self.armed:
                self.stop()
        except (WindupError, KeyboardInterrupt) as error:
            logging.getLogger(__name__).warning("%s", error)
        finally:
            self._disconnect()

    def _disconnect(self) -> None:
        """Give the ports back; torque that has not been read as off is left to the guardian."""
        self._closed = "is closed"
        atexit.unregister(self._end_of_program)
        with counted_signals(self.stack.wired):
            self.custody.busy()
            self.stack.close()
            self.custody.end(off=not self.armed)
        if self.flag is not None:
            self.flag.remove()
            self.flag = None
        remove_signal_listener(self)

    def disown(self) -> None:
        """Leave the robot to the process that this one was forked from."""
        self._closed = "belongs to the process that opened it"
        self.armed, self.flag = False, None
        self.custody.disown()
        atexit.unregister(self._end_of_program)


_open: "WeakSet[Stoppable]" = WeakSet()


def _disown_all() -> None:
    """Nothing that a forked child does reaches its parent's robots."""
    for robot in tuple(_open):
        robot.disown()


os.register_at_fork(after_in_child=_disown_all)
