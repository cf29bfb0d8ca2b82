"""Range checks for numbers from users and files, done before any port or file is opened.

A field of a dataclass, or a parameter of a function, is annotated with its range::

    seconds: Annotated[float, Range(0.0, 86400.0, "s", above=True)] = 5.0

The range applies to every number in the value, also in a tuple. Any other number must be finite.
"""

from collections.abc import Callable, Hashable, Iterator, Mapping
from dataclasses import dataclass, fields
from functools import cache, wraps
from inspect import signature
from math import inf
from numbers import Real
from typing import Any, Final, ParamSpec, TypeVar, cast, get_args, get_type_hints

from windup.hal.errors import UsageError

P = ParamSpec("P")
T = TypeVar("T")


@dataclass(frozen=True)
class Range:
    """A range of valid numbers.

    Attributes:
        low: The smallest.
        high: The largest.
        unit: Their unit, for messages.
        above: True if `low` itself is excluded.
    """

    low: float = -inf
    high: float = inf
    unit: str = ""
    above: bool = False

    def problem(self, value: float) -> str:
        """Return an instruction that states the valid range, or "" if `value` is valid.

        >>> Range(0.0, 90.0, "degrees").problem(91.0)
        'give 0 .. 90 degrees'
        """
        if not -inf < value < inf:
            return f"give a finite number{f' of {self.unit}' if self.unit else ''}"
        inside = self.low < value if self.above else self.low <= value
        return "" if inside and value <= self.high else f"give {self}"

    def __str__(self) -> str:
        unit = f" {self.unit}" if self.unit else ""
        if self.above:
            return f"more than {self.low:.12g}, up to {self.high:.12g}{unit}"
        return f"{self.low:.12g} .. {self.high:.12g}{unit}"


FINITE: Final = Range()
SHOWN: Final = 40
"""Maximum number of characters of an invalid text that a message quotes."""


def check_number(name: str, value: float, range: Range = FINITE) -> None:
    """Raise unless a number is finite and in its range.

    Raises:
        UsageError: It is not; the message begins with `name` and states the valid range.
    """
    if problem := range.problem(value):
        raise UsageError(f"{name} {format_number(value)}: {problem}")


def read_number(name: str, text: str, range: Range = FINITE, *, kind: type = float) -> float:
    """Return the number that `text` contains.

    >>> read_number("--target up", "0.2")
    0.2

    Args:
        name: Name of the option or key, for the message.
        text: The text to convert.
        range: Valid range.
        kind: float, or int for whole numbers.

    Raises:
        UsageError: It is not a number, not finite, or outside its range.
    """
    try:
        value: float = kind(text)
    except ValueError:
        what = "whole number" if kind is int else "number"
        raise UsageError(f"{name}: {text[:SHOWN]!r} is no {what}") from None
    if problem := range.problem(value):
        raise UsageError(f"{name}: {text[:SHOWN]}: {problem}")
    return value


def check_numbers(record: Any, prefix: str = "") -> None:
    """Raise unless every number in a dataclass is finite and in the range of its field.

    Args:
        record: The dataclass instance.
        prefix: Put before the field's name in messages; after "--" names are hyphenated.

    Raises:
        UsageError: A number is not finite or is out of range.
    """
    values = {field.name: getattr(record, field.name) for field in fields(record)}
    _check(_ranges(cast(Hashable, type(record))), values, prefix)


def numbers_checked(function: Callable[P, T]) -> Callable[P, T]:
    """Decorate a function to raise UsageError if an argument is not finite or out of its range."""
    known = signature(function)

    @wraps(function)
    def checked(*args: P.args, **kwargs: P.kwargs) -> T:
        _check(_ranges(function), known.bind(*args, **kwargs).arguments, "")
        return function(*args, **kwargs)

    return checked


def format_number(value: float) -> str:
    """Return a number as text for messages; integers with all their digits."""
    return f"{value:g}" if isinstance(value, float) else str(value)


def _check(ranges: Mapping[str, Range], values: Mapping[str, Any], prefix: str) -> None:
    for name, value in values.items():
        shown = prefix + (name.replace("_", "-") if prefix == "--" else name)
        for number in _numbers(value):
            check_number(shown, number, ranges.get(name, FINITE))


@cache
def _ranges(owner: Hashable) -> dict[str, Range]:
    """Return the ranges of a dataclass's fields, or of a function's parameters."""
    hints = get_type_hints(cast(Any, owner), include_extras=True)
    found = {name: next(_annotated(hint), None) for name, hint in hints.items()}
    return {name: range for name, range in found.items() if range is not None}


def _annotated(hint: Any) -> Iterator[Range]:
    """Yield the ranges in the annotations of a type, at any depth."""
    for part in (*getattr(hint, "__metadata__", ()), *get_args(hint)):
        if isinstance(part, Range):
            yield part
        else:
            yield from _annotated(part)


def _numbers(value: Any) -> Iterator[float]:
    """Yield the numbers in a value, except bools."""
    if isinstance(value, tuple | list):
        for item in value:
            yield from _numbers(item)
    elif isinstance(value, Real) and not isinstance(value, bool):
        yield value  # type: ignore[misc]
