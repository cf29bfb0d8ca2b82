"""What comes back when one id after the other is pinged, understood or not."""

from typing import NamedTuple

from windup.hal.families import Family
from windup.hal.port.port import BITS, Port
from windup.hal.protocols import protocol1, protocol2
from windup.hal.protocols.protocol2 import Status

TIME = 5e-3
"""What a servo may take to answer, with its return delay, s."""
LISTEN = 0.05
"""How long a line is listened to before anybody is asked, s."""
ROOM = 64
"""Bytes that one answer has at most, and then some."""
PING_PARAMS = 3
"""Parameters of an answer to a ping of protocol 2: the model number and the firmware."""


class Strange(NamedTuple):
    """An answer to a ping that is none of a servo.

    Attributes:
        id: Who was asked; None where nobody was.
        data: The first bytes that came.
        whole: Is it a frame with a good checksum?
    """

    id: int | None
    data: bytes
    whole: bool = False


def strange_answers(port: Port, family: Family) -> list[Strange]:
    """Return what answers on a port, at its present baud rate, as no servo of a family does.

    A line on which somebody talks unasked, or that echoes, has that alone.
    """
    port.flush_input()
    if unasked := port.read(ROOM, port.clock.now() + LISTEN):
        return [Strange(None, unasked)]
    found = []
    for id in range(family.dialect.last_id + 1):
        request = _request(family, id)
        data = _exchange(port, request)
        if data.startswith(request):
            return [Strange(None, data)]
        if data and not _is_answer(family, id, data):
            whole = any(frame.id == id for frame in _frames(family, data))
            found.append(Strange(id, data, whole))
    return found


def is_echo(data: bytes) -> bool:
    """Return whether an adapter sent back the first ping of `strange_answers`."""
    return data.startswith((protocol1.ping(0), protocol2.ping(0)))


def _request(family: Family, id: int) -> bytes:
    return protocol1.ping(id) if family.dialect.weak else protocol2.ping(id)


def _exchange(port: Port, request: bytes) -> bytes:
    """Return all that comes when one id is pinged."""
    port.flush_input()
    port.write(request)
    wire = (len(request) + protocol2.OVERHEAD + PING_PARAMS) * BITS / port.baud
    return port.read(ROOM, port.clock.now() + wire + 2.0 * port.latency + TIME)


def _is_answer(family: Family, id: int, data: bytes) -> bool:
    wanted = 0 if family.dialect.weak else PING_PARAMS
    frames = _frames(family, data)
    return any(frame.id == id and len(frame.params) == wanted for frame in frames)


def _frames(family: Family, data: bytes) -> list[Status]:
    salvage = protocol1.salvage if family.dialect.weak else protocol2.salvage
    return list(salvage(data))
