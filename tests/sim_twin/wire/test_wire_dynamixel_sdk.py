"""Every call of dynamixel-sdk on emulated servos, in real time and on a virtual clock."""

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import dynamixel_sdk as sdk
import pytest

from tests.sim_twin.wire.clients.record import calls, recorded
from tests.sim_twin.wire.emulator_process import emulator
from windup.tools.testing.servo_bus import ServoBus

OK, NOT_AVAILABLE = sdk.COMM_SUCCESS, sdk.COMM_NOT_AVAILABLE
GROUPS = ("GroupSyncRead", "GroupSyncWrite", "GroupBulkRead", "GroupBulkWrite")
PATIENCE = 30.0  # s, for a busy machine


class Bus(NamedTuple):
    """A protocol, servos that speak it, and registers of one, two and four bytes that they keep."""

    version: float
    servos: str
    model: int
    places: dict[int, int]


X = Bus(2.0, "XM430-W350:1-2", 1020, {1: 65, 2: 84, 4: 112})
MX = Bus(1.0, "MX-28:1-2", 29, {1: 25, 2: 32, 4: 30})


class Sdk:
    """A handler on an open port, which notes what has been called."""

    def __init__(self, bus: Bus, path: str, port_handler: type[Any] = sdk.PortHandler) -> None:
        port, self.port_called = recorded(port_handler)
        self.kind = type(sdk.PacketHandler(bus.version))
        handler, self.called = recorded(self.kind)
        self.bus, self.port, self.handler = bus, port(path), handler()
        self.port.setPortName(path)
        self.port.openPort()
        self.port.setBaudRate(1_000_000)

    def __call__(self, name: str, *arguments: Any) -> Any:
        return getattr(self.handler, name)(self.port, *arguments)

    def take_answer(self) -> None:
        """Take what a servo answers to a call that does not wait for it."""
        self.port.setPacketTimeout(20)
        fast = (False,) if self.bus.version == 2.0 else ()
        assert self("rxPacket", *fast)[1] == OK

    def uncalled(self) -> set[str]:
        return (calls(self.kind) - self.called) | (calls(sdk.PortHandler) - self.port_called)


@pytest.fixture(params=[X, MX], ids=["protocol 2", "protocol 1"])
def bus(request: pytest.FixtureRequest) -> Bus:
    found: Bus = request.param
    return found


@pytest.fixture(params=["path", "virtual clock"])
def open_sdk(
    bus: Bus, tmp_path: Path, request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Sdk]:
    if request.param == "virtual clock":
        with ServoBus(servos=bus.servos, return_delay=0) as world:
            yield Sdk(bus, "whatever", world.port_handler("dynamixel"))
        return
    monkeypatch.setattr(sdk.port_handler, "LATENCY_TIMER", 1000)
    with emulator(f"twin://bench?servos={bus.servos}&return_delay=0", tmp_path / "bus") as name:
        made = Sdk(bus, name)
        yield made
        made.port.closePort()


def wait_for(what: Callable[[], bool]) -> None:
    deadline = time.monotonic() + PATIENCE
    while not what():
        assert time.monotonic() < deadline


def test_it_makes_every_call(open_sdk: Sdk) -> None:
    check_words(open_sdk)
    for size, address in open_sdk.bus.places.items():
        check_reads_and_writes(open_sdk, size, address)
    check_registered(open_sdk)
    if open_sdk.bus is X:
        check_groups(open_sdk)
        check_what_only_protocol_2_has(open_sdk)
    else:
        check_what_protocol_1_has_not(open_sdk)
    assert open_sdk.uncalled() == set()


def check_words(it: Sdk) -> None:
    assert it.handler.getProtocolVersion() == it.bus.version
    assert it.handler.getTxRxResult(OK).endswith("success!")
    assert it.handler.getRxPacketError(1)
    assert it.port.getPortName() and it.port.getBaudRate() == 1_000_000
    it.port.setPacketTimeoutMillis(0)
    wait_for(it.port.isPacketTimeout)
    assert it.port.getBytesAvailable() == 0
    assert it("ping", 1) == (it.bus.model, OK, 0)


def check_reads_and_writes(it: Sdk, size: int, address: int) -> None:
    """Write and read a register in each way."""
    for value, way in ((1, "TxRx"), (0, "TxOnly")):
        done = it(f"write{size}Byte{way}", 1, address, value)
        assert done == ((OK, 0) if way == "TxRx" else OK)
        it.take_answer() if way == "TxOnly" else None
        assert it(f"read{size}ByteTxRx", 1, address) == (value, OK, 0)
    assert it("writeTxRx", 1, address, size, [1] + [0] * (size - 1)) == (OK, 0)
    assert it(f"read{size}ByteTx", 1, address) == OK
    assert it(f"read{size}ByteRx", 1) == (1, OK, 0)
    assert it("writeTxOnly", 1, address, size, [0] * size) == OK
    it.take_answer()
    assert it("readTx", 1, address, size) == OK
    assert list(it("readRx", 1, size)[0]) == [0] * size
    assert list(it("readTxRx", 1, address, size)[0]) == [0] * size


def check_registered(it: Sdk) -> None:
    """Registered writes wait for the action."""
    address = it.bus.places[1]
    for value, way in ((1, "TxRx"), (0, "TxOnly")):
        it(f"regWrite{way}", 1, address, 1, [value])
        it.take_answer() if way == "TxOnly" else None
        assert it("read1ByteTxRx", 1, address)[0] == 1 - value
        assert it("action", sdk.BROADCAST_ID) == OK
        assert it("read1ByteTxRx", 1, address)[0] == value
    assert it("syncWriteTxOnly", address, 1, [1, 1, 2, 1], 4) == OK
    assert [it("read1ByteTxRx", id, address)[0] for id in (1, 2)] == [1, 1]


def check_groups(it: Sdk) -> None:
    """Write and read two servos together, with others put in and taken out."""
    called: dict[str, set[str]] = {}
    for name in GROUPS:
        kind, called[name] = recorded(getattr(sdk, name))
        sync, writes = "Sync" in name, "Write" in name
        group = kind(it.port, it.handler, *((84, 2) if sync else ()))
        place = () if sync else (84, 2)
        group.addParam(9, *place, *([bytes(2)] if writes else []))
        group.clearParam()
        for id in (1, 2, 9):
            group.addParam(id, *place, *([bytes(2)] if writes else []))
            if writes:
                group.changeParam(id, *place, (500 + id).to_bytes(2, "little"))
        group.removeParam(9)
        if writes:
            assert group.txPacket() == OK
            assert [it("read2ByteTxRx", id, 84)[0] for id in (1, 2)] == [501, 502]
            it("write2ByteTxRx", 1, 84, 501 if sync else 600)
            continue
        for ask in (group.txRxPacket, group.fastSyncRead if sync else group.fastBulkRead):
            assert ask() == OK
            assert group.isAvailable(1, 84, 2) and not group.isAvailable(9, 84, 2)
            assert group.getData(2, 84, 2) == it("read2ByteTxRx", 2, 84)[0]
    assert {name: calls(getattr(sdk, name)) - called[name] for name in GROUPS} == {
        name: set[str]() for name in GROUPS
    }


def check_what_only_protocol_2_has(it: Sdk) -> None:
    wait_for(lambda: {1, 2} == set(it("broadcastPing")[0]))
    assert it("clearMultiTurn", 1) == (OK, 0)
    assert it("write1ByteTxRx", 2, 9, 3) == (OK, 0)  # return delay
    assert it("reboot", 2) == (OK, 0)
    wait_for(lambda: it("ping", 2)[1] == OK)
    assert it("read1ByteTxRx", 2, 65)[0] == 0
    assert it("factoryReset", 2, 2) == (OK, 0)  # all but id and baud rate
    wait_for(lambda: it("ping", 2)[1] == OK)
    assert it("read1ByteTxRx", 2, 9)[0] == 250


def check_what_protocol_1_has_not(it: Sdk) -> None:
    assert it("broadcastPing")[1] == it("reboot", 2)[0] == NOT_AVAILABLE
    assert it("syncReadTx", 36, 2, [1, 2], 2) == NOT_AVAILABLE
    assert it("bulkWriteTxOnly", [], 0) == NOT_AVAILABLE
    assert it("bulkReadTx", [2, 1, 36, 2, 2, 36], 6) == OK
    assert [len(it("readRx", id, 2)[0]) for id in (1, 2)] == [2, 2]
    it("factoryReset", 1)
    it.port.setBaudRate(57_600)
    wait_for(lambda: it("ping", 1)[1] == OK)
