"""A controller of your own: OP3 shifts its weight from one foot to the other.

Run it with `python`, or with `windup run op3 examples/own_controller.py`. A controller is any class
with `reset` and `step`; the same one runs on the twin, on an emulated bus and on the robot.
"""

import numpy as np

from windup import JointCommand, Joints, Observation, Robot

AMPLITUDE = 0.08
"""Largest roll of the legs, rad."""
PERIOD = 2.0
"""Of one sway to the left and to the right, s."""


class Sway:
    """Rolls hips and ankles together, so that the legs tilt and the torso stays level.

    Args:
        joints: The robot's joints.
        stance: (n,) the pose that it sways about, rad.
    """

    def __init__(self, joints: Joints, stance: np.ndarray) -> None:
        self.joints, self.stance = joints, stance
        names = ("l_hip_roll", "l_ank_roll", "r_hip_roll", "r_ank_roll")
        self.direction = joints.array(dict.fromkeys(names, 1.0))
        self.path: list[float] = []

    def reset(self, observation: Observation) -> None:
        """Start swaying now."""
        self.start = observation.time

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command for the next `dt` seconds."""
        if observation.base is not None:
            self.path.append(float(observation.base.position[1]))
        phase = 2.0 * np.pi * (observation.time - self.start) / PERIOD
        goal = self.stance + AMPLITUDE * np.sin(phase) * self.direction
        return JointCommand.of(self.joints, position=goal)


def main() -> tuple[float, bool]:
    """Sway for four periods; return how far it went from side to side, m, and whether it fell."""
    with Robot.open("op3") as robot:
        robot.stand(1.0)
        sway = Sway(robot.description.joints, robot.description.stance)
        report = robot.run(sway, seconds=4 * PERIOD)
        width = max(sway.path) - min(sway.path)
        print(f"{report.reason} after {report.ticks} ticks, {100 * width:.1f} cm wide")
        return width, robot.fallen


if __name__ == "__main__":
    main()
