"""Pings all ids of a port and collects the answers that no servo should give."""

from typing import NamedTuple

from windup.hal.families import Family, families
from windup.hal.port.port import BITS, Port
from windup.hal.protocols import protocol2

ANSWER_TIME = 5e-3
"""Longest time for a servo to answer, including its return delay, s."""
LISTEN_TIME = 0.05
"""Time for which the bus is listened to before the first ping, s."""
MAX_BYTES = 64
"""Largest number of bytes read for an answer, with a margin."""
LONGEST = protocol2.OVERHEAD + 3
"""Length of the longest answer to a ping, of protocol 2: model number and firmware version."""


class InvalidAnswer(NamedTuple):
    """An answer to a ping that is not a servo's.

    Attributes:
        id: Id that was pinged; None if the bytes came unasked or are an echo.
        data: The first bytes received.
        whole: Whether it is a frame with a valid checksum.
    """

    id: int | None
    data: bytes
    whole: bool = False


def invalid_answers(port: Port, family: Family) -> list[InvalidAnswer]:
    """Return the invalid answers on a port, at its present baud rate, for a family of servos.

    On a bus with unasked bytes or an echo, that is the only result.
    """
    port.flush_input()
    if unasked := port.read(MAX_BYTES, port.clock.now() + LISTEN_TIME):
        return [InvalidAnswer(None, unasked)]
    found = []
    for id in range(family.protocol.last_id + 1):
        request = family.protocol.ping(id)
        data = _exchange(port, request)
        if data.startswith(request):
            return [InvalidAnswer(None, data)]
        if data and not _is_answer(family, id, data):
            whole = any(frame.id == id for frame in family.protocol.find_packets(data))
            found.append(InvalidAnswer(id, data, whole))
    return found


def is_echo(data: bytes) -> bool:
    """Return whether `data` is the echo of the first ping of `invalid_answers`."""
    return data.startswith(tuple(family.protocol.ping(0) for family in families()))


def _exchange(port: Port, request: bytes) -> bytes:
    """Ping one id and return all bytes received."""
    port.flush_input()
    port.write(request)
    wire = (len(request) + LONGEST) * BITS / port.baud
    return port.read(MAX_BYTES, port.clock.now() + wire + 2.0 * port.latency + ANSWER_TIME)


def _is_answer(family: Family, id: int, data: bytes) -> bool:
    frames = family.protocol.find_packets(data)
    return any(frame.id == id and len(frame.params) == family.protocol.ping_params
               for frame in frames)  # fmt: skip
