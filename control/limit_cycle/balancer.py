"""Discrete limit-cycle balance: once per step, choose scalings that reach the step's targets.

Laszlo 1996, Fig. 3.20: at the start of each step the model of that step is sampled with rollouts,
inverted for the targets, and the resulting scalings are applied to the pose graph for the whole
step. Without a planner the same controller walks open loop.
"""

from collections import deque
from dataclasses import dataclass, field
from math import nan

import numpy as np

from windup.control.kinematics.robot_state import RobotState
from windup.control.limit_cycle.moment import Moment
from windup.control.limit_cycle.planner import Planner, StepRequest
from windup.control.limit_cycle.policy import policy_input
from windup.control.limit_cycle.walk_block import put_walk, reason_of, walk_names
from windup.control.pose_graph.gait import Gait
from windup.control.pose_graph.goal_limits import GoalLimits
from windup.control.pose_graph.pose_tracker import PoseTracker
from windup.control.pose_graph.torso_servo import TorsoServo
from windup.control.regulation.disturbance_detector import DisturbanceDetector
from windup.control.regulation.footfalls import Footfalls
from windup.control.regulation.step_record import StepRecord, StepStart
from windup.control.regulation.variables import RegulationVariable
from windup.control.steering.steering import Steering
from windup.hal.command import JointCommand
from windup.hal.contacts import ContactSensors
from windup.hal.controller import Outcomes, RolloutStart
from windup.hal.errors import StateMissingError
from windup.hal.joints import Array, Joints
from windup.hal.observation import Observation
from windup.hal.publishing.controller_block import BlockNames, ControllerBlock
from windup.hal.publishing.run_state import RunState

IN_FLIGHT = 32  # number of commands kept; more ticks than the latency of any robot


@dataclass
class Balancer:
    """Controller that walks a gait, balanced by a planner, or open loop without one.

    Attributes:
        gait: Graph, perturbations and tables.
        joints: The robot's joints.
        contacts: Its contact sensors.
        state: Its state.
        regulation: The r regulation variables.
        perturbations: Names of the r perturbations that control them.
        planner: Computes their scalings, or None for open loop.
        steering: Speed, sideways speed, course and style.
        targets: Targets by name of the regulation variable.
        fixed_targets: Targets that override those of the steering, by name.
        torso_servo: The torso servo, or None.
        shaken: Detector of disturbances, after which a step is replanned, or None.
        footfalls: Estimator of the ground plane, or None.
        replans: Number of replans within a step.
        records: Records of the finished steps.
        late: Number of answers that came too late to act in time, or never.
    """

    gait: Gait
    joints: Joints
    contacts: ContactSensors
    state: RobotState
    regulation: list[RegulationVariable]
    perturbations: list[str]
    planner: Planner | None
    steering: Steering
    targets: dict[str, float] = field(default_factory=dict)
    fixed_targets: dict[str, float] = field(default_factory=dict)
    torso_servo: TorsoServo | None = None
    shaken: DisturbanceDetector | None = None
    footfalls: Footfalls | None = None
    replans: int = field(default=0, init=False)
    records: list[StepRecord] = field(default_factory=list, init=False)
    late: int = field(default=0, init=False)
    _start: StepStart | None = field(default=None, init=False)

    @property
    def steps(self) -> int:
        """Number of finished steps."""
        return len(self.records)

    @property
    def begun(self) -> int:
        """Number of steps that have begun: the finished ones and the present one."""
        return len(self.records) + (self._start is not None)

    @property
    def moment(self) -> Moment | None:
        """Present position in the graph; None before the first step."""
        if self._start is None:
            return None
        at = self._tracker.now
        return Moment(int(at.state[0]), float(at.elapsed[0]), self._start.stance)

    @property
    def heading(self) -> float:
        """Heading at the start of the present step, rad; 0 before the first one."""
        return 0.0 if self._start is None else self._start.heading

    def reset(self, observation: Observation) -> None:
        """Start a new walk at the graph's first state.

        Raises:
            StateMissingError: The observation has no base state.
        """
        self.records.clear()
        self.replans = self.late = 0
        self._lateness = nan
        self.resume(observation)

    def resume(self, observation: Observation) -> None:
        """Restart at the graph's first state in the same walk; its step records are kept.

        Raises:
            StateMissingError: The observation has no base state.
        """
        if observation.base is None:
            raise StateMissingError(
                "balance needs the base state and this backend does not measure it; "
                "run with `--state estimated`"
            )
        self._columns = [self.gait.index(name) for name in self.perturbations]
        self._sent: deque[Array] = deque(maxlen=IN_FLIGHT)
        self._limits = GoalLimits(self.joints)
        self._hold = JointCommand.hold(self.joints, observation.joints.position)
        scale = np.zeros((1, len(self.gait.perturbations)))
        self._tracker = PoseTracker(self.gait, self.contacts, scale, None, self.torso_servo)
        self._start = None
        self._shown: Array | None = None  # scalings published last
        self._asked = self._replanned = False
        self._kept: dict[int, Array] = {}
        self._turned = 0.0
        self.steering.reset()
        if self.shaken is not None:
            self.shaken.reset()
        if self.footfalls is not None:
            self.footfalls.reset()
        if self.planner is not None:
            self.planner.reset()

    def step(self, observation: Observation, dt: float) -> JointCommand:
        """Return the command of this tick; at the start of a step, request its plan first."""
        if self._start is None:
            self._begin_step(observation, self.state.update(observation).outcomes, dt)
        elif self._tracker.advance(observation.contacts[None])[0]:
            here = self.state.update(observation).outcomes
            if self.footfalls is not None:
                self.footfalls.end_step()
                self.footfalls.see(observation)
            self._end_step(observation.time, here, self._start)
            self._begin_step(observation, here, dt)
        elif self.shaken is not None:
            self._look_again(observation, self._start, self.shaken, dt)
        if self._asked:
            self._take_answer(observation.time)
        goals = self._tracker.step(policy_input(observation), dt)[0]
        goals = self._limits.apply(goals, self._sent[-1] if self._sent else None, dt)
        self._sent.append(goals)
        return self._hold.with_position(goals)

    @property
    def published(self) -> BlockNames:
        """Names of what `publish` fills in."""
        return walk_names(self.gait, self.regulation, self.perturbations)

    def publish(self, block: ControllerBlock) -> None:
        """Publish the state of the graph and of the planning, and what they led to."""
        tracker = self._tracker
        block.run_state = RunState.WALKING
        block.phase, block.phase_time = int(tracker.state[0]), float(tracker.elapsed[0])
        block.plans, block.late_plans, block.plan_lateness = self.begun, self.late, self._lateness
        block.reason = reason_of(self.planner is not None, self._asked, self._replanned)
        if (scale := tracker.scale) is not self._shown:
            self._shown, plan = scale, self._kept.get(self._first)
            put_walk(block.values, self.records, self._target, plan, self.steering, scale[0])

    def _begin_step(self, observation: Observation, here: Outcomes, dt: float) -> None:
        """Store the start of the step and request its scalings."""
        start = StepStart(observation.time, int(self._tracker.stance()[0]), here)
        self._start = start
        self._first, self._replanned = int(self._tracker.state[0]), False
        self.steering.begin_step(start)
        scale = self.steering.scale(start)
        self._target = self._wanted(start)
        self._scale = scale
        if self.planner is None:
            self._tracker.rescale(scale[None])
            return
        self.late += self._asked
        before = self._before()
        self._tracker.rescale(before[None])
        self._ask(observation, start, before, dt)

    def _look_again(
        self, observation: Observation, start: StepStart, shaken: DisturbanceDetector, dt: float
    ) -> None:
        """Replan the rest of the step at the entry into a state, if a disturbance is detected."""
        state = int(self._tracker.state[0])
        if not shaken.entered(state):
            return
        here = self.state.update(observation).outcomes
        if self.footfalls is not None:
            self.footfalls.see(observation)
        if self.steering.slip is not None:
            self.steering.slip.entered(state, here.feet[0, start.stance])
        if shaken.detect(state, here.com_velocity[0], start.heading) and self.planner is not None:
            self.replans, self._replanned = self.replans + 1, True
            self._ask(observation, start, self._tracker.scale[0], dt)

    def _ask(self, observation: Observation, start: StepStart, before: Array, dt: float) -> None:
        """Request the scalings of the step, or of its rest.

        The scalings `before` (p,) stay in effect until the answer is applied.
        """
        assert self.planner is not None
        ground = None if self.footfalls is None else self.footfalls.plane()
        flight = RolloutStart(observation, np.array(self._sent), dt, ground)
        now = self._tracker.now
        request = StepRequest(
            flight, now, start.stance, self._first, self._scale, before, self._target, start
        )
        self._asked, self._late_from = True, request.due(self.planner.latency) + dt
        self._planned = observation.time + request.ticks(self.planner.latency) * dt
        self.planner.ask(request)

    def _before(self) -> Array:
        """Return the scalings (p,) until the answer: those of the steering plus the old K.

        The old K is the last one of a step that began with the same state of the graph: steps on
        the other foot, or a hop before a step on the same foot, need other values.
        """
        scale = self._scale.copy()
        if self._first in self._kept:
            scale[self._columns] += self._kept[self._first]
        return scale

    def _take_answer(self, time: float) -> None:
        """Apply the planner's scalings, if they are available."""
        assert self.planner is not None
        answer = self.planner.answer(time)
        if answer is None:
            return
        self._asked = False
        self.late += time >= self._late_from
        self._lateness = time - self._planned
        scale = self._scale.copy()
        scale[self._columns] += answer
        self._kept[self._first] = answer
        self._tracker.rescale(scale[None])

    def _end_step(self, time: float, end: Outcomes, start: StepStart) -> None:
        """Record the finished step, and pass the record to the steering."""
        duration = time - start.time
        self._turned += start.turned(end)
        forward, left = start.velocity(end, duration)
        record = StepRecord(
            time=time,
            duration=duration,
            position=end.base_position[0].copy(),
            heading=self._turned,
            speed=float(forward),
            side=float(left),
            regulation=start.evaluate(end, self.regulation, self.contacts)[0],
            target=self._target,
            scale=self._tracker.scale[0].copy(),
        )
        self.records.append(record)
        self.steering.end_step(record)

    def _wanted(self, start: StepStart) -> Array:
        """Return the targets (r,) of the step that begins at `start`."""
        left = self.contacts.is_left(1 - start.stance)
        wanted = self.steering.targets(self.targets, swing_is_left=left) | self.fixed_targets
        return np.array([wanted.get(variable.name, 0.0) for variable in self.regulation])
