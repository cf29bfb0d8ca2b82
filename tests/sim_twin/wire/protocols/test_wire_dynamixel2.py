"""Secondary ids and wrong CRCs on a protocol 2 bus, as the e-Manual has them."""

from collections.abc import Iterator

import pytest

from tests.sim_twin.wire.wire_host import Host, open_host
from windup.sim_twin.wire.protocols.frames import BROADCAST, encode, with_checksum
from windup.sim_twin.wire.servos.register_file import BAD_CRC, OK

GROUP = 100
WRITE, REG_WRITE, ACTION, FACTORY_RESET = 0x03, 0x04, 0x05, 0x06
SYNC_WRITE, BULK_WRITE, BACKUP = 0x83, 0x93, 0x20
LED, DRIVE_MODE = bytes((65, 0)), bytes((10, 0))


@pytest.fixture
def host() -> Iterator[Host]:
    with open_host("twin://bench?servos=XM430-W350:1-5&return_delay=0") as host:
        yield host


def group(host: Host, shadow: int) -> None:
    for k in range(1, 6):
        assert host.write(k, "secondary_id", shadow) == OK


def test_the_manuals_example(host: Host) -> None:
    group(host, 5)
    assert [frame.identifier for frame in host.ask(1, WRITE, LED + b"\1")] == [1]
    assert [host.read(k, "led") for k in range(1, 6)] == [1, 0, 0, 0, 0]
    assert [frame.identifier for frame in host.ask(5, WRITE, LED + b"\1")] == [5]
    assert [host.read(k, "led") for k in range(1, 6)] == [1] * 5
    group(host, GROUP)
    assert host.ask(GROUP, WRITE, LED + b"\0") == []
    assert [host.read(k, "led") for k in range(1, 6)] == [0] * 5


def test_a_secondary_id_gives_no_access_to_the_eeprom(host: Host) -> None:
    group(host, GROUP)
    write = DRIVE_MODE + b"\1"
    host.ask(GROUP, WRITE, write)
    host.ask(GROUP, REG_WRITE, write)
    host.ask(GROUP, ACTION)
    host.ask(GROUP, BACKUP, b"\x01CTRL")
    host.raw(encode(BROADCAST, SYNC_WRITE, bytes((10, 0, 1, 0, GROUP, 1))))
    host.raw(encode(BROADCAST, BULK_WRITE, bytes((GROUP, 10, 0, 1, 0, 1))))
    host.ask(GROUP, FACTORY_RESET, b"\x02")
    for k in range(1, 6):
        assert (host.read(k, "drive_mode"), host.read(k, "backup_ready")) == (0, 0)
        assert host.read(k, "secondary_id") == GROUP
    host.raw(encode(BROADCAST, SYNC_WRITE, bytes((10, 0, 1, 0, 3, 1))))
    assert [host.read(k, "drive_mode") for k in range(1, 6)] == [0, 0, 1, 0, 0]


def test_a_secondary_id_that_is_the_id_changes_nothing(host: Host) -> None:
    host.write(1, "secondary_id", 1)
    assert len(host.ask(1, 1)) == 1
    host.ask(1, WRITE, DRIVE_MODE + b"\1")
    assert host.read(1, "drive_mode") == 1


def test_a_wrong_crc_is_answered_by_its_id_and_not_obeyed(host: Host) -> None:
    frame = encode(2, WRITE, LED + b"\1")
    wrong = frame[:-1] + bytes((frame[-1] ^ 1,))
    answer = host.raw(wrong)
    assert answer == with_checksum(bytes.fromhex("FFFFFD00 02 0400 55 03 0000")) and BAD_CRC == 3
    assert host.read(2, "led") == 0
    for level in (0, 1):
        host.ask(2, WRITE, bytes((68, 0, level)))
        assert host.raw(wrong) == b""


def test_a_wrong_crc_to_all_or_to_a_secondary_id_is_not_answered(host: Host) -> None:
    group(host, GROUP)
    for identifier in (BROADCAST, GROUP, 77):
        frame = encode(identifier, WRITE, LED + b"\1")
        assert host.raw(frame[:-1] + bytes((frame[-1] ^ 1,))) == b""
