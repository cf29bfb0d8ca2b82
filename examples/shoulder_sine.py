"""A controller of your own for the command line: both shoulders follow a sine.

    windup run op3 examples/shoulder_sine.py --amplitude 30 --seconds 4
    windup run op3 examples/shoulder_sine.py --port twin://op3
    windup run op3 examples/shoulder_sine.py --port /dev/ttyUSB0 --arm

Its constructor's annotated arguments are options; `robot` is the robot's description.
"""

import math

from windup import JointCommand, Observation, RobotDescription


class ShoulderSine:
    """Holds the stance, and swings both shoulders forward and back.

    Args:
        robot: The robot.
        amplitude: How far they swing, degrees.
        period: Of one swing forward and back, s.
    """

    def __init__(
        self, robot: RobotDescription, amplitude: float = 20.0, period: float = 2.0
    ) -> None:
        self.joints, self.stance, self.period = robot.joints, robot.stance, period
        reach = math.radians(amplitude)
        self.swing = robot.joints.array({"l_sho_pitch": reach, "r_sho_pitch": -reach})

    def reset(self, observation: Observation) -> None:
        """Start at the stance now."""
        self.start = observation.time

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command for the next `dt` seconds."""
        phase = 2.0 * math.pi * (observation.time - self.start) / self.period
        return JointCommand.of(self.joints, position=self.stance + math.sin(phase) * self.swing)
