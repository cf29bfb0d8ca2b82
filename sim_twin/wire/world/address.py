"""What a ``twin://`` URL says.

``twin://op3[?clock=virtual|real&world=NAME&bus=legs&faults=drop:0.01&seed=1&supply=12...]``: a
robot of ours; ``twin://bench?servos=STS3215:1-20&baud=1000000``: servos of one protocol on a bench.
``twin:///FOLDER`` with an absolute path, or ``twin://./FOLDER``, is a robot of one's own.
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
        robot: A robot's name, or "bench".
        clock: "virtual" (time passes when somebody waits) or "real".
        world: Name of the world; opens of one world share it, also one after the other. Without a
            name, the world lives until its last port is closed.
        bus: Which bus of the robot.
        faults: See `Faults.parse`.
        seed: Seed of everything random.
        supply: Voltage, V; 0: the robot's own, or 12.
        latency: Of the adapter, ms.
        turnaround: Of the servos, on top of their return delay, us.
        missing: Behind a missing servo in a sync read, the others "skip" its slot or "wait".
        power: Whether a board that switches the servo power has it "on" or "off" at the start.
        hold: Whether the robot is held until its servos are driven, "yes" or "no"; "always": also
            whenever none of them is driven any more.
        hand: What hands do to limp joints, see `parse_hands`.
        servos: On the bench, models and ids: "XM430-W350:1-20,XL430:30".
        baud: On the bench, the servos' baud rate; 0: the robot's own, or 1000000.
        return_delay: Of the servos at the start, in their unit of 2 us; -1: as they leave the
            factory.
        physics: Of a robot: "mujoco", its twin, or "inertia", where each servo has nothing to do
            with the others.
        imu: The IMU on a port of its own, bus "imu": "auto", the one that a robot's file says;
            "rvc", a BNO08x in UART-RVC mode; or "none".
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
        UsageError: It is not a twin:// URL, or says something unknown.
    """
    try:
        parts = urlsplit(url)
    except ValueError as error:  # brackets that are none of an IPv6 address
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
    parse_rules(address.faults)
    parse_hands(address.hand)
    return address


def parse_servos(text: str) -> list[tuple[str, int]]:
    """Return (model, id) of a text like "XM430-W350:1-20,XL430:30".

    >>> parse_servos("XL330:1-2,XC330-T288:7")
    [('XL330', 1), ('XL330', 2), ('XC330-T288', 7)]

    Raises:
        UsageError: The text says something else.
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
