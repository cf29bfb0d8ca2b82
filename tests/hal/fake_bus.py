"""Scripted servos behind a fake pyserial object on a virtual clock: the smallest world that talks.

Every byte takes its time on the wire, reading waits for it, and nothing else passes time. Servos
are plain bytes without any rules. What goes wrong is said by attributes.
"""

from collections.abc import Callable

from windup.hal.port.port import Port
from windup.hal.protocols import protocol2
from windup.hal.protocols.crc16 import crc16

FAST_HEAD = bytes.fromhex("fffffd00fe")


class VirtualClock:
    def __init__(self) -> None:
        self.time = 100.0

    def now(self) -> float:
        return self.time

    def wait_until(self, time: float) -> None:
        self.time = max(self.time, time)


class FakeSerial:
    def __init__(self, ids: list[int], clock: VirtualClock | None = None) -> None:
        self.clock = clock or VirtualClock()
        self.baudrate = 1_000_000
        self.timeout: float | None = 0.0
        self.latency = 0.0
        self.memory = {id: self._fresh() for id in ids}
        self.error = dict.fromkeys(ids, 0)
        self.silent: set[int] = set()
        self.knows_fast = True
        self.baud_of_servos = 1_000_000
        self.spoil: Callable[[int, bytes], bytes] = lambda id, frame: frame
        self.requests: list[bytes] = []
        self.written: list[tuple[int, int, bytes]] = []
        self.writable = True
        self.arrivals: list[tuple[float, int]] = []
        self.is_open = True
        self.busy = 0.0  # until when what was written is on the wire, s

    @staticmethod
    def _fresh() -> bytearray:
        memory = bytearray(256)
        memory[0:2] = (1020).to_bytes(2, "little")
        memory[9], memory[11], memory[12], memory[63], memory[68] = 250, 3, 255, 0x34, 2
        memory[36:38] = memory[100:102] = (885).to_bytes(2, "little")
        memory[48:52] = (4095).to_bytes(4, "little")
        memory[84:86] = (800).to_bytes(2, "little")
        memory[132:136] = (2048).to_bytes(4, "little")
        memory[144:147] = bytes([120, 0, 35])
        return memory

    def put(self, id: int, address: int, value: int, size: int) -> None:
        data = value.to_bytes(size, "little", signed=value < 0)
        self.memory[id][address : address + size] = data

    def get(self, id: int, address: int, size: int, signed: bool = False) -> int:
        return int.from_bytes(self.memory[id][address : address + size], "little", signed=signed)

    # what pyserial offers

    def write(self, data: bytes) -> int:
        self.requests.append(bytes(data))
        begin = max(self.clock.time, self.busy) + len(data) * 10.0 / self.baudrate
        self.busy = begin
        if self.baudrate == self.baud_of_servos:
            for byte in self._answer(bytes(data)):
                begin += 10.0 / self.baudrate
                self.arrivals.append((begin, byte))
        return len(data)

    def read(self, size: int = 1) -> bytes:
        deadline = self.clock.time + (self.timeout or 0.0)
        due = [arrival for arrival in self.arrivals if arrival[0] <= deadline + 1e-12][:size]
        del self.arrivals[: len(due)]
        self.clock.wait_until(due[-1][0] if len(due) == size else deadline)
        return bytes(byte for _, byte in due)

    def reset_input_buffer(self) -> None:
        self.arrivals = [a for a in self.arrivals if a[0] > self.clock.time]

    def close(self) -> None:
        self.is_open = False

    # what servos do

    def _answer(self, data: bytes) -> bytes:
        length = int.from_bytes(data[5:7], "little")
        if data[:4] != protocol2.HEADER or crc16(data[:-2]) != int.from_bytes(data[-2:], "little"):
            return b""
        id, kind = data[4], data[7]
        body = protocol2.unstuff(data[8 : 5 + length])
        if id != protocol2.BROADCAST:
            return self._single(id, kind, body)
        start, size = int.from_bytes(body[0:2], "little"), int.from_bytes(body[2:4], "little")
        if kind == 0x01:
            return b"".join(self._single(each, kind, b"") for each in sorted(self.memory))
        if kind == 0x82:
            return b"".join(self._status(each, start, size) for each in body[4:])
        if kind == 0x83:
            for at in range(4, len(body), size + 1):
                self._store(body[at], start, body[at + 1 : at + 1 + size])
        if kind == 0x8A and self.knows_fast:
            return self._fast(body[4:], start, size)
        if kind == 0x92:
            rows = [body[at : at + 5] for at in range(0, len(body), 5)]
            word = int.from_bytes
            return b"".join(
                self._status(r[0], word(r[1:3], "little"), word(r[3:5], "little")) for r in rows
            )
        return b""

    def _single(self, id: int, kind: int, body: bytes) -> bytes:
        start = int.from_bytes(body[0:2], "little")
        if kind == 0x02:
            return self._status(id, start, int.from_bytes(body[2:4], "little"))
        if kind == 0x01:
            return self._reply(id, bytes([*self.memory[id][0:2], 45]) if id in self.memory else b"")
        if kind == 0x03:
            self._store(id, start, body[2:])
            if start == 7 and id in self.memory:
                self.memory[body[2]] = self.memory.pop(id)
                self.error[body[2]] = 0
                return protocol2.status(id)
        return self._reply(id, b"")

    def _store(self, id: int, start: int, data: bytes) -> None:
        if id in self.memory and id not in self.silent:
            self.written.append((id, start, data))
            if self.writable:
                self.memory[id][start : start + len(data)] = data

    def _status(self, id: int, start: int, size: int) -> bytes:
        return self._reply(
            id, bytes(self.memory[id][start : start + size]) if id in self.memory else b""
        )

    def _reply(self, id: int, params: bytes) -> bytes:
        if id not in self.memory or id in self.silent:
            return b""
        return self.spoil(id, protocol2.status(id, params, self.error[id]))

    def _fast(self, ids: bytes, start: int, size: int) -> bytes:
        """Each servo goes on where the one before it stopped; behind a missing one all is quiet."""
        frame = FAST_HEAD + (len(ids) * (size + 4) + 1).to_bytes(2, "little") + b"\x55"
        for id in ids:
            if id not in self.memory or id in self.silent:
                break
            frame += bytes([self.error[id], id, *self.memory[id][start : start + size]])
            frame += crc16(frame).to_bytes(2, "little")
        return frame


def fake_port(ids: list[int], clock: VirtualClock | None = None) -> tuple[FakeSerial, Port]:
    serial = FakeSerial(ids, clock)
    return serial, Port(serial, "fake://bus")
