"""Options that change a twin's world or disturb it; only a twin has them."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import inf, radians

from hal.errors import UsageError
from robots import RobotDescription
from sim_twin.plant import Plant
from sim_twin.terrain import Ground
from sim_twin.world import World
from tools.robot import Robot


@dataclass(frozen=True, kw_only=True)
class WorldOptions:
    """Ground and plant of a twin, of which the rollouts know nothing."""

    slope: float = 0.0
    """Slope of the ground, degrees; positive is uphill."""
    strips: float = 0.0
    """Strips across the way, as much as this above or below the start, m."""
    stairs: float = 0.0
    """Stairs, each so high, m; positive is up, negative down."""
    rough: float = 0.0
    """Rough ground, as much as this above or below the start, m."""
    friction: float | None = None
    """Friction coefficient of feet and floor."""
    plant: int | None = None
    """Draw a random plant with this seed: gains, friction, delay, floor, mass, supply."""
    self_collision: bool = False
    """Let the legs collide with each other."""
    gains: float = 1.0
    """Factor on the gains of all joints."""

    def world(self, robot: RobotDescription, seed: int) -> World | None:
        """Return the twin's world, or None where nothing is odd.

        Raises:
            UsageError: A value cannot be.
        """
        self.check_world()
        plant = Plant() if self.plant is None else Plant.random(self.plant, robot.timestep)
        if self.friction is not None:
            plant = replace(plant, floor=self.friction)
        if self.gains != 1.0:
            plant = replace(plant, stiffness=self.gains)
        ground = self._ground(robot, seed)
        if ground.flat and plant == Plant() and not self.self_collision:
            return None
        return World(ground, plant, self.self_collision)

    def _ground(self, robot: RobotDescription, seed: int) -> Ground:
        """Return the ground, in the robot's own measure: half its height at a time."""
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

    def check_world(self) -> None:
        """Raise what cannot be."""
        if not abs(self.slope) <= 30.0:
            raise UsageError(f"--slope {self.slope:g}: give -30 .. 30 degrees")
        if self.strips < 0.0:
            raise UsageError(f"--strips {self.strips:g}: give 0 m or more")
        if self.rough < 0.0:
            raise UsageError(f"--rough {self.rough:g}: give 0 m or more")
        if not abs(self.stairs) <= 0.3:
            raise UsageError(f"--stairs {self.stairs:g}: give -0.3 .. 0.3 m")
        if sum(map(bool, (self.slope, self.strips, self.stairs, self.rough))) > 1:
            raise UsageError("give one of --slope, --strips, --stairs and --rough")
        if self.friction is not None and self.friction <= 0.0:
            raise UsageError(f"--friction {self.friction:g}: give more than 0")
        if not 0.0 < self.gains < inf:
            raise UsageError(f"--gains {self.gains:g}: give a factor above 0")


@dataclass(frozen=True, kw_only=True)
class TwinOptions(WorldOptions):
    """The same, and pushes."""

    push: float = 0.0
    """Impulse on the torso, N s."""
    shove: float = 0.0
    """Velocity step of the whole robot, m/s."""
    push_direction: float = 0.0
    """Where push and shove go, degrees; 0 forward, 90 to the left."""
    push_at: float = 5.0
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

    def check_world(self) -> None:
        """Raise what cannot be."""
        super().check_world()
        if self.push_at < 0.0:
            raise UsageError(f"--push-at {self.push_at:g}: give 0 s or more")
