"""A run whose controller is the body of a `for` loop."""

import weakref
from collections.abc import Generator, Iterator

from windup.control.motions.play import PoseHolder
from windup.hal.observation import Observation
from windup.tools.reports.run_report import RunReport
from windup.tools.robot.given import Body, hold_pose
from windup.tools.robot.runner import Runner


class Ticks:
    """The ticks of a run: `for observation in robot.ticks(seconds=5)`.

    Each loop over it is a run of its own.

    Args:
        runner: Runs them.
        seconds: How long, s; for ever if None.
        down: The robot may lie.
        needs_imu: The body balances with the IMU.

    Attributes:
        report: Report of the last run over these ticks.
    """

    def __init__(
        self, runner: Runner, seconds: float | None, *, down: bool, needs_imu: bool
    ) -> None:
        # Joints that may get no torque are only read.
        self._may_move = not runner.stack.wired or runner.stack.may_arm
        self._runner, self._seconds, self._needs_imu = runner, seconds, needs_imu
        self._down = down or not self._may_move
        self.report = RunReport()

    def __iter__(self) -> Iterator[Observation]:
        # Only the `for` loop refers to the iterator, so leaving the loop ends the run at once.
        self.report = RunReport()
        run = self._run(self.report)
        self._runner.ticks_iterator = weakref.ref(run)
        return run

    def _run(self, report: RunReport) -> Generator[Observation, None, None]:
        """Yield the observation of each tick; its command has been sent before the next one."""
        runner = self._runner
        if self._may_move and not self._move_first(report):
            return
        given = runner.given_command()
        with runner.prepared(
            report, given, self._seconds, down=self._down, needs_imu=self._needs_imu,
            may_move=self._may_move,
        ) as run, runner.looping(run) as loop:  # fmt: skip
            while loop is not None and (observation := loop.observe()) is not None:
                if not run.falling:
                    body = Body(loop, given, run.fail)
                    runner.enter_body(body, run.end.asked)
                    try:
                        yield observation
                    except GeneratorExit:  # the loop was left
                        run.leave()
                        return
                    finally:
                        runner.exit_body(run.end.asked)
                    if run.failed:
                        return
                loop.finish()

    def _move_first(self, report: RunReport) -> bool:
        """Make the first motion of a robot on servos, if it is due; return whether it went well."""
        runner, down = self._runner, self._down
        if runner.start is None or (runner.armed and runner.start.motion.made):
            return True
        joints, pose = runner.description.joints, runner.description.stance
        if down:
            pose = hold_pose(joints, runner.backend.peek()).position
        moved = runner.run(PoseHolder(joints, pose), 0.0, down=down, needs_imu=self._needs_imu)
        report.reason, report.fallen = moved.reason, moved.fallen
        return moved.reason == "done"
