"""Measures the processor time of a bus cycle, beside dynamixel-sdk and rustypot.

One cycle reads current, velocity and position of n servos and writes n goals. Every function
returns a dict of microseconds of processor time per cycle: the median of interleaved rounds. On a
busy machine only the ratios are reliable. The answers are prepared beforehand, so neither wire time
nor an emulator is included.
"""

import contextlib
import os
import pty
import struct
import subprocess
import sys
import time
import tty
from collections.abc import Callable, Iterator, Mapping

import numpy as np
from dynamixel_sdk import GroupSyncRead, GroupSyncWrite, PortHandler, Protocol2PacketHandler

from windup.hal.bus.transactions import BusTransactions
from windup.hal.command import JointCommand
from windup.hal.families import servo_model
from windup.hal.joints import Joint, Joints
from windup.hal.port.open_port import open_port
from windup.hal.port.port import Port
from windup.hal.protocols import protocol2
from windup.hal.protocols.batched import BlockRead, BlockWrite
from windup.hal.protocols.crc16 import crc16
from windup.hal.protocols.protocol2 import Instruction, Span
from windup.hal.servo_bus.servo_backend import BusPort, ServoBackend
from windup.hal.servos.servo_model import ServoMount
from windup.tools.benches import bus1 as bench_bus1
from windup.tools.benches.bus1 import Vendor

STATE, SIZE = 126, 10
GOAL = 116
BAUD = 4_000_000
READY = b"r"
MEMORY = bytes(64) + b"\x01" + bytes(61) + struct.pack("<hii", -12, 34, 2048) + bytes(range(80, 96))
"""Contents of the servos' registers: torque on, and the measured values from address 126."""
Cycle = Callable[[], None]


def bench_memory(
    servos: int = 20, rounds: int = 9, cycles: int = 100, vendor: Vendor | None = None
) -> dict[str, float]:
    """Measure the codecs alone: prepared answers in memory, without system calls.

    `vendor` selects a maker's protocol 1; None is Dynamixel protocol 2.

    Returns:
        Microseconds of processor time per cycle for "sdk", "codec", "codec fast" (of protocol 2),
        "backend".
    """
    ids = list(range(1, servos + 1))
    if vendor is not None:
        return interleaved(bench_bus1.subjects(vendor, ids), rounds, cycles)
    return interleaved(
        {
            "sdk": _sdk_cycle(_CannedSdkPort(ids), ids),
            "codec": _codec_cycle(Port(_Canned(ids), "canned"), ids),
            "codec fast": _codec_cycle(Port(_Canned(ids), "canned"), ids, fast=True),
            "backend": _backend_cycle(Port(_Canned(ids), "canned"), ids),
        },
        rounds,
        cycles,
    )


def bench_pty(
    servos: int = 20, rounds: int = 9, cycles: int = 100, vendor: Vendor | None = None
) -> dict[str, float]:
    """Measure with system calls, over a pseudo-terminal to a process that answers at once.

    Returns:
        As `bench_memory`, and also "rustypot" where that is installed.
    """
    ids = list(range(1, servos + 1))
    with contextlib.ExitStack() as stack:
        paths = [stack.enter_context(_responder()) for _ in range(5)]
        if vendor is not None:
            others = bench_bus1.pty_subjects(vendor, ids, paths, stack)
            return interleaved(others, rounds, cycles)
        sdk = PortHandler(paths[0])
        sdk.baudrate = BAUD
        sdk.openPort()
        stack.callback(sdk.closePort)
        ports = [stack.enter_context(open_port(path, BAUD)) for path in paths[1:4]]
        subjects = {
            "sdk": _sdk_cycle(sdk, ids),
            "codec": _codec_cycle(ports[0], ids),
            "codec fast": _codec_cycle(ports[1], ids, fast=True),
            "backend": _backend_cycle(ports[2], ids),
        }
        if (rusty := _rustypot_cycle(paths[4], ids)) is not None:
            subjects["rustypot"] = rusty
        return interleaved(subjects, rounds, cycles)


def interleaved(subjects: Mapping[str, Cycle], rounds: int, cycles: int) -> dict[str, float]:
    """Return the median processor time per cycle of each subject, microseconds."""
    times: dict[str, list[float]] = {name: [] for name in subjects}
    for cycle in subjects.values():
        cycle()
    for _ in range(rounds):
        for name, cycle in subjects.items():
            start = time.process_time()
            for _ in range(cycles):
                cycle()
            times[name].append((time.process_time() - start) / cycles)
    return {name: float(np.median(each)) * 1e6 for name, each in times.items()}


def wire_bytes(servos: int = 20, fast: bool = False, vendor: Vendor | None = None) -> int:
    """Return the number of bytes in one cycle: request, answers and goals."""
    if vendor is not None:
        return bench_bus1.wire_bytes(vendor, servos)
    ids = range(1, servos + 1)
    read = BlockRead([Span(id, STATE, SIZE) for id in ids], fast)
    return len(read.request) + read.length + len(BlockWrite(list(ids), GOAL, 4).frame())


def respond(descriptor: int) -> None:
    """Answer reads on `descriptor` for ever, at once, with prepared bytes."""
    canned: dict[bytes, bytes] = {}
    pending = b""
    os.write(descriptor, READY)
    while data := os.read(descriptor, 4096):
        pending += data
        while len(pending) >= 7 or (len(pending) >= 6 and pending[2] != 0xFD):
            newer = pending[2] == 0xFD  # else protocol 1, where no servo here has this id
            end = 7 + int.from_bytes(pending[5:7], "little") if newer else 4 + pending[3]
            if len(pending) < end:
                break
            request, pending = pending[:end], pending[end:]
            if request not in canned:
                canned[request] = _answer(request) if newer else bench_bus1.answer(request)
            if answer := canned.get(request):
                os.write(descriptor, answer)


def _answer(request: bytes) -> bytes:
    """Return the answer of healthy servos to one of the cyclic requests."""
    kind, body = request[7], request[8:-2]
    start, size = struct.unpack_from("<HH", body)
    data = MEMORY[start : start + size]
    if kind == Instruction.SYNC_READ:
        return b"".join(protocol2.status(id, data) for id in body[4:])
    if kind == Instruction.BULK_READ:
        rows = struct.iter_unpack("<BHH", body)
        return b"".join(protocol2.status(id, MEMORY[at : at + length]) for id, at, length in rows)
    if kind == Instruction.FAST_SYNC_READ:
        frame = protocol2.HEADER + b"\xfe"
        frame += (len(body[4:]) * (size + 4) + 1).to_bytes(2, "little") + b"\x55"
        for id in body[4:]:
            frame += bytes([0, id]) + data
            frame += crc16(frame).to_bytes(2, "little")
        return frame
    return b""


class _Canned:
    """A pyserial port whose answers are in the buffer as soon as the request is written."""

    def __init__(self, ids: list[int]) -> None:
        self.baudrate, self.latency = BAUD, 0.0
        self.timeout: float | None = 0.0
        self._answers: dict[bytes, bytes] = {}
        self._left = b""

    def write(self, data: bytes, /) -> int:
        if data[7] != Instruction.SYNC_WRITE:
            if data not in self._answers:
                self._answers[data] = _answer(data)
            self._left = self._answers[data]
        return len(data)

    def read(self, size: int = 1, /) -> bytes:
        data, self._left = self._left[:size], self._left[size:]
        return data

    def reset_input_buffer(self) -> None:
        pass

    def close(self) -> None:
        pass


class _CannedSdkPort(PortHandler):  # type: ignore[misc]  # the SDK has no types
    """The SDK's port with the same prepared answers; the rest is the SDK's own code."""

    def __init__(self, ids: list[int]) -> None:
        super().__init__("canned")
        self.ser, self.is_open = _Canned(ids), True
        self.tx_time_per_byte = 10e3 / BAUD

    def readPort(self, length: int) -> bytes:  # noqa: N802 - the SDK's name
        return self.ser.read(length)

    def writePort(self, packet: list[int]) -> int:  # noqa: N802
        return self.ser.write(bytes(packet))


def _sdk_cycle(port: PortHandler, ids: list[int]) -> Cycle:
    """Return the SDK's cycle: grouped read, three values per servo, grouped write."""
    packets = Protocol2PacketHandler()
    read = GroupSyncRead(port, packets, STATE, SIZE)
    write = GroupSyncWrite(port, packets, GOAL, 4)
    for id in ids:
        read.addParam(id)
        write.addParam(id, bytes(4))
    goal = (2048).to_bytes(4, "little")

    def cycle() -> None:
        if read.txRxPacket() != 0:
            raise RuntimeError("the SDK's sync read failed")
        for id in ids:
            read.getData(id, 126, 2)
            read.getData(id, 128, 4)
            read.getData(id, 132, 4)
            write.changeParam(id, goal)
        write.txPacket()

    return cycle


def _codec_cycle(port: Port, ids: list[int], fast: bool = False) -> Cycle:
    """Return our cycle without the backend: exchange, codec, integers in arrays."""
    exchange = BusTransactions(port)
    read = BlockRead([Span(id, STATE, SIZE) for id in ids], fast)
    write = BlockWrite(ids, GOAL, 4)
    goal = np.full(len(ids), 2048)

    def cycle() -> None:
        exchange.request(read)
        if not exchange.collect().all():
            raise RuntimeError("our sync read failed")
        write.values[:] = goal
        exchange.send([write.frame()])

    return cycle


def _backend_cycle(port: Port, ids: list[int]) -> Cycle:
    """Return a whole tick of `ServoBackend`: observation in SI, joint command, goals."""
    model = servo_model("XM430-W350")
    joints = Joints(tuple(Joint(f"j{id}", -1.5, 1.5, 18.876, 0.85) for id in ids))
    mounts = [ServoMount(model, "body", id, 1, 2048, 1.0) for id in ids]
    backend = ServoBackend(
        joints, mounts, {"body": BusPort("canned", BAUD)}, opener=lambda url, baud: port
    )
    backend.connect()
    backend.links[0].torque.powered = backend.links[0].torque.armed = True
    command = JointCommand.hold(joints, np.zeros(len(ids)))

    def cycle() -> None:
        backend.read()
        backend.write(command)

    return cycle


def _rustypot_cycle(path: str, ids: list[int]) -> Cycle | None:
    """Return rustypot's raw cycle, or None where it is not installed."""
    try:
        from rustypot import Xl330PyController
    except ImportError:
        return None
    bus = Xl330PyController(path, BAUD, 0.1)
    goals = [list((2048).to_bytes(4, "little"))] * len(ids)

    def cycle() -> None:
        bus.sync_read_raw_data(ids, STATE, SIZE)
        bus.sync_write_raw_data(ids, GOAL, goals)

    return cycle


@contextlib.contextmanager
def _responder() -> Iterator[str]:
    """Serve one pseudo-terminal from a process of its own; yield its path."""
    master, slave = pty.openpty()
    tty.setraw(slave)
    code = f"from windup.tools.benches.bus import respond; respond({master})"
    process = subprocess.Popen([sys.executable, "-c", code], pass_fds=[master])
    try:
        os.read(slave, len(READY))
        yield os.ttyname(slave)
    finally:
        process.kill()
        process.wait()
        os.close(master)
        os.close(slave)
