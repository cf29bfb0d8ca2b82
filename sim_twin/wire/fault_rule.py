"""One fault: what goes wrong, how often or when, and for whom; and how a URL says so."""

import random
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from math import inf
from typing import Final

from hal.errors import UsageError, suggest
from hal.ranges import Range, check_number

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
}
# What befalls servos, supply or adapter.
EVENTS: Final = {"dead": 0.0, "reset": 0.0, "brown_out": 0.1, "overload": 0.0, "unplug": 0.5}
SECONDS: Final = {**ANSWERS, **EVENTS}
KINDS: Final = tuple(SECONDS)
KEYS: Final = ("rate", "at", "ids", "bus", "seconds", "volts")
LAST_ID: Final = 253  # 254 is everybody's
SHARE: Final = Range(0.0, 1.0)
TIME: Final = Range(0.0, 1e9, "s")
VOLTS: Final = Range(0.0, 60.0, "V")
RATE = 0.01  # where neither rate nor time is given
EXAMPLE = "'drop:0.01,late:0.02:seconds=0.003:ids=1-6,unplug:at=2.5:seconds=0.5'"

Times = float | Sequence[float]


@dataclass
class Rule:
    """One fault.

    Attributes:
        kind: One of `KINDS`.
        rate: Share of the answers that it hits.
        at: The times that are left, s, in order; where there were any, `rate` does not count.
        ids: Whom it hits; None: everybody.
        bus: On which bus; None: on all.
        seconds: How late, or how long.
        volts: Supply in a brown-out, V.
    """

    kind: str
    rate: float = RATE
    at: list[float] = field(default_factory=list)
    ids: frozenset[int] | None = None
    bus: str | None = None
    seconds: float = 0.0
    volts: float = 0.0

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
    volts: float = 0.0,
) -> Rule:
    """Return a checked rule; what is left out has its default.

    Raises:
        UsageError: A value that cannot be.
    """
    if kind not in KINDS:
        raise UsageError(f"faults: unknown kind {kind!r}{suggest(kind, KINDS)}")
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
    if not (kind == "unplug" and lasts == inf):  # an adapter may never come back
        check_number(f"faults: {kind}: seconds", lasts, TIME)
    check_number(f"faults: {kind}: volts", volts, VOLTS)
    if seconds is not None and not SECONDS[kind]:
        takers = ", ".join(other for other in KINDS if SECONDS[other])
        raise UsageError(f"faults: {kind}: takes no seconds; these do: {takers}")
    if volts and kind != "brown_out":
        raise UsageError(f"faults: {kind}: takes no volts; only brown_out does")
    who = None if ids is None else frozenset(ids)
    return Rule(kind, rate or 0.0, times, who, bus, lasts, volts)


def parse_rules(text: str) -> list[Rule]:
    """Return the faults of a URL: ``KIND[:RATE][:KEY=VALUE...]``, joined by commas.

    Keys are rate (may stand alone), at (s; several joined by ';'), ids ("1-6;9"), bus, seconds and
    volts. Spaces around commas and colons do not count.

    >>> parse_rules("drop:0.02:ids=1-2;7")[0].ids == {1, 2, 7}
    True

    Raises:
        UsageError: The text says something else.
    """
    return [_parse(part.strip()) for part in text.split(",") if part.strip()]


def _parse(part: str) -> Rule:
    kind, *words = (word.strip() for word in part.split(":"))
    if kind not in KINDS:
        raise UsageError(f"faults: unknown kind {kind!r}{suggest(kind, KINDS)}")
    values: dict[str, str] = {}
    for word in words:
        key, equals, value = word.partition("=")
        key, value = (key, value) if equals else ("rate", key)
        if key not in KEYS:
            raise UsageError(f"faults: {part!r}: unknown key {key!r}{suggest(key, KEYS)}")
        values[key] = value
    try:
        return make_rule(
            kind,
            float(values.pop("rate")) if "rate" in values else None,
            at=_numbers(values.pop("at")) if "at" in values else None,
            ids=_ids(values.pop("ids")) if "ids" in values else None,
            bus=values.pop("bus", None),
            seconds=float(values.pop("seconds")) if "seconds" in values else None,
            volts=float(values.pop("volts", "0")),
        )
    except ValueError:
        raise UsageError(
            f"faults: {part!r}: a rate from 0 to 1, keys, ids up to {LAST_ID}, as in {EXAMPLE}"
        ) from None


def _numbers(text: str) -> list[float]:
    return [float(word) for word in text.split(";")]


def _ids(text: str) -> list[int]:
    found: list[int] = []
    for word in text.split(";"):
        first, _, last = word.partition("-")
        ids = range(int(first), int(last or first) + 1)
        if not ids or ids[0] < 0 or ids[-1] > LAST_ID:
            raise ValueError(f"{word}: no ids")
        found += ids
    return found
