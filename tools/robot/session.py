"""A session on a robot: run controllers in the loop, and stop whatever happens."""

import logging
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import dataclass, field
from types import TracebackType
from typing import Self

from windup.control.estimation.estimator import BaseEstimator
from windup.control.estimation.imu_gate import ImuGate
from windup.control.loop import Estimator, LoopReport, Recorder, Until, run_loop
from windup.control.motions.play import PoseHolder
from windup.hal.clock import punctual
from windup.hal.controller import Controller, Stopwatch
from windup.hal.errors import ControllerError, WindupError
from windup.hal.guard import StopPolicy
from windup.hal.guard.finding import Finding
from windup.hal.guard.imu_watch import ImuWatch
from windup.hal.observation import Observation
from windup.hal.publishing.run_state import RunState
from windup.hal.ranges import numbers_checked
from windup.sim_twin.backend import TwinClock
from windup.sim_twin.wire.world.clocks import VirtualClock
from windup.tools.assembly.protect import Protection
from windup.tools.robot.armed import Armed
from windup.tools.robot.run_end import RunEnd
from windup.tools.robot.run_telemetry import RunTelemetry
from windup.tools.robot.stack import look_with
from windup.tools.robot.stopping import INTERRUPTED
from windup.tools.stopping.interrupts import (
    Asked,
    RunInterruptedError,
    counted_signals,
    note_interruption,
)
from windup.tools.stopping.stop_request import stop_requests
from windup.tools.terminal.run_notes import NOTES
from windup.tools.terminal.slowness import Slowness

REST_SECONDS = 1.5
# Called once a tick with the observation.
Watch = Callable[[Observation], None]


@dataclass(eq=False)
class Session(Armed):
    """A robot that controllers run on.

    Attributes:
        period: Period of the control loop, s.
        paced: Its time is real time.
        protect: A fall that cannot be prevented is softened, where the robot's file says how.
        watch: All are called with every observation: whoever draws, logs or looks on.
        telemetry: What other processes can read of its runs.
        imu: Judges the IMU, where the base state is estimated from it.
        slowness: Ticks and plans that came late in all runs.
    """

    period: float = field(kw_only=True)
    paced: bool = False
    protect: bool = True
    watch: list[Watch] = field(default_factory=list, init=False)
    telemetry: RunTelemetry = field(init=False)
    imu: ImuWatch = field(default_factory=ImuWatch, init=False)
    slowness: Slowness = field(init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        self._protection = Protection(self.description)
        self.slowness = Slowness(
            1.0 / self.period, simulated=isinstance(self.backend.clock, VirtualClock)
        )
        self.telemetry = RunTelemetry(self.description, self.stack, self.period, self.imu)

    @property
    def warnings(self) -> list[Finding]:
        """What there was to warn about so far: one finding a kind."""
        health = self.backend.watch.warnings if self.backend.watch is not None else []
        return [*health, *self.imu.warnings]

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
        with counted_signals(self.stack.wired) as asked:
            try:
                self._let_go(error)
            finally:
                self._disconnect()
        if asked():
            note_interruption(asked.by)
            if error is None:
                raise RunInterruptedError(self.loop, asked.by)

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

    @numbers_checked
    def run(
        self,
        controller: Controller,
        seconds: float | None = None,
        *,
        until: Until | None = None,
        rollouts: Stopwatch | None = None,
        down: bool = False,
        needs_imu: bool = False,
    ) -> LoopReport:
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

        Raises:
            PostureError: It was to be armed, and a joint is outside of its limits, or it needs its
                feet (not `down`) and sits or lies.
            FirstMotionError: A joint did not follow in the first motion; the robot is limp.
            WindupError: From the guard, the backend or the controller; the stop policy has run.
        """
        approach = None if self.start is None else self.start.before(controller, down)
        protected = None
        if self.protect and self._protection.possible and not down:
            protected = self._protection.around(approach or controller, controller)
        wishes = stop_requests(self.backend.backend, keys=self.stack.real)
        with (
            counted_signals(self.stack.wired) as asked,
            self._running,
            self._held_afterwards(),
            wishes as wanted,
        ):
            estimator = self._estimator(needs_imu)
            self._get_ready(down, asked)
            self.loop = LoopReport()
            end = RunEnd(
                asked=asked, wishes=[wanted, lambda: self._running.asked],
                fallen=lambda: self.fallen, loop=self.loop, opened=self.backend.clock.now(),
                seconds=seconds, until=until, down=down, approach=approach, protected=protected,
            )  # fmt: skip
            if asked():
                self._stop_before(asked)
            else:
                self._run(protected or approach or controller, end, rollouts, estimator)
        if self.loop.reason == INTERRUPTED:
            raise RunInterruptedError(self.loop, asked.by)
        return self.loop

    def _estimator(self, needs_imu: bool) -> Estimator | None:
        """Return what fills in the base state; who estimates it is guarded against a bad IMU.

        Raises:
            ImuError: The IMU says nothing, and the controller needs it.
        """
        estimator = self.stack.estimator
        if not isinstance(estimator, BaseEstimator):
            return estimator
        look = look_with(self.description, self.stack.port)
        gate = ImuGate(estimator, self.imu, needs_imu, look)
        if not self.armed:
            gate.admit(self.backend.peek)
        return gate

    def _run(
        self,
        controller: Controller,
        end: RunEnd,
        rollouts: Stopwatch | None,
        estimator: Estimator | None,
    ) -> None:
        """Run the loop; stop the robot if it ends by an error or a wish."""
        asked, state = end.asked, RunState.FAULTED
        recorder = self.telemetry.begin(controller)
        try:
            self._loop(controller, end, rollouts, estimator, recorder)
            if self.loop.reason == INTERRUPTED:
                if self.stack.wired:
                    note_interruption(asked.by)
                    logging.getLogger(__name__).warning("stopped by %s", asked.by)
                self._stop_after_error(asked)
            state = self._resting()
        except WindupError as error:
            self.loop.reason = str(error)
            self.telemetry.record_last(self.loop)
            self._stop_after_error(asked, error)
            raise
        except (KeyboardInterrupt, SystemExit) as ended:  # raised by a controller of one's own
            asked.by = asked.by or type(ended).__name__
            self.loop.reason = INTERRUPTED
            self._stop_after_error(asked)
            state = self._resting()
        except BaseException as error:
            self.loop.reason = f"the controller failed: {type(error).__name__}: {error}"
            self._stop_after_error(asked)
            if not isinstance(error, Exception):  # a task that is cancelled, a test that fails
                raise
            raise ControllerError(self.loop.reason) from error
        finally:
            self.slowness.ticks += self.loop.ticks
            self.slowness.missed += self.loop.missed
            self.telemetry.end(self.loop.reason, state)

    def _loop(
        self,
        controller: Controller,
        end: Until,
        rollouts: Stopwatch | None,
        estimator: Estimator | None,
        recorder: Recorder | None,
    ) -> None:
        """Run the loop, with whoever looks on."""

        def until(observation: Observation) -> str | None:
            self.base = observation.base
            for look in self.watch[:]:  # one may take itself off
                look(observation)
            return end(observation)

        with punctual() if self.paced else nullcontext():
            if isinstance(self.backend.clock, TwinClock):
                self.backend.clock.align()
            run_loop(
                self.backend,
                controller,
                period=self.period,
                until=until,
                estimator=estimator,
                rollouts=rollouts,
                report=self.loop,
                recorder=recorder,
            )

    def _resting(self) -> RunState:
        """Return the state of the robot while nothing runs on it."""
        if self.fallen:
            return RunState.FALLEN
        return RunState.HOLDING if self.armed or not self.stack.wired else RunState.LIMP

    def _stop(self, policy: StopPolicy | None, asked: Asked) -> None:
        """Stop, and publish that; see `Stoppable`."""
        with self.telemetry.stopping(self._resting):
            super()._stop(policy, asked)

    def _stop_idle(self, error: WindupError | None) -> None:
        """Stop, and publish that; see `Stoppable`."""
        with self.telemetry.stopping(self._resting):
            super()._stop_idle(error)

    def close(self) -> None:
        """Rest and disconnect, as at the end of a `with`; once more is no matter.

        Raises:
            HardwareError: Torque is not off at every joint; the guardian has the robot now.
        """
        self.__exit__(None, None, None)

    def _disconnect(self) -> None:
        if not self._closed:
            NOTES.add(self.warnings, self.slowness, self.backend.backend)
        super()._disconnect()
        self.telemetry.close()
