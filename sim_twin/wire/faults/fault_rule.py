"""One fault: what goes wrong, how often or when, and for whom."""

import math
import random
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

from windup.hal.errors import UsageError, suggest
from windup.hal.ranges import Range, check_number

# What befalls an answer on its way, and the seconds that some of them take by default.
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
# What befalls what the host sends.
REQUESTS: Final = {"echo": 0.0}
# What befalls servos, supply, adapter, IMU or board.
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
LAST_ID: Final = 253  # 254 is everybody's
SHARE: Final = Range(0.0, 1.0)
TIME: Final = Range(0.0, 1e9, "s")
# Keys that only one kind takes, with their defaults.
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
RATE = 0.01  # where neither rate nor time is given

Times = float | Sequence[float]


@dataclass
class Rule:
    """One fault.

    Attributes:
        kind: One of `KINDS`.
        rate: Share of the answers, or requests, that it hits.
        at: The times that are left, s, in order; where there were any, `rate` does not count.
        ids: Whom it hits; None: everybody.
        bus: On which bus; None: on all.
        seconds: How late, or how long.
        volts: Supply in a brown-out, V.
        degrees: How hot a motor gets at least, degrees C.
        speed: What a spinning gyroscope reads about x, rad/s.
    """

    kind: str
    rate: float = RATE
    at: list[float] = field(default_factory=list)
    ids: frozenset[int] | None = None
    bus: str | None = None
    seconds: float = 0.0
    volts: float = 0.0
    degrees: float = 0.0
    speed: float = 0.0

    def __post_init__(self) -> None:
        self._scripted = bool(self.at)

    def concerns(self, bus: str, identifier: int) -> bool:
        """Whether this servo can be hit."""
        here = self.bus is None or self.bus == bus
        return here and (self.ids is None or identifier in self.ids)

    def check_target(self, buses: Mapping[str, Sequence[int]]) -> None:
        """Raise what could never happen on `buses`, name to ids.

        Raises:
            UsageError: There is no such bus, or nobody on it has one of the ids.
        """
        if self.bus is not None and self.bus not in buses:
            raise UsageError(
                f"faults: {self.kind}: unknown bus {self.bus!r}{suggest(self.bus, buses)}"
            )
        there = {id for name, ids in buses.items() if self.bus in (None, name) for id in ids}
        if self.ids is not None and not self.ids & there:
            given, known = (", ".join(map(str, sorted(ids))) for ids in (self.ids, there))
            raise UsageError(f"faults: {self.kind}: nobody has id {given}; there are {known}")

    def strikes(self, dice: random.Random, bus: str, identifier: int, now: float) -> bool:
        """Whether the answer that a servo begins at `now` s is hit."""
        if not self.concerns(bus, identifier):
            return False
        if not self._scripted:
            return dice.random() < self.rate
        if self.kind in EVENTS or not self.at or now < self.at[0]:
            return False
        del self.at[0]
        return True


def make_rule(
    kind: str,
    rate: float | None = None,
    *,
    at: Times | None = None,
    ids: Iterable[int] | None = None,
    bus: str | None = None,
    seconds: float | None = None,
    **extra: float | None,
) -> Rule:
    """Return a checked rule; what is left out, or None, has its default.

    Args:
        kind: One of `KINDS`.
        rate: Share of the answers that it hits.
        at: Instead of a rate the time, s, or several.
        ids: Whom it hits.
        bus: On which bus.
        seconds: How late, or how long; infinity: for ever.
        **extra: The keys of `EXTRA`.

    Raises:
        UsageError: A value that cannot be.
    """
    check_kind(kind)
    if at is None:
        rate = RATE if rate is None else rate
        check_number(f"faults: {kind}: rate", rate, SHARE)
        times: list[float] = []
    else:
        if rate is not None:
            raise UsageError(f"faults: {kind}: a rate or a time, not both")
        times = sorted(at) if isinstance(at, Sequence) else [at]
    for time in times:
        check_number(f"faults: {kind}: at", time, TIME)
    lasts = SECONDS[kind] if seconds is None else seconds
    if not (kind in EVENTS and lasts == math.inf):  # it may last for ever
        check_number(f"faults: {kind}: seconds", lasts, TIME)
    if seconds is not None and not SECONDS[kind]:
        takers = ", ".join(other for other in KINDS if SECONDS[other])
        raise UsageError(f"faults: {kind}: takes no seconds; these do: {takers}")
    if ids is not None and kind in REQUESTS:
        raise UsageError(f"faults: {kind}: takes no ids; it concerns all that the host sends")
    who = None if ids is None else frozenset(ids)
    return Rule(kind, rate or 0.0, times, who, bus, lasts, **_extra(kind, extra))


def check_kind(kind: str) -> None:
    """Raise if there is no such kind of fault.

    Raises:
        UsageError: There is none.
    """
    if kind not in KINDS:
        raise UsageError(f"faults: unknown kind {kind!r}{suggest(kind, KINDS)}")


def _extra(kind: str, given: Mapping[str, float | None]) -> dict[str, float]:
    """Return the keys of `EXTRA` that `kind` takes, with their values."""
    for key, value in given.items():
        taker = EXTRA[key][0]
        if value is not None and kind != taker:
            raise UsageError(f"faults: {kind}: takes no {key}; only {taker} does")
        if value is not None:
            check_number(f"faults: {kind}: {key}", value, RANGES[key])
    taken = {key: default for key, (taker, default) in EXTRA.items() if taker == kind}
    return {key: default if (value := given.get(key)) is None else value
            for key, default in taken.items()}  # fmt: skip
