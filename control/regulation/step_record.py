"""How a step went, and where the next one begins."""

from dataclasses import dataclass

import numpy as np

from windup.control.kinematics.body import Body, heading
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
        time: When it ended, s.
        duration: s.
        position: (3,) base position at its end, m.
        heading: Heading at its end, unwrapped from the start of the walk, rad.
        speed: Mean speed along its middle heading, m/s.
        side: Mean speed to the left of it, m/s.
        regulation: (r,) regulation variables at its end.
        target: (r,) what they should have been.
        scale: (p,) scalings of the perturbations.
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
    """Where a step begins, and what its end is measured against.

    Attributes:
        time: s.
        stance: Index of the stance foot.
        body: The whole body at that instant, a batch of one.
    """

    time: float
    stance: int
    body: Outcomes

    @classmethod
    def of(cls, observation: Observation, stance: int, body: Body) -> "StepStart":
        """Return the start of a step on foot `stance` at `observation`."""
        return cls(observation.time, stance, body.measure(observation))

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
        """Return the regulation variables (m, r) of steps that begin here and end so."""
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
        """Return where and how fast the centre of mass is over the stance foot, and the lean.

        (7,) in the frame of the heading; velocities over omega = sqrt(g / height), so that all but
        the lean are m. The lateral ones are positive toward the swing foot.
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
        """Return the mean velocity (2,) until `end`: along the middle heading, to its left, m/s."""
        angle = self.heading + 0.5 * self.turned(end)
        c, s = np.cos(angle), np.sin(angle)
        way = end.base_position[0, :2] - self.position[:2]
        return np.array([[c, s], [-s, c]]) @ way / max(duration, 1e-6)
