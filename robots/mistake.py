"""Mistakes in a robot.toml, and the two checks of names that most others need."""

from collections.abc import Iterable, Iterator

from windup.hal.errors import suggest

Mistake = tuple[str, str]
"""Key and message; the message is one line with a remedy."""
SLACK = 1e-6
"""Tolerance of limits for rounding, rad."""


def check_known(key: str, kind: str, name: str, names: Iterable[str]) -> Iterator[Mistake]:
    """Yield a mistake if `name` is not in `names`; the message has the most similar one."""
    if name not in (names := tuple(names)):
        yield key, f"unknown {kind} {name!r}{suggest(name, names)}"


def check_unique(key: str, kind: str, names: Iterable[str]) -> Iterator[Mistake]:
    """Yield a mistake for each name that occurs more than once."""
    names = list(names)
    for name in dict.fromkeys(names):
        if names.count(name) > 1:
            yield key, f"{kind} {name!r} is given twice"
