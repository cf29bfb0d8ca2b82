"""Servo configuration through dynamixel-sdk, on a `Port` and its clock, with SDK defects fixed.

The fixes do not change the installed package. Defects of the SDK: it sends payloads without byte
stuffing and unstuffs wrongly; it polls the wall clock, so virtual time would never advance; it
opens ports itself and reopens them to change the baud rate; its timeouts assume 16 ms of latency
for every adapter; an exception leaves its port marked as in use forever.
"""

import contextlib
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from dynamixel_sdk import COMM_RX_CORRUPT, COMM_RX_TIMEOUT, COMM_SUCCESS
from dynamixel_sdk.port_handler import PortHandler
from dynamixel_sdk.protocol2_packet_handler import Protocol2PacketHandler

from windup.hal.errors import CorruptAnswerError, NoAnswerError, ServoRejectionError
from windup.hal.heartbeat import no_heartbeat
from windup.hal.port.port import BITS, Port
from windup.hal.protocols import protocol2

QUIET = 20e-3
"""Silence, in addition to the adapter's latency, after which no late answer is expected, s."""
NOISY = 0.1
"""Maximum time to wait for silence on a noisy line, s."""
SLACK = 10e-3
"""Time a servo may take to write its EEPROM before it answers, s."""
ATTEMPTS = 3

REFUSALS = {
    1: "could not process the instruction",
    2: "does not know the instruction",
    3: "received a wrong checksum",
    4: "says the value is out of range",
    5: "says the length is wrong",
    6: "says the value is beyond its limit",
    7: "says the register is locked (torque on?) or read-only",
}


class SdkPort(PortHandler):  # type: ignore[misc]  # the SDK has no types
    """Implements the SDK's port interface with a `Port`. Times are in ms, as in the SDK."""

    def __init__(self, port: Port) -> None:
        super().__init__(port.url)
        self.port = port
        self.baudrate = port.baud
        self.is_open = True
        self._sent = b""
        self._ahead: bytes | None = None  # bytes read ahead; None before the echo check

    def openPort(self) -> bool:  # noqa: N802 - the SDK's name, as all below
        """Do nothing: the port is open already."""
        return True

    def closePort(self) -> None:  # noqa: N802
        """Do nothing: the port is closed by the code that opened it."""

    def clearPort(self) -> None:  # noqa: N802
        """Discard received bytes."""
        self.port.flush_input()

    def setBaudRate(self, baudrate: int) -> bool:  # noqa: N802
        """Change the baud rate of the open port."""
        self.port.baud = self.baudrate = baudrate
        return True

    def getBytesAvailable(self) -> int:  # noqa: N802
        """Return 0: no bytes are buffered for the SDK to poll."""
        return 0

    def readPort(self, length: int) -> bytes:  # noqa: N802
        """Wait for `length` bytes until the packet timeout; blocking lets virtual time advance.

        An echo of the request is removed: in protocol 1 it looks like an answer.
        """
        deadline = (self.packet_start_time + self.packet_timeout) * 1e-3
        if self._ahead is None:
            self._ahead = b""
            stream = self.port.read(length, deadline)
            if stream and self._sent.startswith(stream):
                stream += self.port.read(len(self._sent) - len(stream), deadline)
            self._ahead = stream.removeprefix(self._sent)
        got, self._ahead = self._ahead[:length], self._ahead[length:]
        return got + self.port.read(length - len(got), deadline) if len(got) < length else got

    def writePort(self, packet: list[int]) -> int:  # noqa: N802
        """Send the whole packet, or raise."""
        self._sent, self._ahead = bytes(packet), None
        self.port.write(self._sent)
        return len(packet)

    def setPacketTimeout(self, packet_length: int) -> None:  # noqa: N802
        """Set the timeout to the wire time of request and answer, adapter latency and slack."""
        wire = (2 * len(self._sent) + packet_length) * BITS / self.port.baud
        self.setPacketTimeoutMillis((wire + 2.0 * self.port.latency + SLACK) * 1e3)

    def isPacketTimeout(self) -> bool:  # noqa: N802
        """Return whether the packet timeout has passed; reads block until then."""
        return bool(self.getTimeSinceStart() >= self.packet_timeout - 1e-6)

    def getCurrentTime(self) -> float:  # noqa: N802
        """Return the port's time, ms."""
        return self.port.clock.now() * 1e3


class SdkPackets(Protocol2PacketHandler):  # type: ignore[misc]  # the SDK has no types
    """The SDK's packet handler with correct byte stuffing and unstuffing."""

    def addStuffing(self, packet: list[int]) -> list[int]:  # noqa: N802
        """Stuff the packet in place, because the caller ignores the result."""
        end = 7 + packet[5] + (packet[6] << 8) - 2
        body = protocol2.stuff(bytes(packet[7:end]))
        packet[5:] = [*(len(body) + 2).to_bytes(2, "little"), *body, 0, 0]
        return packet

    def removeStuffing(self, packet: list[int]) -> list[int]:  # noqa: N802
        """Return the unstuffed packet; its CRC has been checked before."""
        end = 7 + packet[5] + (packet[6] << 8) - 2
        body = protocol2.unstuff(bytes(packet[7:end]))
        length = (len(body) + 2).to_bytes(2, "little")
        return [*packet[:5], *length, *body, *packet[end : end + 2]]


def keep_received(packets: Any) -> deque[Sequence[int]]:
    """Return a queue that keeps the last packet received, as the SDK does not check its length."""
    got: deque[Sequence[int]] = deque(maxlen=1)
    receive = packets.rxPacket

    def received(*args: Any) -> tuple[Any, int]:
        packet, result = receive(*args)
        got.append(packet)
        return packet, int(result)

    packets.rxPacket = received
    return got


class ServoConfigurator(ABC):
    """Verified access to one servo at a time, with retries; slow, for configuration only.

    All methods raise `NoAnswerError`, `CorruptAnswerError`, `ServoRejectionError` or `PortError`.

    Attributes:
        heartbeat: Called before each attempt, because a silent servo takes several.
    """

    timed_out: int = COMM_RX_TIMEOUT
    """Result code of the SDK for a timeout."""

    def __init__(self, port: Port, packets: Any) -> None:
        self._port, self._packets = SdkPort(port), packets
        self.heartbeat = no_heartbeat
        self._unsettled = False
        self._got = keep_received(packets)

    def settle(self) -> None:
        """Wait until no late answer to an earlier request can arrive."""
        self._port.port.drain_input(QUIET + self._port.port.latency, NOISY)
        self._unsettled = False

    @abstractmethod
    def ping(self, id: int, attempts: int = ATTEMPTS) -> int:
        """Return the model number of servo `id`."""

    @abstractmethod
    def read(self, id: int, address: int, size: int) -> bytes:
        """Return `size` bytes at `address`."""

    def write(self, id: int, address: int, data: bytes) -> None:
        """Write `data` at `address`, and wait for the status packet."""
        value = list(data)
        self._ask(
            id,
            lambda: (
                None,
                *self._packets.writeTxRx(self._port, id, address, len(value), value),
            ),
            0,
        )

    @abstractmethod
    def reboot(self, id: int) -> None:
        """Reboot a servo; it does not answer for some 100 ms."""

    @abstractmethod
    def factory_reset(self, id: int, keep: int) -> None:
        """Reset a servo; `keep`: 0xFF keeps nothing, 0x01 the id, 0x02 id and baud rate."""

    def _ask(
        self,
        id: int,
        call: Callable[[], tuple[Any, int, int]],
        size: int,
        attempts: int = ATTEMPTS,
    ) -> tuple[Any, int]:
        """Return (value, error byte) of an SDK call that returns (value, result, error); retry.

        The answer to a failed call may still arrive, so silence is waited for before the next
        request; an answer whose number of parameters is not `size` is rejected.
        """
        result, before = COMM_SUCCESS, self._port.port.received
        for _ in range(attempts):
            self.heartbeat()
            if self._unsettled:
                self.settle()
            with self._released():
                value, result, error = call()
            if result == COMM_SUCCESS:
                self._check(id, error)
                if self._size(self._got[-1]) == size:
                    return value, error
                result = COMM_RX_CORRUPT
            self._unsettled = True
        where = f"id {id} on {self._port.port.url} at {self._port.port.baud} baud"
        if result == self.timed_out and (came := self._port.port.received - before):
            raise NoAnswerError(
                f"no answer from {where}, but {came} bytes that do not belong to one; "
                "run `windup scan`",
                came,
            )
        if result == self.timed_out:
            raise NoAnswerError(f"no answer from {where}; is it powered? run `windup scan`")
        raise CorruptAnswerError(
            f"only corrupt answers from {where}; a wrong baud rate, or two servos with this id?"
        )

    @abstractmethod
    def _size(self, packet: Sequence[int]) -> int:
        """Return the number of parameters of a status packet from the SDK."""

    @abstractmethod
    def _check(self, id: int, error: int) -> None:
        """Raise RefusedError if the error byte says that the servo rejected the instruction."""

    @contextlib.contextmanager
    def _released(self) -> Iterator[None]:
        """Clear the SDK's "in use" flag before and after a call, also on an exception."""
        self._port.is_using = False
        try:
            yield
        finally:
            self._port.is_using = False


class DynamixelConfigurator(ServoConfigurator):
    """Configuration of protocol 2 servos through dynamixel-sdk."""

    def __init__(self, port: Port) -> None:
        super().__init__(port, SdkPackets())

    def ping(self, id: int, attempts: int = ATTEMPTS) -> int:
        """Return the model number of servo `id`."""
        number, _ = self._ask(id, lambda: self._packets.ping(self._port, id), 3, attempts)
        return int(number)

    def read(self, id: int, address: int, size: int) -> bytes:
        """Return `size` bytes at `address`."""
        data, _ = self._ask(id, lambda: self._packets.readTxRx(self._port, id, address, size), size)
        return bytes(data)

    def reboot(self, id: int) -> None:
        """Reboot a servo; it does not answer for some 100 ms."""
        self._ask(id, lambda: (None, *self._packets.reboot(self._port, id)), 0, attempts=1)

    def factory_reset(self, id: int, keep: int) -> None:
        """Reset a servo; `keep`: 0xFF keeps nothing, 0x01 the id, 0x02 id and baud rate."""
        self._ask(id, lambda: (None, *self._packets.factoryReset(self._port, id, keep)), 0, 1)

    def _size(self, packet: Sequence[int]) -> int:
        """Return the number of parameters of a status packet from the SDK."""
        return packet[5] + (packet[6] << 8) - 4

    def _check(self, id: int, error: int) -> None:
        if code := error & ~protocol2.ALERT:
            what = REFUSALS.get(code, f"answers with error {code}")
            raise ServoRejectionError(f"id {id} on {self._port.port.url} {what}")
