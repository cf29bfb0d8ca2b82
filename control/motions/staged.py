"""Controlled aperiodic motion: a pose graph whose states end on conditions on the sensors.

The thesis plays an aperiodic graph open loop (section 2.3). Here a state may have a condition that
must be met before the next state begins. On a time-out the state is retried, up to `tries` times.
"""

import numpy as np

from windup.control.motions.reach import Condition
from windup.control.motions.upright import UprightFeedback
from windup.control.pose_graph.gait import Gait
from windup.hal.command import JointCommand
from windup.hal.contacts import ContactSensors
from windup.hal.geometry.smooth_step import smooth_step
from windup.hal.joints import Array, Joints
from windup.hal.observation import Observation
from windup.hal.publishing.controller_block import BlockNames, ControllerBlock
from windup.hal.publishing.run_state import RunState

EPSILON = 1e-9
REASONS = ("in time", "tried again", "finished", "given up")


class StagedPlayer:
    """Controller that plays a graph with `move` and `reach`; its goals never jump.

    Args:
        gait: The graph; its perturbations stay at zero.
        joints: The robot's joints.
        contacts: The robot's contact sensors.

    Attributes:
        finished: The last state has been held for its time, and its condition is met.
        failed: Reason why the graph was aborted, one line, or None; the goals then stay.
        retries: Number of retries after a state was not reached in time.
    """

    failed: str | None = None

    def __init__(self, gait: Gait, joints: Joints, contacts: ContactSensors) -> None:
        self.gait, self.joints = gait, joints
        self._conditions = [
            None if state.reach is None else Condition(state.reach, joints, contacts)
            for state in gait.file.state
        ]
        table, names = gait.file.upright, gait.graph.names
        self._upright = None if table is None else UprightFeedback(table, joints, names)
        self.finished, self.retries = False, 0
        self.published = BlockNames(phases=names, reasons=REASONS)
        self._run_state = RunState.STANDING if gait.file.lying is None else RunState.RISING

    @property
    def ends_down(self) -> bool:
        """True if the robot is meant to lie or sit on the floor at the end."""
        return self.gait.file.down

    @property
    def first_pose(self) -> Array:
        """First pose (n,), rad; see `HasFirstPose`."""
        return self.gait.graph.pose[0]

    def reset(self, observation: Observation) -> None:
        """Start at the first state, from the present pose.

        Raises:
            StateMissingError: The graph needs what the observation lacks.
        """
        self.finished, self.failed, self.retries = False, None, 0
        self._missed = np.zeros(len(self.gait.graph), dtype=int)
        position = observation.joints.position
        self._goal = np.clip(position, self.joints.lower, self.joints.upper)
        for condition in filter(None, self._conditions):
            condition.unmet(observation, self._goal)
        self._hold = JointCommand.hold(self.joints, self._goal)
        if self._upright is not None:
            self._upright.apply(self._goal, observation, 0)
        self._enter(0)

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command of this tick, on the way to the pose of the present state."""
        if not (self.finished or self.failed):
            self._advance(observation)
            self._elapsed += dt
            self._goal = self._on_the_way()
        goal = self._goal
        if self._upright is not None:
            goal = self._upright.apply(goal, observation, self._state)
        return self._hold.with_position(goal)

    def publish(self, block: ControllerBlock) -> None:
        """Publish the state of the graph, and whether it is tried again."""
        block.run_state, block.phase = self._run_state, self._state
        block.phase_time = self._elapsed
        block.reason = int(self._missed[self._state] > 0)
        if self.finished or self.failed:
            block.reason = 2 if self.finished else 3

    def _enter(self, state: int) -> None:
        self._state, self._elapsed, self._from = state, 0.0, self._goal

    def _on_the_way(self) -> Array:
        pose, move = self.gait.graph.pose[self._state], self.gait.file.state[self._state].move
        s = min(self._elapsed / move, 1.0) if move > 0.0 else 1.0
        goal: Array = self._from + smooth_step(s) * (pose - self._from)
        return goal

    def _advance(self, observation: Observation) -> None:
        """Enter the next state if the hold time is over and the condition is met."""
        graph, state = self.gait.graph, self._state
        over = self._elapsed - float(graph.hold[state]) + EPSILON
        if over < 0.0:
            return
        condition = self._conditions[state]
        unmet = None if condition is None else condition.unmet(observation, graph.pose[state])
        if unmet is None:
            following = int(graph.successor[state])
            self.finished = following == state
            if not self.finished:
                self._enter(following)
        elif condition is not None and over >= condition.reach.within:
            self._miss(unmet, condition.reach.again)

    def _miss(self, unmet: str, again: str | None) -> None:
        """Retry the state, or abort the graph after the last try."""
        state, name = self._state, self.gait.graph.names[self._state]
        self._missed[state] += 1
        if self._missed[state] < self.gait.file.tries:
            self.retries += 1
            self._enter(state if again is None else self.gait.graph.index(again))
            return
        tries = self.gait.file.tries
        often = "once" if tries == 1 else f"{tries} times"
        self.failed = f"{name!r} was tried {often} and not reached: {unmet}"
