import pytest

from tests.hal.fake_bus1 import AX, MX, SCS, STS, fake_port1
from windup.hal.bus.bus import Bus
from windup.hal.bus.feetech_middle import set_middle
from windup.hal.bus.transactions import TURNAROUND
from windup.hal.errors import HardwareError, UsageError
from windup.hal.families import DYNAMIXEL_1, FEETECH_SCS, FEETECH_STS
from windup.hal.protocols import protocol1
from windup.hal.protocols.protocol1 import Instruction
from windup.hal.protocols.protocol2 import Span

IDS = [1, 2, 3]


def test_a_scan_pings_each_id_and_names_the_model() -> None:
    serial, port = fake_port1({3: STS, 17: STS})
    serial.baud_of_servos = 250_000
    found = Bus(port, FEETECH_STS).scan([1_000_000, 250_000])
    assert [(one.baud, one.id, one.model, one.firmware) for one in found] == [
        (250_000, 3, "STS3215", 3),
        (250_000, 17, "STS3215", 3),
    ]
    assert port.baud == 1_000_000


def test_a_scan_ends_where_one_servo_answers_under_the_id_of_another() -> None:
    serial, port = fake_port1({4: STS, 5: STS})
    serial.spoil = lambda id, frame: protocol1.status(4, frame[5:-1]) if id == 5 else frame
    assert [one.id for one in Bus(port, FEETECH_STS).scan([1_000_000])] == [4]


def test_sts_and_scs_live_in_one_process_with_signs_and_orders_of_their_own() -> None:
    sts, sts_port = fake_port1(dict.fromkeys(IDS, STS))
    scs, scs_port = fake_port1(dict.fromkeys(IDS, SCS))
    buses = Bus(sts_port, FEETECH_STS), Bus(scs_port, FEETECH_SCS)
    for serial, bus in zip((sts, scs), buses, strict=True):
        serial.set(2, "present_position", 700)
        serial.set(2, "present_velocity", -300)
        serial.set(2, "present_load", -45)
        for name, value in (("position", 700), ("velocity", -300), ("load", -45)):
            counts, valid = bus.sync_read(IDS, bus.family.registers[f"present_{name}"])
            assert valid.all() and counts[1] == value
        bus.sync_write(bus.family.registers["goal_position"], {1: 1000, 3: 513})
        assert [serial.show(id, "goal_position") for id in (1, 3)] == [1000, 513]
    assert bytes(sts.memory[3][42:44]) == bytes(reversed(scs.memory[3][42:44])) == b"\x01\x02"


def test_feetechs_eeprom_is_opened_for_a_write_and_closed_again() -> None:
    serial, port = fake_port1({1: STS})
    bus = Bus(port, FEETECH_STS)
    bus.write(1, bus.family.registers["return_delay"], 0)
    assert serial.saved == [(1, 7, b"\x00")]
    assert serial.show(1, "lock") == 1
    bus.write(1, bus.family.registers["torque_limit"], 500)
    assert len(serial.saved) == 1


def test_the_lock_is_closed_under_the_new_id_and_at_the_new_baud_rate() -> None:
    serial, port = fake_port1({1: STS, 2: STS})
    bus = Bus(port, FEETECH_STS)
    bus.set_id(1, 9)
    assert sorted(serial.memory) == [2, 9] and serial.show(9, "lock") == 1
    with pytest.raises(UsageError, match="id 2 on fake://bus belongs to another servo"):
        bus.set_id(9, 2)
    with pytest.raises(
        UsageError, match="baud rate 57600 is not supported; use one of 1000000, 500000"
    ):
        bus.set_baud(9, 57_600)


def test_the_present_position_becomes_the_middle_and_the_offset_has_a_sign() -> None:
    serial, port = fake_port1({1: STS})
    serial.set(1, "present_position", 1800)
    assert set_middle(Bus(port, FEETECH_STS), 1) == -248
    assert serial.show(1, "lock") == 1
    serial.set(1, "torque_enable", 1)
    with pytest.raises(HardwareError, match="torque is on; switch it off with `windup stop` first"):
        set_middle(Bus(port, FEETECH_STS), 1)
    _, scs = fake_port1({1: SCS})
    with pytest.raises(UsageError, match="a Feetech SCS servo has no homing offset"):
        set_middle(Bus(scs, FEETECH_SCS), 1)


def kinds(requests: list[bytes]) -> list[int]:
    return [request[4] for request in requests]


def test_mx_are_read_in_bulk_once_they_have_answered_so() -> None:
    serial, port = fake_port1(dict.fromkeys(IDS, MX))
    bus = Bus(port, DYNAMIXEL_1)
    position = bus.family.registers["present_position"]
    assert bus.sync_read(IDS, position)[1].all()
    assert kinds(serial.requests) == [Instruction.READ] * 3
    assert bus.probe_fast(IDS)
    serial.requests.clear()
    assert bus.sync_read(IDS, position, fast=True)[0].tolist() == [2048] * 3
    assert kinds(serial.requests) == [Instruction.BULK_READ]
    answers = bus.bulk_read([Span(1, 42, 1), Span(2, 43, 1), Span(3, 24, 1)])
    assert answers == {1: b"\x4a", 2: b"\x23", 3: b"\x00"}


def test_ax_are_read_one_after_the_other() -> None:
    serial, port = fake_port1({1: AX, 2: MX, 3: AX})
    serial.knows_bulk = False
    bus = Bus(port, DYNAMIXEL_1)
    assert not bus.probe_fast(IDS)
    serial.requests.clear()
    serial.silent.add(2)
    counts, valid = bus.sync_read(IDS, bus.family.registers["present_position"], fast=True)
    assert valid.tolist() == [True, False, True]
    assert counts[[0, 2]].tolist() == [512, 512]
    assert kinds(serial.requests) == [Instruction.READ] * 3


def test_scs_are_read_in_sync_where_they_know_it() -> None:
    for knows in (True, False):
        serial, port = fake_port1(dict.fromkeys(IDS, SCS))
        serial.knows_sync = knows
        bus = Bus(port, FEETECH_SCS)
        assert bus.probe_fast(IDS) == knows
        serial.requests.clear()
        counts, valid = bus.sync_read(IDS, bus.family.registers["present_position"], fast=True)
        assert valid.all() and counts.tolist() == [512] * 3
        assert len(serial.requests) == (1 if knows else 3)


def test_a_corrupt_reply_of_a_sync_read_costs_that_reply() -> None:
    serial, port = fake_port1(dict.fromkeys(IDS, STS))
    serial.spoil = lambda id, frame: frame[:-2] + b"\x11" + frame[-1:] if id == 2 else frame
    bus = Bus(port, FEETECH_STS)
    _, valid = bus.sync_read(IDS, bus.family.registers["present_position"])
    assert valid.tolist() == [True, False, True]
    assert bus.exchange.errors == {"resynchronised": 1, "corrupt": 1}


def test_a_write_to_31_servos_is_split_where_the_makers_sdk_fails() -> None:
    serial, port = fake_port1(dict.fromkeys(range(1, 32), STS))
    bus = Bus(port, FEETECH_STS)
    register = bus.family.registers["goal_position"]
    for id in range(1, 101):
        serial.models[id] = STS
    bus.sync_write(register, dict.fromkeys(range(1, 101), 300))
    assert len(serial.requests) == 2 and max(map(len, serial.requests)) <= 250
    assert all(serial.show(id, "goal_position") == 300 for id in range(1, 32))


def test_a_cycle_of_20_sts_takes_its_time_on_the_wire_and_a_missing_one_4_ms() -> None:
    ids = list(range(1, 21))
    serial, port = fake_port1(dict.fromkeys(ids, STS))
    serial.latency = port.latency = 1e-3
    bus = Bus(port, FEETECH_STS)
    bus.exchange.turnaround = TURNAROUND
    read = FEETECH_STS.protocol.read([FEETECH_STS.state.span(id) for id in ids])
    wire = (len(read.request) + read.length) * 10.0 / 1e6
    for dead in (None, 7, 20):
        serial.silent = set() if dead is None else {dead}
        start = port.clock.now()
        bus.exchange.request(read)
        valid = bus.exchange.collect()
        taken = port.clock.now() - start
        assert [id for id, has in zip(ids, valid, strict=True) if not has] == sorted(serial.silent)
        assert taken == pytest.approx(wire) if dead is None else taken <= wire + 4e-3
