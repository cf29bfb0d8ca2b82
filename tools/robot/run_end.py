"""A run: what it consists of, and at every tick whether it is over, and why."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import inf
from typing import TYPE_CHECKING

from windup.control.loop import Estimator, LoopReport, Until
from windup.control.motions.first_motion import Approach
from windup.hal.controller import Controller
from windup.hal.errors import WindupError
from windup.hal.observation import Observation
from windup.tools.reports.run_report import RunReport
from windup.tools.robot.stopping import INTERRUPTED, LAY
from windup.tools.stopping.interrupts import StopRequests

if TYPE_CHECKING:  # not needed by robots that do not fall
    from windup.control.falling.protection import Protected

EPSILON = 1e-9  # s
LEFT = "the loop was left"
"""The reason of a run over ticks that ended by `break`, `return`, or an exception in the body."""


@dataclass(kw_only=True)
class RunEnd:
    """Ends a run on a stop request, at a fall, after its time, or for a reason of the caller.

    Attributes:
        asked: Counts the stop requests.
        wishes: Each returns the source of a new stop request, or a false value.
        fallen: Returns whether the robot has fallen.
        loop: Report of the run.
        opened: Start of the run, s.
        seconds: Duration from the end of the first motion on, s; None: no limit.
        until: Returns another reason to end the run, or None.
        down: The robot may lie: a fall does not end the run.
        approach: First motion after torque came on, if it is due.
        protected: Protection against falls; a run with a fall goes on until the robot lies still.
    """

    asked: StopRequests
    wishes: Sequence[Callable[[], str | None]]
    fallen: Callable[[], bool]
    loop: LoopReport
    opened: float
    seconds: float | None = None
    until: Until | None = None
    down: bool = False
    approach: Approach | None = None
    protected: "Protected | None" = None

    def __post_init__(self) -> None:
        self._begin_at(self.opened)

    def __call__(self, observation: Observation) -> str | None:
        """Return why the run is over, or None."""
        if self.interrupted():
            return INTERRUPTED
        if self.protected is not None and self.protected.active:
            return self._landed() if self.protected.finished else None
        if not self.down and self.fallen():
            return "fell" if self.loop.ticks else LAY
        if self.approach is not None and self.approach.active:
            self._begin_at(observation.time)
            return None
        if self.until is not None and (reason := self.until(observation)) is not None:
            return reason
        return "done" if observation.time >= self._end else None

    def open_at(self, time: float) -> None:
        """Begin the run at `time` of the backend's clock, s: its loop begins now."""
        self.opened = time
        self._begin_at(time)

    def interrupted(self) -> bool:
        """Return whether there has been a stop request."""
        for wish in self.wishes:
            if by := wish():
                self.asked.add(by)
        return self.asked()

    def _begin_at(self, time: float) -> None:
        """Let the duration of the run count from `time`, the end of the first motion so far, s."""
        self.loop.first_motion = time - self.opened
        self._end = inf if self.seconds is None else time + self.seconds - EPSILON

    def _landed(self) -> str:
        """Return why a run ends whose fall is over."""
        return "fell" if self.fallen() else "fall protection triggered, but the robot did not fall"


@dataclass
class PreparedRun:
    """What a run consists of.

    Attributes:
        controller: The controller, with first motion and fall protection.
        end: Decides at every tick whether the run is over.
        report: Filled in as the run goes.
        estimator: Fills in the base state.
        may_move: Commands are sent; without, the joints are only read.
        stop: Stops the robot because of an error.
        left: The `for` loop over the ticks of this run was left.
        failed: An error in its body has stopped the robot.
    """

    controller: Controller
    end: RunEnd
    report: RunReport
    estimator: Estimator | None
    may_move: bool
    stop: Callable[[WindupError], None]
    left: bool = False
    failed: bool = False

    @property
    def falling(self) -> bool:
        """True while the fall protection commands the robot, instead of the controller."""
        protected = self.end.protected
        return protected is not None and protected.active

    def fail(self, error: WindupError) -> None:
        """Stop the robot because of an error that is raised in the body of a `for` loop."""
        self.failed = True
        self.stop(error)

    def leave(self) -> None:
        """Record that the `for` loop was left; a stop request may have come in the same tick."""
        self.left = True
        if not self.failed:
            self.report.reason = INTERRUPTED if self.end.interrupted() else LEFT
