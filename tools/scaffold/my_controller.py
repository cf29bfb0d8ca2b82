"""A controller of your own: it holds the stance, and moves one joint to and fro.

Run it on the twin with `windup run op3 my_controller.py`, through emulated servos with
`--port twin://op3`, and on the robot with `--port /dev/ttyUSB0 --arm`: hold on to it then.
"""

import math

from windup import JointCommand, Observation, RobotDescription


class MyController:
    """Observations in, joint commands out: no clock and no input or output of its own.

    Args:
        robot: The robot; all other arguments are options of the command line.
        joint: Which joint moves.
        degrees: How far.
        period: Of one motion to and fro, s.
    """

    def __init__(
        self,
        robot: RobotDescription,
        joint: str = "head_pan",
        degrees: float = 15.0,
        period: float = 2.0,
    ) -> None:
        self.joints, self.stance, self.period = robot.joints, robot.stance, period
        self.way = robot.joints.array({joint: math.radians(degrees)})

    def reset(self, observation: Observation) -> None:
        """Called once, before the first step."""
        self.begin = observation.time

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Called each tick; `observation` has joints, imu, contacts and base. SI units, rad."""
        phase = 2.0 * math.pi * (observation.time - self.begin) / self.period
        goal = self.stance + 0.5 * (1.0 - math.cos(phase)) * self.way
        return JointCommand.of(self.joints, position=goal)
