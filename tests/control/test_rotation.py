import numpy as np
import pytest

from control.rotation import (
    heading_between,
    quaternion_matrix,
    turn,
    turn_about_y,
    turn_between,
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
