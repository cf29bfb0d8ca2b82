"""A duck whose IMU is the BNO055 of its own parts list, through the emulated I2C bus."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from windup.hal.errors import ImuError
from windup.robots.folders import FOLDER
from windup.tools.robot.robot import Robot


@pytest.fixture
def duck(tmp_path: Path) -> Path:
    """Return the folder of a duck with the chip on its back."""
    folder = tmp_path / "duck"
    shutil.copytree(FOLDER / "duck", folder)
    path = folder / "robot.toml"
    text = path.read_text()
    assert 'kind = "bno08x_rvc"' in text
    path.write_text(text.replace('kind = "bno08x_rvc"', 'kind = "open_duck"'))
    return folder


def test_the_driver_sees_how_the_robot_stands(duck: Path) -> None:
    with Robot.open(str(duck), port=f"twin://{duck}") as robot:
        robot.stand(0.5)
        imu, base = robot.backend.read().imu, robot.twin.data.qpos[3:7]
        assert imu is not None and imu.orientation is not None
        assert abs(imu.orientation @ base) == pytest.approx(1.0, abs=1e-3)
        assert np.linalg.norm(imu.acceleration) == pytest.approx(9.81, abs=0.2)
        assert imu.acceleration[2] > 9.0
        assert 0.0 < imu.age < 0.03


def test_a_chip_that_falls_silent_stops_who_balances_with_it(duck: Path) -> None:
    faults = "faults=imu_silent:at=1.5"
    with (
        pytest.raises(ImuError, match="the IMU"),
        Robot.open(str(duck), port=f"twin://{duck}?{faults}") as robot,
    ):
        robot.walk(steps=40)
