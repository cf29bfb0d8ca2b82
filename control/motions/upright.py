"""Balance feedback for a graph that is played: the lean of the base shifts the joints' goals.

``clip(k lean + d rate, -limit, limit)`` is added to the goal q of each named joint, summed over
the forward lean of the base with its rate, and the lean to the right with its rate. This adds the
stiffness that a compliant ankle lacks to keep the robot upright.
"""

import numpy as np

from windup.control.motions.reach import lean
from windup.control.pose_graph.gait_file import Upright
from windup.hal.errors import StateMissingError
from windup.hal.joints import Array, Joints, Mask
from windup.hal.observation import Observation


class UprightFeedback:
    """The feedback of the `upright` table of a gait file, for one robot.

    Args:
        table: The table.
        joints: The robot's joints.
        states: Names of the graph's states.
    """

    def __init__(self, table: Upright, joints: Joints, states: tuple[str, ...]) -> None:
        self.joints, self.limit = joints, float(np.radians(table.limit))
        self._gains = np.array(
            [
                joints.array(gains)
                for gains in (table.forward, table.forward_rate, table.right, table.right_rate)
            ]
        )
        chosen = states if table.states is None else table.states
        self._acts: Mask = np.array([name in chosen for name in states])

    def apply(self, goal: Array, observation: Observation, state: int) -> Array:
        """Return the goals (n,) rad with the balance feedback of the state with index `state`.

        Raises:
            StateMissingError: The observation has no base.
        """
        if observation.base is None:
            raise StateMissingError(
                "the graph balances (`upright`) and needs the base state; "
                "give the robot an [imu] and a [[foot]] in robot.toml"
            )
        if not self._acts[state]:
            return goal
        forward, right = np.radians(lean(observation))
        roll, pitch, _ = observation.base.angular_velocity
        change = np.array([forward, pitch, right, roll]) @ self._gains
        balanced = goal + np.clip(change, -self.limit, self.limit)
        return np.clip(balanced, self.joints.lower, self.joints.upper)
