"""Conditions of a state on the sensors: pose reached, base upright, feet on the ground."""

from collections.abc import Iterator
from math import asin, atan2, degrees

import mujoco
import numpy as np

from windup.control.pose_graph.gait_file import Reach
from windup.hal.contacts import ContactSensors
from windup.hal.errors import StateMissingError
from windup.hal.joints import Array, Joints
from windup.hal.observation import Observation


def lean(observation: Observation) -> tuple[float, float]:
    """Return the lean of the base forward (-180 .. 180) and to the right (-90 .. 90), degrees.

    Raises:
        StateMissingError: The observation has no attitude.
    """
    orientation = None
    if observation.base is not None:
        orientation = observation.base.orientation
    elif observation.imu is not None:
        orientation = observation.imu.orientation
    if orientation is None:
        raise StateMissingError(
            "the graph asks for the base's attitude, which nobody measures; "
            "give the robot an [imu] in robot.toml"
        )
    frame = np.empty(9)
    mujoco.mju_quat2Mat(frame, orientation)
    x, y, z = frame[6:].tolist()
    return degrees(atan2(-x, z)), degrees(asin(min(max(y, -1.0), 1.0)))


class Condition:
    """The condition of a `reach` table in a gait file, for one robot.

    Args:
        reach: The table.
        joints: The robot's joints.
        contacts: The robot's contact sensors.
    """

    def __init__(self, reach: Reach, joints: Joints, contacts: ContactSensors) -> None:
        self.reach, self.joints, self.contacts = reach, joints, contacts

    def unmet(self, observation: Observation, goal: Array) -> str | None:
        """Return a message about the first unmet part of the condition, or None if all are met.

        Args:
            observation: The present observation.
            goal: (n,) goal positions of the joints, rad.
        """
        return next(self._complaints(observation, goal), None)

    def _complaints(self, observation: Observation, goal: Array) -> Iterator[str]:
        reach, state = self.reach, observation.joints
        if reach.lean is not None or reach.side is not None:
            yield from self._attitude(observation)
        if reach.feet:
            down = self.contacts.feet_down(observation.contacts)
            names = zip(self.contacts.feet, down, strict=True)
            yield from (f"{foot} is not on the ground" for foot, on in names if not on)
        if reach.joints is not None:
            yield from self._farthest(state.position - goal, reach.joints, "degrees from its goal")
        if reach.still is not None:
            yield from self._farthest(state.velocity, reach.still, "degrees/s fast")

    def _attitude(self, observation: Observation) -> Iterator[str]:
        forward, right = lean(observation)
        if self.reach.lean is not None:
            least, most = self.reach.lean
            if not least <= forward <= most:
                yield f"leans {forward:.0f} degrees forward ({least:g} .. {most:g} is fine)"
        if self.reach.side is not None and abs(right) > self.reach.side:
            side = "right" if right > 0.0 else "left"
            yield f"leans {abs(right):.0f} degrees to the {side} ({self.reach.side:g} is fine)"

    def _farthest(self, values: Array, limit: float, unit: str) -> Iterator[str]:
        worst = int(np.abs(values).argmax())
        value = degrees(abs(float(values[worst])))
        if value > limit:
            yield f"{self.joints.names[worst]} is {value:.1f} {unit} ({limit:g} is fine)"
