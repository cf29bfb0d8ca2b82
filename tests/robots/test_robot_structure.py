"""What a robot may be made of: its base, its joints, its feet, its files; each mistake one line."""

from pathlib import Path

import numpy as np
import pytest

from tests.shapes import ARM, QUADRUPED, THIRTY, Limb, Shape, write_shape
from windup.hal.errors import ConfigError
from windup.robots import load_robot
from windup.robots.inspection.robot_warnings import robot_warnings

TOE = '<body name="toe" pos="0 0 0.1"><joint name="toe" {}/><geom size="0.01" mass="0.01"/></body>'


def changed(folder: Path, shape: Shape, file: str, old: str, new: str) -> Path:
    """Write a robot, one of whose files says something else."""
    path = write_shape(folder / "robot", shape) / file
    assert old in path.read_text()
    path.write_text(path.read_text().replace(old, new))
    return path.parent


MISTAKES = {
    "no joint": (ARM, "robot.toml", "joint = [", "joint = []\ngone = [", None),
    "a ball joint": (ARM, "model.xml", "<site", TOE.format('type="ball"') + "<site", "ball joint"),
    "a slide": (ARM, "model.xml", "<site", TOE.format('type="slide"') + "<site", "is a slide"),
    "no name": (ARM, "model.xml", 'name="arm_2" ', "", "joint of body 'arm_link2' has no name"),
    "a sole elsewhere": (
        QUADRUPED,
        "robot.toml",
        'site = "hind_left_sole"',
        'site = "imu"',
        "'imu' is on body 'trunk', not on 'hind_left_link2'",
    ),
    "servos of another protocol": (
        ARM,
        "robot.toml",
        "dynamixel2",
        "feetech",
        'a XM430-W350 uses protocol "dynamixel2", and bus \'body\' has protocol "feetech"',
    ),
    "a rate that no servo has": (
        ARM,
        "robot.toml",
        "1_000_000",
        "1_000_001",
        "baud: a XM430-W350 has no 1000001, but 9600, 57600, 115200, 1000000",
    ),
    "an unknown hinge": (ARM, "model.xml", "<site", TOE.format("") + "<site", "has no [[joint]]"),
    "actuators": (
        ARM,
        "model.xml",
        "</mujoco>",
        '<actuator><motor name="m1" joint="arm_0"/></actuator></mujoco>',
        "the MJCF has actuators (m1): delete its <actuator> section",
    ),
    "a base that moves": (ARM, "robot.toml", 'base = "trunk"', 'base = "arm_link1"', "moves with"),
    "feet of an arm": (
        ARM,
        "robot.toml",
        "[poses",
        '[[foot]]\nname = "f"\nbody = "trunk"\nsite = "imu"\n[poses',
        "this one is fixed",
    ),
    "no fall": (THIRTY, "robot.toml", "[fall]\nheight = 0.05\ntilt = 1.0", "", "fall: is missing"),
    "two left feet": (
        THIRTY,
        "robot.toml",
        'name = "right"\n',
        'name = "right"\nside = "left"\n',
        "are both left",
    ),
    "a passive joint": (ARM, "robot.toml", "rate_hz", 'passive = ["arm_0"]\nrate_hz', "as well"),
}


@pytest.mark.parametrize("mistake", MISTAKES.values(), ids=MISTAKES.keys())
def test_a_mistake_is_one_line(
    mistake: tuple[Shape, str, str, str, str | None], tmp_path: Path
) -> None:
    shape, file, old, new, said = mistake
    with pytest.raises(ConfigError) as error:
        load_robot(changed(tmp_path, shape, file, old, new))
    assert (said or "unknown key 'gone'") in str(error.value)
    assert "\n" not in str(error.value)


def test_no_joint_is_one_line(tmp_path: Path) -> None:
    folder = write_shape(tmp_path / "robot", Shape("stone", ()))
    with pytest.raises(ConfigError, match=r"joint: is missing: a robot needs at least one"):
        load_robot(folder)


def test_a_passive_joint_is_none_of_the_joints(tmp_path: Path) -> None:
    hinge = TOE.format('axis="0 1 0" stiffness="1"')
    folder = changed(
        tmp_path, QUADRUPED, "model.xml", '<site name="imu"/>', f'<site name="imu"/>{hinge}'
    )
    file = folder / "robot.toml"
    file.write_text('passive = ["toe"]\n' + file.read_text())
    robot = load_robot(folder)
    assert robot.passive == ("toe",)
    assert len(robot.joints) == 12


def test_a_hinge_without_a_range_has_that_of_the_file(tmp_path: Path) -> None:
    robot = load_robot(changed(tmp_path, ARM, "model.xml", 'range="-1.5 1.5"', ""))
    np.testing.assert_array_equal(robot.joints.upper, 1.5)


@pytest.mark.parametrize("name", ["model.mjcf", "Model.XML"])
def test_a_model_has_any_ending_and_may_have_a_byte_order_mark(tmp_path: Path, name: str) -> None:
    folder = write_shape(tmp_path / "robot", ARM)
    text = (folder / "model.xml").read_text()
    (folder / name).write_bytes(text.encode("utf-8-sig"))
    (folder / "model.xml").unlink()
    file = folder / "robot.toml"
    file.write_bytes(f'model = "{name}"\n{file.read_text()}'.encode("utf-8-sig"))
    assert len(load_robot(folder).joints) == 4


URDF = """<robot name="one"><link name="world"/><link name="arm"><inertial><mass value="0.1"/>
<inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="arm_0" type="revolute"><parent link="world"/><child link="arm"/><axis xyz="0 1 0"/>
<limit lower="-1.5" upper="1.5" effort="1" velocity="1"/></joint></robot>"""


def test_a_urdf_is_read_whatever_its_case(tmp_path: Path) -> None:
    one = Shape("one", (Limb("arm", "0 0 0", 1),), floats=False)
    folder = write_shape(tmp_path / "robot", one)
    (folder / "one.URDF").write_text(URDF)
    file = folder / "robot.toml"
    text = file.read_text().replace('"trunk"', '"world"')
    file.write_text('model = "one.URDF"\n' + text)
    assert load_robot(folder).joints.names == ("arm_0",)


def test_sensors_that_the_mjcf_lacks_are_added(tmp_path: Path) -> None:
    robot = load_robot(write_shape(tmp_path / "robot", QUADRUPED))
    model = robot.spec().compile()
    names = {model.sensor(i).name for i in range(model.nsensor)}
    touches = {f"{end}_{side}_touch" for end in ("front", "hind") for side in ("left", "right")}
    assert names == {"gyro", "accelerometer", "com_velocity"} | touches
    assert set(robot.contacts.names) == touches


def test_robots_of_the_package_raise_no_doubts_about_feet_and_neighbours() -> None:
    assert robot_warnings(load_robot("op3")) == []
    assert robot_warnings(load_robot("so101")) == []


def test_no_floor_is_doubted(tmp_path: Path) -> None:
    plane = '<geom type="plane" size="0 0 0.05" contype="1" conaffinity="0"/>'
    folder = changed(tmp_path, QUADRUPED, "model.xml", plane, "")
    assert "no floor: the robot falls without end" in robot_warnings(load_robot(folder))[0]


def test_zero_armature_points_and_neighbours_are_doubted(tmp_path: Path) -> None:
    folder = changed(tmp_path, THIRTY, "model.xml", 'armature="0.01"', "")
    path = folder / "model.xml"
    text = path.read_text().replace('contype="0" conaffinity="1"', 'contype="1" conaffinity="1"')
    text = text.replace('size="0.01 0.01 0.02"', 'size="0.03 0.03 0.02"')
    path.write_text(text.replace('type="box" size="0.06 0.04 0.005"', 'size="0.01"'))
    said = "; ".join(robot_warnings(load_robot(folder)))
    assert "armature 0 at left_0, left_1" in said
    assert "foot 'left' stands on points" in said
    assert "collide in the stance" in said
