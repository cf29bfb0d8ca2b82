"""Sync and bulk reads, which devices answer one after the other."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from typing import NamedTuple

from windup.sim_twin.wire.bus.bus import BITS, Bus
from windup.sim_twin.wire.device import Device

Encode = Callable[[int, int, bytes], bytes]
PIECE = 4  # number of answers that are computed together
READS = 1  # status return level from which reads are answered


class ReadTurn(NamedTuple):
    """One device's part in a sync or bulk read."""

    identifier: int
    address: int
    size: int


class GroupRead(NamedTuple):
    """Data that all turns of one read share.

    Attributes:
        bus: The bus.
        encode: Builds a status packet from id, error and data.
        overhead: Bytes of a status packet without its data.
    """

    bus: Bus
    encode: Encode
    overhead: int


Turns = Sequence[tuple[ReadTurn, list[Device]]]


def take_turns(turns: Sequence[ReadTurn], group: GroupRead) -> None:
    """Answer a sync or bulk read with one status packet after the other.

    All devices sample their shafts when the request ends, as real servos do.
    """
    bus = group.bus
    who = [(turn, answering(turn, bus)) for turn in turns]
    for _, devices in who:
        for device in devices:
            device.sample()
    if _without_gaps(who, bus):
        _in_pieces(who, 0, group)
    else:
        _go_on(iter(who), group, bus.schedule.now)


def answering(turn: ReadTurn, bus: Bus, fast: bool = False) -> list[Device]:
    """Return the devices that will answer a turn."""
    return [
        device
        for device in bus.listeners(turn.identifier)
        if device.identifier == turn.identifier
        and device.return_level >= READS
        and (device.fast or not fast)
    ]


def _without_gaps(who: Turns, bus: Bus) -> bool:
    """Return whether the answers follow each other without gaps, faults or collisions."""
    return (
        bus.fault_injector is None
        and bus.timing.turnaround == 0.0
        and all(len(devices) == 1 for _, devices in who)
        and all(devices[0].return_delay == 0.0 for _, devices in who)
        and all(devices[0].baud == bus.baud for _, devices in who)
    )


def _in_pieces(who: Turns, first: int, group: GroupRead) -> None:
    """Send gapless answers, a few at once.

    Not all at once, because the host may be waiting for the first of them in real time.
    """
    bus, encode = group.bus, group.encode
    now, byte = bus.schedule.now, BITS / bus.baud
    last = first + PIECE
    answers: list[bytes] = []
    for turn, (device,) in who[first:last]:
        error, data = device.read(turn.address, turn.size, now)
        answers.append(encode(turn.identifier, error, data))
        now += len(answers[-1]) * byte
    bus.answers(answers)
    if last < len(who):
        bus.schedule.add(now, partial(_in_pieces, who, last, group))


def _go_on(left: Iterator[tuple[ReadTurn, list[Device]]], group: GroupRead, end: float) -> None:
    """Schedule the next device's answer; the previous one ended at `end`, s."""
    bus = group.bus
    for turn, devices in left:
        if devices:
            start = end + devices[0].return_delay + bus.timing.turnaround
            bus.schedule.add(start, partial(_take_turn, turn, devices, left, group))
            return
        if bus.timing.waits_for_missing:
            return
        end += (turn.size + group.overhead) * BITS / bus.baud


def _take_turn(
    turn: ReadTurn,
    devices: Iterable[Device],
    left: Iterator[tuple[ReadTurn, list[Device]]],
    group: GroupRead,
) -> None:
    bus = group.bus
    now = end = bus.schedule.now
    for device in devices:
        error, data = device.read(turn.address, turn.size, now)
        status = group.encode(turn.identifier, error, data)
        end = max(end, bus.answer(status, device.baud, turn.identifier))
    _go_on(left, group, end)
