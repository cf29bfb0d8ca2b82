"""Measures the latency of a serial adapter, and whether it echoes what it is sent.

Drivers do not report these in general (pseudo-terminals, network bridges and CH340s do not), so
both are measured with a few requests whose answers cannot be mistaken for their echo.
"""

from collections.abc import Iterable
from typing import NamedTuple

from windup.hal.heartbeat import Heartbeat, no_heartbeat
from windup.hal.port.port import BITS, LATENCY, Port

ANSWER_TIMEOUT = 0.06
"""Timeout of an answer while the latency of the adapter is unknown, s."""
REQUESTS = 8
"""Number of requests to a servo that answers: the phase of the latency timer is arbitrary."""
SILENT = 3
"""Number of silent servos in a row after which the servos are taken to have no power."""
ECHOES = 3
"""Number of consecutive echoed requests after which the adapter is taken to echo all bytes."""
MARGIN = 1.25
"""Safety factor on the measured latency."""
SETUP = 0.6e-3
"""Time that a servo with the factory default return delay takes to answer, s."""


class Probe(NamedTuple):
    """A request to one servo.

    Attributes:
        request: The frame.
        length: Length of its answer, bytes.
        head: First bytes of the answer, which no request begins with.
    """

    request: bytes
    length: int
    head: bytes


class ProbeResult(NamedTuple):
    """Result of a probe: whether it was echoed, and the time to its answer, s, or None."""

    echoed: bool
    seconds: float | None


def measure_adapter(
    port: Port, probes: Iterable[Probe], heartbeat: Heartbeat = no_heartbeat
) -> None:
    """Measure latency and echo of the adapter of a port, once, and store them in the port.

    Args:
        port: The port; `echoes` and `latency` are set.
        probes: A request to each servo that may be present. If none answers, the latency is left
            unchanged.
        heartbeat: Called before each request.
    """
    if port.is_measured:
        return
    echoed = 0
    for silent, probe in enumerate(probes, 1):
        times: list[float] = []
        for _ in range(REQUESTS):
            heartbeat()
            result = _ask(port, probe)
            echoed = echoed + 1 if result.echoed else 0
            port.echoes |= echoed == ECHOES
            if result.seconds is None and not result.echoed:
                break
            times += [] if result.seconds is None else [result.seconds]
        if times:
            _note(port, times)
            return
        if silent == SILENT:
            return


def _note(port: Port, times: list[float]) -> None:
    """Set the latency from the second longest time, so that one outlier is ignored."""
    port.is_measured = True
    longest = sorted(times)[-2:][0]
    if longest > LATENCY + SETUP:
        port.latency = max(port.latency, MARGIN * longest)


def _ask(port: Port, probe: Probe) -> ProbeResult:
    """Send a probe and wait for its answer."""
    request, length, head = probe
    port.flush_input()
    began = port.clock.now()
    port.write(request)
    wire = (len(request) + length) * BITS / port.baud
    deadline = began + wire + ANSWER_TIMEOUT
    stream = port.read(length, deadline)
    echoed = bool(stream) and request.startswith(stream[: len(request)])
    if echoed:
        stream = (stream + port.read(len(request), deadline))[len(request) :]
    if len(stream) == length and stream.startswith(head):
        return ProbeResult(echoed, max(port.clock.now() - began - wire, 0.0))
    return ProbeResult(echoed, None)
