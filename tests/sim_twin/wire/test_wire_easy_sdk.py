"""Every call of ROBOTIS' easy SDK on emulated servos, in real time. Nothing here is timed."""

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import dynamixel_sdk
import pytest
from dynamixel_easy_sdk import Connector, Direction, OperatingMode, ProfileConfiguration
from dynamixel_easy_sdk.dynamixel_error import DxlRuntimeError

from tests.sim_twin.wire.emulator_process import emulator

BUS = "twin://bench?servos=XM430-W350:1-2,XL430-W250:3&return_delay=0"
PATIENCE = 120.0  # s, for a busy machine


@pytest.fixture(scope="module")
def pty(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    path: Path = tmp_path_factory.mktemp("easy") / "servos"
    with emulator(BUS, path) as name:
        yield name


@pytest.fixture
def connector(pty: str, monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    monkeypatch.setattr(dynamixel_sdk.port_handler, "LATENCY_TIMER", 1000)
    made = Connector(pty, 1_000_000)
    yield made
    made.closePort()


@pytest.fixture
def motor(connector: Any) -> Iterator[Any]:
    made = connector.createMotor(1)
    yield made
    made.disableTorque()


def wait_for(what: Callable[[], bool]) -> None:
    deadline = time.monotonic() + PATIENCE
    while not what():
        assert time.monotonic() < deadline


def test_it_finds_motors_and_knows_their_models(connector: Any) -> None:
    one, three = connector.createMotor(1), connector.createMotor(3)
    assert (one.model_number, one.model_name) == (1020, "xm430_w350.model")
    assert (three.model_number, three.model_name) == (1060, "xl430_w250.model")
    assert one.ping() == 1020
    assert not one.isTorqueOn()
    assert one.getOperatingMode() == OperatingMode.POSITION
    with pytest.raises(DxlRuntimeError):
        connector.createAllMotors(9, 3)


def test_it_finds_all_motors_and_reads_and_writes_their_registers(connector: Any) -> None:
    def everybody() -> bool:
        return sorted(motor.id for motor in connector.createAllMotors()) == [1, 2, 3]

    wait_for(lambda: answered(everybody))
    for size, address, value in ((1, 65, 1), (2, 84, 700), (4, 112, 100)):
        before = getattr(connector, f"read{size}ByteData")(2, address)
        getattr(connector, f"write{size}ByteData")(2, address, value)
        assert getattr(connector, f"read{size}ByteData")(2, address) == value != before
        getattr(connector, f"write{size}ByteData")(2, address, before)


def test_it_reads_the_limits_that_it_has_set(motor: Any) -> None:
    for name, value in (
        ("MaxPositionLimit", 4000),
        ("MinPositionLimit", 100),
        ("VelocityLimit", 300),
        ("CurrentLimit", 500),
        ("PWMLimit", 800),
    ):
        before = getattr(motor, f"get{name}")()
        getattr(motor, f"set{name}")(value)
        assert getattr(motor, f"get{name}")() == value != before
        getattr(motor, f"set{name}")(before)


def test_it_sets_gains_light_and_homing_offset(motor: Any) -> None:
    table = motor.control_table
    for name, value in (
        ("Position P Gain", 700),
        ("Position I Gain", 10),
        ("Position D Gain", 20),
        ("Velocity P Gain", 90),
        ("Velocity I Gain", 1900),
    ):
        getattr(motor, f"set{name.replace(' ', '')}")(value)
        assert motor.connector.read2ByteData(1, table[name].address) == value
    motor.LEDOn()
    assert motor.isLEDOn() == 1
    motor.LEDOff()
    assert motor.isLEDOn() == 0
    before = motor.getPresentPosition()
    motor.setHomingOffset(-700)
    assert motor.getPresentPosition() == pytest.approx(before - 700, abs=2)
    motor.setHomingOffset(0)


def test_it_drives_a_motor_in_position(motor: Any) -> None:
    with pytest.raises(DxlRuntimeError):
        motor.setGoalPosition(2200)  # its torque is off
    motor.enableTorque()
    motor.setGoalPosition(2200)
    wait_for(lambda: abs(motor.getPresentPosition() - 2200) < 8)
    assert motor.isTorqueOn() == 1
    with pytest.raises(DxlRuntimeError):
        motor.setGoalVelocity(50)  # it is in another mode


@pytest.mark.parametrize(
    ("mode", "goal", "counts"),
    [
        (OperatingMode.VELOCITY, "setGoalVelocity", -60),
        (OperatingMode.CURRENT, "setGoalCurrent", -40),
        (OperatingMode.PWM, "setGoalPWM", -200),
    ],
)
def test_it_drives_a_motor_backward(
    motor: Any, mode: OperatingMode, goal: str, counts: int
) -> None:
    motor.setOperatingMode(mode)
    motor.enableTorque()
    getattr(motor, goal)(counts)
    wait_for(lambda: motor.getPresentVelocity() < -20)
    assert motor.getPresentPWM() < 0
    assert isinstance(motor.getPresentCurrent(), int)
    motor.disableTorque()
    motor.setOperatingMode(OperatingMode.POSITION)


def test_it_turns_the_direction_and_the_profile(motor: Any) -> None:
    mode = motor.control_table["Drive Mode"].address
    motor.setDirection(Direction.REVERSE)
    motor.setProfileConfiguration(ProfileConfiguration.TIME_BASED)
    assert motor.connector.read1ByteData(1, mode) == 0b101
    motor.setDirection(Direction.NORMAL)
    motor.setProfileConfiguration(ProfileConfiguration.VELOCITY_BASED)
    assert motor.connector.read1ByteData(1, mode) == 0


def test_it_changes_an_id_reboots_and_resets(connector: Any) -> None:
    motor = connector.createMotor(2)
    motor.changeID(9)
    assert motor.ping() == 1020
    motor.changeID(2)
    motor.LEDOn()
    motor.reboot()
    wait_for(lambda: answered(motor.ping))
    assert motor.isLEDOn() == 0
    motor.setVelocityLimit(77)
    motor.factoryResetExceptIDAndBaudRate()
    wait_for(lambda: answered(motor.ping))
    assert motor.getVelocityLimit() != 77


def answered(call: Callable[[], Any]) -> bool:
    try:
        return bool(call())
    except DxlRuntimeError:
        return False


def test_it_resets_all_but_the_id_and_then_all(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(dynamixel_sdk.port_handler, "LATENCY_TIMER", 100)
    with emulator("twin://bench?servos=XM430-W350:7", tmp_path / "servo") as name:
        connector = Connector(name, 1_000_000)
        wait_for(lambda: answered(lambda: connector.ping(7)))
        connector.createMotor(7).factoryResetExceptID()
        connector.closePort()
        connector = Connector(name, 57_600)
        wait_for(lambda: answered(lambda: connector.ping(7)))
        connector.createMotor(7).factoryResetAll()
        wait_for(lambda: answered(lambda: connector.ping(1)))
        connector.closePort()


@pytest.mark.parametrize(
    ("mode", "stage", "counts"),
    [
        (OperatingMode.VELOCITY, "stageSetGoalVelocity", -60),
        (OperatingMode.CURRENT, "stageSetGoalCurrent", -40),
        (OperatingMode.PWM, "stageSetGoalPWM", -200),
    ],
)
def test_a_group_drives_motors_backward(
    connector: Any, mode: OperatingMode, stage: str, counts: int
) -> None:
    motor, group = connector.createMotor(1), connector.createGroupExecutor()
    motor.setOperatingMode(mode)
    motor.enableTorque()
    group.addCmd(getattr(motor, stage)(counts))
    group.executeWrite()
    wait_for(lambda: motor.getPresentVelocity() < -20)
    motor.disableTorque()
    motor.setOperatingMode(OperatingMode.POSITION)


def test_a_group_writes_and_reads_one_register_or_several(connector: Any) -> None:
    motors = [connector.createMotor(id) for id in (1, 2)]
    group = connector.createGroupExecutor()
    for motor in motors:
        group.addCmd(motor.stageEnableTorque())
    group.executeWrite()
    group.clearStagedWriteCommands()
    assert [motor.isTorqueOn() for motor in motors] == [1, 1]
    group.addCmd(motors[0].stageSetGoalPosition(2000))
    group.addCmd(motors[1].stageLEDOn())
    group.executeWrite()
    group.clearStagedWriteCommands()
    for motor in motors:
        group.addCmd(motor.stageIsTorqueOn())
    assert group.executeRead() == [1, 1]
    group.clearStagedReadCommands()
    group.addCmd(motors[0].stageGetPresentPosition())
    group.addCmd(motors[1].stageIsLEDOn())
    wait_for(lambda: abs(group.executeRead()[0] - 2000) < 8)
    assert group.executeRead()[1] == 1
    group.clearStagedReadCommands()
    group.addCmd(motors[1].stageLEDOff())
    group.executeWrite()
    group.clearStagedWriteCommands()
    wait_for(lambda: motors[1].isLEDOn() == 0)
    for stage in ("stageGetPresentVelocity", "stageGetPresentCurrent", "stageGetPresentPWM"):
        for motor in motors:
            group.addCmd(getattr(motor, stage)())
        assert all(isinstance(value, int) for value in group.executeRead())
        group.clearStagedReadCommands()
    for motor in motors:
        group.addCmd(motor.stageDisableTorque())
    group.executeWrite()
