"""The instructions of protocol 1, in the variants of Dynamixel AX and MX and of Feetech."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Final, NamedTuple

from windup.sim_twin.wire.bus.bus import BITS, Bus
from windup.sim_twin.wire.bus.parsed_item import ParsedItem
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.protocols.frames1 import (
    BROADCAST,
    ID_AT,
    LENGTH_AT,
    STATUS_BYTES,
    Frame1,
    Frame1Error,
    Parser1,
    encode,
    with_checksum,
)
from windup.sim_twin.wire.protocols.turns import READS, GroupRead, ReadTurn, take_turns
from windup.sim_twin.wire.servos.register_file import EEPROM_END

PING, READ, WRITE, REG_WRITE, ACTION, RESET, REBOOT = 0x01, 0x02, 0x03, 0x04, 0x05, 0x06, 0x08
SYNC_READ, SYNC_WRITE, BULK_READ = 0x82, 0x83, 0x92
WRITES = 2  # status return level from which all instructions are answered
CHECKSUM_ERROR, INSTRUCTION_ERROR = 0x10, 0x40  # bits of a Dynamixel's error byte
LONGEST_READ = 244  # data bytes of a read; the longest status packet has 250 bytes
IDENTITY_END = 14  # end of the registers with ids, baud rate and protocol
PING_SLOT = 0.001  # s for each id of a broadcast ping, assumed: SDKs allow three times as much


class Variant(NamedTuple):
    """Differences between the makers' implementations of protocol 1.

    Attributes:
        name: Name in a robot's file.
        many: The supported instructions that address several servos.
        longest: Length of the longest frame that fits into a servo's buffer, bytes.
        complains: Whether it answers a wrong checksum or instruction with an error bit.
        slots: Whether broadcast pings are answered in the slots of the ids; else all at once.
    """

    name: str
    many: frozenset[int]
    longest: int
    complains: bool
    slots: bool


DYNAMIXEL1: Final = Variant("dynamixel1", frozenset((SYNC_WRITE, BULK_READ)), 259, True, False)
FEETECH: Final = Variant("feetech", frozenset((SYNC_READ, SYNC_WRITE)), 250, False, True)


class Protocol1:
    """Protocol 1 on a bus with several devices.

    Attributes:
        variant: The maker's variant.
        errors: Number of dropped items for each reason.
    """

    id_at, length_at = ID_AT, LENGTH_AT
    data_at, tail = 5, 1
    with_checksum = staticmethod(with_checksum)

    def __init__(self, variant: Variant) -> None:
        self.variant = variant
        self.errors: dict[str, int] = {}
        self._parser = Parser1(variant.longest)
        self._many: dict[int, Callable[[bytes, Bus], None]] = {
            SYNC_READ: lambda parameters, bus: _take(_sync(parameters), bus),
            BULK_READ: lambda parameters, bus: _take(_bulk(parameters), bus),
            SYNC_WRITE: _sync_write,
        }

    def set_devices(self, devices: Sequence[Device]) -> None:
        """Do nothing: all devices use protocol 1."""

    def feed(self, chunk: bytes) -> list[ParsedItem]:
        """Return the frames that `chunk` completes."""
        return [*self._parser.feed(chunk)]

    def reset(self) -> None:
        """Discard an incomplete frame."""
        self._parser.reset()

    def execute(self, frame: ParsedItem, bus: Bus) -> bool:
        """Execute a frame; return False if it was dropped."""
        if not isinstance(frame, Frame1):
            self._drop(frame, bus)
            return False
        if frame.instruction in self.variant.many:
            if frame.identifier == BROADCAST:
                self._many[frame.instruction](frame.parameters, bus)
        elif frame.identifier != BROADCAST:
            self._one(frame, bus)
        elif frame.instruction == PING:
            self._ping_all(bus)
        elif frame.instruction != READ:
            for device in bus.all_listening():
                self._act(device, frame, bus)
            bus.refresh()
        return True

    def _drop(self, item: ParsedItem, bus: Bus) -> None:
        """Count the reason; a Dynamixel whose id is in the frame answers a checksum error."""
        reason = getattr(item, "reason", "unknown")
        self.errors[reason] = self.errors.get(reason, 0) + 1
        if self.variant.complains and isinstance(item, Frame1Error) and reason == "checksum":
            for device in bus.listeners(item.identifier):
                if device.return_level >= WRITES:
                    _later(device, bus, encode(item.identifier, CHECKSUM_ERROR))

    def _one(self, frame: Frame1, bus: Bus) -> None:
        """Execute an instruction for one id."""
        needs = {PING: 0, READ: READS}.get(frame.instruction, WRITES)
        for device in bus.listeners(frame.identifier):
            level, delay, baud = device.return_level, device.return_delay, device.baud
            silent = device.identifier != frame.identifier
            if silent and _changes_eeprom(frame):
                continue
            answer = self._act(device, frame, bus)
            if answer is not None and level >= needs and not silent:
                error, data = answer
                status = encode(frame.identifier, error, data)
                _later(device, bus, status, delay, baud)

    def _act(self, device: Device, frame: Frame1, bus: Bus) -> tuple[int, bytes] | None:
        """Let a device execute an instruction; return error byte and data, None for no answer."""
        now, instruction, parameters = bus.schedule.now, frame.instruction, frame.parameters
        if instruction == READ and len(parameters) == 2:
            if parameters[1] > LONGEST_READ:
                return None
            device.sample()
            return device.read(parameters[0], parameters[1], now)
        if instruction == WRITE and len(parameters) > 1:
            error = device.write(parameters[0], parameters[1:], now)
            if parameters[0] < IDENTITY_END:
                bus.refresh()
            return error, b""
        if instruction == REG_WRITE and len(parameters) > 1:
            return device.register_write(parameters[0], parameters[1:]), b""
        if instruction == ACTION:
            error = device.action(now)
            bus.refresh()
            return error, b""
        if instruction == PING:
            return device.read(0, 1, now)[0], b""
        if instruction == RESET:
            return self._reset(device, bus), b""
        if instruction == REBOOT and self.variant is FEETECH:
            device.reboot(now)
            bus.refresh()
            return 0, b""
        if not self.variant.complains:
            return None
        return device.read(0, 1, now)[0] | INSTRUCTION_ERROR, b""

    def _reset(self, device: Device, bus: Bus) -> int:
        error = device.factory_reset(0xFF, False, bus.schedule.now)
        bus.refresh()
        return error

    def _ping_all(self, bus: Bus) -> None:
        """Let all devices answer a broadcast ping: each in the slot of its id, or all at once."""
        slot = PING_SLOT + STATUS_BYTES * BITS / bus.baud if self.variant.slots else 0.0
        now = bus.schedule.now
        for device in bus.all_listening():
            status = encode(device.identifier, device.read(0, 1, now)[0])
            _later(device, bus, status, device.return_delay + device.identifier * slot)


def _changes_eeprom(frame: Frame1) -> bool:
    """Return whether an instruction is not allowed through an X servo's secondary id."""
    if frame.instruction in (WRITE, REG_WRITE):
        return frame.parameters[:1] < bytes((EEPROM_END,))
    return frame.instruction == RESET


def _later(
    device: Device, bus: Bus, status: bytes, delay: float | None = None, baud: int = 0
) -> None:
    """Schedule a status packet after the return delay."""
    delay = device.return_delay if delay is None else delay
    start = bus.schedule.now + delay + bus.timing.turnaround
    bus.schedule.add(start, partial(bus.answer, status, baud or device.baud, status[ID_AT]))


def _take(turns: list[ReadTurn], bus: Bus) -> None:
    if all(turn.size <= LONGEST_READ for turn in turns):
        take_turns(turns, GroupRead(bus, encode, STATUS_BYTES))


def _sync(parameters: bytes) -> list[ReadTurn]:
    return [ReadTurn(k, parameters[0], parameters[1]) for k in parameters[2:]]


def _bulk(parameters: bytes) -> list[ReadTurn]:
    """Return the turns of a bulk read: a zero, then length, id and address of each."""
    return [
        ReadTurn(parameters[at + 1], parameters[at + 2], parameters[at])
        for at in range(1, len(parameters) - 2, 3)
    ]


def _sync_write(parameters: bytes, bus: Bus) -> None:
    if len(parameters) < 2:
        return
    address, count = parameters[0], parameters[1]
    for at in range(2, len(parameters) - count, count + 1):
        for device in bus.listeners(parameters[at]):
            if device.identifier != parameters[at] and address < EEPROM_END:
                continue
            device.write(address, parameters[at + 1 : at + 1 + count], bus.schedule.now)
    if address < IDENTITY_END:
        bus.refresh()
