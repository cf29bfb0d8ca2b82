"""Servos that come from other projects: what they hold is repaired, said, shown or refused."""

from dataclasses import replace

import pytest

from tests.hal.backend_robot import Robot
from tests.hal.mixed_robot import Wires, mount, robot
from windup.hal.bus.bus import Bus
from windup.hal.errors import HardwareError
from windup.hal.families import family_of, servo_model
from windup.hal.families.factory_default import protective_limits
from windup.hal.families.feetech import PROTECTION_DEFAULTS
from windup.hal.imu.opencr import OpenCr
from windup.hal.servo_bus.servo_setup import switch_servo_power_on
from windup.tools.testing.servo_bus import ServoBus

KNEE = {"op3": 13, "duck": 23}
BAUD = {"op3": 2_000_000, "duck": 1_000_000}
MODEL = {"op3": "XM430-W350", "duck": "STS3215"}


def left_with(bus: ServoBus, robot: str, **values: int) -> None:
    """Leave values in the registers of a knee, as another project would."""
    family = family_of(MODEL[robot])
    table = family.table(MODEL[robot])
    with bus.port(baud=BAUD[robot]) as port:
        host = Bus(port, family)
        if robot == "op3":
            switch_servo_power_on(host, OpenCr("bus"))
        if "lock" in table:
            host.write(KNEE[robot], table["lock"], 0)
        for name, value in values.items():
            host.sync_write(table[name], {KNEE[robot]: value})


def delivered() -> Robot:
    """Return a robot whose servos protect themselves as their maker delivers them."""
    robot = Robot()
    for id in (1, 2, 3, 4):
        robot.serial.put(id, 31, 80, 1)
        robot.serial.put(id, 32, 160, 2)
        robot.serial.put(id, 34, 95, 2)
    return robot


def held(bus: ServoBus, robot: str, name: str) -> int:
    """Return what a knee holds now."""
    family = family_of(MODEL[robot])
    with bus.port(baud=BAUD[robot]) as port:
        return Bus(port, family).read(KNEE[robot], family.table(MODEL[robot])[name])


def test_a_servo_that_speaks_protocol_1_is_told_by_joint_and_id() -> None:
    with ServoBus("op3", physics="inertia") as bus:
        left_with(bus, "op3", protocol_type=1)
        with pytest.raises(HardwareError) as caught:
            bus.robot()
        assert "knee' id 13: XM430-W350 uses protocol 1: set its Protocol Type" in str(caught.value)


@pytest.mark.parametrize(
    ("robot", "offset", "off"),
    [("op3", 512, "45.0"), ("op3", -20, "1.8"), ("duck", 500, "43.9"), ("duck", -1500, "131.8")],
)
def test_a_foreign_homing_offset_is_refused_by_joint_and_angle(
    robot: str, offset: int, off: str
) -> None:
    with ServoBus(robot, physics="inertia") as bus:
        left_with(bus, robot, homing_offset=offset)
        with pytest.raises(HardwareError) as caught:
            bus.robot()
        said = str(caught.value)
        assert "knee' id" in said
        assert f"homing offset is {offset} counts where robot.toml says 0: {off} degrees" in said
        assert held(bus, robot, "homing_offset") == offset


@pytest.mark.parametrize(
    ("robot", "level", "wanted"), [("op3", 0, 2), ("op3", 1, 2), ("duck", 0, 1)]
)
def test_a_servo_that_obeys_in_silence_is_made_to_answer(
    robot: str, level: int, wanted: int
) -> None:
    with ServoBus(robot, physics="inertia") as bus:
        left_with(bus, robot, status_return_level=level)
        bus.robot()
        assert held(bus, robot, "status_return_level") == wanted


@pytest.mark.parametrize(
    ("robot", "values", "wanted"),
    [
        ("op3", {"secondary_id": 14}, 255),
        ("op3", {"shutdown": 0}, 0x34),
        ("op3", {"shutdown": 0x01}, 0x35),
        ("op3", {"drive_mode": 5}, 0),
        ("op3", {"operating_mode": 4}, 3),
        ("op3", {"startup_configuration": 3}, 0),
        ("op3", {"min_position_limit": 3000}, 0),
        ("op3", {"profile_velocity": 10}, 0),
        ("duck", {"unloading_condition": 0}, 36),
        ("duck", {"angular_resolution": 3}, 1),
        ("duck", {"cw_dead_zone": 32}, 1),
        ("duck", {"phase": 28}, 12),
        ("duck", {"operating_mode": 1}, 0),
        ("duck", {"max_torque": 300}, 1000),
        ("duck", {"min_position_limit": 3000}, 0),
    ],
)
def test_what_changes_the_meaning_of_a_count_or_a_command_is_written(
    robot: str, values: dict[str, int], wanted: int
) -> None:
    ((name, value),) = values.items()
    with ServoBus(robot, physics="inertia") as bus:
        left_with(bus, robot, **values)
        assert held(bus, robot, name) == value
        bus.robot()
        assert held(bus, robot, name) == wanted


def test_what_is_written_is_said_first(caplog: pytest.LogCaptureFixture) -> None:
    robot = delivered()
    robot.serial.put(2, 12, 7, 1)
    robot.serial.put(3, 63, 0, 1)
    robot.backend.configure()
    assert caplog.messages == [
        "changing servo settings: return_delay 250 -> 0 at all 4 joints; "
        "secondary_id 7 -> 255 at j1; shutdown 0 -> 52 at j2"
    ]
    caplog.clear()
    robot.backend.configure()
    assert caplog.messages == []


def test_gains_that_stay_in_a_servo_are_said_too(caplog: pytest.LogCaptureFixture) -> None:
    sts = servo_model("STS3215-7.4V")
    wires = Wires()
    wires.add("body", {1: sts})
    wires["body"].set(1, "position_d_gain", 32)
    backend = robot(wires, [mount(sts, "body", 1)])
    backend.connect()
    backend.configure()
    assert "position_d_gain 32 -> 0 at j0" in caplog.text


def test_one_that_has_to_be_made_to_answer_is_said_too(caplog: pytest.LogCaptureFixture) -> None:
    robot = Robot()
    robot.serial.put(2, 68, 1, 1)
    robot.backend.configure()
    assert "status_return_level 1 -> 2 at j1" in caplog.text


def test_limits_of_its_owner_are_left_and_shown(caplog: pytest.LogCaptureFixture) -> None:
    sts = servo_model("STS3215-7.4V")
    wires = Wires()
    wires.add("body", {1: sts, 2: sts})
    for id in (1, 2):
        for default in (*protective_limits(sts), *PROTECTION_DEFAULTS):
            wires["body"].set(id, default.name, default.value)
    wires["body"].set(2, "overload_torque", 25)
    backend = robot(wires, [mount(sts, "body", 1), mount(sts, "body", 2)])
    backend.connect()
    backend.configure()
    said = (
        "protection limits differ from the factory defaults: "
        "overload_torque 25 (factory default: 80) at j1"
    )
    assert said in caplog.messages
    assert wires["body"].show(2, "overload_torque") == 25


def test_an_offset_that_the_robots_file_states_is_kept() -> None:
    sts = servo_model("STS3215-7.4V")
    wires = Wires()
    wires.add("body", {1: sts})
    wires["body"].set(1, "homing_offset", -300)
    backend = robot(wires, [replace(mount(sts, "body", 1), offset=-300)])
    backend.connect()
    backend.configure()
    assert wires["body"].show(1, "homing_offset") == -300


def test_a_temperature_limit_other_than_the_makers_is_shown(
    caplog: pytest.LogCaptureFixture,
) -> None:
    robot = delivered()
    robot.serial.put(2, 31, 30, 1)
    robot.serial.put(3, 31, 100, 1)
    robot.backend.configure()
    assert caplog.messages[-1] == (
        "protection limits differ from the factory defaults: "
        "temperature_limit 30 (factory default: 80) at j1; "
        "temperature_limit 100 (factory default: 80) at j2"
    )


def test_a_range_of_supply_is_unusual_only_where_it_is_narrow() -> None:
    _, low, high = protective_limits(servo_model("XM430-W350"))
    assert (low.is_unusual(110), low.is_unusual(60)) == (True, False)
    assert (high.is_unusual(130), high.is_unusual(161)) == (True, False)


@pytest.mark.parametrize("robot", KNEE)
def test_who_answers_half_of_what_is_asked_is_not_taken_for_one_without_power(robot: str) -> None:
    half = f"drop:0.5:ids={KNEE[robot]}"
    with ServoBus(robot, seed=1, faults=half) as bus, pytest.raises(HardwareError) as raised:
        bus.robot()
    assert "answers pings, but not all other requests" in str(raised.value)
    assert "powered" not in str(raised.value)
    assert str(raised.value).count("windup scan") == 1
