"""The interface of a behaviour: options, a controller, and a report of how it went."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import asdict
from inspect import getdoc
from pathlib import Path
from typing import Any, Generic, TypeVar, cast

from windup.control.loop import Until
from windup.hal.controller import Controller, Predictor
from windup.hal.observation import Observation
from windup.robots import RobotDescription
from windup.tools.behaviours.report import Report, Summary, count_good, usual_report
from windup.tools.behaviours.run_record import RunRecord

T = TypeVar("T")


class Behaviour(ABC, Generic[T]):
    """Whatever moves a robot.

    A subclass says its name and its options, and builds its controller. That controller runs for
    the option `seconds`, if there is one, and until it is `finished`, if it says so; the run ends
    early when the robot falls or somebody stops it. A behaviour that is more than one run of one
    controller overrides `perform`, and one that measures more overrides `report`.

    Attributes:
        name: Its name on the command line.
        Options: A frozen dataclass. Its fields are the options of the command line, with their
            annotations as types and their docstrings as help.
        done: What a good run did, for "3 of 4 seeds ...".
        needs_imu: The controller balances with the IMU, so one that fails stops the robot.
        down: The robot may lie, so a fall does not end the run.
        run_parallel: Several seeds run at once, in a process each.
        plots: Whether `draw` draws a picture: the command has an option --plot.
    """

    name: str
    Options: type[T]
    done: str = "did what was asked"
    needs_imu: bool = False
    down: bool = False
    run_parallel: bool = False
    plots: bool = False

    @property
    def about(self) -> str:
        """What it does, for the help."""
        return getdoc(type(self)) or self.name

    @abstractmethod
    def build(self, robot: RobotDescription, options: T, predictor: Predictor | None) -> Controller:
        """Return the controller; nothing has moved, and nothing moves here.

        Args:
            robot: The robot.
            options: What the user asks for.
            predictor: Plays rollouts of the robot; None where only the options are checked.

        Raises:
            UsageError: The options do not fit the robot.
        """

    def check(self, robot: RobotDescription, options: T) -> None:
        """Check the options before a port is opened or a twin is built.

        Raises:
            UsageError: They do not fit the robot.
            ConfigError: A file that they name is invalid.
        """
        self.build(robot, options, None)

    def opening(self, robot: RobotDescription, options: T) -> dict[str, Any]:
        """Return arguments of `Robot.open` that depend on the options, or on the behaviour.

        A `rate` is only used where the user gives none.
        """
        return {}

    def perform(self, run: RunRecord[T]) -> None:
        """Move the robot, and keep in `run.measured` what the report needs.

        Raises:
            WindupError: The robot has been stopped.
            KeyboardInterrupt: The same, because somebody asked for it; the report is still wanted.
        """
        robot = run.robot
        run.measured = controller = self.build(robot.description, run.options, robot.predictor)
        run.disturb_twin()
        robot.run(
            controller,
            getattr(run.options, "seconds", None),
            until=until_finished(controller),
            down=self.down,
            needs_imu=self.needs_imu,
        )

    def report(self, run: RunRecord[T]) -> Report:
        """Return how a run went; the robot is still open."""
        return usual_report(self.name, run.robot, asdict(cast(Any, run.options)))

    def sum_up(self, reports: Sequence[Report]) -> Summary:
        """Return how several seeds went."""
        return count_good(reports, self.done)

    def draw(self, path: Path, run: RunRecord[T]) -> None:
        """Draw a run into an image file, where the behaviour `plots`.

        Raises:
            OutputError: The file cannot be written.
        """
        raise NotImplementedError(f"{self.name} has no picture")


def until_finished(controller: Controller) -> Until | None:
    """Return what ends a run once its controller is `finished`; None if it never says so."""
    if not hasattr(controller, "finished"):
        return None

    def until(observation: Observation) -> str | None:
        return "done" if cast(Any, controller).finished else None

    return until
