"""How far joints go: by robot.toml, the MJCF, or one turn of a servo, or many."""

from pathlib import Path

import numpy as np
import pytest

from tests.shapes import Limb, Shape, write_shape
from windup.hal.errors import ConfigError
from windup.robots import RobotDescription, load_robot

ONE = Shape("one", (Limb("arm", "0 0 0.03", 1, "z", down=False),), floats=False, height=0.03)
BOUNDED = "lower = -1.5, upper = 1.5"
RANGE = 'range="-1.5 1.5"'


def one(folder: Path, keys: str, *, bounded: bool = False, servo: str = "") -> RobotDescription:
    """Return a robot with one joint, of which its file says these keys."""
    path = write_shape(folder / "one", ONE)
    model, file = path / "model.xml", path / "robot.toml"
    text = file.read_text().replace(f", {BOUNDED}", f", {keys}" if keys else "")
    if servo:
        text = text.replace("XM430-W350", servo).replace("dynamixel2", "feetech")
    file.write_text(text)
    if not bounded:
        model.write_text(model.read_text().replace(RANGE, ""))
    return load_robot(path)


def test_limits_are_the_mjcfs_where_the_file_says_none(tmp_path: Path) -> None:
    robot = one(tmp_path, "lower = -0.5", bounded=True)
    assert (robot.joints.lower[0], robot.joints.upper[0]) == (-0.5, 1.5)


def test_extended_mode_turns_on_and_on(tmp_path: Path) -> None:
    robot = one(tmp_path, 'mode = "extended"')
    np.testing.assert_allclose(robot.joints.upper, 255 * 2 * np.pi)
    assert robot.servos[0] is not None and robot.servos[0].extended


def test_a_torque_joint_needs_no_limits(tmp_path: Path) -> None:
    path = write_shape(tmp_path / "one", ONE)
    model, file = path / "model.xml", path / "robot.toml"
    model.write_text(model.read_text().replace(RANGE, ""))
    text = file.read_text().replace(f"id = 1, {BOUNDED}", "stiffness = 3.0").split("[[bus]]")
    head = text[0].replace('kind = "servo"\nservo = "XM430-W350"\nbus = "body"', 'kind = "torque"')
    file.write_text(head + "[poses.stand]\n")
    assert load_robot(path).joints.upper[0] > 1000.0


MISTAKES = {
    "no limits": (
        "",
        "",
        "joint 'arm_0': no range in the MJCF, and no lower and upper here: give both",
    ),
    "more than a turn": (
        "lower = -4, upper = 4",
        "",
        "joint 'arm_0': lower -4 to upper 4 rad (ratio 1, zero 2048) is -560 to 4656 counts, and a "
        "XM430-W350 has 0 to 4095 in position mode: narrow lower and upper, or give mode = "
        '"extended"',
    ),
    "by its ratio": (f"{BOUNDED}, ratio = 3", "", "(ratio 3, zero 2048) is -886 to 4982 counts"),
    "beyond the end": (f"{BOUNDED}, zero = 100", "", "lower and upper, or give another zero"),
    "no such mode": (f'{BOUNDED}, mode = "wheel"', "", "mode: Invalid enum value 'wheel'"),
    "of Feetech": ('mode = "extended"', "STS3215-7.4V", "is for Dynamixel X servos"),
    "past a turn of Feetech": ("lower = 0, upper = 7", "STS3215-7.4V", "position mode: narrow"),
}


@pytest.mark.parametrize(("keys", "servo", "said"), MISTAKES.values(), ids=MISTAKES.keys())
def test_travel_that_cannot_be_is_one_line(
    tmp_path: Path, keys: str, servo: str, said: str
) -> None:
    with pytest.raises(ConfigError) as error:
        one(tmp_path, keys, servo=servo)
    assert said in str(error.value)
    assert "\n" not in str(error.value)
