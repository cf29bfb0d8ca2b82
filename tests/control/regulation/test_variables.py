from dataclasses import replace

import numpy as np
import pytest

from windup.control.kinematics.rotation import heading
from windup.control.regulation.variables import StepEnd, regulation_variables
from windup.hal.controller import Outcomes
from windup.hal.errors import UnknownNameError
from windup.hal.geometry.gravity import GRAVITY
from windup.hal.joints import Array


def turned(yaw: float, pitch: float = 0.0) -> Array:
    """Return the quaternion of a base that faces `yaw` and then leans forward by `pitch`, rad."""
    c, s = np.cos(yaw / 2), np.sin(yaw / 2)
    cp, sp = np.cos(pitch / 2), np.sin(pitch / 2)
    return np.array([c * cp, -s * sp, c * sp, s * cp])


def outcomes(yaw: float = 0.0, lean: Array | None = None, pitch: float = 0.0) -> Outcomes:
    """Return one hand-made step end: the body is turned by `yaw` about the origin."""
    R = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1]])
    torso = np.array([0.0, 0.0, 1.0]) if lean is None else lean
    return Outcomes(
        duration=np.array([0.4]),
        base_position=np.zeros((1, 3)),
        base_orientation=turned(yaw, pitch)[None],
        base_velocity=np.zeros((1, 6)),
        joint_position=np.zeros((1, 2)),
        com=(R @ [0.1, 0.02, 0.9])[None],
        com_velocity=(R @ [0.5, -0.2, 0.0])[None],
        feet=np.array([R @ [0.3, 0.1, 0.1], R @ [0.0, -0.1, 0.0]])[None],
        torso=(R @ torso)[None],
        contacts=np.zeros((1, 4)),
        fell=np.zeros(1, dtype=bool),
    )


def end(result: Outcomes, swing: int = 0, start_heading: float = 0.0) -> StepEnd:
    return StepEnd(
        outcomes=result,
        swing=swing,
        start_com=np.array([0.04, -0.03, 0.9]),
        start_heading=start_heading,
        swing_is_left=swing == 0,
    )


def value(name: str, at: StepEnd) -> float:
    return float(regulation_variables([name])[0].evaluate(at)[0])


YAWS = pytest.mark.parametrize("yaw", [0.0, 0.7, -2.5, np.pi])


@YAWS
def test_up_is_how_far_the_torso_leans_ahead_and_toward_the_swing_foot(yaw: float) -> None:
    at = end(outcomes(yaw, lean=np.array([0.2, 0.05, 0.97])))
    assert value("up.forward", at) == pytest.approx(0.2)
    assert value("up.lateral", at) == pytest.approx(0.05)


@YAWS
def test_pelvis_up_is_the_sine_of_the_pelvis_pitch(yaw: float) -> None:
    at = end(outcomes(yaw, pitch=0.3))
    assert value("pelvis_up.forward", at) == pytest.approx(np.sin(0.3))
    assert value("pelvis_up.lateral", at) == pytest.approx(0.0, abs=1e-12)


@YAWS
def test_swing_com_and_stance_com_are_unit_vectors_from_a_foot(yaw: float) -> None:
    at = end(outcomes(yaw))
    swing, stance = np.array([-0.2, -0.08, 0.8]), np.array([0.1, 0.12, 0.9])
    assert value("swing_com.forward", at) == pytest.approx(-0.2 / np.linalg.norm(swing))
    assert value("swing_com.lateral", at) == pytest.approx(-0.08 / np.linalg.norm(swing))
    assert value("stance_com.forward", at) == pytest.approx(0.1 / np.linalg.norm(stance))
    assert value("stance_com.lateral", at) == pytest.approx(0.12 / np.linalg.norm(stance))


@YAWS
def test_xcom_is_hofs_extrapolated_centre_of_mass_from_the_swing_foot(yaw: float) -> None:
    at = end(outcomes(yaw))
    time = np.sqrt(0.8 / GRAVITY)
    assert value("xcom.forward", at) == pytest.approx(0.1 + 0.5 * time - 0.3)
    assert value("xcom.lateral", at) == pytest.approx(0.02 - 0.2 * time - 0.1)


def test_displacement_is_along_the_heading_at_the_start_of_the_step() -> None:
    at = end(outcomes(0.0), start_heading=0.0)
    assert value("com_displacement.forward", at) == pytest.approx(0.06)
    assert value("com_displacement.lateral", at) == pytest.approx(0.05)
    # The base now faces elsewhere; the way of the step does not.
    facing = replace(outcomes(0.0), base_orientation=turned(1.0)[None])
    assert value("com_displacement.forward", end(facing)) == pytest.approx(0.06)
    aside = end(outcomes(0.0), start_heading=np.pi / 2)
    assert value("com_displacement.forward", aside) == pytest.approx(0.05)
    assert value("com_displacement.lateral", aside) == pytest.approx(-0.06)


@pytest.mark.parametrize(
    "name", ["up", "pelvis_up", "swing_com", "stance_com", "com_displacement", "xcom"]
)
def test_a_step_and_its_mirror_image_have_the_same_variables(name: str) -> None:
    flip = np.array([1.0, -1.0, 1.0])
    left = outcomes(0.4, lean=np.array([0.2, 0.05, 0.97]), pitch=0.2)
    right = replace(
        left,
        base_orientation=left.base_orientation * [1.0, -1.0, 1.0, -1.0],
        com=left.com * flip,
        com_velocity=left.com_velocity * flip,
        feet=left.feet[:, ::-1] * flip,
        torso=left.torso * flip,
    )
    one = replace(end(left, swing=0, start_heading=0.4))
    other = replace(end(right, swing=1, start_heading=-0.4), start_com=one.start_com * flip)
    for variable in regulation_variables([name]):
        np.testing.assert_allclose(variable.evaluate(one), variable.evaluate(other))


def test_heading_is_where_the_base_faces_whatever_its_pitch() -> None:
    for yaw in (-3.0, -1.0, 0.0, 0.5, 2.0):
        for pitch in (-0.6, 0.0, 0.6):
            assert heading(turned(yaw, pitch)) == pytest.approx(yaw)


def test_a_bare_name_is_both_components_and_a_composite_is_as_many_names() -> None:
    chosen = regulation_variables(["up", "xcom.lateral"])
    assert [rv.name for rv in chosen] == ["up.forward", "up.lateral", "xcom.lateral"]
    assert [rv.unit for rv in chosen] == ["1", "1", "m"]


@pytest.mark.parametrize("name", ["upp", "up.forwards", "up.", ""])
def test_an_unknown_variable_lists_the_known(name: str) -> None:
    with pytest.raises(UnknownNameError) as error:
        regulation_variables([name])
    assert str(error.value).startswith(f"unknown regulation variable {name!r}; ")
    assert "known: com_displacement, com_displacement.forward, " in str(error.value)
