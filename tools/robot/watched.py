"""A robot whose runs are observed by callbacks, by telemetry, and by the check of its IMU."""

from collections.abc import Callable
from dataclasses import dataclass, field

from windup.control.estimation.estimator import BaseEstimator
from windup.control.estimation.imu_gate import ImuGate
from windup.control.loop import Estimator, Until
from windup.hal.errors import WindupError
from windup.hal.guard import StopPolicy
from windup.hal.guard.imu_watch import ImuWatch
from windup.hal.observation import Observation
from windup.hal.publishing.run_state import RunState
from windup.sim_twin.wire.world.clocks import VirtualClock
from windup.tools.reports.run_report import RunReport
from windup.tools.robot.armed import Armed
from windup.tools.robot.run_telemetry import RunTelemetry
from windup.tools.robot.stack import look_with
from windup.tools.stopping.interrupts import StopRequests
from windup.tools.terminal.slowness import Slowness

# Called once a tick with the observation.
Watch = Callable[[Observation], None]


@dataclass(eq=False)
class Watched(Armed):
    """A robot whose runs are observed.

    Attributes:
        period: Period of the control loop, s.
        watch: Callbacks, each called with every observation; for drawing and logging.
        telemetry: What other processes can read of its runs.
        imu: Detects faults of the IMU, where the base state is estimated from it.
        slowness: Number of late ticks and plans in all runs.
        seen: The last observation, with its base state.
    """

    period: float = field(kw_only=True)
    watch: list[Watch] = field(default_factory=list, init=False)
    telemetry: RunTelemetry = field(init=False)
    imu: ImuWatch = field(default_factory=ImuWatch, init=False)
    slowness: Slowness = field(init=False)
    seen: Observation | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        self.slowness = Slowness(
            1.0 / self.period, simulated=isinstance(self.backend.clock, VirtualClock)
        )
        self.telemetry = RunTelemetry(self.description, self.stack, self.period, self.imu)

    def with_callbacks(self, end: Until) -> Until:
        """Return `end`, preceded by the callbacks."""

        def until(observation: Observation) -> str | None:
            self.seen, self.base = observation, observation.base
            for look in self.watch[:]:  # one may remove itself
                look(observation)
            return end(observation)

        return until

    def guarded_estimator(self, needs_imu: bool) -> Estimator | None:
        """Return the estimator of the base state, behind a gate that rejects bad IMU samples.

        Raises:
            ImuError: The IMU is silent, and the controller needs it.
        """
        estimator = self.stack.estimator
        if not isinstance(estimator, BaseEstimator):
            return estimator
        look = look_with(self.description, self.stack.port)
        gate = ImuGate(estimator, self.imu, needs_imu, look)
        if not self.armed:
            gate.admit(self.backend.peek)
        return gate

    def conclude(self, report: RunReport, state: RunState) -> None:
        """Record in report and telemetry how a run has ended."""
        report.fallen = self.fallen
        self.slowness.ticks += report.ticks
        self.slowness.missed += report.missed
        self.telemetry.end(report.reason, state)

    def state_between_runs(self) -> RunState:
        """Return the state of the robot outside of runs."""
        if self.fallen:
            return RunState.FALLEN
        return RunState.HOLDING if self.armed or not self.stack.wired else RunState.LIMP

    def _stop(self, policy: StopPolicy | None, asked: StopRequests) -> None:
        """Stop, and publish that; see `Stoppable`."""
        with self.telemetry.stopping(self.state_between_runs):
            super()._stop(policy, asked)

    def _stop_idle(self, error: WindupError | None) -> None:
        """Stop, and publish that; see `Stoppable`."""
        with self.telemetry.stopping(self.state_between_runs):
            super()._stop_idle(error)
