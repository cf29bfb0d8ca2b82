import numpy as np
import pytest

from tests.small_world import CONTACTS, JOINTS, L_TOE, R_HEEL
from windup.hal.contacts import ContactSensors
from windup.hal.errors import UnknownNameError


def test_names_are_looked_up_once_and_in_the_order_asked_for() -> None:
    assert JOINTS.index("l_knee") == 2
    np.testing.assert_array_equal(JOINTS.indices(["r_knee", "waist"]), [4, 0])


def test_an_unknown_joint_names_the_likely_one_and_the_known() -> None:
    with pytest.raises(UnknownNameError) as error:
        JOINTS.index("l_kne")
    assert str(error.value) == (
        "unknown joint 'l_kne'; did you mean 'l_knee'? known: l_hip, l_knee, r_hip, r_knee, waist"
    )


def test_values_by_name_become_an_array_with_a_default_elsewhere() -> None:
    values = JOINTS.array({"waist": 1.0, "r_hip": 2.0}, default=-1.0)
    np.testing.assert_array_equal(values, [1.0, -1.0, -1.0, 2.0, -1.0])
    with pytest.raises(UnknownNameError, match="unknown joint 'hip'"):
        JOINTS.array({"hip": 1.0})


@pytest.mark.parametrize("key", ["lower", "upper", "stiffness", "damping", "torque", "velocity"])
def test_the_limits_of_a_robot_cannot_be_written_over(key: str) -> None:
    with pytest.raises(ValueError, match="read-only"):
        getattr(JOINTS, key)[0] = 0.0


def test_a_contact_is_one_sensor_or_a_whole_foot() -> None:
    np.testing.assert_array_equal(CONTACTS.mask("l_toe"), [False, True, False, False])
    np.testing.assert_array_equal(CONTACTS.mask("left_foot"), [True, True, False, False])


def test_an_unknown_contact_names_the_likely_one() -> None:
    with pytest.raises(UnknownNameError) as error:
        CONTACTS.mask("left_fot")
    assert str(error.value) == (
        "unknown contact 'left_fot'; did you mean 'left_foot'? "
        "known: l_heel, l_toe, left_foot, r_heel, r_toe, right_foot"
    )


def test_a_sensor_is_pressed_above_its_threshold_not_at_it() -> None:
    contacts = ContactSensors(("a", "b", "c"), {"foot": ("a", "b", "c")}, threshold=2.0)
    np.testing.assert_array_equal(contacts.pressed(np.array([1.9, 2.0, 2.1])), [False, False, True])


def test_a_foot_is_down_when_any_of_its_sensors_is_pressed() -> None:
    down = CONTACTS.feet_down(np.stack([L_TOE, R_HEEL, L_TOE + R_HEEL, 0.0 * L_TOE]))
    np.testing.assert_array_equal(
        down, [[True, False], [False, True], [True, True], [False, False]]
    )
