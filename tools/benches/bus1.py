"""The bus benchmark of protocol 1: STS beside feetech-servo-sdk, MX beside dynamixel-sdk.

One cycle reads position, velocity and load of n servos and writes n goals: with a sync read on
Feetech servos, with a bulk read on Dynamixels. See `windup.tools.benches.bus` for the method.
"""

import contextlib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import scservo_sdk
from dynamixel_sdk import GroupBulkRead, GroupSyncWrite, PortHandler, Protocol1PacketHandler
from scservo_sdk.protocol_packet_handler import protocol_packet_handler

from windup.hal.bus.transactions import BusTransactions
from windup.hal.command import JointCommand
from windup.hal.families import DYNAMIXEL_1, FEETECH_STS, Family, servo_model
from windup.hal.joints import Joint, Joints
from windup.hal.port.open_port import open_port
from windup.hal.port.port import Port
from windup.hal.protocols import protocol1
from windup.hal.protocols.protocol1 import Instruction
from windup.hal.servo_bus.servo_backend import BusPort, ServoBackend
from windup.hal.servos.servo_model import ServoMount

Vendor = Literal["feetech", "dynamixel1"]
Cycle = Callable[[], None]
BAUD = 1_000_000
ATTEMPTS = 5
STATE = b"\x00\x08\x00\x00\x00\x00\x4a\x23"
"""Position 2048, no velocity, no load, 7.4 V, 35 degrees C."""
STS_MEMORY = bytes(40) + b"\x01".ljust(8, b"\0") + b"\xe7\x03".ljust(8, b"\0") + STATE
MX_MEMORY = bytes(24) + b"\x01".ljust(10, b"\0") + b"\xfe\x03" + STATE
"""The same at the servos' addresses, with torque on and the mark of an armed servo."""


@dataclass(frozen=True)
class VendorCycle:
    """The subject of a measurement: one model of one family, and the maker's SDK."""

    model: str
    family: Family
    sdk_cycle: Callable[[Any, list[int], Family], Cycle]
    sdk_port: Callable[[str], Any]
    rustypot: str | None


def subjects(vendor: Vendor, ids: list[int]) -> dict[str, Cycle]:
    """Return the cycles to measure with prepared answers in memory."""
    maker = MAKERS[vendor]
    return {
        "sdk": maker.sdk_cycle(_over_canned(maker.sdk_port("canned")), ids, maker.family),
        "codec": codec_cycle(Port(_Canned(), "canned"), ids, maker.family),
        "backend": backend_cycle(Port(_Canned(), "canned"), ids, maker),
    }


def pty_subjects(
    vendor: Vendor, ids: list[int], paths: list[str], stack: contextlib.ExitStack
) -> dict[str, Cycle]:
    """Return the cycles to measure over the four pseudo-terminals at `paths`."""
    maker = MAKERS[vendor]
    sdk = maker.sdk_port(paths[0])
    sdk.baudrate = BAUD
    sdk.openPort()
    stack.callback(sdk.closePort)
    ports = [stack.enter_context(open_port(path, BAUD)) for path in paths[1:3]]
    found = {
        "sdk": maker.sdk_cycle(sdk, ids, maker.family),
        "codec": codec_cycle(ports[0], ids, maker.family),
        "backend": backend_cycle(ports[1], ids, maker),
    }
    if (rusty := _rustypot_cycle(maker, paths[3], ids)) is not None:
        found["rustypot"] = rusty
    return found


def wire_bytes(vendor: Vendor, servos: int = 20) -> int:
    """Return the number of bytes in one cycle: request, answers and goals."""
    family, ids = MAKERS[vendor].family, list(range(1, servos + 1))
    read = family.protocol.read([family.state.span(id) for id in ids], fast=True)
    goals = family.protocol.write(ids, family.registers["goal_position"])
    return len(read.request) + read.length + sum(map(len, goals.frames()))


def answer(request: bytes) -> bytes:
    """Return the answer of healthy servos to one of the cyclic requests."""
    kind, body = request[4], request[5:-1]
    if kind == Instruction.SYNC_READ:
        data = STS_MEMORY[body[0] : body[0] + body[1]]
        return b"".join(protocol1.status(id, data) for id in body[2:])
    if kind == Instruction.BULK_READ:
        rows = [body[at : at + 3] for at in range(1, len(body), 3)]
        return b"".join(protocol1.status(id, MX_MEMORY[at : at + size]) for size, id, at in rows)
    if kind == Instruction.READ:
        return protocol1.status(request[2], STS_MEMORY[body[0] : body[0] + body[1]])
    return b""


def codec_cycle(port: Port, ids: list[int], family: Family) -> Cycle:
    """Return our cycle without the backend: exchange, codec, integers in arrays."""
    exchange, block = BusTransactions(port), family.state
    read = family.protocol.read([block.span(id) for id in ids], fast=True)
    write = family.protocol.write(ids, family.registers["goal_position"])
    goal = np.full(len(ids), 2048)

    def cycle() -> None:
        exchange.request(read)
        if not exchange.collect().all():
            raise RuntimeError("our read failed")
        block.counts(read.payload.view(block.dtype))
        write.values[:] = goal
        exchange.send(write.frames())

    return cycle


def backend_cycle(port: Port, ids: list[int], maker: VendorCycle) -> Cycle:
    """Return a whole tick of `ServoBackend`: observation in SI, joint command, goals."""
    model = servo_model(maker.model)
    stiffness = model.stiffness(32, 12.0)
    joints = Joints(tuple(Joint(f"j{id}", -1.5, 1.5, stiffness, 0.85) for id in ids))
    mounts = [ServoMount(model, "body", id, 1, 2048, 1.0) for id in ids]
    backend = ServoBackend(
        joints, mounts, {"body": BusPort("canned", BAUD)}, opener=lambda url, baud: port
    )
    backend.connect()
    backend.readouts[0].reads.probe_fast()
    backend.links[0].torque.powered = True
    command = JointCommand.hold(joints, np.zeros(len(ids)))

    def cycle() -> None:
        backend.read()
        backend.write(command)

    return cycle


def _feetech_cycle(port: Any, ids: list[int], family: Family) -> Cycle:
    packets, block = protocol_packet_handler(), family.state
    read = scservo_sdk.GroupSyncRead(port, packets, block.address, block.size)
    return _sdk_cycle(read, scservo_sdk.GroupSyncWrite(port, packets, 42, 2), ids, block.address)


def _dynamixel_cycle(port: Any, ids: list[int], family: Family) -> Cycle:
    packets, block = Protocol1PacketHandler(), family.state
    read = _BulkRead(port, packets)
    for id in ids:
        read.addParam(id, block.address, block.size)
    return _sdk_cycle(read, GroupSyncWrite(port, packets, 30, 2), ids, block.address)


class _BulkRead(GroupBulkRead):  # type: ignore[misc]  # the SDK has no types
    """The SDK's bulk read, without the surplus argument that makes it fail in protocol 1."""

    def txPacket(self) -> Any:  # noqa: N802 - the SDK's name
        if self.is_param_changed or not self.param:
            self.makeParam()
        return self.ph.bulkReadTx(self.port, self.param, len(self.param))


def _sdk_cycle(read: Any, write: Any, ids: list[int], address: int) -> Cycle:
    goal = [0x00, 0x08]
    for id in ids:
        if isinstance(read, scservo_sdk.GroupSyncRead):
            read.addParam(id)
        write.addParam(id, goal)

    def cycle() -> None:
        # Its time-out is short for a machine that is busy now and then.
        if all(read.txRxPacket() != 0 for _ in range(ATTEMPTS)):
            raise RuntimeError("the SDK's read failed")
        for id in ids:
            for offset in (0, 2, 4):
                read.getData(id, address + offset, 2)
            write.changeParam(id, goal)
        write.txPacket()

    return cycle


def _rustypot_cycle(maker: VendorCycle, path: str, ids: list[int]) -> Cycle | None:
    """Return rustypot's raw cycle, or None where it is missing or has no such servo."""
    try:
        import rustypot
    except ImportError:
        return None
    if maker.rustypot is None:
        return None
    bus = getattr(rustypot, maker.rustypot)(path, BAUD, 0.1)
    block, goal = maker.family.state, maker.family.registers["goal_position"].address
    goals = [[0x00, 0x08]] * len(ids)

    def cycle() -> None:
        bus.sync_read_raw_data(ids, block.address, block.size)
        bus.sync_write_raw_data(ids, goal, goals)

    return cycle


class _Canned:
    """A pyserial port whose answers are in the buffer as soon as the request is written."""

    def __init__(self) -> None:
        self.baudrate, self.latency = BAUD, 0.0
        self.timeout: float | None = 0.0
        self._answers: dict[bytes, bytes] = {}
        self._left = b""

    def write(self, data: bytes, /) -> int:
        if data[4] != Instruction.SYNC_WRITE:
            if data not in self._answers:
                self._answers[data] = answer(data)
            self._left = self._answers[data]
        return len(data)

    def read(self, size: int = 1, /) -> bytes:
        data, self._left = self._left[:size], self._left[size:]
        return data

    def reset_input_buffer(self) -> None:
        pass

    def close(self) -> None:
        pass


def _over_canned(port: Any) -> Any:
    """Return an SDK's port with prepared answers; the rest is the SDK's own code."""
    canned = _Canned()
    port.ser, port.is_open, port.tx_time_per_byte = canned, True, 10e3 / BAUD
    port.readPort = canned.read
    port.writePort = lambda packet: canned.write(bytes(packet))
    port.clearPort = canned.reset_input_buffer
    return port


MAKERS: dict[Vendor, VendorCycle] = {
    "feetech": VendorCycle(
        "STS3215-7.4V",
        FEETECH_STS,
        _feetech_cycle,
        scservo_sdk.PortHandler,
        "Sts3215PyController",
    ),
    "dynamixel1": VendorCycle("MX-28", DYNAMIXEL_1, _dynamixel_cycle, PortHandler, None),
}
