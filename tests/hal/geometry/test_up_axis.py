import numpy as np
import pytest

from windup.hal.geometry.quaternion import euler_zxy, rotate
from windup.hal.geometry.up_axis import UP_AXIS, up_axis, uprightness


@pytest.mark.parametrize("angles", [(0.0, 0.0, 0.0), (1.0, 0.3, -0.2), (-2.0, 2.5, 0.7)])
def test_the_up_axis_is_where_an_orientation_puts_z(angles: tuple[float, float, float]) -> None:
    orientation = euler_zxy(*angles)
    found = up_axis(orientation)
    assert found == pytest.approx(rotate(orientation, np.array([0.0, 0.0, 1.0])))
    assert uprightness(orientation[1], orientation[2]) == found[2]


def test_it_stands_in_the_last_column_of_a_rotation_matrix() -> None:
    matrix = np.arange(9.0)
    assert matrix[UP_AXIS].tolist() == matrix.reshape(3, 3)[:, 2].tolist()
