"""Options of the emulated buses of a test, and the URL that they form."""

from collections.abc import Mapping
from pathlib import Path
from typing import Literal, TypedDict
from urllib.parse import urlencode

from windup.hal.errors import UsageError
from windup.sim_twin.wire.world.address import BENCH, SCHEME, parse_address

RESERVED = ("clock", "world", "bus")
"""Options of a twin:// URL that `ServoBus` and `ServoPty` set themselves."""


class BusOptions(TypedDict, total=False):
    """Options of an emulated bus; omitted options have their defaults.

    Attributes:
        servos: Models and ids on a bench, "XM430-W350:1-20,XL430:30"; all of one protocol.
        baud: Baud rate of the servos, bits/s; by default the robot's, or 1,000,000.
        return_delay: Initial return delay register of the servos, in units of 2 us; by default the
            factory value (of a Dynamixel 250, which is 500 us).
        latency: Time for which the adapter holds bytes back, ms; 0 by default, 16 for an FTDI chip
            with its default latency timer.
        turnaround: Time from the end of a request to an answer, besides the return delay, us.
        missing: Behaviour of the servos after a missing one in a sync read: they "skip" its slot
            (default), or "wait" for its answer.
        supply: Supply voltage, V; by default the robot's, or 12, limited to the servos' maximum.
        physics: Physics of a robot: "mujoco" (its twin, default), or "inertia" (separate servos).
        power: Servo power switched by an OpenCR board at the start: "on" (default) or "off".
        hold: Whether a robot is held until all its servos are driven: "yes" (default), "no", or
            "always", also whenever none of them is driven any more.
        hand: Hands that turn limp joints, "JOINT:DEGREES:SECONDS", joined by commas.
        imu: A BNO08x on a separate port, bus "imu": "rvc", "none", or "auto" (default), which
            follows the robot.
        faults: Faults in their text form, "drop:0.01,late:0.02:seconds=0.003".
        seed: Seed of the random numbers; 0 by default.
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
        UsageError: An option is unknown or reserved, or a value is not possible.
    """
    if taken := set(options) & set(RESERVED):
        raise UsageError(f"a test's bus sets these options itself: {' and '.join(sorted(taken))}")
    _check_robot(str(robot), options)
    query = urlencode({key: value for key, value in options.items() if value != ""}, safe=":,;")
    url = f"{SCHEME}://{robot}?{query}"
    parse_address(url)
    return url


def _check_robot(robot: str, options: Mapping[str, object]) -> None:
    """Raise UsageError if servos are given as a robot, or with one."""
    if ":" in robot and "/" not in robot:
        raise UsageError(
            f'unknown robot {robot!r}; servos without a robot are given as servos="{robot}"'
        )
    if options.get("servos") and robot != BENCH:
        raise UsageError(
            f"servos are for a bench, and robot {robot!r} has its own: give one of the two"
        )
