"""A robot whose runs are looked at: by callbacks, the telemetry, and the gate of its IMU."""

import logging
from collections.abc import Callable
from dataclasses import dataclass, field

from windup.control.estimation.estimator import BaseEstimator
from windup.control.estimation.imu_gate import ImuGate
from windup.control.loop import Estimator, Until
from windup.hal.errors import TelemetryError
from windup.hal.guard.imu_watch import ImuWatch
from windup.hal.observation import Observation
from windup.hal.telemetry.ring import TelemetryWriter
from windup.sim_twin.wire.world.clocks import VirtualClock
from windup.tools.reports.run_report import RunReport
from windup.tools.robot.armed import Armed
from windup.tools.robot.stack import look_with
from windup.tools.terminal.slowness import Slowness

# Called once a tick with the observation.
Watch = Callable[[Observation], None]


@dataclass(eq=False)
class Watched(Armed):
    """A robot whose runs are looked at.

    Attributes:
        period: Period of the control loop, s.
        record: Each run keeps the arrays of its report.
        watch: All are called with every observation: whoever draws, logs or looks on.
        telemetry: Where everybody else can read how it goes, once it runs.
        imu: Judges the IMU, where the base state is estimated from it.
        slowness: Ticks and plans that came late in all runs.
        seen: The last observation, with its base state.
    """

    period: float = field(kw_only=True)
    record: bool = False
    watch: list[Watch] = field(default_factory=list, init=False)
    telemetry: TelemetryWriter | None = field(default=None, init=False)
    imu: ImuWatch = field(default_factory=ImuWatch, init=False)
    slowness: Slowness = field(init=False)
    seen: Observation | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        super().__post_init__()
        self.slowness = Slowness(
            1.0 / self.period, simulated=isinstance(self.backend.clock, VirtualClock)
        )

    def looked_at(self, end: Until) -> Until:
        """Return `end`, with a look of everybody at the observation first."""

        def until(observation: Observation) -> str | None:
            self.seen, self.base = observation, observation.base
            for look in self.watch[:]:  # one may take itself off
                look(observation)
            return end(observation)

        return until

    def guarded_estimator(self, needs_imu: bool) -> Estimator | None:
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

    def publish(self) -> None:
        """Say to everybody that a run begins; a robot runs without them all the same."""
        try:
            self.telemetry = self.telemetry or TelemetryWriter(
                self.description.name,
                self.backend,
                self.description.contacts,
                1.0 / self.period,
                port=self.stack.port,
                estimated=isinstance(self.stack.estimator, BaseEstimator),
            )
            self.telemetry.begin()
        except TelemetryError as error:
            logging.getLogger(__name__).warning("no telemetry: %s", error)

    def publish_last(self) -> None:
        """Publish what was seen in a tick that has ended the run, too."""
        if self.telemetry is not None and (last := self.backend.last) is not None:
            self.telemetry.record(*last, 0.0, self.loop.ticks + 1, self.loop.missed)

    def conclude(self, report: RunReport) -> None:
        """Note how a run has ended, for everybody."""
        report.fallen = self.fallen
        self.slowness.ticks += report.ticks
        self.slowness.missed += report.missed
        if self.telemetry is not None:
            self.telemetry.end(report.reason)
