"""How a robot is that has no torque: what its accelerometer and its encoders say."""

from math import inf, radians

import numpy as np
import pytest

from windup.control.estimation.posture import Posture, PostureSense
from windup.hal.geometry.gravity import GRAVITY
from windup.hal.joints import Array
from windup.hal.observation import ImuState, JointState, Observation
from windup.robots import RobotDescription


def seen(pose: Array, up: Array, felt: float = GRAVITY) -> Observation:
    """Return what is seen in a pose (n,) rad with the vertical (3,) in the base."""
    zero = np.zeros_like(pose)
    state = JointState(pose, zero, zero, zero, zero, zero, zero)
    return Observation(0.0, state, ImuState(None, np.zeros(3), felt * up, 0.0), np.zeros(0), None)


def posture(robot: RobotDescription, *looks: Observation) -> Posture | None:
    feet = [foot.body for foot in robot.feet]
    return PostureSense(robot.spec().compile(), feet).posture(looks)


def leaning(forward: float) -> Array:
    """Return the vertical as a base sees it that leans forward, degrees."""
    angle = radians(forward)
    return np.array([-np.sin(angle), 0.0, np.cos(angle)])


def test_one_that_stands_is_upright_and_high_on_its_feet_alone(op3: RobotDescription) -> None:
    stands = posture(op3, seen(op3.stance, leaning(5.0)))
    assert stands is not None
    assert stands.tilt == pytest.approx(radians(5.0))
    assert stands.height == pytest.approx(0.28, abs=0.02)
    assert stands.clearance > 0.1


def test_one_that_squats_is_low_and_nothing_but_its_feet_is_near_the_floor(
    op3: RobotDescription,
) -> None:
    assert op3.crouch is not None
    squats = posture(op3, seen(op3.crouch, leaning(0.0)))
    assert squats is not None
    assert squats.height > op3.fall.height and squats.clearance > 0.04


def test_one_that_sits_touches_the_floor_with_more_than_its_feet(op3: RobotDescription) -> None:
    legs = {"l_hip_pitch": -1.25, "r_hip_pitch": 1.25}
    sits = posture(op3, seen(op3.joints.array(legs), leaning(-35.0)))
    assert sits is not None
    assert sits.clearance < 0.01 and sits.tilt < op3.fall.tilt


@pytest.mark.parametrize(
    ("up", "side"),
    [
        ((-1.0, 0.1, 0.2), "front"),
        ((1.0, 0.1, -0.2), "back"),
        ((0.1, -1.0, 0.0), "left side"),
        ((0.1, 1.0, 0.0), "right side"),
    ],
)
def test_one_that_lies_does_so_on_the_side_that_is_down(
    op3: RobotDescription, up: tuple[float, ...], side: str
) -> None:
    lies = posture(op3, seen(op3.stance, np.array(up) / np.linalg.norm(up)))
    assert lies is not None
    assert lies.side == side and lies.tilt > op3.fall.tilt


def test_the_accelerometer_is_averaged(op3: RobotDescription) -> None:
    looks = [seen(op3.stance, leaning(lean)) for lean in (-4.0, 0.0, 4.0, 8.0)]
    mean = posture(op3, *looks)
    assert mean is not None and mean.tilt == pytest.approx(radians(2.0), abs=1e-3)


def test_one_that_falls_or_has_no_imu_is_not_told(op3: RobotDescription) -> None:
    assert posture(op3, seen(op3.stance, leaning(0.0), felt=2.0)) is None
    blind = seen(op3.stance, leaning(0.0))
    object.__setattr__(blind, "imu", None)
    assert posture(op3, blind) is None


def test_one_of_which_only_the_soles_collide_is_told_by_its_feet_and_its_tilt(
    op3: RobotDescription,
) -> None:
    spec, feet = op3.spec(), {foot.body for foot in op3.feet}
    for geom in spec.geoms:
        if geom.parent.name not in feet:
            geom.contype = geom.conaffinity = 0
    sense = PostureSense(spec.compile(), sorted(feet))
    stands = sense.posture([seen(op3.stance, leaning(0.0))])
    lies = sense.posture([seen(op3.stance, leaning(90.0))])
    assert stands is not None and lies is not None
    assert stands.clearance == inf and stands.height == pytest.approx(0.28, abs=0.02)
    assert lies.tilt > op3.fall.tilt


def test_one_without_collisions_is_told_by_its_tilt(op3: RobotDescription) -> None:
    spec = op3.spec()
    for geom in spec.geoms:
        geom.contype = geom.conaffinity = 0
    sense = PostureSense(spec.compile(), [foot.body for foot in op3.feet])
    lies = sense.posture([seen(op3.stance, leaning(90.0))])
    assert lies is not None and lies.height == inf and lies.clearance == inf
    assert lies.tilt == pytest.approx(radians(90.0))
