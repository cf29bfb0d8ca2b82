"""Instructions of Dynamixel protocol 2: which devices act, which answer, and when."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial

from windup.sim_twin.wire.bus.bus import Bus
from windup.sim_twin.wire.bus.parsed_item import ParsedItem
from windup.sim_twin.wire.device import Device
from windup.sim_twin.wire.protocols.frames import (
    BROADCAST,
    HEADER,
    ID_AT,
    LENGTH_AT,
    LENGTH_MAX,
    STATUS,
    Frame,
    FrameError,
    Parser,
    crc16,
    encode_status,
    with_checksum,
)
from windup.sim_twin.wire.protocols.turns import READS, GroupRead, ReadTurn, answering, take_turns
from windup.sim_twin.wire.servos.register_file import (
    BAD_CRC,
    BAD_INSTRUCTION,
    BAD_LENGTH,
    EEPROM_END,
    OK,
)

PING, READ, WRITE, REG_WRITE, ACTION = 0x01, 0x02, 0x03, 0x04, 0x05
FACTORY_RESET, REBOOT, CLEAR, BACKUP = 0x06, 0x08, 0x10, 0x20
SYNC_READ, SYNC_WRITE, FAST_SYNC_READ = 0x82, 0x83, 0x8A
BULK_READ, BULK_WRITE, FAST_BULK_READ = 0x92, 0x93, 0x9A

WRITES = 2
STATUS_BYTES = 11  # bytes of a status packet without its data
PING_GAP = 0.003  # s between the slots of a broadcast ping, which SDKs allow for each id


class Dynamixel2:
    """Protocol 2 on a bus with several devices.

    Attributes:
        errors: Number of dropped items for each reason.
    """

    id_at, length_at = ID_AT, LENGTH_AT
    data_at, tail = 9, 2
    with_checksum = staticmethod(with_checksum)

    def __init__(self) -> None:
        self._parser = Parser()
        self.errors: dict[str, int] = {}
        self._many: dict[int, Callable[[bytes, Bus], None]] = {
            SYNC_READ: lambda parameters, bus: _take(_sync(parameters), bus),
            BULK_READ: lambda parameters, bus: _take(_bulk(parameters), bus),
            FAST_SYNC_READ: lambda parameters, bus: _chained(_sync(parameters), bus),
            FAST_BULK_READ: lambda parameters, bus: _chained(_bulk(parameters), bus),
            SYNC_WRITE: _sync_write,
            BULK_WRITE: _bulk_write,
        }

    def set_devices(self, devices: Sequence[Device]) -> None:
        """Do nothing: all devices use protocol 2."""

    def feed(self, chunk: bytes) -> list[ParsedItem]:
        """Return the frames that `chunk` completes."""
        return [*self._parser.feed(chunk)]

    def reset(self) -> None:
        """Discard an incomplete frame."""
        self._parser.reset()

    def execute(self, frame: ParsedItem, bus: Bus) -> bool:
        """Execute a frame; return False if it was dropped."""
        if not isinstance(frame, Frame):
            reason = getattr(frame, "reason", "unknown")
            self.errors[reason] = self.errors.get(reason, 0) + 1
            if isinstance(frame, FrameError) and reason == "crc":
                _complain(frame.identifier, bus)
            return False
        if frame.instruction == STATUS:
            return False
        many = self._many.get(frame.instruction)
        if frame.identifier != BROADCAST:
            _one(frame, bus)
        elif many is not None:
            many(frame.parameters, bus)
        elif frame.instruction == PING:
            _ping_all(bus)
        elif frame.instruction != READ:
            for device in bus.all_listening():
                _act(device, frame, bus, broadcast=True)
            bus.refresh()
        return True


def _complain(identifier: int, bus: Bus) -> None:
    """Let the servo whose id is in a frame with a wrong CRC answer with CRC Error, 0x03.

    The instruction in such a frame is unknown, so only servos at return level 2 answer.
    """
    for device in bus.listeners(identifier):
        if device.identifier == identifier and device.return_level >= WRITES:
            alert = device.read(0, 1, bus.schedule.now)[0]
            status = encode_status(identifier, alert | BAD_CRC)
            start = bus.schedule.now + device.return_delay + bus.timing.turnaround
            bus.schedule.add(start, partial(bus.answer, status, device.baud, identifier))


def _one(frame: Frame, bus: Bus) -> None:
    """Execute an instruction for one id."""
    for device in bus.listeners(frame.identifier):
        delay, level, baud = device.return_delay, device.return_level, device.baud
        silent = device.identifier != frame.identifier
        if silent and _changes_eeprom(frame):
            continue
        needs = {PING: 0, READ: READS}.get(frame.instruction, WRITES)
        error, data = _act(device, frame, bus)
        if level >= needs and not silent:
            status = encode_status(frame.identifier, error, data)
            start = bus.schedule.now + delay + bus.timing.turnaround
            bus.schedule.add(start, partial(bus.answer, status, baud, frame.identifier))


def _changes_eeprom(frame: Frame) -> bool:
    """Return whether an instruction is not allowed through a Secondary(Shadow) ID(12)."""
    if frame.instruction in (WRITE, REG_WRITE):
        return len(frame.parameters) > 1 and _word(frame.parameters, 0) < EEPROM_END
    return frame.instruction in (FACTORY_RESET, BACKUP)


def _act(device: Device, frame: Frame, bus: Bus, broadcast: bool = False) -> tuple[int, bytes]:
    """Let a device execute an instruction; return the error byte and data of its status packet."""
    now, instruction, parameters = bus.schedule.now, frame.instruction, frame.parameters
    if instruction == PING:
        device.sample()
        return device.read(0, 1, now)[0], device.ping()
    if instruction == READ:
        if len(parameters) != 4:
            return BAD_LENGTH, b""
        device.sample()
        return device.read(_word(parameters, 0), _word(parameters, 2), now)
    if instruction in (WRITE, REG_WRITE):
        if len(parameters) < 3:
            return BAD_LENGTH, b""
        address, data = _word(parameters, 0), parameters[2:]
        if instruction == REG_WRITE:
            return device.register_write(address, data), b""
        return _write(device, address, data, bus), b""
    if instruction == ACTION:
        error = device.action(now)
        bus.refresh()
        return error, b""
    if instruction == REBOOT:
        device.reboot(now)
        return OK, b""
    if instruction == FACTORY_RESET:
        error = device.factory_reset(parameters[0] if parameters else 0, broadcast, now)
        bus.refresh()
        return error, b""
    if instruction == CLEAR:
        return device.clear(parameters), b""
    if instruction == BACKUP:
        error = device.backup(parameters, now)
        bus.refresh()
        return error, b""
    return BAD_INSTRUCTION, b""


def _write(device: Device, address: int, data: bytes, bus: Bus) -> int:
    error = device.write(address, data, bus.schedule.now)
    if address < EEPROM_END:
        bus.refresh()
    return error


def _write_to(identifier: int, address: int, data: bytes, bus: Bus) -> None:
    """Write to all devices with an id; through a secondary id, only outside of the EEPROM."""
    for device in bus.listeners(identifier):
        if device.identifier == identifier or address >= EEPROM_END:
            _write(device, address, data, bus)


def _ping_all(bus: Bus) -> None:
    """Let every device answer a broadcast ping in the slot of its id."""
    now = bus.schedule.now
    for device in bus.all_listening():
        data = encode_status(device.identifier, device.read(0, 1, now)[0], device.ping())
        slot = PING_GAP + len(data) * 10.0 / bus.baud
        start = now + device.identifier * slot + device.return_delay
        bus.schedule.add(start, partial(bus.answer, data, device.baud, device.identifier))


def _sync_write(parameters: bytes, bus: Bus) -> None:
    address, count = _word(parameters, 0), _word(parameters, 2)
    for at in range(4, len(parameters) - count, count + 1):
        _write_to(parameters[at], address, parameters[at + 1 : at + 1 + count], bus)


def _bulk_write(parameters: bytes, bus: Bus) -> None:
    at = 0
    while at + 5 <= len(parameters):
        count = _word(parameters, at + 3)
        data = parameters[at + 5 : at + 5 + count]
        _write_to(parameters[at], _word(parameters, at + 1), data, bus)
        at += 5 + count


def _sync(parameters: bytes) -> list[ReadTurn]:
    address, count = _word(parameters, 0), _word(parameters, 2)
    return [ReadTurn(identifier, address, count) for identifier in parameters[4:]]


def _bulk(parameters: bytes) -> list[ReadTurn]:
    return [
        ReadTurn(parameters[at], _word(parameters, at + 1), _word(parameters, at + 3))
        for at in range(0, len(parameters) - 4, 5)
    ]


def _word(data: bytes, at: int) -> int:
    return int.from_bytes(data[at : at + 2], "little")


def _take(turns: list[ReadTurn], bus: Bus) -> None:
    take_turns(turns, GroupRead(bus, encode_status, STATUS_BYTES))


def _chained(turns: list[ReadTurn], bus: Bus) -> None:
    """Answer a fast read: all devices contribute to one status packet, without byte stuffing.

    Each part ends with a CRC over all bytes so far; the last one is the packet's CRC.
    """
    who = [answering(turn, bus, fast=True) for turn in turns]
    for devices in who:
        for device in devices[:1]:
            device.sample()
    length = 1 + sum(turn.size + 4 for turn in turns)
    if length > LENGTH_MAX:
        return
    head = HEADER + bytes((BROADCAST,)) + length.to_bytes(2, "little") + bytes((STATUS,))
    _chain_on(iter([*zip(turns, who, strict=True)]), head, 0, bus, bus.schedule.now)


def _chain_on(
    left: Iterator[tuple[ReadTurn, list[Device]]], head: bytes, crc: int, bus: Bus, end: float
) -> None:
    """Schedule the next device's part; it begins with `head` if it is the first."""
    for turn, devices in left:
        if devices:
            # Only the first device applies its return delay: the packet has no gaps.
            delay = devices[0].return_delay + bus.timing.turnaround if head else 0.0
            part = partial(_add_part, turn, devices[0], left, head, crc, bus)
            bus.schedule.add(end + delay, part)
            return
        if bus.timing.waits_for_missing or head:
            return
        end += (turn.size + 4) * 10.0 / bus.baud


def _add_part(
    turn: ReadTurn,
    device: Device,
    left: Iterator[tuple[ReadTurn, list[Device]]],
    head: bytes,
    crc: int,
    bus: Bus,
) -> None:
    error, data = device.read(turn.address, turn.size, bus.schedule.now)
    part = head + bytes((error, turn.identifier)) + data.ljust(turn.size, b"\0")
    crc = crc16(part, crc)
    tail = crc.to_bytes(2, "little")
    end = bus.answer(part + tail, device.baud, device.identifier)
    _chain_on(left, b"", crc16(tail, crc), bus, end)
