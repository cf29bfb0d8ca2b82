"""A robot on its stack: what it is, whether it has fallen, and pushes where it is a twin."""

from dataclasses import dataclass, field

from windup.hal.errors import UsageError
from windup.hal.geometry.up_axis import uprightness
from windup.hal.guard import GuardedBackend
from windup.hal.observation import BaseState
from windup.hal.ranges import numbers_checked
from windup.robots import RobotDescription
from windup.robots.fallen import has_fallen
from windup.sim_twin.push import Push
from windup.sim_twin.twin import Twin
from windup.tools.robot.stack import Stack


@dataclass(eq=False)
class OnStack:
    """A robot on its stack.

    Attributes:
        description: What robot it is.
        stack: Its backend and what belongs to it.
        base: Base state last seen: the truth on a twin, an estimate on a robot.
    """

    description: RobotDescription
    stack: Stack
    base: BaseState | None = field(default=None, init=False)

    @property
    def backend(self) -> GuardedBackend:
        """The guarded backend."""
        return self.stack.backend

    @property
    def fallen(self) -> bool:
        """True when the robot has fallen."""
        if self.stack.twin is not None:
            return self.stack.twin.fallen
        if self.base is None or self.description.fixed:
            return False
        _, x, y, _ = self.base.orientation
        height = self.base.position[2]
        return bool(has_fallen(self.description.fall, height, uprightness(x, y)))

    @property
    def twin(self) -> Twin:
        """The twin behind the backend.

        Raises:
            UsageError: This is a robot, not a twin.
        """
        if self.stack.twin is None:
            raise UsageError("only a twin can do that; leave --port away")
        return self.stack.twin

    @numbers_checked
    def push(
        self, impulse: float, direction: float = 0.0, *, duration: float = 0.1, delay: float = 0.0
    ) -> None:
        """Push the torso of a twin.

        Args:
            impulse: N s.
            direction: rad; 0 pushes forward, positive to the left.
            duration: s.
            delay: s from now.
        """
        start = self.twin.time + delay
        self.twin.push(Push.impulse(self.description.torso, impulse, direction, start, duration))

    @numbers_checked
    def shove(self, speed: float, direction: float = 0.0, *, delay: float = 0.0) -> None:
        """Give a whole twin `speed` m/s toward `direction` rad, `delay` s from now."""
        mass = float(self.twin.model.body_mass.sum())
        self.twin.push(Push.velocity_step(speed, mass, direction, self.twin.time + delay))
