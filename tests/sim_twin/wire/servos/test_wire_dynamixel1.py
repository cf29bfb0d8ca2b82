"""What AX and MX servos do, over the wire, on the virtual clock."""

from collections.abc import Iterator

import pytest

from tests.sim_twin.wire.wire_host1 import (
    ACTION,
    BULK_READ,
    PING,
    READ,
    REG_WRITE,
    RESET,
    SYNC_READ,
    SYNC_WRITE,
    WRITE,
    Host1,
    open_host1,
    statuses,
)
from windup.sim_twin.wire.protocols.frames1 import encode
from windup.sim_twin.wire.servos.dynamixel1_servo import (
    ANGLE_LIMIT,
    CHECKSUM,
    INPUT_VOLTAGE,
    INSTRUCTION,
    OVERHEATING,
    OVERLOAD,
    RANGE,
)

ALL = 254
AX, MX28, MX64, MX106 = 1, 2, 3, 4
RPM = 6.2832 / 60


@pytest.fixture
def host() -> Iterator[Host1]:
    with open_host1("twin://bench?servos=AX-12A:1,MX-28:2,MX-64:3,MX-106:4&return_delay=0") as host:
        yield host


def test_the_manuals_ping_and_read_get_the_manuals_answers(host: Host1) -> None:
    assert host.raw("FF FF 01 02 01 FB") == bytes.fromhex("FF FF 01 02 00 FC")
    host.servo(AX).temperature = 32.0
    assert host.raw("FF FF 01 04 02 2B 01 CC") == bytes.fromhex("FF FF 01 03 00 20 DB")


def test_the_manuals_sync_write_reaches_all_and_is_not_answered() -> None:
    with open_host1("twin://bench?servos=AX-12A:0-3") as host:
        got = host.raw(
            "FF FF FE 18 83 1E 04 00 10 00 50 01 01 20 02 60 0302 30 00 70 01 03 20 02 80 03 12"
        )
        assert got == b""
        assert [host.read(k, "goal_position") for k in range(4)] == [0x10, 0x220, 0x30, 0x220]
        assert [host.read(k, "moving_speed") for k in range(4)] == [0x150, 0x360, 0x170, 0x380]


def test_the_manuals_bulk_read_is_answered_in_the_order_asked() -> None:
    with open_host1("twin://bench?servos=MX-28:1-2") as host:
        host.place(2, 1600)
        host.write(1, "goal_position", 512)
        got = statuses(host.raw("FF FF FE 09 92 00 02 01 1E 02 02 24 1D"))
        assert [(f.identifier, f.parameters) for f in got] == [
            (1, (512).to_bytes(2, "little")),
            (2, (1600).to_bytes(2, "little")),
        ]


def test_a_bulk_read_waits_for_a_missing_neighbour_or_skips_it() -> None:
    for missing, expected in (("skip", [1, 3]), ("wait", [1])):
        with open_host1(f"twin://bench?servos=MX-28:1,MX-28:3&missing={missing}") as host:
            request = encode(ALL, BULK_READ, bytes((0, 2, 1, 36, 2, 2, 36, 2, 3, 36)))
            assert [f.identifier for f in statuses(host.raw(request))] == expected


def test_there_is_no_sync_read(host: Host1) -> None:
    assert host.raw(encode(ALL, SYNC_READ, bytes((36, 2, 1, 2)))) == b""


def test_errors_have_their_bits(host: Host1) -> None:
    assert statuses(host.raw(encode(1, PING)[:-1] + b"\0"))[0].instruction == CHECKSUM
    assert host.ask(AX, 0x55)[0].instruction == INSTRUCTION
    assert host.write(AX, "goal_position", 1024) == RANGE
    assert host.ask(AX, WRITE, bytes((36, 0, 0)))[0].instruction == RANGE
    host.write(AX, "ccw_angle_limit", 600)
    assert host.write(AX, "goal_position", 601) == ANGLE_LIMIT
    assert host.read(AX, "torque_enable") == 0


def test_everybody_answers_a_broadcast_ping_at_once() -> None:
    with open_host1("twin://bench?servos=AX-12A:1-2&return_delay=0") as host:
        assert statuses(host.raw(encode(ALL, PING))) == []
        assert host.port.bus.counts["collisions"] == 1
    with open_host1("twin://bench?servos=AX-12A:1") as host:
        assert len(statuses(host.raw(encode(ALL, PING)))) == 1


@pytest.mark.parametrize(("level", "heard"), [(0, [1, 0, 0]), (1, [1, 1, 0]), (2, [1, 1, 1])])
def test_the_status_return_level_silences(host: Host1, level: int, heard: list[int]) -> None:
    host.raw(encode(AX, WRITE, bytes((16, level))))
    asked = (PING, b""), (READ, b"\x24\x02"), (WRITE, b"\x19\x01")
    assert [len(host.ask(AX, what, data)) for what, data in asked] == heard


def test_a_goal_switches_the_torque_on_and_is_reached_at_the_moving_speed(host: Host1) -> None:
    for servo, goal, unit in ((AX, 300, 0.111), (MX28, 1000, 0.114)):
        host.write(servo, "moving_speed", 100)
        assert host.write(servo, "goal_position", goal) == 0
        assert host.read(servo, "torque_enable") == 1
        host.wait(0.3)
        assert host.shaft(servo).velocity == pytest.approx(-100 * unit * RPM, rel=0.05)
        raw = host.ask(servo, READ, bytes((38, 2)))[0].parameters
        assert int.from_bytes(raw, "little") == pytest.approx(1024 + 100, abs=5)
        assert host.read(servo, "moving") == 1
        host.wait(3.0)
        assert host.read(servo, "present_position") == pytest.approx(goal, abs=3)
        assert host.read(servo, "moving") == 0


def test_torque_on_goes_to_the_goal_of_old(host: Host1) -> None:
    host.write(MX28, "goal_position", 1500)
    host.wait(1.0)
    host.write(MX28, "torque_enable", 0)
    host.place(MX28, 2500)
    host.write(MX28, "torque_enable", 1)
    host.wait(1.0)
    assert host.read(MX28, "present_position") == pytest.approx(1500, abs=3)


def test_wheels_turn_by_duty_on_an_ax_and_by_speed_on_an_mx(host: Host1) -> None:
    for servo in (AX, MX28):
        host.write(servo, "cw_angle_limit", 0)
        host.write(servo, "ccw_angle_limit", 0)
        host.write(servo, "torque_enable", 1)
        host.write(servo, "moving_speed", 1024 + 300)
    host.wait(1.5)
    free = 59 * RPM * 300 / 1023
    assert host.shaft(AX).velocity == pytest.approx(-free, rel=0.1)
    assert host.shaft(MX28).velocity == pytest.approx(-300 * 0.114 * RPM, rel=0.02)
    host.write(MX28, "moving_speed", 0)
    host.wait(1.0)
    assert host.shaft(MX28).velocity == pytest.approx(0.0, abs=1e-3)


def test_an_mx_counts_turns_where_both_limits_are_4095(host: Host1) -> None:
    host.write(MX28, "cw_angle_limit", 4095)
    host.write(MX28, "goal_position", -6000)
    host.wait(4.0)
    assert host.read(MX28, "present_position") == pytest.approx(-6000, abs=3)
    host.write(MX28, "multi_turn_offset", 1000)
    assert host.read(MX28, "present_position") == pytest.approx(-5000, abs=3)
    host.write(MX28, "resolution_divider", 2)
    assert host.read(MX28, "present_position") == pytest.approx(-2000, abs=3)


def test_the_torque_limit_starts_as_max_torque_and_caps_the_load(host: Host1) -> None:
    host.write(MX28, "max_torque", 400)
    assert host.read(MX28, "torque_limit") == 400
    host.shaft(MX28).load = 3.0
    host.write(MX28, "torque_enable", 1)
    host.wait(0.3)
    assert host.read(MX28, "present_load") == pytest.approx(-400 * 0.9625, abs=4)


def test_the_law_is_the_gain_registers(host: Host1) -> None:
    for servo, gain in ((MX28, 32 / 8 / 511), (AX, 1 / 32)):
        host.shaft(servo).load = 0.2
        host.write(servo, "torque_enable", 1)
        host.wait(1.0)
        loop = host.servo(servo).loop
        error = -host.shaft(servo).position * loop.per_rad
        assert host.read(servo, "present_load") == pytest.approx(1023 * gain * error, abs=3)


def test_after_an_alarm_shutdown_nothing_moves_until_there_is_a_torque_limit(host: Host1) -> None:
    host.shaft(MX28).blocked = True
    host.write(MX28, "goal_position", 3500)
    host.wait(2.0)
    assert host.ask(MX28, PING)[0].instruction == OVERLOAD
    assert (host.read(MX28, "torque_enable"), host.read(MX28, "torque_limit")) == (0, 0)
    host.shaft(MX28).blocked = False
    host.write(MX28, "torque_enable", 1)
    host.wait(0.5)
    assert host.read(MX28, "present_position") == 2048
    assert host.write(MX28, "torque_limit", 1023) == 0
    host.write(MX28, "goal_position", 3500)
    host.wait(2.0)
    assert host.read(MX28, "present_position") == pytest.approx(3500, abs=3)


def test_heat_and_voltage_alarm_as_the_registers_say(host: Host1) -> None:
    host.write(MX28, "torque_enable", 1)
    host.servo(MX28).temperature = 85.0
    host.world.set_supply(17.0)
    host.wait(0.05)
    assert host.ask(MX28, PING)[0].instruction == OVERHEATING | INPUT_VOLTAGE
    assert host.read(MX28, "torque_enable") == 0  # shutdown 36: heat and overload
    host.write(MX64, "torque_enable", 1)
    host.wait(0.05)
    assert host.ask(MX64, PING)[0].instruction == INPUT_VOLTAGE
    assert host.read(MX64, "torque_enable") == 1
    assert host.read(MX64, "present_voltage") == 170


def test_the_lock_holds_until_the_power_goes(host: Host1) -> None:
    host.write(AX, "lock", 1)
    assert host.write(AX, "cw_angle_limit", 5) == RANGE
    assert host.write(AX, "lock", 0) == RANGE
    host.world.set_supply(0.0)
    host.world.set_supply(12.0)
    host.wait(0.5)
    assert host.write(AX, "cw_angle_limit", 5) == 0


def test_current_and_torque_control_where_there_is_a_sensor(host: Host1) -> None:
    host.shaft(MX64).load = 1.0
    host.write(MX64, "torque_enable", 1)
    host.wait(0.5)
    amperes = (host.read(MX64, "current") - 2048) * 4.5e-3
    assert amperes == pytest.approx(-1.0 / 1.46, rel=0.15)
    host.shaft(MX64).load = 0.0
    host.shaft(MX64).blocked = True
    host.write(MX64, "torque_control_mode", 1)
    host.write(MX64, "goal_torque", 1024 + 200)
    host.wait(0.1)
    assert host.read(MX64, "current") == pytest.approx(2048 - 200, abs=2)


def test_goal_acceleration_on_an_mx(host: Host1) -> None:
    host.write(MX106, "goal_acceleration", 10)
    host.write(MX106, "moving_speed", 300)
    host.write(MX106, "goal_position", 3500)
    host.wait(1.0)
    assert host.shaft(MX106).velocity == pytest.approx(10 * 8.583 / 57.2958, rel=0.1)


def test_reg_write_and_action_move_together(host: Host1) -> None:
    for k in (MX28, MX64):
        host.ask(k, REG_WRITE, bytes((30, 0x60, 0x09)))
        assert host.read(k, "registered") == 1
    host.ask(ALL, ACTION)
    host.wait(1.5)
    for k in (MX28, MX64):
        assert host.read(k, "present_position") == pytest.approx(0x960, abs=3)


def test_id_baud_and_reset(host: Host1) -> None:
    assert len(host.ask(AX, WRITE, bytes((3, 50)))) == 1
    assert len(host.ask(50, WRITE, bytes((4, 3)))) == 1
    host.port.baudrate = 500_000
    assert len(host.ask(50, PING)) == 1
    host.ask(50, RESET)
    host.wait(0.5)
    host.port.baudrate = 1_000_000
    assert len(host.ask(1, PING)) == 1
    host.raw(encode(ALL, SYNC_WRITE, bytes((3, 1, 1, 9))))
    assert len(host.ask(9, PING)) == 1
