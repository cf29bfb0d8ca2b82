import numpy as np
import pytest

from windup.control.kinematics.rotation import (
    heading_between,
    lying,
    quaternion_matrix,
    turn,
    turn_about_y,
    turn_between,
    way_round,
    yaw_of,
)


def test_a_quaternion_turns_as_mujocos() -> None:
    quaternion = np.array([np.cos(0.3), 0.0, 0.0, np.sin(0.3)])
    assert quaternion_matrix(quaternion) == pytest.approx(turn(0.6))


@pytest.mark.parametrize("yaw", [0.0, 1.2, -3.0])
def test_the_heading_of_a_turn_is_its_angle(yaw: float) -> None:
    assert yaw_of(turn(yaw)) == pytest.approx(yaw)


def test_a_turn_about_y_leans_forward() -> None:
    assert turn_about_y(0.3) @ [0.0, 0.0, 1.0] == pytest.approx([np.sin(0.3), 0.0, np.cos(0.3)])


@pytest.mark.parametrize("angle", [0.0, 1e-4, 0.5, 2.0])
def test_the_turn_between_two_is_what_is_missing(angle: float) -> None:
    one = turn(0.4) @ turn_about_y(0.2)
    assert turn_between(one, turn(angle) @ one) == pytest.approx([0.0, 0.0, angle], abs=1e-9)


def test_between_two_headings_it_goes_the_shorter_way() -> None:
    assert heading_between(0.1, 0.5, 0.25) == pytest.approx(0.2)
    assert turn(heading_between(3.0, -3.0, 0.5)) == pytest.approx(turn(np.pi))


def test_what_lies_on_a_slope_keeps_its_heading_seen_from_above() -> None:
    normal = np.array([-0.1, 0.05, 1.0])
    normal /= np.linalg.norm(normal)
    frame = lying(normal, 0.7)
    assert frame.T @ frame == pytest.approx(np.eye(3))
    assert frame[:, 2] == pytest.approx(normal)
    assert yaw_of(frame) == pytest.approx(0.7)
    assert lying(np.array([0.0, 0.0, 1.0]), 0.7) == pytest.approx(turn(0.7))


def test_the_way_round_is_the_shorter_one() -> None:
    assert way_round(3.0, -3.0) == pytest.approx(2.0 * np.pi - 6.0)
    assert way_round(0.2, -0.3) == pytest.approx(-0.5)
