"""A controller of your own: it stands, and moves one joint to and fro.

Run it on the twin: `python my_controller.py`. On the robot it is the same, with
`Robot.open(ROBOT, port="/dev/ttyUSB0", arm=True)`: hold on to the robot.
"""

import math

from windup import JointCommand, Observation, Robot, RobotDescription

ROBOT = "op3"
JOINT = "head_pan"
DEGREES = 15.0
PERIOD = 2.0  # s


class MyController:
    """Observations in, joint commands out: no clock and no input or output of its own."""

    def __init__(self, robot: RobotDescription) -> None:
        self.joints, self.stance = robot.joints, robot.stance
        self.index = robot.joints.index(JOINT)

    def reset(self, observation: Observation) -> None:
        """Called once, before the first step."""
        self.begin = observation.time

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Called each tick; `observation` has joints, imu, contacts and base. SI units, rad."""
        phase = 2.0 * math.pi * (observation.time - self.begin) / PERIOD
        goal = self.stance.copy()
        goal[self.index] += math.radians(DEGREES) * (1.0 - math.cos(phase)) / 2.0
        return JointCommand.hold(self.joints, goal)


def main() -> None:
    """Stand, run the controller for two periods, and say how it went."""
    with Robot.open(ROBOT) as robot:
        robot.stand(1.0)
        report = robot.run(MyController(robot.description), seconds=2 * PERIOD)
        print(f"{report.reason} after {report.ticks} ticks; fallen: {report.fallen}")


if __name__ == "__main__":
    main()
