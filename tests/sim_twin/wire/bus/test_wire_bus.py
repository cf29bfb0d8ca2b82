"""Who answers when, and what happens to bytes that meet."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.sim_twin.wire.wire_host import Host, open_host
from windup.sim_twin.wire.protocols.frames import Frame, Parser, encode

BYTE = 1e-5  # s at 1 Mbaud


def place(host: Host, **counts: int) -> None:
    """Put servos at counts: `_3=166` is servo 3."""
    for name, value in counts.items():
        host.shaft(int(name[1:])).position = (value - 2048) * 2.0 * math.pi / 4096


def answers(data: bytes) -> list[int]:
    return [item.identifier for item in Parser().feed(data) if isinstance(item, Frame)]


def test_the_manuals_read_gets_the_manuals_answer() -> None:
    with open_host("twin://bench?servos=XM430-W210:1") as host:
        place(host, _1=166)
        got = host.raw(bytes.fromhex("FFFFFD00 01 0700 02 84000400 1D15"))
        assert got == bytes.fromhex("FFFFFD00 01 0800 55 00 A6000000 8CC0")


def test_the_manuals_sync_read_gets_the_manuals_answers() -> None:
    with open_host("twin://bench?servos=XM430-W210:1-2") as host:
        place(host, _1=166, _2=2079)
        got = host.raw(bytes.fromhex("FFFFFD00 FE 0900 82 840004000102 CEFA"))
        assert got == bytes.fromhex(
            "FFFFFD00 01 0800 55 00 A6000000 8CC0 FFFFFD00 02 0800 55 00 1F080000 BABE"
        )


def test_the_manuals_fast_sync_read_gets_the_manuals_chained_answer() -> None:
    with open_host("twin://bench?servos=XC330-T288:3,XC330-T288:7,XC330-T288:4") as host:
        place(host, _3=166, _7=2079, _4=1023)
        got = host.sync_read(132, 4, 3, 7, 4, fast=True)
        assert got == bytes.fromhex(
            "FFFFFD00 FE 1900 55 00 03 A6000000 8408 00 07 1F080000 16CA 00 04 FF030000 D19E"
        )


def test_the_manuals_fast_bulk_read_is_chained_as_well() -> None:
    with open_host("twin://bench?servos=XC330-T288:3,XC330-T288:7,XC330-T288:4") as host:
        place(host, _3=166)
        host.servo(4).firmware.health.temperature = 31.0
        request = encode(254, 0x9A, bytes.fromhex("0384000400 077C000200 0492000100"))
        got = host.raw(request)
        assert got[:16] == bytes.fromhex("FFFFFD00 FE 1400 55 00 03 A6000000 67A4")
        assert got[16:20] == b"\0\x07\0\0"  # the manual's servo has a PWM of 421
        assert got[22:25] == b"\0\x04\x1f"
        assert isinstance(Parser().feed(got)[0], Frame)


def test_the_manuals_bulk_read_and_writes() -> None:
    with open_host("twin://bench?servos=XM430-W210:1-2&supply=11.9") as host:
        host.servo(2).firmware.health.temperature = 36.0
        got = host.raw(bytes.fromhex("FFFFFD00 FE 0D00 92 0190000200 0292000100 1A05"))
        assert got == bytes.fromhex(
            "FFFFFD00 01 0600 55 00 7700 C369 FFFFFD00 02 0500 55 00 24 8BA9"
        )
        write = "FFFFFD00 FE 1100 83 74000400 0196000000 02AA000000 8287"
        assert host.raw(bytes.fromhex(write)) == b""
        assert (host.read(1, "goal_position"), host.read(2, "goal_position")) == (150, 170)
        write = "FFFFFD00 FE 1000 93 0120000200A000 021F00010050 B768"
        assert host.raw(bytes.fromhex(write)) == b""
        assert host.read(2, "temperature_limit") == 80


def test_an_answer_takes_the_time_of_its_bytes_and_delays() -> None:
    with open_host("twin://bench?servos=XM430-W350:1&latency=1") as host:
        request = encode(1, 1)
        began = host.now
        host.port.write(request)
        host.port.read(1)
        delay = 250 * 2e-6
        assert host.now - began == pytest.approx((len(request) + 1) * BYTE + delay + 1e-3)
        host.port.read(13)
        assert host.now - began == pytest.approx((len(request) + 14) * BYTE + delay + 1e-3)


def test_a_sync_read_of_twenty_takes_its_bytes_and_nothing_else() -> None:
    with open_host("twin://bench?servos=XM430-W350:1-20&return_delay=0") as host:
        began = host.now
        request = encode(254, 0x82, bytes((126, 0, 10, 0, *range(1, 21))))
        host.port.write(request)
        assert len(host.port.read(420)) == 420
        assert host.now - began == pytest.approx((len(request) + 420) * BYTE)


@pytest.mark.parametrize(("missing", "expected"), [("skip", [1, 2, 4]), ("wait", [1, 2])])
def test_behind_a_missing_neighbour_the_others_skip_its_slot_or_wait(
    missing: str, expected: list[int]
) -> None:
    url = f"twin://bench?servos=XM430-W350:1-2,XM430-W350:4&return_delay=0&missing={missing}"
    with open_host(url) as host:
        assert answers(host.sync_read(132, 4, 1, 2, 3, 4)) == expected
        if missing == "skip":
            began = host.now
            host.port.write(encode(254, 0x82, bytes((132, 0, 4, 0, 1, 2, 3, 4))))
            host.port.read(45)
            assert host.now - began == pytest.approx((18 + 4 * 15) * BYTE)


def test_servos_that_know_no_fast_sync_read_stay_silent() -> None:
    with open_host("twin://bench?servos=2XL430:1,XL330:2") as host:
        assert host.sync_read(132, 4, 1, fast=True) == b""
        assert host.sync_read(132, 4, 2, fast=True) != b""
        host.servo(2).registers.set("firmware_version", 45)
        assert host.sync_read(132, 4, 2, fast=True) == b""
        assert answers(host.sync_read(132, 4, 1, 2)) == [1, 2]


def test_everybody_answers_a_broadcast_ping_in_the_slot_of_its_id() -> None:
    with open_host("twin://bench?servos=XM430-W350:1,XL430:7,XL330:250", timeout=1.0) as host:
        assert answers(host.raw(encode(254, 1))) == [1, 7, 250]


def test_the_status_return_level_silences() -> None:
    with open_host() as host:
        host.write(1, "status_return_level", 1)
        assert host.ask(1, 0x03, bytes((116, 0, 0, 4, 0, 0))) == []
        assert host.read(1, "goal_position") == 1024
        assert host.ask(1, 0x03, bytes((68, 0, 0))) == []
        assert host.ask(1, 0x02, bytes((68, 0, 1, 0))) == []
        assert host.sync_read(132, 4, 1) == b""
        assert len(host.ask(1, 0x01)) == 1


def test_two_servos_of_one_id_talk_over_each_other() -> None:
    with open_host("twin://bench?servos=XM430-W350:1,XM430-W350:1") as host:
        got = host.raw(encode(1, 1))
        assert got and answers(got) == []
        assert host.port.bus.counts["collisions"] == 1


def test_a_host_that_talks_into_an_answer_ruins_both() -> None:
    with open_host("twin://bench?servos=XM430-W350:1&return_delay=0") as host:
        host.port.write(encode(1, 1))
        host.wait(13 * BYTE)  # the answer has begun
        host.port.write(encode(1, 3, bytes((65, 0, 1))))
        assert answers(host.port.read(100)) == []
        assert host.read(1, "led") == 0
        assert host.port.bus.counts == {"frames": 2, "dropped": 0, "collisions": 1}


def test_at_another_baud_rate_nobody_answers_and_late_answers_are_noise() -> None:
    with open_host() as host:
        host.port.baudrate = 57600
        assert host.raw(encode(1, 1)) == b""
        host.port.baudrate = 1_000_000
        host.port.write(encode(1, 1))
        host.wait(11 * BYTE)
        host.port.baudrate = 2_000_000
        got = host.port.read(14)
        assert len(got) == 14 and answers(got) == []


def test_id_and_baud_change_behind_the_answer() -> None:
    with open_host() as host:
        assert host.write(1, "id", 9) == 0
        assert host.ask(1, 1) == []
        assert host.write(9, "baud_rate", 4) == 0
        assert host.ask(9, 1) == []
        host.port.baudrate = 2_000_000
        assert len(host.ask(9, 1)) == 1


def test_a_frame_in_pieces_is_heard_unless_the_pause_is_long() -> None:
    with open_host() as host:
        frame = encode(1, 1)
        host.port.write(frame[:6])
        host.wait(0.05)
        assert len(host.raw(frame[6:])) == 14
        host.port.write(frame[:6])
        host.wait(0.2)
        assert host.raw(frame[6:]) == b""


def test_faults_drop_and_corrupt_answers_the_same_way_every_time() -> None:
    url = "twin://bench?servos=XM430-W350:1&faults=drop:0.1,corrupt:0.1&seed=3"
    runs = []
    for _ in range(2):
        with open_host(url) as host:
            runs.append([host.raw(encode(1, 1), 14) for _ in range(300)])
            faults = host.port.world.faults.counts
    assert runs[0] == runs[1]
    assert sum(not got for got in runs[0]) == faults["drop"] == pytest.approx(30, abs=15)
    spoilt = sum(bool(got) and answers(got) == [] for got in runs[0])
    assert spoilt == faults["corrupt"] == pytest.approx(30, abs=15)


@settings(max_examples=30, deadline=None)
@given(st.lists(st.binary(max_size=40), max_size=6))
def test_no_bytes_of_a_host_break_the_bus(chunks: list[bytes]) -> None:
    with open_host("twin://bench?servos=XM430-W350:1-2") as host:
        for chunk in chunks:
            host.port.write(chunk)
            host.wait(0.001)
        host.wait(0.5)
        assert answers(host.raw(encode(1, 1))) == [1]


@settings(max_examples=60, deadline=None)
@given(
    st.sampled_from([1, 2, 3, 4, 5, 6, 8, 0x10, 0x82, 0x83, 0x8A, 0x92, 0x93, 0x9A]),
    st.sampled_from([1, 2, 254]),
    st.binary(max_size=30),
)
def test_no_parameters_break_an_instruction(
    instruction: int, identifier: int, parameters: bytes
) -> None:
    with open_host("twin://bench?servos=XM430-W350:1-2") as host:
        host.ask(identifier, instruction, parameters)
        host.wait(2.0)
