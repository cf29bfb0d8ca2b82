import numpy as np
import pytest

from windup.hal.errors import ConfigError
from windup.hal.geometry.quaternion import rotate
from windup.hal.imu.mounting import Axes, Mounting

TURNED: list[Axes] = [
    ("x", "y", "z"),
    ("-x", "-y", "z"),
    ("-y", "-x", "-z"),
    ("-y", "x", "z"),
    ("y", "z", "x"),
    ("x", "-y", "-z"),
]


@pytest.mark.parametrize("axes", TURNED, ids=" ".join)
def test_vectors_and_orientations_are_turned_alike(axes: Axes) -> None:
    mounting, vector = Mounting(axes), np.array([1.0, 2.0, 3.0])
    assert rotate(mounting.quaternion, vector) == pytest.approx(mounting.to_body(vector))
    assert mounting.to_imu(mounting.to_body(vector)).tolist() == vector.tolist()


def test_an_axis_says_what_of_the_board_points_there() -> None:
    # Its own y axis points backward: what it feels along y is behind the robot.
    assert Mounting(("-y", "x", "z")).to_body(np.array([0.0, 1.0, 0.0])).tolist() == [-1, 0, 0]


def test_a_straight_board_is_turned_by_nothing_at_all() -> None:
    assert Mounting().quaternion.tolist() == [1.0, 0.0, 0.0, 0.0]


@pytest.mark.parametrize(
    ("axes", "says"),
    [
        (("x", "y", "w"), "'w' is no axis; known: x, y, z, -x, -y, -z"),
        (("x", "-x", "z"), "x, -x, z names an axis twice"),
        (("y", "x", "z"), "y, x, z is left-handed, and no board is: change the sign of one axis"),
    ],
)
def test_axes_that_no_board_can_have_are_refused(axes: Axes, says: str) -> None:
    with pytest.raises(ConfigError) as error:
        Mounting(axes)
    assert str(error.value) == says
