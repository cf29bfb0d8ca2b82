"""Control Table Backup (0x20), as the e-Manual of protocol 2 has it."""

from collections.abc import Iterator

import pytest

from tests.sim_twin.wire.wire_host import Host, open_host
from windup.sim_twin.wire.servos.register_file import BAD_INSTRUCTION, BAD_RANGE, FAILED, OK

XM, TWIN = 1, 2
BACKUP, REBOOT, FACTORY_RESET = 0x20, 0x08, 0x06
STORE, RESTORE = b"\x01CTRL", b"\x02CTRL"


@pytest.fixture
def host() -> Iterator[Host]:
    with open_host("twin://bench?servos=XM430-W350:1,2XL430:2&return_delay=0") as host:
        yield host


def ask(host: Host, instruction: int, data: bytes = b"", servo: int = XM) -> int:
    (answer,) = host.ask(servo, instruction, data)
    host.wait(0.5)
    return answer.parameters[0]


def test_the_manuals_packet_gets_the_manuals_answer(host: Host) -> None:
    done = bytes.fromhex("FF FF FD 00 01 04 00 55 00 A1 0C")
    store = bytes.fromhex("FF FF FD 00 01 08 00 20 01 43 54 52 4C 16 F5")
    assert host.raw(store) == done
    assert host.ask(XM, BACKUP, RESTORE)[0].parameters == b"\0"
    assert host.raw(store) == b""  # it reboots
    host.wait(0.5)
    assert host.raw(store) == done


def test_a_backup_brings_the_eeprom_back_and_the_ram_not(host: Host) -> None:
    host.write(XM, "homing_offset", 12)
    host.write(XM, "position_p_gain", 300)
    assert host.read(XM, "backup_ready") == 0
    assert ask(host, BACKUP, STORE) == OK
    assert host.read(XM, "backup_ready") == 1
    assert ask(host, FACTORY_RESET, b"\x02") == OK
    assert (host.read(XM, "homing_offset"), host.read(XM, "backup_ready")) == (0, 1)
    assert ask(host, BACKUP, RESTORE) == OK
    assert host.read(XM, "homing_offset") == 12
    assert host.read(XM, "position_p_gain") == 800


def test_the_startup_configuration_brings_the_ram_back(host: Host) -> None:
    host.write(XM, "startup_configuration", 2)
    host.write(XM, "position_p_gain", 300)
    host.write(XM, "profile_velocity", 50)
    host.write(XM, "indirect_address_168", 132)
    host.write(XM, "goal_position", 1000)
    assert ask(host, BACKUP, STORE) == OK
    host.write(XM, "position_p_gain", 400)
    assert ask(host, REBOOT) == OK
    assert host.read(XM, "position_p_gain") == 300
    assert host.read(XM, "profile_velocity") == 50
    assert host.read(XM, "indirect_address_168") == 132
    assert host.read(XM, "goal_position") == host.read(XM, "present_position") == 2048


def test_with_torque_on_or_nothing_stored_it_fails(host: Host) -> None:
    assert ask(host, BACKUP, RESTORE) == FAILED
    assert ask(host, BACKUP, b"\x01CTRX") == BAD_RANGE
    host.write(XM, "torque_enable", 1)
    assert ask(host, BACKUP, STORE) == FAILED
    assert host.read(XM, "backup_ready") == 0


def test_a_model_without_backup_ready_does_not_know_the_instruction(host: Host) -> None:
    assert ask(host, BACKUP, STORE, TWIN) == BAD_INSTRUCTION
