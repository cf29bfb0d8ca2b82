"""Regulation variables: scalar measures of the state at the end of a step.

Laszlo 1996, section 3.5: Q = gamma(x), Eq. 3.5, a projection of the state sampled at the end of a
step. Each variable has a forward and a lateral component in the frame of the hips. Lateral
components are positive toward the foot that has just swung, so that one target serves both sides.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from windup.control.kinematics.rotation import heading
from windup.hal.controller import Outcomes
from windup.hal.errors import UnknownNameError
from windup.hal.geometry.gravity import GRAVITY
from windup.hal.geometry.up_axis import up_axis
from windup.hal.joints import Array

AXES = ("forward", "lateral")


@dataclass(frozen=True)
class StepEnd:
    """End states of m steps that share one start.

    Attributes:
        outcomes: States at the ends.
        swing: Index of the swing foot.
        start_com: (3,) centre of mass at the start of the step, m.
        start_heading: Heading at the start of the step, rad.
        swing_is_left: The swing foot is the left one.
    """

    outcomes: Outcomes
    swing: int
    start_com: Array
    start_heading: float
    swing_is_left: bool


Vector = Callable[[StepEnd], Array]


def _unit(vector: Array) -> Array:
    return vector / np.linalg.norm(vector, axis=-1, keepdims=True)


def up(end: StepEnd) -> Array:
    """Return the unit vectors (m, 3) along the torso (section 3.5)."""
    return end.outcomes.torso


def pelvis_up(end: StepEnd) -> Array:
    """Return the unit vectors (m, 3) along the pelvis; for use with a torso servo (section 3.8)."""
    return up_axis(end.outcomes.base_orientation)


def swing_com(end: StepEnd) -> Array:
    """Return the unit vectors (m, 3) from the swing foot to the centre of mass (section 3.5)."""
    return _unit(end.outcomes.com - end.outcomes.feet[:, end.swing])


def stance_com(end: StepEnd) -> Array:
    """Return the unit vectors (m, 3) from the stance foot to the centre of mass (section 3.5)."""
    return _unit(end.outcomes.com - end.outcomes.feet[:, 1 - end.swing])


def com_displacement(end: StepEnd) -> Array:
    """Return the displacements (m, 3) of the centre of mass over the step, m.

    `RegulationVariable` takes their components along and left of the heading at its start.
    """
    return end.outcomes.com - end.start_com


def xcom(end: StepEnd) -> Array:
    """Return XcoM, com + v / omega, relative to the swing foot, (m, 3) m.

    Hof 2005, with omega = sqrt(g / height of the centre of mass above the swing foot).
    """
    foot = end.outcomes.feet[:, end.swing]
    height = np.maximum(end.outcomes.com[:, 2:] - foot[:, 2:], 0.1)
    return end.outcomes.com + end.outcomes.com_velocity * np.sqrt(height / GRAVITY) - foot


VARIABLES: dict[str, tuple[Vector, str]] = {
    "up": (up, "1"),
    "pelvis_up": (pelvis_up, "1"),
    "swing_com": (swing_com, "1"),
    "stance_com": (stance_com, "1"),
    "com_displacement": (com_displacement, "m"),
    "xcom": (xcom, "m"),
}


@dataclass(frozen=True)
class RegulationVariable:
    """One component of one regulation variable.

    Attributes:
        name: Variable and axis, such as "up.forward".
        axis: "forward" or "lateral".
        unit: Unit of the component.
        vector: Function that returns the variable as vectors in the world frame.
    """

    name: str
    axis: str
    unit: str
    vector: Vector

    def evaluate(self, end: StepEnd) -> Array:
        """Return the component (m,) of the end states of m steps."""
        vector = self.vector(end)
        if self.vector is com_displacement:
            angle: Array = np.full(len(vector), end.start_heading)
        else:
            angle = heading(end.outcomes.base_orientation)
        c, s = np.cos(angle), np.sin(angle)
        if self.axis == "forward":
            return c * vector[:, 0] + s * vector[:, 1]
        left = c * vector[:, 1] - s * vector[:, 0]
        return left if end.swing_is_left else -left


def regulation_variables(names: list[str]) -> list[RegulationVariable]:
    """Return the components that `names` stand for; a name without axis stands for both.

    >>> [rv.name for rv in regulation_variables(["up", "xcom.lateral"])]
    ['up.forward', 'up.lateral', 'xcom.lateral']

    Raises:
        UnknownNameError: There is no such variable or component.
    """
    chosen = []
    known = [*VARIABLES, *(f"{name}.{axis}" for name in VARIABLES for axis in AXES)]
    for name in names:
        if name not in known:
            raise UnknownNameError("regulation variable", name, known)
        variable, _, axis = name.partition(".")
        vector, unit = VARIABLES[variable]
        chosen += [
            RegulationVariable(f"{variable}.{a}", a, unit, vector)
            for a in ([axis] if axis else AXES)
        ]
    return chosen


def unmatched(perturbations: Sequence[str], variables: Sequence[RegulationVariable]) -> str:
    """Return a message if there are not as many perturbations as variables; else "".

    >>> unmatched(["hip"], regulation_variables(["up"]))
    '1 perturbations for 2 regulation variables; give as many (for up.forward, up.lateral)'
    """
    if len(perturbations) == len(variables):
        return ""
    names = ", ".join(variable.name for variable in variables)
    return (
        f"{len(perturbations)} perturbations for {len(variables)} regulation variables; "
        f"give as many (for {names})"
    )
