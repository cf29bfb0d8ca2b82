from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import windup.sim_twin.wire as wire
from tests.tools.conftest import Windup
from windup.hal.errors import UnhealthyError
from windup.hal.servo_bus.servo_backend import ServoBackend
from windup.tools.robot.robot import Robot


def servo_of(robot: Robot, joint: str) -> Any:
    """Return the emulated servo at a joint."""
    mounts = dict(zip(robot.description.joints.names, robot.description.servos, strict=True))
    mount = mounts[joint]
    assert mount is not None
    devices = wire.find_world(robot.stack.world).devices
    return next(device for device in devices if device.identifier == mount.id)


def heat_of(robot: Robot, joint: str) -> Callable[[float], None]:
    """Return what sets the temperature of the emulated servo at a joint."""
    servo = servo_of(robot, joint)
    owner = servo.firmware.health if hasattr(servo, "firmware") else servo
    return lambda temperature: setattr(owner, "temperature", temperature)


def undriven(robot: Robot) -> bool:
    backend = robot.backend.backend
    assert isinstance(backend, ServoBackend)
    return all(link.torque.state().all_off for link in backend.links)


@pytest.mark.parametrize(("name", "knee"), [("op3", "l_knee"), ("duck", "left_knee")])
def test_a_servo_that_grows_hot_stops_the_robot(name: str, knee: str) -> None:
    robot = Robot.open(name, port=f"twin://{name}")
    robot.stand(1.0)
    heat_of(robot, knee)(78.0 if name == "op3" else 66.0)
    with pytest.raises(UnhealthyError) as error:
        robot.stand(6.0)
    assert str(error.value).startswith(f"{knee} is at ")
    assert str(error.value).endswith(f"look with `windup health {name} --port 'twin://{name}'`")
    assert error.value.exit_status == 3
    assert robot.loop.reason == str(error.value)
    assert not robot.armed and undriven(robot)
    robot.close()


def test_a_hot_servo_is_not_held_by_a_robot_that_stops_by_holding() -> None:
    with Robot.open("op3", port="twin://op3") as robot:
        robot.backend.stop_policy = "hold"
        robot.stand(0.5)
        heat_of(robot, "l_knee")(78.0)
        with pytest.raises(UnhealthyError):
            robot.stand(6.0)
        assert not robot.armed and undriven(robot)


def test_a_hot_servo_is_refused_before_the_first_motion() -> None:
    with Robot.open("op3", port="twin://op3") as robot:
        heat_of(robot, "l_knee")(79.0)
        here = robot.twin.data.qpos.copy()
        with pytest.raises(UnhealthyError, match=r"^l_knee is at 79 .*: nothing has moved; let it"):
            robot.stand(1.0)
        assert not robot.armed and undriven(robot)
        np.testing.assert_array_equal(robot.twin.data.qpos, here)


FAULT = "brown_out:at={at}:volts={volts}:seconds={seconds}"


@pytest.mark.parametrize(("name", "volts", "stop"), [("op3", 9.8, "10.2"), ("duck", 6.0, "6.2")])
def test_an_empty_battery_stops_the_robot(
    shell: Windup, name: str, volts: float, stop: str
) -> None:
    faults = FAULT.format(at=1.5, volts=volts, seconds="inf")
    line = f"stand {name} --port twin://{name} --seconds 4 --json - --faults"
    ran = shell(*line.split(), faults)
    assert ran.status == 3
    assert ran.json["error"]["kind"] == "Unhealthy"
    assert f"joints are on {volts} V (stop below {stop})" in ran.json["error"]["message"]


@pytest.mark.parametrize(("name", "volts"), [("op3", 9.8), ("duck", 6.0)])
def test_an_empty_battery_is_refused_before_the_first_motion(
    shell: Windup, name: str, volts: float
) -> None:
    faults = FAULT.format(at=0, volts=volts, seconds="inf")
    ran = shell(*f"stand {name} --port twin://{name} --faults {faults} --json -".split())
    assert ran.status == 3
    assert "nothing has moved; charge the battery" in ran.json["error"]["message"]


@pytest.mark.parametrize(("name", "volts"), [("op3", 9.8), ("duck", 6.0)])
def test_a_dip_of_the_supply_stops_nobody(shell: Windup, name: str, volts: float) -> None:
    faults = FAULT.format(at=1.5, volts=volts, seconds=0.2)
    ran = shell(*f"stand {name} --port twin://{name} --seconds 4 --faults {faults}".split())
    assert ran.status == 0, ran.err


def test_levels_of_my_robot_are_its_own(
    shell: Windup, my_op3: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    toml = my_op3 / "robot.toml"
    toml.write_text(toml.read_text().replace("warn = 11.0, stop = 10.2", "warn = 11.9, stop = 11"))
    faults = FAULT.format(at=0, volts=10.5, seconds="inf")
    monkeypatch.chdir(my_op3.parent)
    ran = shell("stand", my_op3.name, "--port", f"twin://{my_op3.name}", "--faults", faults)
    assert ran.status == 3 and "20 joints are on 10.5 V (stop below 11.0)" in ran.err
