"""A mistake in a robot.toml: a key, and in one line what is wrong there and what would be right."""

from collections.abc import Iterable, Iterator

from windup.hal.errors import suggest

Mistake = tuple[str, str]
SLACK = 1e-6
"""Rounding that a limit may carry, rad."""


def known(key: str, kind: str, name: str, names: Iterable[str]) -> Iterator[Mistake]:
    """Yield a mistake if there is nothing of this `name`, with the likely one of `names`."""
    if name not in (names := tuple(names)):
        yield key, f"unknown {kind} {name!r}{suggest(name, names)}"


def unique(key: str, kind: str, names: Iterable[str]) -> Iterator[Mistake]:
    """Yield a mistake for each of `names` that two of a kind have."""
    names = list(names)
    for name in dict.fromkeys(names):
        if names.count(name) > 1:
            yield key, f"{kind} {name!r} stands there twice"
