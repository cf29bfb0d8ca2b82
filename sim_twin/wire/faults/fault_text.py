"""Parses the text form of faults, as used in URLs, on the command line and in injections."""

from collections.abc import Iterable
from typing import Final

from windup.hal.errors import UsageError, suggest
from windup.sim_twin.wire.faults.fault_rule import (
    EVENTS,
    EXTRA,
    LAST_ID,
    SECONDS,
    FaultRule,
    check_kind,
    make_rule,
)

KEYS: Final = ("rate", "at", "ids", "bus", "seconds", *EXTRA)
EXAMPLE = "'drop:0.01,late:0.02:seconds=0.003:ids=1-6,unplug:at=2.5:seconds=0.5'"


def parse_rules(text: str, live: bool = False) -> list[FaultRule]:
    """Return the faults of a text: ``KIND[:RATE][:KEY=VALUE...]``, joined by commas.

    Keys are rate (its key may be omitted), at (s; several joined by ';'), ids ("1-6;9"), bus,
    seconds, volts, degrees and speed. Spaces around commas and colons are ignored.

    >>> parse_rules("drop:0.02:ids=1-2;7")[0].ids == {1, 2, 7}
    True

    Args:
        text: The text.
        live: The text is injected into a running world: an event without rate and time happens
            now, and times count from now.

    Raises:
        UsageError: The text is malformed or a value is out of range.
    """
    return [_parse(part.strip(), live) for part in text.split(",") if part.strip()]


def format_rule(rule: FaultRule) -> str:
    """Return a fault as text, in the form that `parse_rules` reads.

    >>> format_rule(make_rule("unplug", at=2.5, seconds=1.0))
    'unplug:at=2.5:seconds=1.0'
    """
    words = [rule.kind]
    words.append(f"at={_joined(rule.at)}" if rule.at else f"rate={rule.rate}")
    if rule.ids is not None:
        words.append(f"ids={_joined(sorted(rule.ids))}")
    if rule.bus is not None:
        words.append(f"bus={rule.bus}")
    if SECONDS[rule.kind]:
        words.append(f"seconds={rule.seconds}")
    words += [
        f"{key}={getattr(rule, key)}" for key, (kind, _) in EXTRA.items() if kind == rule.kind
    ]
    return ":".join(words)


def _joined(numbers: Iterable[float]) -> str:
    return ";".join(map(str, numbers))


def _parse(part: str, live: bool) -> FaultRule:
    kind, *words = (word.strip() for word in part.split(":"))
    check_kind(kind)
    values: dict[str, str] = {}
    for word in words:
        key, equals, value = word.partition("=")
        key, value = (key, value) if equals else ("rate", key)
        if key not in KEYS:
            raise UsageError(f"faults: {part!r}: unknown key {key!r}{suggest(key, KEYS)}")
        values[key] = value
    if live and kind in EVENTS and not {"rate", "at"} & set(values):
        values["at"] = "0"
    try:
        return make_rule(
            kind,
            float(values.pop("rate")) if "rate" in values else None,
            at=_numbers(values.pop("at")) if "at" in values else None,
            ids=_ids(values.pop("ids")) if "ids" in values else None,
            bus=values.pop("bus", None),
            seconds=float(values.pop("seconds")) if "seconds" in values else None,
            **{key: float(value) for key, value in values.items()},
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
