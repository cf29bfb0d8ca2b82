"""The value of --port: one URL for each bus, and one for an IMU of its own."""

import pytest

from windup.hal.errors import UsageError
from windup.robots import load_robot
from windup.tools.robot.port_urls import port_urls

WIRE, SENSOR = "/dev/ttyUSB0", "/dev/ttyUSB1"


def test_an_imu_of_its_own_has_a_url() -> None:
    duck = load_robot("duck")
    both = port_urls(duck, f"body={WIRE},imu={SENSOR}")
    assert both == {"body": WIRE, "imu": SENSOR}
    assert port_urls(duck, f"body={WIRE}") == {"body": WIRE}


@pytest.mark.parametrize("name", ["op3", "so101"])
def test_one_on_the_board_or_none_at_all_has_no_url(name: str) -> None:
    robot = load_robot(name)
    (bus,) = robot.buses
    with pytest.raises(UsageError) as caught:
        port_urls(robot, f"{bus.name}={WIRE},imu={SENSOR}")
    assert str(caught.value) == f"--port names {bus.name}, imu; the buses are {bus.name}"


def test_the_imu_may_come_first() -> None:
    duck = load_robot("duck")
    assert port_urls(duck, f"imu={SENSOR},body={WIRE}") == {"body": WIRE, "imu": SENSOR}
    with pytest.raises(UsageError, match="--port names imu; the buses are body"):
        port_urls(duck, f"imu={SENSOR}")
