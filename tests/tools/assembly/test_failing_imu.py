from pathlib import Path

import numpy as np
import pytest

from tests.tools.conftest import Windup
from windup.hal.errors import ImuError
from windup.robots import load_robot, robot_names
from windup.tools.assembly.gaits import find_gait
from windup.tools.robot.robot import Robot

AT = 3.0
FAULTS = {
    "imu_silent": "the IMU is silent for 0.2",
    "imu_frozen": "the IMU is repeating one sample for 0.5 s",
    "imu_spin:speed=10": "the IMU is repeating a rate of 10.0 rad/s about one axis",
}


def failing(name: str, fault: str, **options: object) -> Robot:
    kind, _, rest = fault.partition(":")
    at = f"{kind}:at={AT:g}" + (f":{rest}" if rest else "")
    return Robot.open(name, port=f"twin://{name}?faults={at}", **options)  # type: ignore[arg-type]


@pytest.mark.parametrize("fault", FAULTS)
def test_a_walk_without_its_imu_stops_and_says_so(fault: str) -> None:
    robot = failing("op3", fault)
    with pytest.raises(ImuError) as error:
        robot.walk(steps=40)
    assert str(error.value).startswith(FAULTS[fault])
    assert str(error.value).endswith("look with `windup health op3 --port '" + robot_port(robot))
    assert robot.loop.reason == str(error.value)
    assert not robot.armed
    assert robot.backend.clock.now() - AT < 0.6
    robot.close()


def robot_port(robot: Robot) -> str:
    return f"{robot.stack.port}'`"


@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("name", ["op3", "duck"])
def test_a_stand_without_its_imu_goes_on_and_says_so(name: str, fault: str) -> None:
    with failing(name, fault) as robot:
        assert robot.stand(AT + 2.0).reason == "done"
        assert not robot.twin.fallen
        (warning,) = robot.imu.warnings
        assert warning.text.name == fault.split(":")[0].replace("_", " ").replace(
            "spin", "spinning"
        )


def test_what_needs_a_silent_imu_is_refused_before_the_first_motion() -> None:
    with Robot.open("op3", port="twin://op3?faults=imu_silent:at=0.6") as robot:
        robot.backend.clock.wait_until(1.0)
        here = robot.twin.data.qpos.copy()
        with pytest.raises(ImuError, match=r"^the IMU has said nothing for .*: nothing has moved"):
            robot.walk(steps=5)
        assert not robot.armed
        np.testing.assert_array_equal(robot.twin.data.qpos, here)


def test_a_walk_after_a_stand_without_an_imu_stops() -> None:
    with failing("op3", "imu_silent") as robot:
        robot.stand(AT + 1.0)
        with pytest.raises(ImuError, match=r"^the IMU is silent"):
            robot.walk(steps=5)
        assert not robot.armed


def test_a_stride_needs_the_imu(shell: Windup) -> None:
    line = "stride op3 --port twin://op3 --seconds 4 --json - --faults imu_silent:at=2.5"
    ran = shell(*line.split())
    assert (ran.status, ran.json["error"]["kind"]) == (3, "Imu")


@pytest.mark.parametrize("direction", [0.0, np.pi / 2, np.pi])
@pytest.mark.parametrize("protect", [True, False])
def test_falls_do_not_look_like_a_failing_imu(direction: float, protect: bool) -> None:
    with Robot.open("op3", state="estimated", protect=protect) as robot:
        robot.push(5.0, direction, delay=0.5)
        assert robot.stand(3.0).reason == "fell"
        assert robot.imu.warnings == []


def test_only_who_estimates_the_base_looks_at_the_imu() -> None:
    with Robot.open("op3", port="twin://op3?faults=imu_silent:at=1", state="true") as robot:
        assert robot.stand(2.0).reason == "done"
        assert robot.imu.warnings == []


def test_graphs_that_ask_for_the_attitude_need_the_imu() -> None:
    needing = {
        f"{name}/{gait}"
        for name in robot_names()
        for gait, path in load_robot(name).gaits().items()
        if attitude(name, path)
    }
    assert {"op3/get_up_front", "op3/crouch", "duck/crouch"} <= needing
    assert "op3/wave" not in needing


def attitude(name: str, path: Path) -> bool:
    return find_gait(load_robot(name), path.stem).file.attitude
