"""Decides when a walk ends: after its steps, at its goal, and at rest if required."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from windup.control.limit_cycle.balancer import Balancer
from windup.control.steering.guide import Steady, WalkCommand
from windup.control.steering.navigation import PathFollower, PointFollower
from windup.hal.errors import UsageError
from windup.hal.observation import Observation

# Called at the end of each step with its number and speed, m/s.
OnStep = Callable[[int, float], None]
LONGEST_STOP = 60  # steps


@dataclass
class WalkEnd:
    """Ends a walk.

    Attributes:
        walker: The walking controller.
        steps: Number of steps to walk, or within which to reach the goal.
        on_step: All are called at the end of each step.
        rest: Whether the robot must come to rest first.
    """

    walker: Balancer
    steps: int
    on_step: Sequence[OnStep] = ()
    rest: bool = False
    _seen: int = field(default=0, init=False)

    def __post_init__(self) -> None:
        if self.rest and not self.walker.steering.can_rest:
            raise UsageError(
                f"gait {self.walker.gait.name!r} cannot step on the spot and therefore cannot come "
                "to rest"
            )

    def __call__(self, observation: Observation) -> str | None:
        """Return the reason why the walk is over, or None."""
        walker = self.walker
        if walker.steps <= self._seen:
            return None
        self._seen = walker.steps
        for look in self.on_step:
            look(self._seen, walker.records[-1].speed)
        return self._over()

    def _over(self) -> str | None:
        walker, goal = self.walker, self.walker.steering.guide
        if not isinstance(goal, PathFollower | PointFollower):
            if self._seen < self.steps:
                return None
            if self.rest:
                walker.steering.guide = Steady(WalkCommand(stop=True))
            return self._rested(self.steps)
        if not goal.done:
            return "goal missed" if self._seen >= self.steps else None
        return self._rested(self.steps)

    def _rested(self, since: int) -> str | None:
        """Return "done" at rest, or at once if rest is not required."""
        steering = self.walker.steering
        if not self.rest or steering.resting:
            return "done"
        return "does not come to rest" if self._seen > since + LONGEST_STOP else None
