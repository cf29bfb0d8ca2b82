"""What Feetech servos do, over the wire, on the virtual clock."""

from collections.abc import Iterator

import pytest

from tests.sim_twin.wire.wire_host1 import (
    ACTION,
    PING,
    READ,
    REBOOT,
    REG_WRITE,
    RESET,
    SYNC_WRITE,
    WRITE,
    Host1,
    open_host1,
    statuses,
)
from windup.sim_twin.wire.protocols.frames1 import encode

ALL = 254
STS, BIG = 1, 2
SPEED, PWM, STEP = 1, 2, 3


@pytest.fixture
def host() -> Iterator[Host1]:
    with open_host1("twin://bench?servos=STS3215-12V:1,STS3250:2,STS3215:3") as host:
        yield host


def test_the_manuals_reads_get_the_manuals_answers() -> None:
    with open_host1("twin://bench?servos=STS3215-12V:1&supply=12.1") as host:
        host.place(1, 1304)
        assert host.raw("FF FF 01 04 02 38 02 BE") == bytes.fromhex("FF FF 01 04 00 18 05 DD")
        host.place(1, 2048)
        host.servo(1).temperature = 30.0
        got = host.raw("FF FF FE 05 82 38 08 01 39")
        assert got == bytes.fromhex("FF FF 01 0A 00 00 08 00 00 00 00 79 1E 55")


def test_the_manuals_goal_is_kept_and_acted_upon(host: Host1) -> None:
    host.place(1, 1000)
    host.raw("FF FF 01 09 04 2A 00 08 00 00 E8 03 D4")
    host.wait(0.5)
    assert host.read(1, "present_position") == 1000
    assert host.read(1, "registered") == 1
    host.raw("FF FF FE 02 05 FA")
    host.wait(0.5)
    assert host.read(1, "present_speed") == pytest.approx(1000, abs=20)
    host.wait(2.0)
    assert host.read(1, "present_position") == pytest.approx(2048, abs=3)


def test_a_sync_read_is_answered_in_the_order_asked(host: Host1) -> None:
    for k, counts in ((1, 100), (2, 200), (3, 300)):
        host.place(k, counts)
    got = statuses(host.sync_read(56, 2, 3, 1, 2))
    assert [(f.identifier, int.from_bytes(f.parameters, "little")) for f in got] == [
        (3, 300),
        (1, 100),
        (2, 200),
    ]


@pytest.mark.parametrize(("missing", "expected"), [("skip", [1, 3]), ("wait", [1])])
def test_behind_a_missing_neighbour_the_others_skip_its_slot_or_wait(
    missing: str, expected: list[int]
) -> None:
    url = f"twin://bench?servos=STS3215:1,STS3215:3&missing={missing}"
    with open_host1(url) as host:
        assert [f.identifier for f in statuses(host.sync_read(56, 2, 1, 2, 3))] == expected


def test_twenty_answers_take_their_bytes_and_nothing_else() -> None:
    with open_host1("twin://bench?servos=STS3215:1-20") as host:
        request = encode(ALL, 0x82, bytes((56, 6, *range(1, 21))))
        began = host.now
        host.port.write(request)
        assert len(host.port.read(240)) == 240
        assert host.now - began == pytest.approx((len(request) + 240) * 1e-5)


def test_a_frame_of_more_than_250_bytes_is_not_heard(host: Host1) -> None:
    body = bytes((42, 6)) + b"".join(bytes((k, 0, 8, 0, 0, 0, 0)) for k in range(1, 36))
    assert len(encode(ALL, SYNC_WRITE, body)) > 250
    host.raw(encode(ALL, SYNC_WRITE, body))
    assert host.read(1, "torque_enable") == 0
    host.raw(encode(ALL, SYNC_WRITE, body[: 2 + 7 * 34]))
    assert host.read(1, "torque_enable") == 1


def test_a_broadcast_ping_is_answered_in_the_slots_of_the_ids(host: Host1) -> None:
    host.port.timeout = 1.0
    assert [f.identifier for f in host.ask(ALL, PING)] == [1, 2, 3]


def test_without_answers_to_writes_reads_are_answered_all_the_same(host: Host1) -> None:
    host.write(1, "status_return_level", 0)
    assert host.ask(1, WRITE, b"\x29\x05") == []
    assert host.read(1, "acceleration") == 5
    assert len(host.ask(1, PING)) == 1


def test_a_wrong_checksum_is_not_answered(host: Host1) -> None:
    assert host.raw(encode(1, PING)[:-1] + b"\0") == b""
    assert host.ask(1, 0x55) == []


def test_the_lock_keeps_writes_from_outliving_the_power(host: Host1) -> None:
    assert host.read(1, "lock") == 1
    host.write(1, "p_gain", 20)
    assert host.read(1, "p_gain") == 20
    host.ask(1, REBOOT)
    host.wait(0.5)
    assert host.read(1, "p_gain") == 32
    host.write(1, "lock", 0)
    host.write(1, "p_gain", 20)
    host.world.set_supply(0.0)
    host.wait(0.1)
    host.world.set_supply(12.0)
    host.wait(0.5)
    assert (host.read(1, "p_gain"), host.read(1, "lock")) == (20, 1)


def test_the_offset_is_subtracted_and_signed_by_bit_11(host: Host1) -> None:
    host.write(1, "offset", -100)
    assert host.ask(1, READ, bytes((31, 2)))[0].parameters == (100 | 1 << 11).to_bytes(2, "little")
    assert host.read(1, "present_position") == 2148
    host.write(1, "goal_position", 2148)
    host.wait(0.5)
    assert host.shaft(1).position == pytest.approx(0.0, abs=2e-3)


def test_128_makes_the_present_position_the_middle(host: Host1) -> None:
    host.place(1, 3000)
    host.write(1, "torque_enable", 128)
    assert host.read(1, "offset") == 952
    assert host.read(1, "present_position") == 2048
    assert host.read(1, "torque_enable") == 0
    host.ask(1, REBOOT)
    host.wait(0.5)
    assert host.read(1, "present_position") == 2048


def test_a_goal_switches_the_torque_on_and_runs_at_3400_steps_a_second(host: Host1) -> None:
    host.place(2, 0)
    host.write(2, "goal_position", 4000)
    assert host.read(2, "torque_enable") == 1
    host.wait(0.6)
    assert host.read(2, "moving") == 1
    assert host.read(2, "present_speed") == pytest.approx(3400, rel=0.02)
    host.wait(1.0)
    assert host.read(2, "present_position") == pytest.approx(4000, abs=3)
    assert host.read(2, "moving") == 0


def test_speed_and_acceleration_shape_the_way(host: Host1) -> None:
    host.place(1, 1000)
    host.ask(1, WRITE, bytes((41, 5)) + bytes.fromhex("D007 0000 F401"))  # 2000 at 500, 500/s
    host.wait(0.5)
    assert host.read(1, "present_speed") == pytest.approx(250, abs=15)
    host.wait(1.0)
    assert host.read(1, "present_speed") == pytest.approx(500, abs=5)
    host.wait(2.0)
    assert host.read(1, "present_position") == pytest.approx(2000, abs=3)


def test_the_phase_sets_the_unit_of_speed_and_what_zero_means(host: Host1) -> None:
    host.write(1, "phase", 8)
    host.place(1, 1000)
    host.ask(1, WRITE, bytes((42,)) + bytes.fromhex("B80B 0000 0A00"))  # speed 10 x 50
    host.wait(0.5)
    assert host.read(1, "present_speed") == 10
    assert host.shaft(1).velocity * 4096 / 6.2832 == pytest.approx(500, rel=0.05)
    host.write(1, "phase", 4)
    before = host.read(1, "present_position")
    host.ask(1, WRITE, bytes((42,)) + bytes.fromhex("E803 0000 0000"))
    host.wait(0.5)
    assert host.read(1, "present_position") == pytest.approx(before, abs=20)


def test_the_phase_decides_whether_turns_are_counted(host: Host1) -> None:
    host.place(1, 5000)
    assert host.read(1, "present_position") == 5000 - 4096
    host.write(1, "phase", 12 + 16)
    assert host.read(1, "present_position") == 5000
    host.place(1, -5000)
    assert host.read(1, "present_position") == -5000
    raw = host.ask(1, READ, bytes((56, 2)))[0].parameters
    assert raw == (5000 | 1 << 15).to_bytes(2, "little")
    host.write(1, "min_angle", 0)
    host.write(1, "max_angle", 0)
    host.write(1, "goal_position", -6000)
    host.wait(1.0)
    assert host.read(1, "present_position") == pytest.approx(-6000, abs=3)


def test_goals_stay_within_the_angle_limits(host: Host1) -> None:
    host.write(1, "max_angle", 2500)
    host.write(1, "goal_position", 4000)
    host.wait(1.5)
    assert host.read(1, "present_position") == pytest.approx(2500, abs=3)


@pytest.mark.parametrize("speed", [600, -600])
def test_speed_mode(host: Host1, speed: int) -> None:
    host.write(1, "mode", SPEED)
    host.write(1, "goal_speed", speed)
    host.wait(1.0)
    assert host.read(1, "present_speed") == pytest.approx(speed, abs=6)
    load = host.read(1, "present_load")
    assert load * speed > 0
    host.write(1, "goal_speed", 0)
    host.wait(0.5)
    assert host.read(1, "present_speed") == 0


def test_in_speed_mode_a_shaft_that_was_held_does_not_catch_up(host: Host1) -> None:
    host.write(1, "mode", SPEED)
    host.write(1, "goal_speed", 500)
    host.shaft(1).blocked = True
    host.wait(1.0)
    host.shaft(1).blocked = False
    host.wait(1.0)
    assert host.read(1, "present_speed") == pytest.approx(500, abs=6)


def test_pwm_mode_puts_a_share_of_the_supply_on_the_motor(host: Host1) -> None:
    host.write(1, "mode", PWM)
    host.write(1, "goal_time", -500)
    assert host.ask(1, READ, bytes((44, 2)))[0].parameters == (500 | 1 << 10).to_bytes(2, "little")
    host.wait(1.5)
    free = 45 / 60 * 4096 * 0.5
    assert host.read(1, "present_speed") == pytest.approx(-free, rel=0.1)
    assert host.read(1, "present_load") == pytest.approx(-500, abs=2)


def test_step_mode_goes_on_from_where_it_is(host: Host1) -> None:
    host.write(1, "mode", STEP)
    host.write(1, "min_angle", 0)
    host.write(1, "max_angle", 0)
    for _ in range(3):
        host.write(1, "goal_position", 1000)
        host.wait(1.0)
    assert host.read(1, "present_position") == pytest.approx(2048 + 3000, abs=3)


def test_half_a_field_can_be_written_and_what_is_read_only_is_skipped(host: Host1) -> None:
    host.ask(1, WRITE, bytes((12, 5)))
    assert host.read(1, "max_angle") == 4095 & 0xFF | 5 << 8
    assert host.ask(1, WRITE, bytes((56, 1, 2)))[0].instruction == 0
    assert host.read(1, "present_position") == 2048


def test_id_and_baud_change_behind_the_answer(host: Host1) -> None:
    host.write(1, "lock", 0)
    assert len(host.ask(1, WRITE, bytes((5, 7)))) == 1
    assert len(host.ask(7, WRITE, bytes((6, 1)))) == 1
    assert host.ask(7, PING) == []
    host.port.baudrate = 500_000
    assert len(host.ask(7, PING)) == 1


def test_a_reset_brings_back_the_factory_but_for_the_id(host: Host1) -> None:
    host.write(1, "lock", 0)
    host.write(1, "p_gain", 5)
    host.write(1, "offset", 100)
    host.ask(1, WRITE, bytes((5, 7)))
    host.ask(7, RESET)
    host.wait(0.5)
    assert (host.read(7, "p_gain"), host.read(7, "offset")) == (32, 0)


def test_reg_write_and_action_move_together(host: Host1) -> None:
    for k in (1, 2, 3):
        assert len(host.ask(k, REG_WRITE, bytes((42, 0x60, 0x09)))) == 1
    assert not any(host.read(k, "torque_enable") for k in (1, 2, 3))
    host.ask(ALL, ACTION)
    host.wait(1.0)
    for k in (1, 2, 3):
        assert host.read(k, "present_position") == pytest.approx(0x960, abs=3)
