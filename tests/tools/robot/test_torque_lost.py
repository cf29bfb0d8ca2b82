"""Servos that restart, shut down or fall silent under a robot: no goal drives them again."""

import numpy as np
import pytest

import windup.sim_twin.wire.servos.byte_servo
import windup.sim_twin.wire.servos.servo
from tests.tools.conftest import Windup
from windup.hal.command import JointCommand
from windup.hal.errors import PortError, StaleStateError, TorqueLostError, WindupError
from windup.hal.observation import Observation
from windup.hal.servo_bus.servo_backend import ServoBackend
from windup.tools.benches.soak_rig import SoakRig
from windup.tools.robot.robot import Robot
from windup.tools.testing.servo_bus import ServoBus

KNEE = 13
TORQUE = {"dynamixel2": 64, "dynamixel1": 24, "ax": 24, "sts": 40, "scs": 40}
"""Address of Torque Enable."""


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Let emulated servos boot before the loop gives them up."""
    monkeypatch.setattr(windup.sim_twin.wire.servos.byte_servo, "BOOT_SECONDS", 0.15)
    monkeypatch.setattr(windup.sim_twin.wire.servos.servo, "BOOT_SECONDS", 0.15)


def torque_enable(bus: ServoBus, address: int) -> int:
    _, data = bus.servo(KNEE).read(address, 1, bus.clock.now())
    return data[0]


def stands_until(bus: ServoBus, robot: Robot, error: type[WindupError], text: str) -> float:
    """Stand until `error` says `text`; return what went by since the robot was last read, s."""
    seen = [0.0]

    def watch(observation: Observation) -> None:
        seen[0] = observation.time

    robot.watch.append(watch)
    with pytest.raises(error, match=text):
        robot.stand(5.0)
    return bus.clock.now() - seen[0]


@pytest.mark.usefixtures("quick")
@pytest.mark.parametrize(
    ("name", "joint", "address"), [("duck", "right_knee", 40), ("op3", "r_knee", 64)]
)
def test_a_servo_that_restarts_under_a_standing_robot_stays_limp_until_it_is_armed_again(
    name: str, joint: str, address: int
) -> None:
    with ServoBus(name, seed=1, faults=f"reset:at=2.5:ids={KNEE}") as bus:
        robot = bus.robot()
        enabled = []
        tick = robot.backend.backend.write

        def write(command: JointCommand) -> JointCommand:
            real = tick(command)
            if bus.clock.now() > 2.5:
                enabled.append(torque_enable(bus, address))
            return real

        robot.backend._send = write
        stands_until(bus, robot, TorqueLostError, f"^{joint} lost its torque: its servo restarted")
        assert not any(enabled) and len(enabled) > 10
        assert not any(device.driving for device in bus.world.devices)
        robot.rearm()
        assert torque_enable(bus, address) == 1


def test_a_duck_that_loses_a_knee_does_not_crouch() -> None:
    with ServoBus("duck", seed=1, faults=f"overload:at=2.5:ids={KNEE}") as bus:
        robot = bus.robot()
        assert robot.backend.stop_policy == "crouch"
        weak = "right_knee lost its torque: its servo has reduced its torque"
        assert stands_until(bus, robot, TorqueLostError, weak) < 0.1
        assert not any(device.driving for device in bus.world.devices)


def test_a_robot_with_a_silent_joint_does_not_crouch_either() -> None:
    with ServoBus("duck", seed=1, faults=f"dead:at=2.5:ids={KNEE}") as bus:
        robot = bus.robot()
        stale = "joint 'right_knee' has not answered"
        assert stands_until(bus, robot, StaleStateError, stale) < 1.0
        assert not any(device.driving for device in bus.world.devices)


@pytest.mark.parametrize("command", [("walk", "op3", "--steps", "12"), ("stand", "op3")])
def test_an_overload_ends_the_command_with_the_joint_and_the_cause(
    shell: Windup, command: tuple[str, ...]
) -> None:
    faults = f"overload:at=1.5:ids={KNEE}"
    ran = shell(*command, "--port", "twin://op3", "--faults", faults, "--json", "-")
    assert ran.status == 3
    message = (
        "r_knee lost its torque: its servo shut down: overload; "
        "remove the cause, then switch the servos' power off and on"
    )
    assert ran.err.strip().endswith(f"windup: {message}")
    assert ran.json["error"] == {"kind": "TorqueLost", "message": message, "exit_status": 3}


CAUSES = {
    ("reset", "any"): "its servo restarted",
    ("overload", "dynamixel2"): "its servo shut down: overload",
    ("overload", "dynamixel1"): "its servo shut down: overload",
    ("overload", "ax"): "its servo shut down: overload",
    ("overload", "sts"): "its servo has reduced its torque: overload",
    ("overload", "scs"): "its servo has reduced its torque: overload",
}


@pytest.mark.parametrize("family", TORQUE)
@pytest.mark.parametrize("fault", ["reset", "overload"])
def test_no_goal_wakes_a_servo_of_any_make(family: str, fault: str) -> None:
    with SoakRig(family, servos=3) as rig:
        at = rig.world.now + 0.2
        getattr(rig.faults, fault)(at=at, ids=[2])
        victim, woken = rig.world.devices[1], False
        for _ in range(100):
            rig.backend.clock.wait_until(rig.backend.clock.now() + 0.008)
            rig.backend.read()
            rig.backend.write(JointCommand.hold(rig.backend.joints, np.zeros(3)))
            if fault == "reset" and rig.world.now > at + 0.05:
                woken |= bool(victim.read(TORQUE[family], 1, rig.world.now)[1][0])
        assert not woken
        assert list(rig.backend.lost_joints) == ["servo 2"]
        said = CAUSES.get((fault, family)) or CAUSES[fault, "any"]
        assert str(rig.backend.lost_joints["servo 2"]).startswith(said)
        others = [rig.world.devices[0], rig.world.devices[2]]
        assert all(device.driving for device in others)


@pytest.mark.parametrize(("gone", "known"), [(0.5, True), (30.0, False)])
def test_a_port_that_went_is_named_and_torque_is_read_as_off_if_it_comes_back(
    gone: float, known: bool
) -> None:
    with ServoBus("duck", seed=1, faults=f"unplug:at=2.5:seconds={gone:g}:bus=body") as bus:
        robot = bus.robot()
        said = "^no joint can be reached: port .* was disconnected"
        assert stands_until(bus, robot, PortError, said) < 1.0
        assert robot.armed is not known
        drives = [device.driving for device in bus.world.bus("body").devices]
        assert any(drives) is not known


def test_a_servo_that_restarts_too_slowly_is_named_and_read_as_off_all_the_same() -> None:
    with ServoBus("duck", seed=1, faults=f"reset:at=2.5:ids={KNEE}") as bus:
        robot = bus.robot()
        stands_until(bus, robot, StaleStateError, "joint 'right_knee' has not answered")
        assert not robot.armed and torque_enable(bus, 40) == 0


def test_a_robot_stands_behind_an_adapter_that_holds_answers_back() -> None:
    with ServoBus("duck", seed=5) as bus:
        bus.faults.delay(0.016).drop(ids=[KNEE], rate=0.02)
        robot = bus.robot()
        assert robot.stand(2.0).reason == "done"
        servos = robot.backend.backend
        assert isinstance(servos, ServoBackend) and servos.lost_joints == {}
