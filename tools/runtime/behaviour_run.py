"""A behaviour that a client has ordered, run on the robot of the runtime."""

from dataclasses import fields, replace
from typing import Any, Final

from windup.hal.errors import UsageError, WindupError
from windup.tools.behaviours.run_record import RunRecord
from windup.tools.remote.messages import Ended, Run
from windup.tools.remote.plain_options import options_of
from windup.tools.robot.robot import Robot
from windup.tools.runtime.known_behaviours import known_behaviour
from windup.tools.stopping.interrupts import BrokenOffError, RunInterruptedError
from windup.tools.terminal.output import to_json_types

SETTLE: Final = 1.0
"""Time to stand after a walk has come to rest, s."""

Stopped = WindupError | RunInterruptedError | None
"""Why the robot has been stopped; None if it is held."""


class BehaviourRun:
    """One run of a behaviour.

    Args:
        robot: The robot.
        order: What the client wants.

    Attributes:
        walks: It is a walk, after which the robot has to come to stand.

    Raises:
        WindupError: There is no such behaviour, or its options do not fit the robot.
    """

    def __init__(self, robot: Robot, order: Run) -> None:
        self._robot, self._order = robot, order
        self._behaviour = behaviour = known_behaviour(order.behaviour)
        options = options_of(behaviour.Options, order.options)
        self.walks = any(item.name == "stand" for item in fields(options))
        if self.walks:  # something else may follow at any time, so it always comes to rest
            options = replace(options, stand=max(options.stand, SETTLE))
        behaviour.check(robot.description, options)
        _check_opened(robot, behaviour.opening(robot.description, options))
        self._record: RunRecord[Any] = RunRecord(robot, options)

    def perform(self) -> tuple[Ended, Stopped]:
        """Run it; return what its client is told, and why the robot has been stopped, if it has."""
        try:
            self._behaviour.perform(self._record)
        except BrokenOffError as ended:
            return self._told(str(ended), 0), None
        except RunInterruptedError as stopped:
            return self._told(str(stopped), 130), stopped
        except WindupError as error:
            return self._told(str(error), error.exit_status), error
        except Exception as error:  # of the user's own code, between two runs; the robot is held
            return self._told(f"failed: {type(error).__name__}: {error}", 1), None
        return self._went(), None

    def _went(self) -> Ended:
        """Return how it went, where it came to its end."""
        try:
            report = self._behaviour.report(self._record)
        except Exception as error:  # of the user's own code
            return self._told(f"has no report: {type(error).__name__}: {error}", 1)
        return Ended(
            id=self._order.id,
            good=report.good,
            reason=report.reason,
            lines=report.lines,
            result=to_json_types(report.result),
            exit_status=0 if report.good else 1,
        )

    def _told(self, reason: str, status: int) -> Ended:
        """Return what the client of a behaviour that did not come to its end is told."""
        line = f"{self._robot.description.name}: {self._order.behaviour} {reason}"
        return Ended(
            id=self._order.id,
            good=False,
            reason=reason,
            lines=(line,),
            result={"robot": self._robot.description.name, "reason": reason},
            exit_status=status,
        )


def _check_opened(robot: Robot, wanted: dict[str, Any]) -> None:
    """Refuse what a robot would have to be opened with, because it is open.

    Raises:
        UsageError: The behaviour needs something else than the robot was opened with.
    """
    for name, value in wanted.items():
        if name == "rate" and value is not None and abs(value * robot.period - 1.0) > 1e-6:
            command = f"windup up {robot.description.name} --rate {value:g}"
            raise UsageError(
                f"this needs a loop of {value:g} Hz: begin the runtime with `{command}`"
            )
        if name != "rate" and value:
            option = name.replace("_", "-")
            raise UsageError(f"--{option} cannot be changed on a robot that is up")
