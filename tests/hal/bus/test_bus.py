import pytest

from tests.hal.fake_bus import fake_port
from windup.hal.bus.bus import Bus
from windup.hal.errors import HardwareError, UsageError
from windup.hal.protocols.protocol2 import Span
from windup.hal.servos.x_series_registers import x_series_registers

TABLE = x_series_registers("XM430-W350")


def test_a_scan_finds_every_servo_at_its_baud_rate() -> None:
    serial, port = fake_port([3, 17])
    serial.baud_of_servos = 57_600
    found = Bus(port).scan()
    assert [(one.baud, one.id, one.model, one.firmware) for one in found] == [
        (57_600, 3, "XM430-W350", 45),
        (57_600, 17, "XM430-W350", 45),
    ]
    assert port.baud == 1_000_000


def test_a_register_is_written_and_read_back() -> None:
    serial, port = fake_port([1])
    bus = Bus(port)
    bus.write(1, TABLE["goal_position"], -5)
    assert bus.read(1, TABLE["goal_position"]) == -5
    serial.writable = False
    message = "id 1 on fake://bus: goal_position was set to 7 and reads back as -5"
    with pytest.raises(HardwareError, match=message):
        bus.write(1, TABLE["goal_position"], 7)


def test_sync_read_says_whose_values_are_fresh() -> None:
    serial, port = fake_port([1, 2, 3])
    serial.silent.add(2)
    counts, valid = Bus(port).sync_read([1, 2, 3], TABLE["present_position"])
    assert valid.tolist() == [True, False, True]
    assert counts[0] == 2048


def test_sync_write_reaches_each_servo() -> None:
    serial, port = fake_port([1, 2])
    Bus(port).sync_write(TABLE["goal_position"], {1: 100, 2: -100})
    assert [serial.get(id, 116, 4, signed=True) for id in (1, 2)] == [100, -100]


def test_bulk_read_returns_who_answered() -> None:
    serial, port = fake_port([1, 2, 200])
    serial.memory[200] = bytearray(256)
    serial.silent.add(2)
    answers = Bus(port).bulk_read([Span(1, 144, 2), Span(2, 146, 1), Span(200, 30, 20)])
    assert answers == {1: bytes([120, 0]), 200: bytes(20)}


def test_fast_sync_read_is_used_where_all_know_it() -> None:
    serial, port = fake_port([1, 2])
    bus = Bus(port)
    assert bus.probe_fast([1, 2])
    bus.sync_read([1, 2], TABLE["present_position"], fast=True)
    assert serial.requests[-1][7] == 0x8A


def test_fast_sync_read_is_given_up_where_the_plain_one_is_answered() -> None:
    serial, port = fake_port([1, 2])
    serial.knows_fast = False
    bus = Bus(port)
    assert not bus.probe_fast([1, 2])
    counts, valid = bus.sync_read([1, 2], TABLE["present_position"], fast=True)
    assert valid.all() and counts.tolist() == [2048, 2048]


def test_an_id_that_is_taken_is_not_given_twice() -> None:
    serial, port = fake_port([1, 2])
    with pytest.raises(UsageError, match="id 2 on fake://bus belongs to another servo"):
        Bus(port).set_id(1, 2)
    assert serial.written == []


def test_a_servo_answers_to_its_new_id() -> None:
    serial, port = fake_port([1])
    Bus(port).set_id(1, 9)
    assert list(serial.memory) == [9]


def test_a_baud_rate_that_no_servo_has_is_refused() -> None:
    _, port = fake_port([1])
    with pytest.raises(UsageError, match="baud rate 123 is not supported; use one of 9600, 57600"):
        Bus(port).set_baud(1, 123)


def test_registers_of_the_family_differ_where_the_trap_is() -> None:
    assert "present_current" not in x_series_registers("2XC430-W250")
    assert x_series_registers("XL430-W250")["present_load"].unit == 1e-3
    assert x_series_registers("XC330-T288")["present_current"].unit == 1e-3
    assert x_series_registers("XM540-W270")["present_current"].unit == 2.69e-3
    with pytest.raises(UsageError, match="unknown register of the XL430-W250 'present_current'"):
        x_series_registers("XL430-W250")["present_current"]
