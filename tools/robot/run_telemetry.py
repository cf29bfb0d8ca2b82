"""Telemetry of the runs of one session; a robot runs without it just the same."""

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache

import mujoco
import numpy as np

from windup.control.estimation.estimator import BaseEstimator
from windup.control.loop import LoopReport
from windup.hal.controller import Controller
from windup.hal.errors import TelemetryError
from windup.hal.guard.imu_watch import ImuWatch
from windup.hal.publishing.run_state import RunState
from windup.hal.telemetry.leftovers import remove_leftovers
from windup.hal.telemetry.runtime_folder import ring_path
from windup.hal.telemetry.writer import TelemetryWriter
from windup.robots import RobotDescription
from windup.tools.command_line.version import installed_version
from windup.tools.robot.stack import Stack


class RunTelemetry:
    """The telemetry ring of one session.

    Args:
        robot: The robot.
        stack: Its stack.
        period: Period of the loop, s.
        imu: The check of its IMU.

    Attributes:
        writer: Writer of the ring; None before the first run, or if there can be none.
    """

    def __init__(self, robot: RobotDescription, stack: Stack, period: float, imu: ImuWatch) -> None:
        self._robot, self._stack, self._period, self._imu = robot, stack, period, imu
        self.writer: TelemetryWriter | None = None
        self._versions = _versions()
        with suppress(TelemetryError):  # a run logs it
            remove_leftovers(ring_path(robot.name, stack.port))

    def begin(self, controller: Controller) -> TelemetryWriter | None:
        """Begin a run, and return the writer of its ticks; a failure is logged."""
        try:
            self.writer = self.writer or TelemetryWriter(
                self._robot.name,
                self._stack.backend,
                self._robot.contacts,
                1.0 / self._period,
                port=self._stack.port,
                estimated=isinstance(self._stack.estimator, BaseEstimator),
                imu=self._imu,
                versions=self._versions,
            )
            self.writer.begin(controller)
        except TelemetryError as error:
            logging.getLogger(__name__).warning("no telemetry: %s", error)
            return None
        return self.writer

    def record_last(self, loop: LoopReport) -> None:
        """Record what was observed in the tick in which the run failed."""
        last = self._stack.backend.last
        if self.writer is not None and last is not None:
            self.writer.record_last(*last, loop.ticks + 1, loop.missed)

    def end(self, reason: str, state: RunState) -> None:
        """End a run, and publish why, and in which state the robot is now."""
        if self.writer is not None:
            self.writer.end(reason, state)

    @contextmanager
    def stopping(self, after: Callable[[], RunState]) -> Iterator[None]:
        """Publish that the robot is being stopped, then the state that `after` returns."""
        if self.writer is None:
            yield
            return
        self.writer.change_state(RunState.STOPPING)
        try:
            yield
        finally:
            self.writer.change_state(after())

    def close(self) -> None:
        """Close the ring; it stays readable."""
        if self.writer is not None:
            self.writer.close()


@cache
def _versions() -> dict[str, str]:
    """Return the versions of this program and of what its twins depend on; looked up once."""
    return {
        "windup": installed_version(),
        "mujoco": mujoco.__version__,
        "numpy": np.__version__,
    }
