"""A package of somebody else: it adds a behaviour, and touches nothing of ours."""

from dataclasses import dataclass

import numpy as np

from windup import Behaviour, JointCommand, Observation, RobotDescription
from windup.hal.controller import Predictor


class Nodder:
    """Holds the stance and moves one joint there and back."""

    def __init__(self, robot: RobotDescription, joint: str, angle: float, times: int) -> None:
        self.joints, self.stance, self.times = robot.joints, robot.stance, times
        self.way = robot.joints.array({joint: np.radians(angle)})
        self.finished = False

    def reset(self, observation: Observation) -> None:
        self.begin = observation.time

    def step(self, observation: Observation, dt: float) -> JointCommand:
        done = observation.time - self.begin  # a nod takes a second
        self.finished = done >= self.times
        share = 0.5 - 0.5 * np.cos(2.0 * np.pi * done)
        return JointCommand.of(self.joints, position=self.stance + share * self.way)


@dataclass(frozen=True)
class NodOptions:
    joint: str = "head_tilt"
    """Which joint."""
    angle: float = 10.0
    """How far, degrees."""
    times: int = 2
    """How often; a nod takes a second."""


class Nod(Behaviour[NodOptions]):
    """Nod, and say how it went."""

    name, Options, done = "nod", NodOptions, "nodded"

    def build(
        self, robot: RobotDescription, options: NodOptions, predictor: Predictor | None
    ) -> Nodder:
        return Nodder(robot, options.joint, options.angle, options.times)
