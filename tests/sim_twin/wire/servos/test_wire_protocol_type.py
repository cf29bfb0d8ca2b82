"""X servos whose Protocol Type(13) is 1, spoken to by ROBOTIS' SDK."""

from collections.abc import Iterator
from contextlib import closing
from typing import Any

import pytest
from dynamixel_sdk import (
    COMM_RX_TIMEOUT,
    COMM_SUCCESS,
    GroupSyncWrite,
    Protocol1PacketHandler,
    Protocol2PacketHandler,
)

from tests.sim_twin.wire.wire_host import Host
from windup.hal.families.configurator import SdkPort
from windup.hal.port.open_port import open_port
from windup.sim_twin.wire.servos.health import OVERHEATING
from windup.sim_twin.wire.servos.protocol1_errors import ANGLE_LIMIT, INSTRUCTION, RANGE

PROTOCOL, SHADOW, TORQUE, LED, GOAL, POSITION, FURTHER = 13, 12, 64, 65, 116, 132, 634
OLD, NEW = Protocol1PacketHandler(), Protocol2PacketHandler()
DONE = (COMM_SUCCESS, 0)


@pytest.fixture
def port() -> Iterator[Any]:
    """Three servos, of which the second one has been told to speak protocol 1."""
    with closing(open_port("twin://bench?servos=XM430-W350:1-3")) as opened:
        sdk = SdkPort(opened)
        assert NEW.write1ByteTxRx(sdk, 2, PROTOCOL, 1) == DONE
        yield sdk


def host(port: Any) -> Host:
    return Host(port.port._serial)


def test_a_servo_set_to_protocol_1_hears_that_alone(port: Any) -> None:
    assert OLD.ping(port, 2) == (1020, *DONE)
    assert NEW.ping(port, 2)[1] == COMM_RX_TIMEOUT
    assert [NEW.ping(port, id)[0] for id in (1, 3)] == [1020, 1020]
    assert [OLD.ping(port, id)[1] for id in (1, 3)] == [COMM_RX_TIMEOUT] * 2


def test_reads_and_writes_in_protocol_1_are_of_the_same_registers(port: Any) -> None:
    assert OLD.write1ByteTxRx(port, 2, TORQUE, 1) == DONE
    assert OLD.write4ByteTxRx(port, 2, GOAL, 2500) == DONE
    host(port).wait(2.0)
    counts, *said = OLD.read4ByteTxRx(port, 2, POSITION)
    assert (tuple(said), counts) == (DONE, pytest.approx(2500, abs=3))


def test_a_sync_write_of_either_protocol_reaches_who_speaks_it(port: Any) -> None:
    for handler, ids in ((OLD, [2]), (NEW, [1, 3])):
        group = GroupSyncWrite(port, handler, LED, 1)
        for id in (1, 2, 3):
            group.addParam(id, [1])
        assert group.txPacket() == COMM_SUCCESS
        host(port).wait(0.01)
        on = [id for id in (1, 2, 3) if host(port).servo(id).registers.get("led")]
        assert on == ids
        for id in ids:
            host(port).servo(id).registers.set("led", 0)


def test_what_is_refused_is_said_in_the_bits_of_protocol_1(port: Any) -> None:
    assert OLD.write4ByteTxRx(port, 2, GOAL, 5000) == (COMM_SUCCESS, ANGLE_LIMIT)
    assert OLD.write1ByteTxRx(port, 2, LED, 2) == (COMM_SUCCESS, RANGE)
    assert OLD.txRxPacket(port, [0, 0, 2, 2, 0x55, 0])[1:] == (COMM_SUCCESS, INSTRUCTION)
    host(port).servo(2).firmware.health.inject(OVERHEATING)
    assert OLD.write1ByteTxRx(port, 2, LED, 1) == (COMM_SUCCESS, OVERHEATING)


def test_registers_from_256_on_are_out_of_reach_in_protocol_1(port: Any) -> None:
    host(port).servo(2).registers.set("indirect_data_634", 7)
    assert OLD.read1ByteTxRx(port, 2, FURTHER & 0xFF)[0] != 7


def test_a_second_id_in_protocol_1_gives_no_answers_and_no_access_to_the_eeprom(port: Any) -> None:
    assert OLD.write1ByteTxRx(port, 2, SHADOW, 9) == DONE
    assert OLD.write1ByteTxRx(port, 9, LED, 1)[0] == COMM_RX_TIMEOUT
    assert OLD.write1ByteTxRx(port, 9, SHADOW, 10)[0] == COMM_RX_TIMEOUT
    registers = host(port).servo(2).registers
    assert (registers.get("led"), registers.get("secondary_id")) == (1, 9)


def test_the_protocol_survives_a_power_cycle_and_can_be_taken_back(port: Any) -> None:
    servo = host(port).servo(2)
    servo.set_supply(0.0, host(port).now)
    servo.set_supply(12.0, host(port).now)
    host(port).wait(1.0)
    assert OLD.ping(port, 2) == (1020, *DONE)
    assert OLD.write1ByteTxRx(port, 2, PROTOCOL, 2) == DONE
    assert NEW.ping(port, 2) == (1020, *DONE)


def test_a_factory_reset_in_protocol_1_ends_it(port: Any) -> None:
    assert OLD.factoryReset(port, 2) == DONE
    host(port).wait(1.0)
    assert host(port).servo(1).identifier == 1
    servos = [d for d in host(port).world.devices if d.baud == 57_600]
    assert [(servo.identifier, servo.protocol) for servo in servos] == [(1, 2)]


def test_the_protocol_is_locked_while_torque_is_on(port: Any) -> None:
    assert OLD.write1ByteTxRx(port, 2, TORQUE, 1) == DONE
    assert OLD.write1ByteTxRx(port, 2, PROTOCOL, 2) == (COMM_SUCCESS, RANGE)
    assert OLD.ping(port, 2) == (1020, *DONE)


@pytest.mark.parametrize(("value", "takes"), [(1, False), (2, True), (3, False), (20, True)])
def test_an_x330_knows_no_protocol_1_but_those_of_remote_controls(value: int, takes: bool) -> None:
    with closing(open_port("twin://bench?servos=XL330-M288:1")) as opened:
        port = SdkPort(opened)
        assert (NEW.write1ByteTxRx(port, 1, PROTOCOL, value)[1] == 0) is takes
        assert NEW.ping(port, 1)[1] == COMM_SUCCESS
