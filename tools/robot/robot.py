"""`Robot`: the interface of programs to one robot. MuJoCo and SciPy are imported by `Robot.open`.

with Robot.open("op3") as robot:              # its twin
    report = robot.walk(speed=0.2, steps=40)
"""

from collections.abc import Callable, Sequence
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Self

from windup.hal.joints import Array
from windup.tools.robot.handle import Handle

if TYPE_CHECKING:
    from windup.control.steering.guide import Guide
    from windup.sim_twin.environment import Environment
    from windup.sim_twin.rollouts import RolloutPredictor
    from windup.tools.assembly.walk_options import WalkOptions
    from windup.tools.measures.walk_end import OnStep
    from windup.tools.remote.remote_robot import RemoteRobot
    from windup.tools.reports.play_report import PlayReport
    from windup.tools.reports.run_report import RunReport
    from windup.tools.robot.motions import Motions
    from windup.tools.robot.stack import State
    from windup.tools.robot.walk_report import WalkReport

MOTIONS = "windup.tools.robot.motions"
"""Module that opens a robot; it imports all that a run may need."""
REMOTE = "windup.tools.remote.remote_robot"
"""Module that connects to a robot that is up."""

Disturb = Callable[["Robot"], None]
"""Arranges pushes on a twin."""


class Robot(Handle):
    """A robot that can be run; open one with `Robot.open`.

    Args:
        motions: The motions of an open session.
    """

    def __init__(self, motions: "Motions") -> None:
        super().__init__(motions.session)
        self._motions = motions

    @classmethod
    def open(
        cls,
        name: str,
        *,
        port: str | None = None,
        arm: bool = False,
        state: "State | None" = None,
        rate: float | None = None,
        realtime: bool = False,
        seed: int = 0,
        noise: float = 0.0,
        delay: float | None = None,
        world: "Environment | None" = None,
        known_ground: bool = False,
        protect: bool = True,
        record: bool = False,
    ) -> Self:
        """Return a robot, connected and configured. Nothing moves.

        Args:
            name: Name of a robot, or path of a folder with one.
            port: URL of its servo bus, or "BUS=URL,BUS=URL"; without one, its twin.
            arm: Allow torque on a port that is not twin://.
            state: Where the base state comes from, "true" or "estimated"; on a port it is
                estimated, else the truth.
            rate: Rate of the loop, Hz; the robot's own by default.
            realtime: Let simulated time pass no faster than real time.
            seed: Seed of everything random.
            noise: Standard deviation of noise on the start pose, degrees.
            delay: Delay of the servos, s; the robot's own by default.
            world: The twin's ground and how its plant differs; the controller does not know.
            known_ground: The rollouts know the ground.
            protect: Soften falls that cannot be prevented, where the robot's file says how.
            record: Keep every tick of each run, for the arrays, files and pictures of its report.

        Raises:
            WindupError: The robot's files, these options, or the bus cannot be.
        """
        return cls(
            import_module(MOTIONS).open_robot(
                name, port=port, arm=arm, state=state, rate=rate, realtime=realtime, seed=seed,
                noise=noise, delay=delay, world=world, known_ground=known_ground, protect=protect,
                record=record,
            )
        )  # fmt: skip

    @classmethod
    def connect(cls, name: str) -> "RemoteRobot":
        """Return a robot that `windup up` has brought up; its runtime does what this program wants.

        Args:
            name: Name of the robot, or path of its folder.

        Raises:
            UsageError: It is not up, or its runtime is another version of Windup.
        """
        remote: RemoteRobot = import_module(REMOTE).RemoteRobot(name)
        return remote

    @property
    def predictor(self) -> "RolloutPredictor":
        """Plays rollouts of the robot."""
        return self._motions.predictor

    @property
    def noise(self) -> float:
        """Standard deviation of noise on the start pose, degrees."""
        return self._motions.noise

    @property
    def seed(self) -> int:
        """Seed of everything random."""
        return self._motions.seed

    def stand(self, seconds: float = 2.0) -> "RunReport":
        """Hold the stance for `seconds` s of the robot's time."""
        return self._motions.stand(seconds)

    def play(
        self, graph: str, seconds: float | None = None, disturb: Disturb | None = None
    ) -> "PlayReport":
        """Play a pose graph of the robot to its end, or for `seconds` s.

        A graph without an end is played for 5 s. One that waits for the sensors in vain is given
        up, and the report's reason says why.

        Args:
            graph: Name of the graph, or the path of a file.
            seconds: How long at most.
            disturb: Called when it is in its start pose, to arrange pushes on a twin.
        """
        return self._motions.play(graph, seconds, self._bound(disturb))

    def walk(
        self,
        speed: float | None = None,
        steps: int = 40,
        options: "WalkOptions | None" = None,
        on_step: "Sequence[OnStep]" = (),
        disturb: Disturb | None = None,
        stand: float = 0.0,
        guide: "Guide | None" = None,
    ) -> "WalkReport":
        """Walk a number of steps and return a report.

        Args:
            speed: m/s; the gait's default if None.
            steps: How many.
            options: Everything else; `speed` wins.
            on_step: All are called at the end of each step with its number and its speed, m/s.
            disturb: Called before the first step, to arrange pushes on a twin.
            stand: Then come to rest and stand for so long, s.
            guide: Leads the walk, instead of speed, side, turn, path and goal of the options.

        Raises:
            UsageError: The options do not fit the gait; nothing has moved.
            RunInterruptedError: By a signal; the robot has stopped, and the report is attached.
        """
        return self._motions.walk(
            speed, steps, options, on_step, self._bound(disturb), stand, guide
        )

    def _bound(self, disturb: Disturb | None) -> Callable[[], None] | None:
        return None if disturb is None else partial(disturb, self)

    def start_at(self, name: str | None, *, needs_imu: bool = False) -> None:
        """Put a fresh twin into a start pose, with noise; let anything else move there."""
        self._motions.start_at(name, needs_imu=needs_imu)

    def start_in(self, pose: Array, *, needs_imu: bool = False) -> None:
        """Put a fresh twin into a pose (n,) rad, with noise; let anything else move there.

        What comes next may need the IMU: then this does not begin without it either.
        """
        self._motions.start_in(pose, needs_imu=needs_imu)
