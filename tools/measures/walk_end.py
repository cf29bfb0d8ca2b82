"""When a walk ends: after enough steps, at its goal, and at rest where it shall stand."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from windup.control.limit_cycle.balancer import Balancer
from windup.control.steering.guide import Steady, WalkCommand
from windup.control.steering.navigation import PathFollower, PointFollower
from windup.hal.errors import UsageError
from windup.hal.observation import Observation

# Called at the end of a step with its number and its speed, m/s.
OnStep = Callable[[int, float], None]
LONGEST_STOP = 60  # steps


@dataclass
class WalkEnd:
    """Ends a walk.

    Attributes:
        walker: The walking controller.
        steps: Steps to walk, or to reach the goal in.
        on_step: All are called at the end of each step.
        rest: Come to rest first.
    """

    walker: Balancer
    steps: int
    on_step: Sequence[OnStep] = ()
    rest: bool = False
    _seen: int = field(default=0, init=False)

    def __post_init__(self) -> None:
        if self.rest and not self.walker.steering.can_rest:
            raise UsageError(
                f"gait {self.walker.gait.name!r} cannot step on the spot, and so not come to rest"
            )

    def __call__(self, observation: Observation) -> str | None:
        """Return why the walk is over, or None."""
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
        """Return "done" at rest, or at once where nobody asked for it."""
        steering = self.walker.steering
        if not self.rest or steering.resting:
            return "done"
        return "does not come to rest" if self._seen > since + LONGEST_STOP else None
