"""Record of a finished step, and the start state of a step."""

from dataclasses import dataclass

import numpy as np

from windup.control.kinematics.robot_state import RobotState
from windup.control.kinematics.rotation import heading
from windup.control.regulation.variables import RegulationVariable, StepEnd
from windup.hal.contacts import ContactSensors
from windup.hal.controller import Outcomes
from windup.hal.geometry.angles import wrapped
from windup.hal.geometry.gravity import GRAVITY
from windup.hal.joints import Array
from windup.hal.observation import Observation


@dataclass(frozen=True)
class StepRecord:
    """One finished step.

    Attributes:
        time: Time at its end, s.
        duration: Duration, s.
        position: (3,) base position at its end, m.
        heading: Heading at its end, unwrapped from the start of the walk, rad.
        speed: Mean speed along the mean of its start and end headings, m/s.
        side: Mean speed to the left of that heading, m/s.
        regulation: (r,) regulation variables at its end.
        target: (r,) targets of the regulation variables.
        scale: (p,) scalings of the perturbations at its end.
    """

    time: float
    duration: float
    position: Array
    heading: float
    speed: float
    side: float
    regulation: Array
    target: Array
    scale: Array


@dataclass(frozen=True)
class StepStart:
    """Start state of a step, the reference for the measurements at its end.

    Attributes:
        time: Time at the start, s.
        stance: Index of the stance foot.
        body: Whole-body state at the start, a batch of one.
    """

    time: float
    stance: int
    body: Outcomes

    @classmethod
    def of(cls, observation: Observation, stance: int, state: RobotState) -> "StepStart":
        """Return the start of a step on foot `stance` at `observation`."""
        return cls(observation.time, stance, state.update(observation).outcomes)

    @property
    def heading(self) -> float:
        """Heading, rad."""
        return float(heading(self.body.base_orientation)[0])

    @property
    def position(self) -> Array:
        """Base position (3,), m."""
        return self.body.base_position[0]

    def evaluate(
        self, outcomes: Outcomes, variables: list[RegulationVariable], contacts: ContactSensors
    ) -> Array:
        """Return the regulation variables (m, r) of m steps from this start to `outcomes`."""
        swing = 1 - self.stance
        end = StepEnd(
            outcomes,
            swing=swing,
            start_com=self.body.com[0],
            start_heading=self.heading,
            swing_is_left=contacts.is_left(swing),
        )
        columns = [variable.evaluate(end) for variable in variables]
        return np.stack(columns, axis=-1) if columns else np.zeros((len(outcomes.fell), 0))

    def features(self) -> Array:
        """Return features (7,): CoM relative to the stance foot, CoM velocity, and torso lean.

        In the frame of the heading, lateral components positive toward the swing foot. Velocities
        are divided by omega = sqrt(g / height), so that all features but the lean are in m.
        """
        body = self.body
        offset = body.com[0] - body.feet[0, self.stance]
        slow = np.sqrt(max(float(offset[2]), 0.1) / GRAVITY)
        c, s = np.cos(self.heading), np.sin(self.heading)
        out = np.sign(body.feet[0, 1 - self.stance] @ [-s, c, 0.0] - body.com[0] @ [-s, c, 0.0])
        turn = np.array([[c, s], [-s * out, c * out]])
        flat = [offset[:2], slow * body.com_velocity[0, :2], 0.2 * body.torso[0, :2]]
        return np.concatenate([turn @ part for part in flat] + [[offset[2]]])

    def turned(self, end: Outcomes) -> float:
        """Return the change of heading until `end`, rad."""
        change = float(heading(end.base_orientation)[0]) - self.heading
        return wrapped(change)

    def velocity(self, end: Outcomes, duration: float) -> Array:
        """Return the mean velocity (2,) until `end`, along and left of the mean heading, m/s."""
        angle = self.heading + 0.5 * self.turned(end)
        c, s = np.cos(angle), np.sin(angle)
        way = end.base_position[0, :2] - self.position[:2]
        return np.array([[c, s], [-s, c]]) @ way / max(duration, 1e-6)
