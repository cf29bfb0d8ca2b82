"""The points of a sweep: a grid over a command's options, or random ones."""

from dataclasses import dataclass
from itertools import product

import numpy as np

from windup.hal.errors import UsageError
from windup.hal.ranges import Range, read_number

COUNT = Range(2, 10_000)
SYNTAX = "write name=v1,v2,.. or name=low:high:count"
Point = dict[str, str]


@dataclass(frozen=True)
class Axis:
    """One option and its values, as written on the command line.

    Attributes:
        name: Name of the option, with underscores.
        values: The values; empty for a range without a count, which can only be drawn from.
        low: Lower end of a range; None for a list of values.
        high: Upper end of a range; None for a list of values.
    """

    name: str
    values: tuple[str, ...]
    low: float | None = None
    high: float | None = None

    @property
    def checked(self) -> tuple[str, ...]:
        """Values that represent all others when the command's parser checks them."""
        return self.values or tuple(
            _written(end) for end in (self.low, self.high) if end is not None
        )

    def draw(self, rng: np.random.Generator) -> str:
        """Return a random value."""
        if self.low is None or self.high is None:
            return str(rng.choice(np.array(self.values)))
        return _written(float(rng.uniform(self.low, self.high)))


def parse_axis(text: str) -> Axis:
    """Parse the argument of one --grid into an axis.

    >>> parse_axis("target=0.1:0.3:3").values
    ('0.1', '0.2', '0.3')
    >>> parse_axis("sampling=sp,fl").values
    ('sp', 'fl')

    Raises:
        UsageError: The text is malformed.
    """
    name, equals, rest = text.partition("=")
    name = name.strip().lstrip("-").replace("-", "_")
    if not equals or not name or not rest:
        raise UsageError(f"--grid {text}: {SYNTAX}")
    parts = rest.split(":")
    if "," in rest or len(parts) == 1:
        values = tuple(value.strip() for value in rest.split(","))
        if not all(values):
            raise UsageError(f"--grid {text}: a value is missing between the commas")
        return Axis(name, values)
    return _range(name, text, parts)


def _range(name: str, text: str, parts: list[str]) -> Axis:
    if len(parts) > 3:
        raise UsageError(f"--grid {text}: {SYNTAX}")
    where = f"--grid {text}"
    low, high = (read_number(where, part) for part in parts[:2])
    count = 0
    if len(parts) == 3:
        count = int(read_number(f"{where}: count", parts[2], COUNT, kind=int))
    if not low < high:
        raise UsageError(f"--grid {text}: {SYNTAX}, with low below high")
    values = tuple(_written(float(value)) for value in np.linspace(low, high, count))
    return Axis(name, values, low, high)


def points(axes: list[Axis], random: int | None, seed: int) -> list[Point]:
    """Return all points of the grid, or `random` of them drawn from its ranges and lists.

    The first of N random points are those of a smaller N, so that a sweep can be extended.

    >>> points([parse_axis("a=1,2"), parse_axis("b=x")], None, 0)
    [{'a': '1', 'b': 'x'}, {'a': '2', 'b': 'x'}]

    Raises:
        UsageError: An axis is given twice, or a range without a count is not drawn at random.
    """
    names = [axis.name for axis in axes]
    if len(set(names)) < len(names):
        twice = next(name for name in names if names.count(name) > 1)
        raise UsageError(f"--grid {twice}: this option stands twice")
    if random is not None:
        if random < 1 or not axes:
            raise UsageError(f"--random {random}: give 1 or more, and a --grid to draw from")
        rng = np.random.default_rng(seed)
        return [{axis.name: axis.draw(rng) for axis in axes} for _ in range(random)]
    for axis in axes:
        if not axis.values:
            raise UsageError(
                f"--grid {axis.name}={axis.low:g}:{axis.high:g}: how many? {SYNTAX}, "
                "or draw from the range with --random N"
            )
    return [dict(zip(names, values, strict=True)) for values in product(*(a.values for a in axes))]


def _written(value: float) -> str:
    return f"{value:.6g}"
