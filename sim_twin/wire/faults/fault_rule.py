"""One fault: its kind, its rate or times, and its targets."""

import math
import random
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from windup.hal.errors import UsageError, suggest
from windup.hal.ranges import Range, check_number

# Faults of status packets in transit, with the default duration of those that have one, s.
ANSWERS: Final = {
    "drop": 0.0,
    "corrupt": 0.0,
    "cut": 0.0,
    "noise": 0.0,
    "late": 0.002,
    "delay": 0.004,
    "wrong_id": 0.0,
    "wrong_length": 0.0,
    "glue": 0.004,
    "longer": 0.0,
    "shorter": 0.0,
    "zeros": 0.0,
    "stale": 0.0,
    "jump": 0.0,
    "twice": 0.0,
    "late_byte": 0.02,
}
# Faults of the bytes that the host sends.
REQUESTS: Final = {"echo": 0.0}
# Events of servos, supply, adapter, IMU or board, with their default durations, s.
EVENTS: Final = {
    "dead": 0.0,
    "reset": 0.0,
    "brown_out": 0.1,
    "overload": 0.0,
    "unplug": 0.5,
    "heat": math.inf,
    "imu_silent": math.inf,
    "imu_frozen": math.inf,
    "imu_spin": math.inf,
    "button": 0.2,
}
SECONDS: Final = {**ANSWERS, **REQUESTS, **EVENTS}
KINDS: Final = tuple(SECONDS)
LAST_ID: Final = 253  # 254 is the broadcast id
SHARE: Final = Range(0.0, 1.0)
TIME: Final = Range(0.0, 1e9, "s")
# Keys that only one kind of fault takes, with that kind and the default value.
EXTRA: Final = {
    "volts": ("brown_out", 0.0),
    "degrees": ("heat", 75.0),
    "speed": ("imu_spin", 3.0),
}
RANGES: Final = {
    "volts": Range(0.0, 60.0, "V"),
    "degrees": Range(-273.0, 255.0, "degrees C"),
    "speed": Range(-100.0, 100.0, "rad/s"),
}
DEFAULT_RATE = 0.01  # default share of answers that are hit, if neither rate nor time is given

Times = float | Sequence[float]


@dataclass
class FaultRule:
    """One fault.

    Attributes:
        kind: One of `KINDS`.
        rate: Share of the answers, or requests, that it hits.
        at: Remaining times, s, in order; a fault created with times ignores `rate`.
        ids: Ids that it can hit; None: all.
        bus: Name of the bus that it is limited to; None: all buses.
        seconds: Delay or duration, s.
        volts: Supply voltage in a brown-out, V.
        degrees: Lowest temperature of a heated motor, degrees C.
        speed: Angular rate about x that a spinning gyroscope reports, rad/s.
    """

    kind: str
    rate: float = DEFAULT_RATE
    at: list[float] = field(default_factory=list)
    ids: frozenset[int] | None = None
    bus: str | None = None
    seconds: float = 0.0
    volts: float = 0.0
    degrees: float = 0.0
    speed: float = 0.0

    def __post_init__(self) -> None:
        self._scripted = bool(self.at)

    def applies_to(self, bus: str, identifier: int) -> bool:
        """Return whether the fault can hit the device with this id on this bus."""
        here = self.bus is None or self.bus == bus
        return here and (self.ids is None or identifier in self.ids)

    def check_target(self, buses: Mapping[str, Sequence[int]]) -> None:
        """Check that the fault can happen on `buses`, a mapping from names to ids.

        Raises:
            UsageError: There is no such bus, or no device on it has any of the ids.
        """
        if self.bus is not None and self.bus not in buses:
            raise UsageError(
                f"faults: {self.kind}: unknown bus {self.bus!r}{suggest(self.bus, buses)}"
            )
        there = {id for name, ids in buses.items() if self.bus in (None, name) for id in ids}
        if self.ids is not None and not self.ids & there:
            given, known = (", ".join(map(str, sorted(ids))) or "none" for ids in (self.ids, there))
            raise UsageError(f"faults: {self.kind}: no servo has id {given}; ids here: {known}")

    def hits(self, rng: random.Random, bus: str, identifier: int, now: float) -> bool:
        """Return whether it hits the answer that a device begins at `now`, s."""
        if not self.applies_to(bus, identifier):
            return False
        if not self._scripted:
            return rng.random() < self.rate
        if self.kind in EVENTS or not self.at or now < self.at[0]:
            return False
        del self.at[0]
        return True


def make_rule(
    kind: str,
    rate: float | None = None,
    *,
    at: Times | None = None,
    ids: Iterable[int] | int | None = None,
    bus: str | None = None,
    seconds: float | None = None,
    **extra: float | None,
) -> FaultRule:
    """Return a checked rule; arguments that are omitted or None get their defaults.

    Args:
        kind: One of `KINDS`.
        rate: Share of the answers that it hits.
        at: One or several times instead of a rate, s.
        ids: Ids, or the id, that it can hit.
        bus: Name of the bus that it is limited to.
        seconds: Delay or duration, s; infinity: for ever.
        **extra: The keys of `EXTRA`.

    Raises:
        UsageError: A value is out of range, or this kind does not take it.
    """
    check_kind(kind)
    if at is None:
        rate = DEFAULT_RATE if rate is None else rate
        check_number(f"faults: {kind}: rate", rate, SHARE)
        times: list[float] = []
    else:
        if rate is not None:
            raise UsageError(f"faults: {kind}: give a rate or a time, not both")
        times = sorted(at) if isinstance(at, Sequence) else [at]
    for time in times:
        check_number(f"faults: {kind}: at", time, TIME)
    lasts = SECONDS[kind] if seconds is None else seconds
    if not (kind in EVENTS and lasts == math.inf):  # an event may last for ever
        check_number(f"faults: {kind}: seconds", lasts, TIME)
    if seconds is not None and not SECONDS[kind]:
        takers = ", ".join(other for other in KINDS if SECONDS[other])
        raise UsageError(f"faults: {kind}: takes no seconds; these do: {takers}")
    if ids is not None and kind in REQUESTS:
        raise UsageError(
            f"faults: {kind}: takes no ids; it applies to all bytes that the host sends"
        )
    who = None if ids is None else frozenset([ids] if isinstance(ids, int) else ids)
    return FaultRule(kind, rate or 0.0, times, who, bus, lasts, **_extra(kind, extra))


def check_kind(kind: str) -> None:
    """Check that a kind of fault exists.

    Raises:
        UsageError: It does not.
    """
    if kind not in KINDS:
        raise UsageError(f"faults: unknown kind {kind!r}{suggest(kind, KINDS)}")


def _extra(kind: str, given: Mapping[str, float | None]) -> dict[str, float]:
    """Return the `EXTRA` keys that `kind` takes, with given or default values."""
    for key, value in given.items():
        taker = EXTRA[key][0]
        if value is not None and kind != taker:
            raise UsageError(f"faults: {kind}: takes no {key}; only {taker} does")
        if value is not None:
            check_number(f"faults: {kind}: {key}", value, RANGES[key])
    taken = {key: default for key, (taker, default) in EXTRA.items() if taker == kind}
    return {key: default if (value := given.get(key)) is None else value
            for key, default in taken.items()}  # fmt: skip
