from dataclasses import replace

import mujoco
import numpy as np
import pytest

from windup.control.execution.footing import Footing
from windup.control.kinematics.rotation import turn
from windup.hal.errors import StateMissingError
from windup.hal.observation import BaseState, JointState, Observation
from windup.robots import load_robot
from windup.tools.assembly.stepping import footing_of, stepping_stance

OP3 = load_robot("op3")
STANCE = stepping_stance(OP3)
N = len(OP3.joints)


def seen(
    yaw: float = 0.0, place: tuple[float, float] = (0.0, 0.0), drift: float = 0.0
) -> Observation:
    """Return a robot in its stance with flat soles, somewhere, drifting forward, m/s."""
    footing = footing_of(OP3, STANCE)
    upright = footing_level(footing, yaw)
    zero = np.zeros(N)
    quaternion = np.empty(4)
    mujoco.mju_mat2Quat(quaternion, upright.ravel())
    base = BaseState(
        np.array([*place, footing.height]), quaternion, np.array([drift, 0.0, 0.0]), np.zeros(3)
    )
    joints = JointState(STANCE.copy(), zero, zero, zero, zero, zero)
    return Observation(0.0, joints, None, np.zeros(8), base)


def footing_level(footing: Footing, yaw: float) -> np.ndarray:
    return footing.upright(np.zeros(2), yaw).rotation


@pytest.fixture
def footing() -> Footing:
    return footing_of(OP3, STANCE)


def test_in_its_stance_the_base_is_at_home_over_flat_soles(footing: Footing) -> None:
    footing.update(seen(place=(0.3, -0.1)))
    assert footing.home(footing.planted()) == pytest.approx([0.3, -0.1], abs=2e-3)
    assert footing.down == [True, True]
    assert [foot.position[2] for foot in footing.feet] == pytest.approx([0.0, 0.0], abs=1e-3)
    assert footing.support((0, 1)).margin(footing.momenta.com[:2]) > 0.03
    assert footing.support((0,)).margin(footing.momenta.com[:2]) < 0.0


@pytest.mark.parametrize("yaw", [0.0, 0.8, -2.0])
def test_standing_as_it_stands_changes_no_joint(footing: Footing, yaw: float) -> None:
    footing.update(seen(yaw))
    goals, planted = STANCE.copy(), footing.planted()
    for foot in (0, 1):
        base = footing.upright(footing.home(planted), planted.front)
        footing.keep(goals, foot, planted, base)
    assert np.abs(goals - STANCE).max() < 0.02


@pytest.mark.parametrize("yaw", [0.0, 1.0])
def test_a_foot_comes_where_it_is_put(footing: Footing, yaw: float) -> None:
    observation = seen(yaw)
    footing.update(observation)
    at = np.append(footing.places[0], 0.03) + turn(yaw) @ [0.03, 0.01, 0.0]
    goals = STANCE.copy()
    for _ in range(10):
        footing.put(goals, 0, at, yaw, footing.base)
    joints = replace(observation.joints, position=goals)
    footing.update(replace(observation, joints=joints))
    assert footing.feet[0].position == pytest.approx(at, abs=2e-3)
    assert footing.down == [False, True]


def test_ahead_goes_on_as_the_base_does(footing: Footing) -> None:
    footing.update(seen(drift=0.5))
    assert footing.ahead(0.1).position == pytest.approx([0.05, 0.0, footing.height])
    turned = footing.ahead(0.1).rotation
    assert turned == pytest.approx(footing.base.rotation)


def test_without_a_base_nobody_knows_where_the_feet_are(footing: Footing) -> None:
    blind = seen()
    with pytest.raises(StateMissingError, match="--state estimated"):
        footing.update(Observation(0.0, blind.joints, None, blind.contacts, None))


def test_circles_support_as_much_as_the_soles_do(footing: Footing) -> None:
    footing.update(seen())
    hull, centre = footing.support((0,)).shape.area, footing.places[0]
    footing.rounded = True
    assert footing.support((0,)).shape.area == pytest.approx(hull, rel=0.01)
    radius = np.sqrt(hull / np.pi)
    assert footing.support((0,)).margin(centre) == pytest.approx(radius, rel=0.01)
    aside = centre + np.array([0.0, 0.5 * radius])
    assert footing.support((0, 1)).margin(aside) == pytest.approx(0.5 * radius, rel=0.02)
