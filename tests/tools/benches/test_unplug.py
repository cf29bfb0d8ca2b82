import pytest

import windup.sim_twin.wire as wire
from windup.hal.errors import WindupError
from windup.robots import load_robot
from windup.tools.benches.unplug import script, watch
from windup.tools.robot.stack import servo_backend


@pytest.mark.parametrize(("robot", "bus"), [("duck", "body"), ("op3", "body")])
def test_a_robot_is_found_again_each_time_with_torque_off_until_armed(robot: str, bus: str) -> None:
    url = f"twin://{robot}?world=pulled&faults={script(3, 0, bus)}"
    backend = servo_backend(load_robot(robot), url)
    backend.connect()
    backend.configure()
    backend.set_torque(True)
    seen = watch(backend, 3)
    backend.disconnect()
    wire.unregister_world("pulled")
    assert (seen.lost, seen.found, seen.off, seen.withheld, seen.armed) == (3, 3, 3, 3, 3)
    assert len(set(seen.descriptors)) == 1


def test_a_port_that_stays_away_ends_the_measure() -> None:
    faults = "unplug:at=3:seconds=1000:bus=body"
    backend = servo_backend(load_robot("duck"), f"twin://duck?world=away&faults={faults}")
    backend.connect()
    backend.configure()
    backend.set_torque(True)
    with pytest.raises(WindupError, match="nothing happened for 20 s after 1 times"):
        watch(backend, 2)
    backend.disconnect()
    wire.unregister_world("away")


def test_moments_are_random_and_the_same_for_a_seed() -> None:
    assert script(5, 1, "body") == script(5, 1, "body")
    assert script(5, 1, "body") != script(5, 2, "body")
    assert script(5, 1, "body").count("unplug") == 5
