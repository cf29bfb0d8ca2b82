from pathlib import Path

import numpy as np
import pytest

from windup.hal.errors import ConfigError, UnknownNameError
from windup.robots import load_robot, robot_names

MJCF = """
<mujoco>
  <compiler angle="radian"/>
  <option timestep="0.002"/>
  <worldbody>
    <body name="base" pos="0 0 1">
      <freejoint/>
      <inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>
      <site name="imu"/>
      <body name="thigh">
        <joint name="hip" axis="0 1 0" range="-1 1"/>
        <inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>
        <body name="foot" pos="0 0 -1">
          <joint name="knee" axis="0 1 0" range="-2 0.5"/>
          <inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>
          <site name="sole"/>
        </body>
      </body>
    </body>
  </worldbody>
  <sensor>
    <touch name="heel" site="sole"/>
    <gyro name="gyro" site="imu"/>
    <accelerometer name="accelerometer" site="imu"/>
  </sensor>
</mujoco>
"""

TOML = """
name = "hopper"
title = "Hopper"
rate_hz = 100
base = "base"
torso = "base"
stance = "stand"
joint = [
  { name = "knee", id = 2, lower = -2.0, upper = 0.5, servo = "XL430-W250" },
  { name = "hip", id = 1, lower = -1.0, upper = 1.0, sign = -1, zero = 1400, ratio = 2.0 },
]

[drive]
kind = "servo"
servo = "XM430-W350"
bus = "leg"
stiffness = 10.0
damping = 0.5

[fall]
height = 0.3
tilt = 1.0

[imu]
site = "imu"
gyro = "gyro"
accelerometer = "accelerometer"

[[bus]]
name = "leg"
protocol = "dynamixel2"
baud = 1_000_000

[[foot]]
name = "foot"
body = "foot"
site = "sole"
sensors = ["heel"]

[poses.stand]
knee = -0.5
"""


def folder(path: Path, toml: str = TOML, mjcf: str = MJCF) -> Path:
    (path / "robot.toml").write_text(toml)
    (path / "model.xml").write_text(mjcf)
    return path


def test_a_users_own_folder_is_a_robot(tmp_path: Path) -> None:
    robot = load_robot(folder(tmp_path))
    assert robot.joints.names == ("hip", "knee")
    np.testing.assert_array_equal(robot.stance, [0.0, -0.5])
    assert robot.contacts.feet == {"foot": ("heel",)}
    assert robot.gaits() == {}


def test_gaits_are_the_files_in_its_folder(tmp_path: Path) -> None:
    (tmp_path / "gaits").mkdir()
    (tmp_path / "gaits" / "hop.toml").touch()
    gaits = load_robot(str(folder(tmp_path))).gaits()
    assert gaits == {"hop": tmp_path / "gaits" / "hop.toml"}


def test_gears_trade_speed_for_torque(tmp_path: Path) -> None:
    joints = load_robot(folder(tmp_path)).joints
    assert joints.torque[0] == pytest.approx(2 * 4.1)
    assert joints.velocity[0] == pytest.approx(4.817 / 2, abs=1e-3)


def test_a_joint_may_name_its_own_servo(tmp_path: Path) -> None:
    mounts = load_robot(folder(tmp_path)).servos
    assert [(m.model.name, m.id, m.sign, m.zero) for m in mounts if m] == [
        ("XM430-W350", 1, -1, 1400),
        ("XL430-W250", 2, 1, 2048),
    ]


BROKEN = {
    "unknown key": ("rate_hz", "rat_hz", "unknown key 'rat_hz'; did you mean 'rate_hz'?"),
    "unknown key in a table": ("tilt", "tild", "unknown key 'fall.tild'; did you mean 'tilt'?"),
    "wrong type": ("rate_hz = 100", 'rate_hz = "fast"', "rate_hz: Expected `float`, got `str`"),
    "negative rate": ("rate_hz = 100", "rate_hz = -1", "rate_hz: Expected `float` >= 1.0"),
    "rate too low": ("rate_hz = 100", "rate_hz = 1e-6", "rate_hz: Expected `float` >= 1.0"),
    "rate in mid-step": ("= 100", "= 300", "rate_hz: a period of 1/300 s is not a whole number of"),
    "joint twice": ('"knee", id', '"hip", id', "joint: joint 'hip' is given twice"),
    "id twice": ("id = 2", "id = 1", "'hip': has id 1, which 'knee' already has on bus 'leg'"),
    "joint not in MJCF": ('"knee", id', '"nee", id', "unknown MJCF hinge 'nee'; did you mean 'kne"),
    "too wide": ("upper = 0.5", "upper = 0.6", "'knee': -2 to 0.6 rad is wider than the MJCF's"),
    "turned round": ("lower = -2.0", "lower = 2.0", "'knee': lower 2 is not below upper 0.5"),
    "servo": ('"XL430-W250"', '"XL430"', "'knee': servo: unknown servo 'XL430'; did you mean"),
    "bus": ('bus = "leg"', 'bus = "legs"', "bus: unknown bus 'legs'; did you mean 'leg'?"),
    "no id": ("id = 2, ", "", "joint 'knee': needs servo, bus and id"),
    "no gain": ("stiffness = 10.0", "", "drive: give stiffness in [drive] (those of a XL430-W250"),
    "torque joints with servos": ('"servo"', '"torque"', 'has a servo, but drive.kind is "torque"'),
    "base": ('base = "base"', 'base = "bass"', "base: unknown body 'bass'; did you mean 'base'?"),
    "base without free joint": (
        'base = "base"',
        'base = "foot"',
        "base: body 'foot' has no free j",
    ),
    "site": ('site = "sole"', 'site = "soul"', "foot 'foot': site: unknown site 'soul'; did you"),
    "touch sensor": ('["heel"]', '["gyro"]', "foot 'foot': sensors: unknown touch sensor 'gyro'"),
    "gyro": ('gyro = "gyro"', 'gyro = "giro"', "imu.gyro: unknown gyro sensor 'giro'; did you"),
    "pose outside": ("knee = -0.5", "knee = 1.5", "poses.stand.knee: 1.5 rad is outside -2 to 0.5"),
    "pose of no joint": ("knee = -0.5", "nee = 0.5", "poses.stand: unknown joint 'nee'; did you"),
    "stance": ('"stand"', '"stnad"', "stance: unknown pose 'stnad'; did you mean 'stand'?"),
    "crouch": ('stance = "stand"', 'stance = "stand"\nstop = "crouch"', 'stop: "crouch" needs'),
    "not TOML": ("[fall]", "[fall", "not TOML: "),
    "no model": ('name = "hopper"', 'name = "hopper"\nmodel = "m.xml"', "m.xml: cannot be read"),
}


@pytest.mark.parametrize(("old", "new", "message"), BROKEN.values(), ids=BROKEN.keys())
def test_a_broken_robot_toml_is_one_line_with_file_and_key(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    assert old in TOML
    with pytest.raises(ConfigError) as error:
        load_robot(folder(tmp_path, TOML.replace(old, new, 1)))
    text = str(error.value)
    assert text.startswith(str(tmp_path))
    assert message in text
    assert "\n" not in text


def test_gains_that_no_joint_has_are_one_mistake_with_those_of_the_servo(tmp_path: Path) -> None:
    toml = TOML.replace("stiffness = 10.0\ndamping = 0.5\n", "")
    with pytest.raises(ConfigError) as error:
        load_robot(folder(tmp_path, toml))
    assert str(error.value).endswith(
        "robot.toml: drive: give stiffness and damping in [drive] (those of a XL430-W250 with its "
        "default P at 12 V: stiffness = 5.52, damping = 0.235)"
    )


def test_an_unknown_servo_of_the_drive_is_one_mistake(tmp_path: Path) -> None:
    toml = TOML.replace(', servo = "XL430-W250"', "").replace('"XM430-W350"', '"STS3215"')
    with pytest.raises(ConfigError) as error:
        load_robot(folder(tmp_path, toml))
    hint = "unknown servo 'STS3215'; did you mean 'STS3215-12V' or 'STS3215-7.4V'?"
    assert str(error.value).count(hint) == 1 and f"drive.servo: {hint}" in str(error.value)


def test_a_hinge_without_an_entry_is_named(tmp_path: Path) -> None:
    extra = MJCF.replace('<site name="sole"/>', '<site name="sole"/>' + TOE)
    with pytest.raises(ConfigError, match=r"joint: the MJCF hinge 'toe' has no \[\[joint\]\]"):
        load_robot(folder(tmp_path, mjcf=extra))


TOE = """
<body>
  <joint name="toe" range="-1 1"/>
  <inertial mass="1" pos="0 0 0" diaginertia="1 1 1"/>
</body>
"""


def test_actuators_belong_to_the_twin(tmp_path: Path) -> None:
    actuator = '<actuator><motor joint="hip"/></actuator></mujoco>'
    with pytest.raises(ConfigError, match="model: the MJCF has actuators"):
        load_robot(folder(tmp_path, mjcf=MJCF.replace("</mujoco>", actuator)))


@pytest.mark.parametrize(
    "mjcf", [MJCF.replace("worldbody", "worldbdy"), MJCF.replace('"1"', '"x"')]
)
def test_mujocos_own_complaints_come_in_one_line(tmp_path: Path, mjcf: str) -> None:
    with pytest.raises(ConfigError, match=r"^[^\n]*model\.xml: [^\n]+$"):
        load_robot(folder(tmp_path, mjcf=mjcf))


def test_an_unknown_robot_names_the_likely_one() -> None:
    with pytest.raises(UnknownNameError, match=r"unknown robot 'opp3'; did you mean 'op3'\?"):
        load_robot("opp3")
    assert {"human", "op3"} <= set(robot_names())
