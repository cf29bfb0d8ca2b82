"""The requests and reads of each protocol, as implemented by each maker."""

import contextlib
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from windup.hal.errors import CorruptAnswerError, HardwareError, NoAnswerError, ServoRejectionError
from windup.hal.port.adapter import MARGIN, Probe
from windup.hal.port.port import BITS, Port
from windup.hal.protocols import protocol1, protocol2
from windup.hal.protocols.batched import BlockRead, BlockWrite
from windup.hal.protocols.batched1 import ChainRead, GoalWrite, bulk_read, sync_read
from windup.hal.protocols.cyclic import CyclicRead, CyclicWrite
from windup.hal.protocols.protocol2 import Span, Status
from windup.hal.registers import Register

if TYPE_CHECKING:
    from windup.hal.families.configurator import ServoConfigurator

PING_SLOT = 3e-3
"""Time slot of each id in the answer to a broadcast ping of protocol 2, s."""
PING_TIME = 3e-3
"""Maximum time to the answer to a ping of one servo, including return delay and driver, s."""
MODEL_NUMBER = Register("model_number", 0, 2, "eeprom", False)
"""Model number register of every Dynamixel, in both protocols."""
LATEST = 0.1
"""Maximum delay of a late answer, s; later bytes are noise."""


class Answered(NamedTuple):
    """A servo that answered a ping."""

    id: int
    model_number: int
    firmware: int


class ServoProtocol(ABC):
    """One protocol as implemented by one maker.

    Attributes:
        last_id: The largest id that a servo can have.
        weak: Whether the checksum is so short (8 bits) that corrupt frames often pass it.
        ping_params: Number of parameters in the answer to a ping.
        scan_bytes: Number of bytes that `scan` reads from one servo.
    """

    last_id: int
    weak: bool
    ping_params: int
    scan_bytes: int

    @abstractmethod
    def configurator(self, port: Port) -> "ServoConfigurator":
        """Return a configurator, for access to one servo at a time."""

    @abstractmethod
    def read(self, spans: Sequence[Span], fast: bool = False) -> CyclicRead:
        """Return a cyclic read; `fast` selects one that not all servos of the family support."""

    @abstractmethod
    def write(self, ids: Sequence[int], register: Register) -> CyclicWrite:
        """Return a cyclic write of one register."""

    @abstractmethod
    def sync_write(self, data: Mapping[int, bytes], address: int, size: int) -> list[bytes]:
        """Return the frames that write `size` bytes at `address` of each id in `data`."""

    @abstractmethod
    def ping(self, id: int) -> bytes:
        """Return the frame that pings one servo."""

    @abstractmethod
    def find_packets(self, data: bytes) -> list[Status]:
        """Return the valid status packets in received bytes."""

    @abstractmethod
    def probe(self, id: int) -> Probe:
        """Return a request to one servo whose answer cannot be mistaken for its echo."""

    @abstractmethod
    def scan(self, port: Port, configurator: "ServoConfigurator") -> list[Answered]:
        """Return the servos that answer at the port's present baud rate."""

    def other_protocol(self, port: Port, id: int) -> int | None:
        """Return the model number of a silent servo that answers in another protocol, or None."""
        return None


class Protocol2(ServoProtocol):
    """Dynamixel protocol 2. Its fast read is the fast sync read."""

    last_id, weak = protocol2.LAST_ID, False
    ping_params, scan_bytes = 3, 14  # one ping suffices

    def configurator(self, port: Port) -> "ServoConfigurator":
        """Return a configurator, for access to one servo at a time."""
        from windup.hal.families.configurator import DynamixelConfigurator  # and the SDK

        return DynamixelConfigurator(port)

    def read(self, spans: Sequence[Span], fast: bool = False) -> CyclicRead:
        """Return a sync read, or a bulk read if the spans differ."""
        return BlockRead(spans, fast)

    def write(self, ids: Sequence[int], register: Register) -> CyclicWrite:
        """Return a cyclic write of one register."""
        return BlockWrite(ids, register.address, register.size)

    def sync_write(self, data: Mapping[int, bytes], address: int, size: int) -> list[bytes]:
        """Return the frame that writes `size` bytes at `address` of each id in `data`."""
        return [protocol2.sync_write(data, address, size)]

    def ping(self, id: int) -> bytes:
        """Return the frame that pings one servo."""
        return protocol2.ping(id)

    def find_packets(self, data: bytes) -> list[Status]:
        """Return the valid status packets in received bytes."""
        return list(protocol2.find_packets(data))

    def probe(self, id: int) -> Probe:
        """Return a ping: its answer differs from its echo by the instruction byte."""
        answer = protocol2.status(id, bytes(3))
        return Probe(protocol2.ping(id), len(answer), answer[:8])

    def scan(self, port: Port, configurator: "ServoConfigurator") -> list[Answered]:
        """Send a broadcast ping, and return all servos with a valid reply."""
        port.flush_input()
        port.write(protocol2.ping())
        slots = PING_SLOT * protocol2.LAST_ID + 2.0 * port.latency
        longest = (protocol2.LAST_ID + 1) * (protocol2.OVERHEAD + 3)
        stream = port.read(longest, port.clock.now() + slots + longest * 10.0 / port.baud)
        answers = {item.id: item.params for item in protocol2.find_packets(stream)}
        return [
            Answered(id, int.from_bytes(params[:2], "little"), params[2])
            for id, params in sorted(answers.items())
            if len(params) == 3
        ]

    def other_protocol(self, port: Port, id: int) -> int | None:
        """Return the model number of a servo that answers in protocol 1 instead, or None."""
        from windup.hal.families.configurator1 import Dynamixel1Configurator

        with contextlib.suppress(NoAnswerError, CorruptAnswerError, ServoRejectionError):
            return Dynamixel1Configurator(port, MODEL_NUMBER).ping(id, attempts=1)
        return None


class Protocol1(ServoProtocol):
    """Base class of Dynamixel protocol 1 and Feetech.

    Args:
        model_number: Register of the model number.
        firmware: Register of the firmware version.
        longest: Maximum length of a frame that a servo accepts, bytes.
    """

    last_id, weak = protocol1.LAST_ID, True
    ping_params, scan_bytes = 0, 27  # a servo is pinged, read, pinged and read

    def __init__(self, model_number: Register, firmware: Register, longest: int) -> None:
        self.model_number, self.firmware, self.longest = model_number, firmware, longest

    def read(self, spans: Sequence[Span], fast: bool = False) -> CyclicRead:
        """Return one common read if `fast` and its request fits into a frame, else single reads."""
        if fast and len(spans) > 1 and self._room_for(len(spans)):
            return self._common(spans)
        return ChainRead(spans)

    def write(self, ids: Sequence[int], register: Register) -> CyclicWrite:
        """Return a cyclic write of one register."""
        return GoalWrite(ids, register, self.longest)

    def sync_write(self, data: Mapping[int, bytes], address: int, size: int) -> list[bytes]:
        """Return the frames that write `size` bytes at `address` of each id in `data`."""
        return protocol1.split_sync_write(data, address, size, self.longest)

    def ping(self, id: int) -> bytes:
        """Return the frame that pings one servo."""
        return protocol1.ping(id)

    def find_packets(self, data: bytes) -> list[Status]:
        """Return the valid status packets in received bytes."""
        return list(protocol1.find_packets(data))

    def probe(self, id: int) -> Probe:
        """Return a read of one byte: its answer differs in length from its echo, a ping's not."""
        answer = protocol1.status(id, bytes(1))
        request = protocol1.read(id, self.model_number.address, 1)
        return Probe(request, len(answer), answer[:4])

    def scan(self, port: Port, configurator: "ServoConfigurator") -> list[Answered]:
        """Ping each id in turn, as answers to a broadcast ping would collide; return who answered.

        An answer that comes while a later id is pinged shows that the adapter's latency is longer
        than assumed: it is raised, and all ids are pinged again. Ids not yet pinged do not count.
        """
        found, firmware = [], self.firmware
        asked: dict[int, float] = {}
        for id in range(self.last_id + 1):
            asked[id] = port.clock.now()
            pongs = _pongs(port, id)
            late = [port.clock.now() - asked[other] for other in pongs & asked.keys() - {id}]
            if port.latency < max(late, default=0.0) < LATEST:
                port.latency = MARGIN * max(late)
                return self.scan(port, configurator)
            # Noise, or two servos with this id, may look like an answer, but give no model number.
            if id in pongs:
                with contextlib.suppress(HardwareError):
                    version = configurator.read(id, firmware.address, firmware.size)
                    found.append(Answered(id, configurator.ping(id), firmware.decode(version)))
        return found

    @abstractmethod
    def _common(self, spans: Sequence[Span]) -> CyclicRead:
        """Return one read of all spans."""

    @abstractmethod
    def _room_for(self, servos: int) -> bool:
        """Return whether the request of a common read of `servos` servos fits into a frame."""


class Dynamixel1(Protocol1):
    """Dynamixel AX and MX. The common read is the bulk read, which an AX does not support."""

    def configurator(self, port: Port) -> "ServoConfigurator":
        """Return a configurator, for access to one servo at a time."""
        from windup.hal.families.configurator1 import Dynamixel1Configurator  # and the SDK

        return Dynamixel1Configurator(port, self.model_number)

    def _common(self, spans: Sequence[Span]) -> CyclicRead:
        return bulk_read(spans)

    def _room_for(self, servos: int) -> bool:
        return 3 * servos + protocol1.OVERHEAD + 1 <= self.longest


class Feetech(Protocol1):
    """Feetech STS, SMS and SCS. The common read is the sync read.

    Args:
        model_number: Register of the model number.
        firmware: Register of the firmware version.
        always_sync: Whether all servos of the family support the sync read.
    """

    def __init__(self, model_number: Register, firmware: Register, always_sync: bool) -> None:
        super().__init__(model_number, firmware, protocol1.LONGEST_FEETECH)
        self.always_sync = always_sync

    def configurator(self, port: Port) -> "ServoConfigurator":
        """Return a configurator, for access to one servo at a time."""
        from windup.hal.families.configurator1 import FeetechConfigurator  # and the SDK

        return FeetechConfigurator(port, self.model_number)

    def read(self, spans: Sequence[Span], fast: bool = False) -> CyclicRead:
        """Return a sync read if `fast` or all servos support it, else single reads."""
        return super().read(spans, fast or self.always_sync)

    def _common(self, spans: Sequence[Span]) -> CyclicRead:
        alike = len({(span.address, span.size) for span in spans}) == 1
        return sync_read(spans) if alike else ChainRead(spans)

    def _room_for(self, servos: int) -> bool:
        return servos + protocol1.OVERHEAD + 2 <= self.longest


def _pongs(port: Port, id: int) -> set[int]:
    """Ping one id; return the ids of all answers received."""
    request = protocol1.ping(id)
    port.flush_input()
    port.write(request)
    wire = (len(request) + protocol1.OVERHEAD) * BITS / port.baud
    deadline = port.clock.now() + wire + 2.0 * port.latency + PING_TIME
    stream = port.read(protocol1.OVERHEAD, deadline)
    return {item.id for item in protocol1.find_packets(stream, {}, (0,))}
