"""A duck whose IMU is the BNO055 of its own parts list, through the emulated I2C bus."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from windup.hal.errors import ImuError
from windup.hal.observation import Observation
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


def test_a_chip_that_is_unplugged_for_a_moment_goes_on(duck: Path) -> None:
    faults = "faults=unplug:bus=imu:at=1.8:seconds=0.2"
    with Robot.open(str(duck), port=f"twin://{duck}?{faults}") as robot:
        ages: list[float] = []

        def note(observation: Observation) -> None:
            assert observation.imu is not None
            ages.append(observation.imu.age)

        robot.watch.append(note)
        robot.stand(2.0)
        assert 0.2 < max(ages) < 0.6
        imu = robot.backend.read().imu
        assert imu is not None and imu.age < 0.05


def test_a_gyroscope_that_spins_does_so_about_the_same_axis_of_the_body(duck: Path) -> None:
    faults = "faults=imu_spin:at=1.8:speed=0.5"
    with Robot.open(str(duck), port=f"twin://{duck}?{faults}") as robot:
        robot.stand(1.0)
        imu = robot.backend.read().imu
        assert imu is not None
        assert imu.angular_velocity[0] == pytest.approx(0.5, abs=0.01)
