"""What an adapter does to the bytes: it may hold answers back, or give back what it is sent.

Neither can be asked of a driver in general (a pseudo-terminal, a network bridge and a CH340 say
nothing), so both are measured with a few requests whose answers cannot be taken for their echo.
"""

from collections.abc import Iterable
from typing import NamedTuple

from windup.hal.heartbeat import Heartbeat, no_heartbeat
from windup.hal.port.port import BITS, LATENCY, Port

PATIENCE = 0.06
"""How long an answer is waited for while nothing is known of the adapter, s."""
REQUESTS = 8
"""How often who answers is asked: the latency timer of an adapter may be anywhere."""
SILENT = 3
"""So many silent servos in a row mean that there is no power."""
ECHOES = 3
"""An adapter that gives back so many requests, one behind the other, gives back all."""
MARGIN = 1.25
"""How much longer than it was seen to be a latency may be."""
SETUP = 0.6e-3
"""What a servo with its factory's return delay takes to answer, s."""


class Probe(NamedTuple):
    """A request to one servo.

    Attributes:
        request: The frame.
        length: Bytes of its answer, which begins with `head`.
        head: The bytes an answer begins with and a request does not.
    """

    request: bytes
    length: int
    head: bytes


class Heard(NamedTuple):
    """What came of a request: did it come back, and after how many s was its answer there?"""

    echoed: bool
    seconds: float | None


def get_to_know(port: Port, probes: Iterable[Probe], heartbeat: Heartbeat = no_heartbeat) -> None:
    """Measure the adapter of a port, once, and note in the port what it does.

    Args:
        port: The port; `echoes` and `latency` are set.
        probes: A request to each servo that may be there. Where all are silent the latency stays
            what it was said to be.
        heartbeat: Called before each request.
    """
    if port.known:
        return
    echoed = 0
    for silent, probe in enumerate(probes, 1):
        times: list[float] = []
        for _ in range(REQUESTS):
            heartbeat()
            heard = _ask(port, probe)
            echoed = echoed + 1 if heard.echoed else 0
            port.echoes |= echoed == ECHOES
            if heard.seconds is None and not heard.echoed:
                break
            times += [] if heard.seconds is None else [heard.seconds]
        if times:
            _note(port, times)
            return
        if silent == SILENT:
            return


def _note(port: Port, times: list[float]) -> None:
    """Take the second longest time, so that one mishap does not count, for the latency."""
    port.known = True
    longest = sorted(times)[-2:][0]
    if longest > LATENCY + SETUP:
        port.latency = max(port.latency, MARGIN * longest)


def _ask(port: Port, probe: Probe) -> Heard:
    """Send a request and wait for its answer."""
    request, length, head = probe
    port.flush_input()
    began = port.clock.now()
    port.write(request)
    wire = (len(request) + length) * BITS / port.baud
    deadline = began + wire + PATIENCE
    stream = port.read(length, deadline)
    echoed = bool(stream) and request.startswith(stream[: len(request)])
    if echoed:
        stream = (stream + port.read(len(request), deadline))[len(request) :]
    if len(stream) == length and stream.startswith(head):
        return Heard(echoed, max(port.clock.now() - began - wire, 0.0))
    return Heard(echoed, None)
