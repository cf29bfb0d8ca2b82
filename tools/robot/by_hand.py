"""Reads and writes of a robot outside of a run: each write is a tick by itself."""

import logging
from math import nan

from windup.control.loop import TickLoop
from windup.hal.command import JointCommand
from windup.hal.errors import UsageError, WindupError
from windup.hal.observation import Observation
from windup.sim_twin.backend import TwinClock
from windup.tools.reports.run_report import RunReport
from windup.tools.robot.given import GivenCommand
from windup.tools.robot.runner import Runner
from windup.tools.robot.stopping import INTERRUPTED
from windup.tools.stopping.interrupts import RunInterruptedError, StopRequests, counted_signals
from windup.tools.stopping.stop_request import pressed_button, told_to_stop

SAME = (
    "robot.read() gave the same instant twice: time of a twin passes in "
    "`for observation in robot.ticks():`, robot.write() and robot.run() only"
)
LOOP = "write in `for observation in robot.ticks():`"


class ByHand:
    """Reads and writes of a robot outside of a run, on the schedule of its loop.

    Falls are not looked for: that is what the ticks of a run are for. The robot is an argument of
    each call, so that it is freed at once when it is closed.
    """

    def __init__(self) -> None:
        self._given: GivenCommand | None = None
        self._loop: TickLoop | None = None
        self._report, self._begun = RunReport(), -1
        self._read_at, self._said = nan, False

    def forget(self) -> None:
        """Forget the loop, when the robot is closed."""
        self._given = self._loop = None

    def check_may_move(self, runner: Runner) -> None:
        """Raise unless the joints may move.

        Raises:
            UsageError: Their torque is off, or they have not made their first motion.
        """
        name, twin = runner.description.name, runner.stack.twin
        off = f"the torque of {name} is off: call robot.stand() first, or {LOOP}"
        if not runner.stack.wired:
            if runner.body is None and twin is not None and not twin.powered:
                raise UsageError(off)
            return
        if not runner.stack.may_arm:
            raise UsageError(
                f"the torque of {name} is off: open it with Robot.open(..., arm=True), and hold on "
                "to it"
            )
        if runner.body is not None:
            return
        if not runner.armed:
            raise UsageError(off)
        if runner.start is not None and not runner.start.motion.made:
            raise UsageError(
                f"{name} has not made its first motion: call robot.stand() first, or {LOOP}"
            )

    def read(self, runner: Runner) -> Observation:
        """Return a new observation, with its base state.

        Raises:
            UsageError: The robot is closed.
            WindupError: From the backend or the guard.
        """
        runner.check_open()
        runner.raise_pending_interrupt()
        seen = self._observe(self._current(runner))
        stands = isinstance(runner.backend.clock, TwinClock)
        if stands and seen.time == self._read_at and not self._said:
            self._said = True
            logging.getLogger(__name__).warning(SAME)
        self._read_at = seen.time
        return seen

    def write(self, runner: Runner, command: JointCommand) -> JointCommand:
        """Send a command, wait for the next tick, and return what the joints really got.

        Raises:
            RunInterruptedError: There was a request to stop; the robot has stopped.
            WindupError: From the guard or the backend; the robot has stopped.
        """
        runner.raise_pending_interrupt()
        with (
            counted_signals(runner.stack.wired) as asked,
            runner.running,
            runner.held_afterwards(),
        ):
            runner.check_going_on(asked)
            applied = self._tick(runner, command, asked)
            self._stop_if_asked(runner, asked)
        if asked():
            raise RunInterruptedError(runner.loop, asked.by)
        return applied

    def _tick(self, runner: Runner, command: JointCommand, asked: StopRequests) -> JointCommand:
        """Send a command in a tick of its own; stop the robot after an error."""
        loop, runner.loop = self._current(runner), self._report
        assert self._given is not None, "it came with the loop"
        if loop.recorder is None:
            loop.recorder = runner.telemetry.begin(self._given)
        try:
            if loop.observation is None or loop.applied is not None:
                self._observe(loop)
            self._given.command = command
            applied = loop.command()
            loop.finish()
        except WindupError as error:
            runner.fail(error, asked)
            raise
        return applied

    def _stop_if_asked(self, runner: Runner, asked: StopRequests) -> None:
        if by := told_to_stop(runner.flag) or pressed_button(runner.backend.backend):
            asked.add(by)
        if asked():
            runner.loop.reason = INTERRUPTED
            runner.stop_if_asked(asked)

    def _observe(self, loop: TickLoop) -> Observation:
        seen = loop.observe()
        assert seen is not None, "nothing ends this loop"
        return seen

    def _current(self, runner: Runner) -> TickLoop:
        """Return the loop that goes on, or a new one after a run."""
        loop = self._loop
        if loop is None or self._begun != runner.runs:
            self._given, self._report = runner.given_command(), RunReport()
            loop = self._loop = runner.loop_by_hand(self._given, self._report)
            self._begun = runner.runs
        return loop
