"""Options that change a twin's world or disturb it; only a twin has them."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import radians
from typing import Annotated

from windup.hal.errors import UsageError
from windup.hal.ranges import Range
from windup.robots import RobotDescription
from windup.sim_twin.environment import Environment
from windup.sim_twin.ground.terrain import Ground
from windup.sim_twin.plant import Plant
from windup.tools.robot.robot import Robot
from windup.tools.terminal.command import Command
from windup.tools.terminal.quantities import Degrees, Impulse, Seconds, Seed, Speed

Slope = Annotated[float, Range(-30.0, 30.0, "degrees")]
Stairs = Annotated[float, Range(-0.3, 0.3, "m")]
Unevenness = Annotated[float, Range(0.0, 1.0, "m")]
Friction = Annotated[float, Range(0.0, 10.0, above=True)]
Factor = Annotated[float, Range(0.0, 100.0, above=True)]


@dataclass(frozen=True, kw_only=True)
class WorldOptions(Command):
    """Ground and plant of a twin, of which the rollouts know nothing."""

    slope: Slope = 0.0
    """Slope of the ground, degrees; positive is uphill."""
    strips: Unevenness = 0.0
    """Strips across the way, as much as this above or below the start, m."""
    stairs: Stairs = 0.0
    """Stairs, each so high, m; positive is up, negative down."""
    rough: Unevenness = 0.0
    """Rough ground, as much as this above or below the start, m."""
    friction: Friction | None = None
    """Friction coefficient of feet and floor."""
    plant: Seed | None = None
    """Draw a random plant with this seed: gains, friction, delay, floor, mass, supply."""
    self_collision: bool = False
    """Let the legs collide with each other."""
    gains: Factor = 1.0
    """Factor on the gains of all joints."""

    def world(self, robot: RobotDescription, seed: int) -> Environment | None:
        """Return the twin's world, or None where nothing is odd."""
        plant = Plant() if self.plant is None else Plant.random(self.plant, robot)
        if self.friction is not None:
            plant = replace(plant, floor=self.friction)
        if self.gains != 1.0:
            plant = replace(plant, stiffness=self.gains)
        ground = self._ground(robot, seed)
        if ground.flat and plant == Plant() and not self.self_collision:
            return None
        return Environment(ground, plant, self.self_collision)

    def _ground(self, robot: RobotDescription, seed: int) -> Ground:
        """Return the ground, in the robot's own measure: half its height at a time.

        Raises:
            UsageError: The robot is fixed, and the ground is not flat.
        """
        if robot.fixed and any((self.slope, self.strips, self.stairs, self.rough)):
            raise UsageError(f"{robot.name} is fixed: leave the ground away")
        tall = robot.spec().body(robot.base).pos[2]
        return Ground(
            slope=self.slope,
            strips=self.strips,
            stairs=self.stairs,
            rough=self.rough,
            start=2.0 * tall,
            strip=0.5 * tall,
            seed=seed,
        )

    def check(self) -> None:
        """Raise what cannot be; see `Command.check`."""
        super().check()
        if sum(map(bool, (self.slope, self.strips, self.stairs, self.rough))) > 1:
            raise UsageError("give one of --slope, --strips, --stairs and --rough")


@dataclass(frozen=True, kw_only=True)
class TwinOptions(WorldOptions):
    """The same, and pushes."""

    push: Impulse = 0.0
    """Impulse on the torso, N s."""
    shove: Speed = 0.0
    """Velocity step of the whole robot, m/s."""
    push_direction: Degrees = 0.0
    """Where push and shove go, degrees; 0 forward, 90 to the left."""
    push_at: Seconds = 5.0
    """When push and shove begin, s."""

    def disturb(self) -> Callable[[Robot], None] | None:
        """Return what arranges the pushes of a walk."""
        if not (self.push or self.shove):
            return None

        def arrange(robot: Robot) -> None:
            direction = radians(self.push_direction)
            if self.push:
                robot.push(self.push, direction, delay=self.push_at)
            if self.shove:
                robot.shove(self.shove, direction, delay=self.push_at)

        return arrange
