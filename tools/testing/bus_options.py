"""What the buses of a test can be told, with completion, and the URL that says it."""

from collections.abc import Mapping
from pathlib import Path
from typing import Literal, TypedDict
from urllib.parse import urlencode

from windup.hal.errors import UsageError
from windup.sim_twin.wire.world.address import SCHEME, parse_address

RESERVED = ("clock", "world", "bus")
"""Options of a twin:// URL that a test's bus chooses by itself."""


class BusOptions(TypedDict, total=False):
    """Options of an emulated bus; what is left out has its default.

    Attributes:
        servos: On the bench, models and ids: "XM430-W350:1-20,XL430:30"; one protocol a bus.
        baud: Baud rate of the servos, bits/s; the robot's own, or 1,000,000.
        return_delay: Return delay of the servos at the start, in their unit of 2 us; as they leave
            the factory (250, 500 us, of a Dynamixel) by default.
        latency: Time for which the adapter holds bytes back, ms; 0 by default, 16 of an FTDI chip
            whose latency timer nobody has lowered.
        turnaround: Time from the end of a request to an answer, on top of the return delay, us.
        missing: Behind a servo that is missing in a sync read the others "skip" its slot, or
            "wait" for it.
        supply: Voltage, V; the robot's own, or 12 (less where the servos stand less).
        physics: Of a robot: "mujoco", its twin, or "inertia", each servo alone.
        power: Whether the servo power of an OpenCR board is "on" (default) or "off" at the start.
        hold: Whether a robot is held until its servos are driven: "yes" (default) or "no";
            "always": also whenever none of them is driven any more.
        hand: What hands do to limp joints: "JOINT:DEGREES:SECONDS", several joined by commas.
        imu: A BNO08x on a port of its own, bus "imu": "rvc" or "none"; "auto" (default): as the
            robot has it.
        faults: What goes wrong, as a URL has it: "drop:0.01,late:0.02:seconds=0.003".
        seed: Seed of everything random; 0 by default.
    """

    servos: str
    baud: int
    return_delay: int
    latency: float
    turnaround: float
    missing: Literal["skip", "wait"]
    supply: float
    physics: Literal["mujoco", "inertia"]
    power: Literal["on", "off"]
    hold: Literal["yes", "no", "always"]
    hand: str
    imu: Literal["auto", "rvc", "none"]
    faults: str
    seed: int


def bus_url(robot: str | Path, options: Mapping[str, object]) -> str:
    """Return the twin:// URL of a robot's buses, or of servos on a bench.

    >>> bus_url("bench", {"servos": "STS3215:1-3", "faults": ""})
    'twin://bench?servos=STS3215:1-3'

    Args:
        robot: Name of a robot, path of a folder with one, or "bench".
        options: See `BusOptions`.

    Raises:
        UsageError: An option is unknown, chosen by the bus itself, or cannot be.
    """
    if taken := set(options) & set(RESERVED):
        raise UsageError(f"a test's bus chooses its own {' and '.join(sorted(taken))}")
    query = urlencode({key: value for key, value in options.items() if value != ""}, safe=":,;")
    url = f"{SCHEME}://{robot}?{query}"
    parse_address(url)
    return url
