from pathlib import Path

import pytest

from tests.robots.test_robot_errors import MJCF, TOML
from windup.hal.errors import ConfigError
from windup.robots import RobotDescription, load_robot

FEETECH = [
    ('servo = "XM430-W350"', 'servo = "STS3215-12V"'),
    (', servo = "XL430-W250"', ""),
    ('"dynamixel2"', '"feetech"'),
]


def robot(folder: Path, imu: str = "", *changes: tuple[str, str]) -> RobotDescription:
    """Return the robot of the error tests with something more in its [imu]."""
    text = TOML.replace("[imu]\n", f"[imu]\n{imu}\n")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (folder / "model.xml").write_text(MJCF)
    (folder / "robot.toml").write_text(text)
    return load_robot(folder)


def test_an_imu_of_no_kind_is_what_its_bus_suggests(tmp_path: Path) -> None:
    kind = robot(tmp_path).imu_kind
    assert kind is not None and kind.name == "opencr"
    kind = robot(tmp_path, "", *FEETECH).imu_kind
    assert kind is not None and kind.name == "bno08x_rvc"


def test_a_robot_says_how_its_imu_is_mounted(tmp_path: Path) -> None:
    kind = robot(tmp_path, 'kind = "bno055"\nmounting = ["-y", "x", "z"]').imu_kind
    assert kind is not None and (kind.name, kind.mounting.axes) == ("bno055", ("-y", "x", "z"))
    kind = robot(tmp_path, 'kind = "open_duck"').imu_kind
    assert kind is not None and kind.mounting.axes == ("-y", "-x", "-z")


@pytest.mark.parametrize(
    ("imu", "changes", "says"),
    [
        (
            'kind = "bno0555"',
            [],
            "imu.kind: unknown kind of IMU 'bno0555'; did you mean 'bno055'? "
            "known: bno055, bno08x_rvc, open_duck, opencr",
        ),
        (
            'kind = "opencr"',
            FEETECH,
            "imu.kind: an opencr is read by protocol \"dynamixel2\", and bus 'leg' has protocol "
            '"feetech"',
        ),
        (
            'mounting = ["y", "x", "z"]',
            [],
            "imu.mounting: y, x, z is left-handed, and no board is: change the sign of one axis",
        ),
    ],
    ids=["kind", "bus", "mounting"],
)
def test_an_imu_that_cannot_be_is_refused(
    tmp_path: Path, imu: str, changes: list[tuple[str, str]], says: str
) -> None:
    with pytest.raises(ConfigError) as error:
        robot(tmp_path, imu, *changes)
    assert str(error.value) == f"{tmp_path / 'robot.toml'}: {says}"
