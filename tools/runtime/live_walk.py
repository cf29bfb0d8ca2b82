"""A walk that goes on, whose speed, side, turn and style a client changes, and which it ends."""

from dataclasses import replace
from typing import Final

from windup.control.limit_cycle.balancer import Balancer
from windup.control.pose_graph.style import styles_of
from windup.control.steering.guide import Steady, WalkCommand
from windup.hal.errors import UnknownNameError, UsageError
from windup.tools.remote.messages import Change

LONGEST: Final = 60
"""Maximum number of steps for a walk to come to rest."""


class LiveWalk:
    """A walk that goes on.

    Args:
        walker: Its controller.
    """

    def __init__(self, walker: Balancer) -> None:
        self.walker = walker
        self._ends_at: int | None = None

    def change(self, change: Change) -> None:
        """Change the command from the next step on; it is clipped to what the gait can.

        Raises:
            UsageError: The gait has no such style, or the walk follows a path.
        """
        steering, gait = self.walker.steering, self.walker.gait
        known = styles_of(gait)
        for name in change.style:
            if name not in known:
                raise UnknownNameError(f"style of gait {gait.name!r}", name, known)
        if not isinstance(guide := steering.guide, Steady):
            raise UsageError("this walk follows a path, or goes to a point; end it first")
        order = guide.order
        steering.guide = Steady(
            replace(
                order,
                speed=order.speed if change.speed is None else change.speed,
                side=order.side if change.side is None else change.side,
                turn=order.turn if change.turn is None else change.turn,
            )
        )
        steering.style.wanted.update(change.style)

    def come_to_rest(self) -> bool:
        """Let the walk come to rest; return whether it has, so that the robot can be held.

        A walk that has not made a step is at rest, and one that cannot rest after `LONGEST` steps.
        """
        walker = self.walker
        if walker.steps == 0:
            return True
        if self._ends_at is None:
            self._ends_at = walker.steps + LONGEST
            walker.steering.guide = Steady(WalkCommand(stop=True))
        return walker.steering.resting or walker.steps >= self._ends_at
