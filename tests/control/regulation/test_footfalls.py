"""What the feet feel of the ground."""

from dataclasses import replace
from math import cos, radians, sin, tan

import numpy as np
import pytest

from windup.control.regulation.footfalls import Footfalls
from windup.hal.observation import Observation
from windup.robots import RobotDescription
from windup.sim_twin.backend import TwinBackend
from windup.sim_twin.twin import Twin
from windup.tools.assembly.state import state_of

DOWN = radians(-4.0)


def standing(human: RobotDescription, pitch: float, height: float = 0.0) -> Observation:
    """Return an observation of a human whose flat soles all touch ground that rises by `pitch`."""
    observation = TwinBackend(Twin(human)).read()
    assert observation.base is not None
    base = replace(
        observation.base,
        position=observation.base.position + np.array([0.0, 0.0, height]),
        orientation=np.array([cos(0.5 * pitch), 0.0, -sin(0.5 * pitch), 0.0]),
    )
    contacts = np.full(len(human.contacts.names), 50.0)
    return replace(observation, base=base, contacts=contacts)


def feel(human: RobotDescription, *observations: Observation) -> tuple[float, float, float]:
    footfalls = Footfalls(state_of(human), human.contacts, 4)
    for observation in observations:
        footfalls.see(observation)
        footfalls.end_step()
    return footfalls.plane()


def test_flat_feet_feel_a_slope(human: RobotDescription) -> None:
    _, ahead, left = feel(human, standing(human, DOWN))
    assert ahead == pytest.approx(tan(DOWN), abs=0.005)
    assert left == pytest.approx(0.0, abs=1e-6)


def test_level_ground_is_felt_as_level_and_a_step_up_by_its_height(
    human: RobotDescription,
) -> None:
    assert feel(human, standing(human, 0.0)) == (0.0, 0.0, 0.0)
    height, ahead, _ = feel(human, standing(human, 0.0, 0.03))
    assert height == pytest.approx(0.03, abs=0.002)
    assert ahead == 0.0


def test_the_last_step_counts_most(human: RobotDescription) -> None:
    _, ahead, _ = feel(human, *[standing(human, 0.0)] * 3, standing(human, DOWN))
    assert ahead < 0.5 * tan(DOWN)


def test_nothing_is_felt_in_the_air(human: RobotDescription) -> None:
    flying = standing(human, DOWN)
    flying = replace(flying, contacts=np.zeros_like(flying.contacts))
    assert feel(human, flying) == (0.0, 0.0, 0.0)
