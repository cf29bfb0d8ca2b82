"""Parses ``twin://`` URLs, which describe an emulated world.

``twin://op3[?clock=virtual|real&world=NAME&bus=legs&faults=drop:0.01&seed=1&supply=12...]`` is a
robot of ours; ``twin://bench?servos=STS3215:1-20&baud=1000000`` is a set of servos of one protocol
on a bench. ``twin:///FOLDER`` (an absolute path) or ``twin://./FOLDER`` is a robot of one's own.
"""

from dataclasses import dataclass, fields, replace
from typing import Annotated, Any
from urllib.parse import parse_qsl, urlsplit

from windup.hal.errors import UsageError, suggest
from windup.hal.ranges import Range, check_numbers
from windup.sim_twin.wire.faults.fault_rule import LAST_ID
from windup.sim_twin.wire.faults.fault_text import parse_rules
from windup.sim_twin.wire.world.hand import parse_hands

SCHEME = "twin"
BENCH = "bench"


@dataclass(frozen=True)
class Address:
    """The parts of a URL.

    Attributes:
        robot: Name of a robot, or "bench".
        clock: "virtual" (time advances only in waits) or "real".
        world: Name of the world; ports with the same name share it, also one after the other. A
            world without a name lives until its last port is closed.
        bus: Name of the robot's bus.
        faults: Text of faults, see `Faults.parse`.
        seed: Seed of all random numbers.
        supply: Supply voltage, V; 0: the robot's own, or 12.
        latency: Latency of the adapter, ms.
        turnaround: Delay of the servos in addition to their return delay, us.
        missing: Whether servos after a missing one in a sync read "skip" its slot or "wait".
        power: Whether a board that switches the servo power starts with it "on" or "off".
        hold: Whether the robot is held until its servos are driven, "yes" or "no"; "always": also
            whenever none of them is driven any more.
        hand: Motions of limp joints by hand, see `parse_hands`.
        servos: On the bench, models and ids: "XM430-W350:1-20,XL430:30".
        baud: On the bench, the servos' baud rate; 0: the robot's own, or 1000000.
        return_delay: Initial return delay of the servos, in their unit of 2 us; -1: the factory
            default.
        physics: Of a robot: "mujoco", its twin, or "inertia", where each servo drives a separate
            inertia.
        imu: IMU on its own port, bus "imu": "auto", the one in the robot's file; "rvc", a BNO08x in
            UART-RVC mode; or "none".
    """

    robot: str
    clock: str = "virtual"
    world: str = ""
    bus: str = ""
    faults: str = ""
    seed: Annotated[int, Range(0, 2**32 - 1)] = 0
    supply: Annotated[float, Range(0.0, 60.0, "V")] = 0.0
    latency: Annotated[float, Range(0.0, 1_000.0, "ms")] = 0.0
    turnaround: Annotated[float, Range(0.0, 1e6, "us")] = 0.0
    missing: str = "skip"
    power: str = "on"
    hold: str = "yes"
    hand: str = ""
    servos: str = "XM430-W350:1"
    baud: Annotated[int, Range(0, 10_000_000)] = 0
    return_delay: Annotated[int, Range(-1, 254)] = -1
    physics: str = "mujoco"
    imu: str = "auto"


CHOICES = {
    "clock": ("virtual", "real"),
    "missing": ("skip", "wait"),
    "power": ("on", "off"),
    "hold": ("yes", "no", "always"),
    "physics": ("mujoco", "inertia"),
    "imu": ("auto", "rvc", "none"),
}
DEFAULTS = Address(BENCH)
OPTIONS = tuple(item.name for item in fields(Address) if item.name != "robot")


def parse_address(url: str) -> Address:
    """Return the parts of a URL.

    >>> parse_address("twin://op3?clock=real&supply=11.1").supply
    11.1

    Raises:
        UsageError: It is not a twin:// URL, an option is unknown or out of range, or a robot is
            given servos.
    """
    try:
        parts = urlsplit(url)
    except ValueError as error:  # brackets that do not enclose an IPv6 address
        raise UsageError(f"{url!r} is not a twin:// address: {error}") from None
    if parts.scheme != SCHEME or not (parts.netloc or parts.path.strip("/")):
        raise UsageError(f"{url!r} is not a twin:// address; 'twin://op3' is")
    values: dict[str, Any] = {"robot": parts.netloc + parts.path.rstrip("/")}
    for name, text in parse_qsl(parts.query, keep_blank_values=True):
        if name not in OPTIONS:
            raise UsageError(f"{url!r}: unknown option {name!r}{suggest(name, OPTIONS)}")
        values[name] = _value(url, name, text)
    address = replace(DEFAULTS, **values)
    check_numbers(address, f"{url!r}: ")
    parse_servos(address.servos)
    if "servos" in values and values["robot"] != BENCH:
        raise UsageError(
            f"{url!r}: servos are for {SCHEME}://{BENCH}; a robot has its own: give one of them"
        )
    parse_rules(address.faults)
    parse_hands(address.hand)
    return address


def parse_servos(text: str) -> list[tuple[str, int]]:
    """Return (model, id) of a text like "XM430-W350:1-20,XL430:30".

    >>> parse_servos("XL330:1-2,XC330-T288:7")
    [('XL330', 1), ('XL330', 2), ('XC330-T288', 7)]

    Raises:
        UsageError: The text is malformed.
    """
    found = []
    for part in text.split(","):
        name, _, ids = part.partition(":")
        first, _, last = ids.partition("-")
        try:
            numbers = range(int(first), int(last or first) + 1)
        except ValueError:
            numbers = range(0)
        if not numbers:
            raise UsageError(f"servos: {part!r}: a model and its ids, as in 'XM430-W350:1-20'")
        if numbers[0] < 0 or numbers[-1] > LAST_ID:
            raise UsageError(f"servos: {part!r}: ids are 0 .. {LAST_ID}")
        found += [(name, k) for k in numbers]
    return found


def _value(url: str, name: str, text: str) -> Any:
    if name in CHOICES and text not in CHOICES[name]:
        raise UsageError(f"{url!r}: {name} is one of {', '.join(CHOICES[name])}, not {text!r}")
    kind: type = type(getattr(DEFAULTS, name))
    try:
        return kind(text)
    except ValueError:
        raise UsageError(f"{url!r}: {name} is a number, not {text!r}") from None
