"""A joint that turns on and on: its servo counts many turns, on the twin and through the bus."""

from math import pi
from pathlib import Path

import numpy as np
import pytest

from tests.shapes import Limb, Shape, write_shape
from windup import Robot
from windup.control.motions.play import PoseHolder
from windup.hal.backend import BusHealth
from windup.hal.guardian.order import GuardedBus
from windup.hal.guardian.remote_bus import RemoteBus
from windup.robots import RobotDescription, load_robot
from windup.sim_twin.twin import Twin
from windup.tools.testing.servo_bus import ServoBus

ONE = Shape("one", (Limb("arm", "0 0 0.03", 1, "z", down=False),), floats=False, height=0.03)
FAR = 15.0
"""More than two turns, rad."""
COUNTS = 4096 / (2.0 * pi)


@pytest.fixture
def wheel(tmp_path: Path) -> RobotDescription:
    """Return a robot with one joint that has no limits."""
    path = write_shape(tmp_path / "wheel", ONE)
    model, file = path / "model.xml", path / "robot.toml"
    model.write_text(model.read_text().replace('range="-1.5 1.5"', 'limited="false"'))
    file.write_text(file.read_text().replace("lower = -1.5, upper = 1.5", 'mode = "extended"'))
    return load_robot(path)


def turn(robot: Robot, angle: float) -> float:
    """Turn the joint to an angle, and return where it says that it is, rad."""
    robot.run(PoseHolder(robot.description.joints, np.array([angle])), 6.0)
    return float(robot.backend.read().joints.position[0])


def test_the_twin_turns_on_and_on(wheel: RobotDescription) -> None:
    twin = Twin(wheel)
    twin.set_goals(np.array([FAR]))
    twin.step(4000)
    assert twin.data.qpos[0] == pytest.approx(FAR, abs=0.05)


@pytest.mark.parametrize("angle", [FAR, -FAR])
def test_so_does_an_emulated_servo(wheel: RobotDescription, angle: float) -> None:
    with ServoBus(str(wheel.folder)) as bus:
        robot = bus.robot()
        assert turn(robot, angle) == pytest.approx(angle, abs=0.05)
        assert robot.twin.data.qpos[0] == pytest.approx(angle, abs=0.05)
        driver = robot.backend.backend
        assert isinstance(driver, BusHealth) and driver.clamps["goal"] == 0


def test_torque_comes_on_again_in_whatever_turn_it_is(wheel: RobotDescription) -> None:
    with ServoBus(str(wheel.folder)) as bus:
        robot = bus.robot()
        turn(robot, -FAR)
        robot.backend.set_torque(False)
        robot.backend.set_torque(True)
        bus.wait(0.3)
        assert robot.backend.read().joints.position[0] == pytest.approx(-FAR, abs=0.1)


def test_a_guardian_holds_it_in_its_turn(wheel: RobotDescription) -> None:
    with ServoBus(str(wheel.folder)) as bus:
        robot = bus.robot()
        turn(robot, -FAR)
        record = GuardedBus(url=bus.url, baud=1_000_000, servos={1: "XM430-W350"}, extended=(1,))
        assert RemoteBus(record).hold_position() == pytest.approx([2048 - FAR * COUNTS], abs=60)


def test_a_graph_plays_on_it(wheel: RobotDescription) -> None:
    with ServoBus(str(wheel.folder)) as bus:
        assert bus.robot().play("nod", 1.0).reason == "done"
