"""Runs controllers on a robot, and carries out the stop policy after every kind of failure."""

import logging
from collections.abc import Generator, Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated
from weakref import ref

from windup.control.loop import Recorder, TickLoop, Until
from windup.hal.clock import real_time_loop
from windup.hal.command import JointCommand
from windup.hal.controller import Controller, Stopwatch
from windup.hal.errors import ControllerError, WindupError
from windup.hal.observation import Observation
from windup.hal.publishing.run_state import RunState
from windup.hal.ranges import numbers_checked
from windup.sim_twin.backend import TwinClock
from windup.tools.assembly.protect import Protection
from windup.tools.reports.recording import Recording
from windup.tools.reports.run_report import RunReport
from windup.tools.robot.given import LASTING, Body, GivenCommand, ReadOnly, check_controller
from windup.tools.robot.run_end import PreparedRun, RunEnd
from windup.tools.robot.stopping import INTERRUPTED
from windup.tools.robot.watched import Watched
from windup.tools.stopping.break_off import BreakOff
from windup.tools.stopping.interrupts import (
    RunInterruptedError,
    StopRequests,
    counted_signals,
    note_interruption,
)
from windup.tools.stopping.stop_request import stop_requests

if TYPE_CHECKING:  # not needed by robots that do not fall
    from windup.control.falling.protection import Protected
TicksIterator = Generator[Observation, None, None]


@dataclass(eq=False)
class Runner(Watched):
    """A robot that controllers run on.

    Attributes:
        paced: The loop runs in real time.
        protect: A fall that cannot be prevented is softened, where the robot's file says how.
        record: Each run records its ticks for the arrays of its report.
        body: The body of a `for` loop over ticks, while it is executed.
        ticks_iterator: The iterator of the last loop over ticks, while it exists.
        runs: Number of runs so far.
        pending_interrupt: Source of a stop request in the tick in which a loop over ticks was left.
            Nothing can be raised there, so the next call raises it; "" if there is none.
        controller: The controller of the present run, or of the last one.
        protected: Protection of that run against falls, or None.
        break_off: Ends runs while the robot stays held, where somebody owns it beyond them.
    """

    paced: bool = False
    protect: bool = True
    record: bool = False
    body: Body | None = field(default=None, init=False)
    ticks_iterator: "ref[TicksIterator] | None" = field(default=None, init=False)
    runs: int = field(default=0, init=False)
    pending_interrupt: str = field(default="", init=False)
    controller: Controller | None = field(default=None, init=False)
    protected: "Protected | None" = field(default=None, init=False)
    break_off: BreakOff | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        self._protection = Protection(self.description)

    @numbers_checked
    def run(
        self,
        controller: Controller,
        seconds: Annotated[float | None, LASTING] = None,
        *,
        until: Until | None = None,
        rollouts: Stopwatch | None = None,
        down: bool = False,
        needs_imu: bool = False,
        report: RunReport | None = None,
    ) -> RunReport:
        """Run a controller until the time is over, `until` gives a reason, or the robot falls.

        Where the robot falls `protect`ed, until it lies still.

        Args:
            controller: The controller.
            seconds: How long, s of the backend's clock; for ever if None. On servos that were just
                armed, from the end of the first motion on.
            until: Called with each observation; a reason ends the run.
            rollouts: Time to leave out of the ticks.
            down: The robot may lie: a fall does not end the run.
            needs_imu: The controller balances with the IMU, or decides by it: one that fails stops
                the robot. Without, that is a warning.
            report: Filled in as the run goes; a new one by default.

        Raises:
            UsageError: It is no controller, or `seconds` is negative; nothing has moved.
            PostureError: It was to be armed, and a joint is outside of its limits, or it needs its
                feet (not `down`) and sits or lies.
            FirstMotionError: A joint did not follow in the first motion; the robot is limp.
            WindupError: From the guard, the backend or the controller; the stop policy has run.
        """
        check_controller(controller)
        report = RunReport() if report is None else report
        with (
            self.prepared(
                report, controller, seconds, until=until, down=down, needs_imu=needs_imu
            ) as run,
            self.looping(run, rollouts) as loop,
        ):
            while loop is not None and loop.observe() is not None:
                loop.finish()
        return report

    @contextmanager
    def prepared(
        self,
        report: RunReport,
        controller: Controller,
        seconds: float | None,
        *,
        until: Until | None = None,
        down: bool,
        needs_imu: bool,
        may_move: bool = True,
    ) -> Iterator[PreparedRun]:
        """Prepare a run: arm the robot if it `may_move`; hold it again afterwards; see `run`.

        Raises:
            RunInterruptedError: A stop request has ended the run; the robot has stopped.
            BrokenOffError: Whoever owns the robot has ended the run; it is held.
        """
        self.raise_pending_interrupt()
        self.controller = controller
        if self.break_off is not None:
            until = self.break_off.around(until)
        approach = None if self.start is None else self.start.before(controller, down)
        protected = self.protected = None
        if self.protect and self._protection.possible and not down:
            protected = self._protection.around(approach or controller, controller)
            self.protected = protected
        wishes = stop_requests(self.backend.backend, keys=self.stack.real, flag=self.flag)
        with (
            counted_signals(self.stack.wired) as asked,
            self.running,
            self.held_afterwards(),
            wishes as wanted,
        ):
            estimator = self.guarded_estimator(needs_imu)
            if may_move:
                self._get_ready(down, asked)
            self.loop = report
            self.runs += 1
            end = RunEnd(
                asked=asked, wishes=[wanted, lambda: self.running.requested_by],
                fallen=lambda: self.fallen, loop=report, opened=self.backend.clock.now(),
                seconds=seconds, until=until, down=down, approach=approach, protected=protected,
            )  # fmt: skip
            run = PreparedRun(
                protected or approach or controller, end, report, estimator, may_move,
                lambda error: self.fail(error, asked),
            )  # fmt: skip
            yield run
        if report.reason == INTERRUPTED and run.left:
            self.pending_interrupt = asked.by
        elif report.reason == INTERRUPTED:
            raise RunInterruptedError(report, asked.by)
        if self.break_off is not None:
            self.break_off.check(report)

    def raise_pending_interrupt(self) -> None:
        """Raise a stop request that could not be raised when it was carried out.

        Raises:
            RunInterruptedError: A loop over ticks was left, and its robot stopped, in one tick.
        """
        by, self.pending_interrupt = self.pending_interrupt, ""
        if by:
            raise RunInterruptedError(self.loop, by)

    def given_command(self) -> GivenCommand:
        """Return a controller that holds the last goal of the joints until it gets a command."""
        last, joints = self.backend.last, self.description.joints
        held = None if last is None else JointCommand.hold(joints, last[1].position)
        return GivenCommand(joints, held)

    @contextmanager
    def looping(
        self, run: PreparedRun, rollouts: Stopwatch | None = None
    ) -> Iterator[TickLoop | None]:
        """Yield the loop of a run; stop the robot if the run ends by an error or a stop request.

        Yields None if a stop request came before the first tick: the robot has stopped.

        Args:
            run: The run.
            rollouts: Time to leave out of the ticks.
        """
        asked, state = run.end.asked, RunState.FAULTED
        if asked():
            self._stop_before(asked)
            yield None
            return
        recorder = self.telemetry.begin(run.controller)
        try:
            with real_time_loop() if self.paced else nullcontext():
                yield self._loop(run, rollouts, recorder)
            self.stop_if_asked(asked)
            state = RunState.FAULTED if run.failed else self.state_between_runs()
        except WindupError as error:
            self.fail(error, asked)
            raise
        except KeyboardInterrupt as ended:  # raised by a controller of one's own
            asked.by = asked.by or type(ended).__name__
            self.loop.reason = INTERRUPTED
            self._stop_after_error(asked)
            state = self.state_between_runs()
        except BaseException as error:
            self.loop.reason = f"the controller failed: {type(error).__name__}: {error}"
            self._stop_after_error(asked)
            if not isinstance(error, Exception | SystemExit):  # a cancelled task, a failed test
                raise
            raise ControllerError(self.loop.reason) from error
        finally:
            self.conclude(run.report, state)

    def _loop(
        self, run: PreparedRun, rollouts: Stopwatch | None, recorder: Recorder | None
    ) -> TickLoop:
        """Return the loop of a run, with its callbacks and recorders."""
        if isinstance(self.backend.clock, TwinClock):
            self.backend.clock.align()
        if self.record:
            robot = self.description
            recorder = run.report.recording = Recording(
                robot.name, robot.joints.names, robot.contacts.names, recorder
            )
        run.end.open_at(self.backend.clock.now())
        return TickLoop(
            self.backend if run.may_move else ReadOnly(self.backend),
            run.controller,
            period=self.period,
            until=self.with_callbacks(run.end),
            estimator=run.estimator,
            rollouts=rollouts,
            report=run.report,
            recorder=recorder,
        )

    def loop_by_hand(self, controller: Controller, report: RunReport) -> TickLoop:
        """Return a loop without an end, whose ticks are called one by one outside of a run."""
        if isinstance(self.backend.clock, TwinClock):
            self.backend.clock.align()
        return TickLoop(
            self.backend,
            controller if self.start is None else self.start.before(controller, down=True),
            period=self.period,
            until=self.with_callbacks(lambda _: None),
            estimator=self.guarded_estimator(needs_imu=False),
            report=report,
        )

    def close_ticks(self) -> None:
        """End a loop over ticks whose body is executed, before the robot is closed."""
        run = None if self.ticks_iterator is None else self.ticks_iterator()
        if run is not None and self.body is not None:
            run.close()

    def enter_body(self, body: Body, asked: StopRequests) -> None:
        """Begin the body of a `for` loop: from now on the third signal interrupts it."""
        self.body, asked.raises = body, True

    def exit_body(self, asked: StopRequests) -> None:
        """End the body of a `for` loop: signals are only counted again."""
        self.body, asked.raises = None, False

    def stop_if_asked(self, asked: StopRequests) -> None:
        """Stop the robot if a stop request has ended the run."""
        if self.loop.reason == INTERRUPTED:
            if self.stack.wired:
                note_interruption(asked.by)
                logging.getLogger(__name__).warning("stopped by %s", asked.by)
            self._stop_after_error(asked)

    def fail(self, error: WindupError, asked: StopRequests) -> None:
        """Stop the robot because of an error, and publish the observation of its tick, too."""
        self.loop.reason = str(error)
        self.telemetry.record_last(self.loop)
        self._stop_after_error(asked, error)
